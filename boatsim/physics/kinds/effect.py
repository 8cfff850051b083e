"""Base class of effects, and how a kind of effect adds its lines to the compiled program."""

from collections import namedtuple
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from functools import cache
from math import cos, sin
from operator import attrgetter
from typing import Any, ClassVar, NamedTuple, Protocol, Self

from boatsim.errors import BadInput
from boatsim.physics.content import snake_case
from boatsim.physics.param import LARGEST_FLOAT, UNSET, CheckedParameters
from boatsim.physics.waves.field import WaveField

# groups of numbers of a vessel that may be estimates
REFINED_GROUPS = ("damping", "thrust", "lag", "mass_centre", "inertia", "added_mass", "restoring")


@cache
def _named_tuple_type(fields: tuple[str, ...]) -> Callable[..., tuple[float, ...]]:
    """Return the NamedTuple type of these fields; one law has one type, to be compiled once."""
    return namedtuple("Given", fields)


@dataclass(frozen=True)
class Role:
    """Input signal of an effect's law, such as "thrust", which a vessel binds to a channel.

    It has a unit, a description and, if binding is optional, a fixed value.
    """

    unit: str
    words: str
    # value if no channel is bound; None: a channel is required
    fixed: float | None = None
    # an angle of which the law uses only sine and cosine, so that whole turns change nothing
    direction: bool = False


