"""Base class of effects, and how a kind of effect adds its lines to the compiled program."""

from collections import namedtuple
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from functools import cache
from math import cos, isfinite, sin
from operator import attrgetter
from typing import Any, ClassVar, NamedTuple, Protocol, Self

from boatsim.errors import BadInput
from boatsim.physics.content import snake_case
from boatsim.physics.param import UNSET, CheckedParameters

# groups of numbers of a vessel that may be estimates
REFINED_GROUPS = ("damping", "thrust", "lag", "mass_centre", "inertia", "added_mass", "restoring")


@cache
def _named_tuple_type(fields: tuple[str, ...]) -> Callable[..., tuple[float, ...]]:
    """Return the NamedTuple type of these fields; one law has one type, to be compiled once."""
    return namedtuple("Given", fields)


@dataclass(frozen=True)
class Role:
    """Signal that a law takes under a fixed name, bound to a channel of the vessel."""

    unit: str
    words: str
    # value if no channel is bound; None: a channel is required
    fixed: float | None = None


@dataclass(frozen=True)
class Effect(CheckedParameters):
    """One instance of a physical or measurement effect on a vessel.

    Subclasses derive from one or several of the kinds in this folder.
    """

    # sentence in a report: "a steady wind pushes the hull downwind ..."
    words: ClassVar[str] = ""
    # the same if the first fitted parameter exceeds its inactive value
    words_above: ClassVar[str] = ""
    shown_by: ClassVar[str] = ""  # manoeuvre in which the effect is most visible
    kind: ClassVar[str] = "physics"  # or "measurement"
    source: ClassVar[str] = ""  # paper, equation or table of the law
    # group of numbers of a vessel that it refines, one of REFINED_GROUPS: where a vessel file calls
    # that group estimated, the effect is a better value of a number and no missing physics
    refines: ClassVar[str] = ""
    # parameters of its strength, zero if absent; empty: all fitted parameters
    strength: ClassVar[tuple[str, ...]] = ()
    # fact in the notes of a recording -> parameters that it gives
    facts: ClassVar[Mapping[str, tuple[str, ...]]] = {}
    # starting points of a fit; empty: a tenth of each spread
    starts: ClassVar[tuple[Mapping[str, float], ...]] = ()
    # parameter -> starting points as shares of the largest recorded command
    thresholds: ClassVar[Mapping[str, tuple[float, ...]]] = {}
    # signals that the law takes as its third argument, each bound to a channel
    roles: ClassVar[Mapping[str, Role]] = {}
    # effects of a lower stage come first in the program; otherwise the order of the file counts
    stage: ClassVar[int] = 0
    # dof without which it has no effect, in addition to those of its parameters
    needs: ClassVar[tuple[str, ...]] = ()
    # fact -> values that exclude the effect
    ruled_out_by: ClassVar[Mapping[str, tuple[object, ...]]] = {}
    # effects with the same signature: this one is a candidate on request only
    confounded_with: ClassVar[tuple[str, ...]] = ()
    # a random process: the filter tracks it, a simulation without data cannot
    random: ClassVar[bool] = False
    alone: ClassVar[bool] = False  # no candidate for a vessel that has one already
    # a term written by symbolic regression, not an effect of the library
    described: ClassVar[bool] = False
    # its law also takes all actuators: `act`, `at` and the index of the recalled value
    sees_held: ClassVar[bool] = False
    # effect on each of whose instances it acts: its law takes their signals and parameters
    per_instance_of: ClassVar[str] = ""

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
            if wants_table and all(type(c) in (int, float) and isfinite(c) for c in numbers):
                return dict(on)
            raise refusal
        names = isinstance(on, list | tuple) and all(isinstance(c, str) for c in on)
        if not names or (wants_table and on):
            raise refusal
        return tuple(on)

    @classmethod
    def type_name(cls) -> str:
        """Return the name of the effect, which is its file name and the word for `use` in files."""
        return snake_case(cls.__name__)

    @classmethod
    def values_type(cls) -> Callable[..., tuple[float, ...]]:
        """Return the NamedTuple type of the parameters, as the compiled law takes them."""
        return _named_tuple_type(tuple(cls.params()))

    @classmethod
    def signals_type(cls) -> Callable[..., tuple[float, ...]]:
        """Return the NamedTuple type of the signals that a vessel assigns to the effect's roles.

        A role in radians also has its cosine and sine.
        """
        angles: list[str] = []
        for name, role in cls.roles.items():
            if role.unit == "rad":
                angles += (f"cos_{name}", f"sin_{name}")
        return _named_tuple_type((*cls.roles, *angles))

    @classmethod
    def signals(cls, **given: float) -> tuple[float, ...]:
        """Return the signals of the roles as the third argument of the law.

        Args:
            given: Signal of each role; a missing one has the fixed value of its role, or 0.
        """
        held = {name: role.fixed or 0.0 for name, role in cls.roles.items()} | given
        parts: dict[str, float] = {}
        for name, role in cls.roles.items():
            if role.unit == "rad":
                parts[f"cos_{name}"] = cos(held[name])
                parts[f"sin_{name}"] = sin(held[name])
        return cls.signals_type()(**held, **parts)

    def values(self) -> tuple[float, ...]:
        """Return the parameters as the second argument of the law; 0 for those without a value."""
        values = [0.0] * len(type(self).params())
        for i, name in enumerate(type(self).params()):
            if self.has_value(name):
                values[i] = float(getattr(self, name))
        return type(self).values_type()(*values)

    def has_value(self, name: str) -> bool:
        """Return whether a parameter has a value, including zero.

        Args:
            name: Name of the parameter.
        """
        return getattr(self, name) is not UNSET

    def with_values(self, values: Mapping[str, Any]) -> Self:
        """Return the effect with other values of some parameters.

        Args:
            values: Name of the parameter -> value.
        """
        return replace(self, **values)

    def with_all_parameters(self, vessel: "Boat") -> Self:
        """Return the effect with all parameters set; values from a file take precedence.

        A parameter without a value takes that of the vessel it `follows`, else that of
        `derived_parameters`, else 0.

        Args:
            vessel: Vessel on which the effect acts.

        Raises:
            BadInput: The vessel lacks an effect or a fact on which this effect builds.
        """
        own = self
        for name, about in type(self).params().items():
            if about.follows and not self.has_value(name):
                own = own.with_values({name: self.followed_value(about.follows, vessel)})
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
        """Return the quantities that recordings identify instead of a parameter.

        Args:
            vessel: Vessel on which the effect acts.

        Returns:
            Name -> (value, meaning in words).
        """
        return {}

    def fixed_settings(self) -> dict[str, object]:
        """Return the settings that no fit changes, other than the name and `on`."""
        return {n: getattr(self, n) for names in type(self).facts.values() for n in names}

    def derived_parameters(self, vessel: "Boat") -> dict[str, float]:
        """Return parameters that follow from the vessel by a rule, for those without a value.

        Args:
            vessel: Vessel on which the effect acts; parameters with `follows` are set before.

        Returns:
            Name of the parameter -> value.
        """
        return {}

    def keeps_derived_codes(self, vessel: "Boat") -> bool:
        """Return whether derived code parameters are unchanged for the completed vessel.

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

    def followed_value(self, source: str, vessel: "Boat") -> float:
        """Return the value of the vessel, or of one of its effects, that a parameter follows.

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
        """Return the effect of the vessel on which this one builds.

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
        """Position in the program: effects with a lower number come first."""
        return type(self).stage

    def with_seed(self, seed: int) -> Self:
        """Return the effect with its random realisation set from the seed of a scenario.

        Args:
            seed: Seed of the scenario.
        """
        return self


class RigidBody(Protocol):
    """Properties of the rigid body of a vessel that an effect may use."""

    mass: float  # [kg]
    roll_inertia: float  # [kg m^2]
    yaw_inertia: float  # [kg m^2]


class Boat(Protocol):
    """Properties of a vessel that an effect may use."""

    @property
    def name(self) -> str:
        """Name of the vessel."""

    @property
    def length(self) -> float:
        """Length [m]."""

    @property
    def beam(self) -> float:
        """Beam [m]."""

    @property
    def draught(self) -> float:
        """Draught [m]."""

    @property
    def body(self) -> RigidBody:
        """The rigid body."""

    @property
    def described_signals(self) -> Sequence[str]:
        """Actuator signals for laws of symbolic regression: values, cos, sin, sums."""

    def effect(self, name: str) -> Effect | None:
        """Return the vessel's effect of that name, or its only one of that class."""

    def names_of(self, name: str) -> list[str]:
        """Return the names of the vessel's effects to which a word refers."""