@dataclass(frozen=True)
class Effect(CheckedParameters):
    """Base class of effects: one term of a vessel's physics or one error of its instruments.

    An instance holds the parameters of the term. Subclasses derive from one or several of the kinds
    in this folder, such as force, inertia or measurement.
    """

    # sentence in a report: "a steady wind pushes the hull downwind ..."
    words: ClassVar[str] = ""
    # the same if the first fitted parameter exceeds its inactive value
    words_above: ClassVar[str] = ""
    # the law in LaTeX, with SNAME symbols, as the reference shows it
    formula: ClassVar[str] = ""
    # parameter -> its symbol in the formula, in LaTeX
    symbols: ClassVar[Mapping[str, str]] = {}
    shown_by: ClassVar[str] = ""  # manoeuvre in which the effect is most visible
    kind: ClassVar[str] = "physics"  # or "measurement"
    source: ClassVar[str] = ""  # paper, equation or table of the law
    # group of numbers of a vessel that it refines, one of REFINED_GROUPS: where a vessel file calls
    # that group estimated, the effect is a better value of a number and no missing physics
    refines: ClassVar[str] = ""
    # parameter -> number of the vessel to which it adds, as the mass of a load to "body.mass": if a
    # vessel file calls that number estimated, a load within its uncertainty is a better value of it
    adds_to: ClassVar[Mapping[str, str]] = {}
    # parameter -> coefficient of the vessel, in the same unit, whose fit contains it where the
    # effect is missing, as a linear damping contains that by waves
    contained_in: ClassVar[Mapping[str, str]] = {}
    # whether it acts from the surroundings, as wind does: the vessel does not limit its size
    of_surroundings: ClassVar[bool] = False
    # parameters that may change while a vessel moves, as the velocity of a current does: they are
    # inputs of a vessel that is exported to another simulator
    exogenous: ClassVar[tuple[str, ...]] = ()
    # parameters of its strength, zero if absent; empty: all fitted parameters
    strength: ClassVar[tuple[str, ...]] = ()
    # parameters that limit a quantity: the effect is absent at an infinite value of them
    limits: ClassVar[tuple[str, ...]] = ()
    # fact in the notes of a recording -> parameters that it gives
    facts: ClassVar[Mapping[str, tuple[str, ...]]] = {}
    # starting points of a fit; empty: a tenth of each spread
    starts: ClassVar[tuple[Mapping[str, float], ...]] = ()
    # parameter -> starting points as shares of the largest recorded command
    thresholds: ClassVar[Mapping[str, tuple[float, ...]]] = {}
    # signals that the law takes as its third argument, each bound to a channel
    roles: ClassVar[Mapping[str, Role]] = {}
    # role -> usual column of the measured quantity that it takes: the effect is a candidate for a
    # vessel that names all of these in [measured]
    recorded_as: ClassVar[Mapping[str, str]] = {}
    # results of the filter of its first role, which its law receives as further signals
    filtered: ClassVar[tuple[str, ...]] = ()
    filter_states: ClassVar[int] = 0  # of that filter
    # effects of a lower stage come first in the program; otherwise the order of the file counts
    stage: ClassVar[int] = 0
    # dof without which it has no effect, in addition to those of its parameters
    needs: ClassVar[tuple[str, ...]] = ()
    # dof of which it needs at least one, in addition to `needs`
    needs_one_of: ClassVar[tuple[str, ...]] = ()
    # fact -> values that exclude the effect
    ruled_out_by: ClassVar[Mapping[str, tuple[object, ...]]] = {}
    # fact -> value that must be specified, or the effect is no candidate
    required_facts: ClassVar[Mapping[str, object]] = {}
    # effect for each of whose instances it is a candidate of its own; "actuator" for a channel
    # effect, which is one for each actuator on which it acts; tried last where there are two drives
    once_per: ClassVar[str] = ""
    # effect that describes the same where there are two instances; where it cannot act, this one is
    # tested in its place
    of_two: ClassVar[str] = ""
    # effects that describe equal errors of all instances; one of them takes the place of several
    of_all: ClassVar[tuple[str, ...]] = ()
    # one candidate for all of `once_per` together, where each of them may be one
    jointly: ClassVar[bool] = False
    # effects with the same signature: this one is a candidate on request only
    confounded_with: ClassVar[tuple[str, ...]] = ()
    # a candidate only where the others leave a force unexplained, or include a confounded one
    tried_last: ClassVar[bool] = False
    # effects that are selected in its place where it is not tested; it is then tried last
    imitated_by: ClassVar[tuple[str, ...]] = ()
    # a random process: the filter tracks it, a simulation without data cannot
    random: ClassVar[bool] = False
    alone: ClassVar[bool] = False  # no candidate for a vessel that has one already
    # a term written by symbolic regression, not an effect of the library
    described: ClassVar[bool] = False
    # the channels bound to its roles are measured forces, which contain noise, and no commands
    measures_input: ClassVar[bool] = False
    # its law holds at any roll angle, also after several turns: the vessel may go over the top
    turns_over: ClassVar[bool] = False
    # its law also takes all actuators: `act`, `at` and the index of the recalled value
    sees_held: ClassVar[bool] = False
    # its law also takes all parameters `p` and the index of the first entry of its table in them
    sees_table: ClassVar[bool] = False
    # effect on each of whose instances it acts: its law takes their signals and parameters
    per_instance_of: ClassVar[str] = ""
    # with `influence`: instances in `on` are influenced by all others, not only by those in `on`
    influenced_by_all: ClassVar[bool] = False

    # settings that are paths; relative ones start at the folder of the file that contains them
    paths: ClassVar[tuple[str, ...]] = ()

    filled: frozenset[str] = field(  # parameters set by `with_all_parameters` instead of by a file
        default=frozenset(), kw_only=True, repr=False, compare=False, metadata={"ours": True}
    )
    # name of the instance; by default that of the effect
    name: str = field(default="", kw_only=True)
    # role -> channel or constant; or the channels or instances on which
    # it acts on
    on: Mapping[str, str | float] | Sequence[str] = field(default=(), kw_only=True, hash=False)

    def __post_init__(self) -> None:
        super().__post_init__()
        object.__setattr__(self, "name", self.name or type(self).type_name())
        object.__setattr__(self, "on", self._checked_on())

    def _checked_on(self) -> Mapping[str, str | float] | tuple[str, ...]:
        """Return `on` in the form that the class needs. Raises BadInput."""
        on, wants_table = self.on, bool(type(self).roles)
        allowed = "a name or a list of names"
        if wants_table:
            allowed = f"a table of {', '.join(type(self).roles)}"
        refusal = BadInput(f"{self.name}: on = {self.on!r}; allowed is {allowed}")
        if isinstance(on, str):
            on = (on,)
        if isinstance(on, Mapping):
            numbers = [c for c in on.values() if not isinstance(c, str)]
            if wants_table and all(
                type(c) in (int, float) and abs(c) <= LARGEST_FLOAT for c in numbers
            ):
                return dict(on)
            raise refusal
        names = isinstance(on, list | tuple) and all(isinstance(c, str) for c in on)
        if not names or (wants_table and on):
            raise refusal
        return tuple(on)

    @classmethod
    def type_name(cls) -> str:
        """Return the name of the effect's type, such as "fan_wind".

        It is the name of the effect's file and the value of the key `use` in vessel and scenario
        files.
        """
        return snake_case(cls.__name__)

    @classmethod
    def values_type(cls) -> Callable[..., tuple[float, ...]]:
        """Return the named tuple type in which the law of this effect receives its parameters."""
        return _named_tuple_type(tuple(cls.params()))

    @classmethod
    def signals_type(cls) -> Callable[..., tuple[float, ...]]:
        """Return the named tuple type in which the law of this effect receives its input signals.

        It has one field for each role of the effect, also the cosine and sine of a role in
        radians, and one for each filtered value.
        """
        angles: list[str] = []
        for name, role in cls.roles.items():
            if role.unit == "rad":
                angles += (f"cos_{name}", f"sin_{name}")
        return _named_tuple_type((*cls.roles, *angles, *cls.filtered))

    @classmethod
    def signals(cls, **given: float) -> tuple[float, ...]:
        """Return the input signals of an effect's law as the named tuple that the law receives.

        Args:
            given: Value of the signal of each role; a missing one has the fixed value of its role,
                or 0.
        """
        held = {name: role.fixed or 0.0 for name, role in cls.roles.items()}
        held |= dict.fromkeys(cls.filtered, 0.0) | given
        parts: dict[str, float] = {}
        for name, role in cls.roles.items():
            if role.unit == "rad":
                parts[f"cos_{name}"] = cos(held[name])
                parts[f"sin_{name}"] = sin(held[name])
        return cls.signals_type()(**held, **parts)

    def values(self) -> tuple[float, ...]:
        """Return the parameters of the effect as the named tuple that its compiled law receives.

        A parameter without a value is 0.
        """
        values = []
        for name in type(self).params():
            values.append(float(getattr(self, name)) if self.has_value(name) else 0.0)
        return type(self).values_type()(*values)

    def has_value(self, name: str) -> bool:
        """Return whether a parameter of the effect has been given a value (zero counts as a value).

        Args:
            name: Name of the parameter.
        """
        return getattr(self, name) is not UNSET

    def with_values(self, values: Mapping[str, Any]) -> Self:
        """Return a copy of the effect with other values of some parameters.

        Args:
            values: Name of the parameter -> value.
        """
        return replace(self, **values)

    def missing_for_test(self, vessel: "Boat") -> str:
        """Return why recordings of a vessel could not show the effect, in words; "" if they could.

        A diagnosis does not test the effect then, unless it is requested. An example is the
        interaction of drives whose races never meet. Empty unless a subclass has a reason.

        Args:
            vessel: Vessel on which the effect acts.
        """
        return ""

    def with_all_parameters(self, vessel: "Boat") -> Self:
        """Return a copy of the effect in which every parameter has a value.

        Values that were given, for example in a vessel file, are kept. A parameter without a value
        takes that of the vessel's number which it `follows`, else that of `derived_parameters`,
        else 0.

        Args:
            vessel: Vessel on which the effect acts.

        Raises:
            BadInput: The vessel lacks an effect or a fact on which this effect builds.
        """
        own = self
        for name, about in type(self).params().items():
            if about.follows and not self.has_value(name):
                own = own.with_values({name: self.inherited_value(about.follows, vessel)})
        if own._parameters_without_value():
            rules = own.derived_parameters(vessel)
            own = own.with_values({n: x for n, x in rules.items() if not own.has_value(n)})
        for fact, names in type(self).facts.items():
            for missing in (n for n in names if not own.has_value(n)):
                raise BadInput(
                    f"{vessel.name}: {self.name} needs {missing}: state it in its table, or {fact} "
                    "among the facts of a recording or of the vessel's diagnosis"
                )
        return replace(
            own.with_values(dict.fromkeys(own._parameters_without_value(), 0.0)),
            filled=frozenset(self._parameters_without_value()) | self.filled,
        )

    def identifiable_ratios(self, vessel: "Boat") -> dict[str, tuple[float, str]]:
        """Return the quantities that recordings can identify instead of single parameters.

        An example is force over mass, where motion data determine the ratio only. Empty unless a
        subclass defines some.

        Args:
            vessel: Vessel on which the effect acts.

        Returns:
            Name -> (value, meaning in words).
        """
        return {}

    def fixed_settings(self) -> dict[str, object]:
        """Return the settings of the effect that a diagnosis keeps fixed in its fits, by name.

        The instance name and the binding `on` are not among them.
        """
        return {n: getattr(self, n) for names in type(self).facts.values() for n in names}

    def derived_parameters(self, vessel: "Boat") -> dict[str, float]:
        """Return parameter values that a rule computes from the vessel, such as an added mass.

        They are used for parameters without a given value. Empty unless a subclass defines a rule.

        Args:
            vessel: Vessel on which the effect acts; parameters with `follows` are set before.

        Returns:
            Name of the parameter -> value.
        """
        return {}

    def table(self) -> tuple[float, ...]:
        """Return the table of numbers that the compiled law reads after all parameters.

        It holds what no parameter can, such as coefficients over frequency. Empty unless a subclass
        has one; its law takes it with `sees_table`.
        """
        return ()

    def wave_axes(self) -> tuple[str, ...]:
        """Return the degrees of freedom in which the waves of the effect can exert a force.

        It is empty for calm water, and for effects other than waves. The effect has all parameters.
        """
        return ()

    def excitation_speed(self) -> float:
        """Return the forward speed at which the wave loads of the effect were computed [m/s].

        It is 0 at rest, for calm water, and for effects other than waves. The effect has all
        parameters.
        """
        return 0.0

    def radiates_as_at_rest(self) -> bool:
        """Return whether the effect is a radiation force without its terms of forward speed."""
        return False

    def wave_field(self) -> WaveField | None:
        """Return the waves of the effect, whose elevation is known at any place and time.

        It is None for calm water, and for effects without an elevation. The effect has all
        parameters.
        """
        return None

    def has_current_derived_codes(self, vessel: "Boat") -> bool:
        """Return whether the numeric codes derived from a vessel equal those that the effect holds.

        Such codes stand for names, for example of a factor or a channel, in the compiled law; an
        effect bound to another vessel may need other codes.

        Args:
            vessel: Completed vessel.
        """
        ruled = self.derived_parameters(vessel)
        return all(
            ruled[f.name] == getattr(self, f.name)
            for f in fields(self)
            if {"param", "ours"} <= set(f.metadata)
        )

    def _parameters_without_value(self) -> list[str]:
        """Return the parameters without a value."""
        return [n for n in type(self).params() if not self.has_value(n)]

    def inherited_value(self, source: str, vessel: "Boat") -> float:
        """Return the vessel's number that serves as the default of one of the effect's parameters.

        A parameter may follow, for instance, "vessel.length" or "linear_damping.yaw".

        Args:
            source: "vessel.key" or "effect.key"; with a trailing "?" a missing effect gives 0.
            vessel: Vessel on which the effect acts.

        Raises:
            BadInput: The vessel does not have the effect.
        """
        owner, _, key = source.removesuffix("?").partition(".")
        if owner == "vessel":
            return float(attrgetter(key)(vessel))
        if source.endswith("?") and vessel.effect(owner) is None:
            return 0.0
        return float(getattr(self.required_effect(vessel, owner), key))

    def required_effect(self, vessel: "Boat", owner: str) -> "Effect":
        """Return another effect of the vessel, on whose numbers this effect depends.

        Args:
            vessel: Vessel on which the effect acts.
            owner: Name of the other effect.

        Raises:
            BadInput: The vessel does not have it.
        """
        own = vessel.effect(owner)
        if own is None:
            raise BadInput(f"{vessel.name}: {self.name} needs a vessel with {owner}")
        return own

    @property
    def program_position(self) -> int:
        """Sorting key of the effect in the compiled program: lower numbers are evaluated first."""
        return type(self).stage

    def with_seed(self, seed: int) -> Self:
        """Return a copy of the effect whose random realisation follows from the seed of a scenario.

        Effects without a random realisation are returned unchanged.

        Args:
            seed: Seed of the scenario.
        """
        return self


class RigidBody(Protocol):
    """Mass and moments of inertia of a vessel, as far as effects may read them."""

    mass: float  # [kg]
    roll_inertia: float  # [kg m^2]
    yaw_inertia: float  # [kg m^2]
    centre: tuple[float, float]  # [m] mass centre ahead of the origin of motion and below it


class Boat(Protocol):
    """Interface of a vessel for its effects: name, dimensions, rigid body and other effects."""

    @property
    def name(self) -> str:
        """Name of the vessel."""

    @property
    def length(self) -> float:
        """Length of the vessel [m]."""

    @property
    def beam(self) -> float:
        """Beam of the vessel [m]."""

    @property
    def draught(self) -> float:
        """Draught of the vessel [m]."""

    @property
    def dof(self) -> Sequence[str]:
        """Degrees of freedom of the vessel, of `AXES`."""

    @property
    def body(self) -> RigidBody:
        """Rigid body of the vessel: its mass and moments of inertia."""

    @property
    def described_signals(self) -> Sequence[str]:
        """Names of the actuator signals that terms found by symbolic regression may contain.

        They are values of actuators, cosines and sines of actuator angles, and sums over several
        actuators.
        """

    def effect(self, name: str) -> Effect | None:
        """Return the vessel's effect with a given name, or its only effect of the type so named."""

    def names_of(self, name: str) -> list[str]:
        """Return the names of all effects of the vessel that have a given name or type."""

    def side(self, channel: str) -> int:
        """Return the side of the drive of a channel: -1 port, +1 starboard, 0 on the centreline."""

    def effects_of_type(self, idea: str) -> list[Effect]:
        """Return the vessel's effects of a type, and those that can stand for that type."""

    def host_effects(self, effect: Effect) -> Sequence[Effect]:
        """Return the other effects at which an effect acts, such as the propellers of prop walk."""

    def bindings(self, effect: Effect) -> Mapping[str, str | float]:
        """Return the channel or constant that each input signal of an effect's law is bound to."""

    def limits(self) -> Mapping[str, tuple[float, float]]:
        """Return the allowed range (low, high) of each input of the vessel, by name."""

    def neutral_value(self, name: str) -> float:
        """Return the value of an input of the vessel where nothing is sent or measured."""

    def target_actuators(self, effect: Effect) -> tuple[str, ...]:
        """Return the actuators whose signals a channel effect changes."""