class LawCall(NamedTuple):
    """Call of the law of an effect: its index in the program and the text of the arguments."""

    number: int  # of the effect
    values: str  # text of the parameters: V3(p[7], p[8])
    # further arguments: the bound signals, and the parameters of the instance it acts on
    signals: tuple[str, ...] = ()

    def text(self, law: str, *first: str) -> str:
        """Return the text of a call of one of the compiled functions of the effect.

        Args:
            law: Name of the function.
            first: First arguments.
        """
        return f"{law}{self.number}({', '.join((*first, self.values, *self.signals))})"


class InsertionPoint(NamedTuple):
    """Place in a composed function at which effects add lines."""

    begin: tuple[str, ...] = ()
    end: tuple[str, ...] = ()
    channel: str = ""  # actuator whose signal this station processes


class ProgramLayout(Protocol):
    """Properties of the composed program that a kind may use."""

    effects: tuple[Effect, ...]
    signals: tuple[str, ...]  # actuators, and readings of the environment
    commands: tuple[str, ...]  # inputs of the vessel: commands, then measured quantities
    # contents of `act`: signals, cosine and sine of angles; for described laws sums and past values
    law_signals: Sequence[str]
    signal_sums: Mapping[str, Sequence[str]]  # sum in `law_signals` -> the actuators that it adds

    def law_calls(self, number: int) -> Sequence[LawCall]:
        """Return the calls of the laws of an effect, one for each instance on which it acts."""

    def target_actuators(self, number: int) -> Sequence[str]:
        """Return the actuators on which a channel effect acts."""

    def command_for_actuator(self, number: int, actuator: str) -> str | None:
        """Return the command that feeds an actuator through a channel effect, or None."""

    def side(self, actuator: str) -> float:
        """Return the side of an actuator: -1 port, +1 starboard, 0 on the centreline."""

    def memory_offset(self, number: int, actuator: str) -> int:
        """Return the index at which the memory of an effect for an actuator begins."""

    def history_place(self, number: int) -> int:
        """Return the index in `law_signals` of the past value of an effect; 0 if it has none."""

    def later_effects(self, number: int) -> Sequence[int]:
        """Return the effects that come after one in the program."""