class LawCall(NamedTuple):
    """Source text with which a generated program calls the compiled law of one effect.

    It holds the index of the effect and the text of the arguments.
    """

    number: int  # of the effect
    values: str  # text of the parameters: V3(p[7], p[8])
    # further arguments: the bound signals, and the parameters of the instance it acts on
    signals: tuple[str, ...] = ()

    def text(self, law: str, *first: str) -> str:
        """Return the source text of a call to one of the compiled functions of an effect.

        Args:
            law: Name of the function, such as "transform_signal".
            first: Texts of the first arguments, before the parameters and signals of the effect.
        """
        return f"{law}{self.number}({', '.join((*first, self.values, *self.signals))})"


class InsertionPoint(NamedTuple):
    """Place in a generated function at which effects insert source lines.

    It has fixed lines before and after those of the effects and, if the place belongs to one
    actuator, the name of that actuator.
    """

    begin: tuple[str, ...] = ()
    end: tuple[str, ...] = ()
    channel: str = ""  # actuator whose signal this station processes


class ProgramLayout(Protocol):
    """Interface of a vessel's generated program for the code that writes its source lines.

    It gives the effects, the signals and their indices in the flat arrays of the program.
    """

    effects: tuple[Effect, ...]
    signals: tuple[str, ...]  # actuators, and readings of the environment
    commands: tuple[str, ...]  # inputs of the vessel: commands, then measured quantities
    # contents of `act`: signals, cosine and sine of angles; for described laws sums and past values
    law_signals: Sequence[str]
    signal_sums: Mapping[str, Sequence[str]]  # sum in `law_signals` -> the actuators that it adds

    def law_calls(self, number: int) -> Sequence[LawCall]:
        """Return the source texts of the calls to an effect's law.

        There is one call, or one for each instance of the other effect on which it acts (for
        example, one for each thruster).
        """

    def target_actuators(self, number: int) -> Sequence[str]:
        """Return the names of the actuators whose signals a given channel effect changes."""

    def source_for_actuator(self, number: int, actuator: str) -> str | None:
        """Return the input that feeds an actuator through a channel effect, or None.

        Examples are the PWM command from which a drive curve computes the thrust, and the measured
        voltage of its supply.
        """

    def side(self, actuator: str) -> float:
        """Return the side of an actuator: -1 port, +1 starboard, 0 on the centreline."""

    def memory_offset(self, number: int, actuator: str) -> int:
        """Return the index in the program's memory array of an effect's state for one actuator."""

    def history_index(self, number: int) -> int:
        """Return the index in `law_signals` of the past signal value that an effect uses.

        It is 0 for an effect that uses none. An effect with several values has consecutive ones.
        """

    def table_place(self, number: int) -> int:
        """Return the place of the first entry of an effect's table among all parameters."""

    def filtered_signal_index(self, number: int) -> int:
        """Return the index in `law_signals` of the signal that an effect passes through a filter.

        It is that of the effect's first role.
        """

    def indices_of_later_effects(self, number: int) -> Sequence[int]:
        """Return the indices of the effects that are evaluated after a given effect."""