def single_insertion_point(program: ProgramLayout) -> Sequence[InsertionPoint]:
    """Return one station: the body of a sum over effects.

    Args:
        program: Program that is composed.
    """
    return (InsertionPoint(),)


@dataclass(frozen=True)
class ProgramFunction:
    """Function of the composed program to which kinds add lines."""

    name: str
    arguments: str
    begin: tuple[str, ...]
    result: str
    compiled: str = "inlined"  # decorator of `boatsim.physics.kernel.compiling`
    stations: Callable[[ProgramLayout], Sequence[InsertionPoint]] = single_insertion_point


class EffectKind(Effect):
    """Base of the kinds: defines what effects of one kind add to the program."""

    parts: ClassVar[
        tuple[ProgramFunction, ...]
    ] = ()  # functions that this kind adds to the program
    # its compiled functions; optional ones are None by default
    laws: ClassVar[tuple[str, ...]] = ()

    @classmethod
    def program_lines(
        cls, part: ProgramFunction, station: InsertionPoint, number: int, program: ProgramLayout
    ) -> Iterator[str]:
        """Yield the lines that an effect adds to a part of the program at a station.

        Args:
            part: Function of the program.
            station: Place in it.
            number: Index of the effect.
            program: Program that is composed.
        """
        yield from ()