def single_insertion_point(program: ProgramLayout) -> Sequence[InsertionPoint]:
    """Return the single place at which effects add lines to a generated function.

    It is the default for functions that sum contributions of effects.

    Args:
        program: Layout of the program that is generated for the vessel.
    """
    return (InsertionPoint(),)


@dataclass(frozen=True)
class ProgramFunction:
    """Function of the generated program whose body is composed of the lines of many effects.

    It has a name, arguments, first lines, a result, and the places at which effects add lines.
    """

    name: str
    arguments: str
    begin: tuple[str, ...]
    result: str
    compiled: str = "inlined"  # decorator of `boatsim.physics.kernel.compiling`
    stations: Callable[[ProgramLayout], Sequence[InsertionPoint]] = single_insertion_point


class EffectKind(Effect):
    """Base class of the kinds of effects, such as force, inertia, channel or measurement.

    A kind defines which source lines its effects add to the compiled program of a vessel.
    """

    parts: ClassVar[
        tuple[ProgramFunction, ...]
    ] = ()  # functions that this kind adds to the program
    # its compiled functions; optional ones are None by default
    laws: ClassVar[tuple[str, ...]] = ()

    @classmethod
    def program_lines(
        cls, part: ProgramFunction, station: InsertionPoint, number: int, program: ProgramLayout
    ) -> Iterator[str]:
        """Yield the source lines that an effect adds to one function of the generated program.

        Empty unless a kind defines some.

        Args:
            part: Function of the compiled program that receives the lines.
            station: Insertion point in that function.
            number: Index of the effect among all effects of the program.
            program: Layout of the program that is generated for the vessel.
        """
        yield from ()
