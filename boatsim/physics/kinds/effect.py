"""An effect: one idea of physics or of measurement, and how a kind of effect adds its lines to the composed program."""

from collections import namedtuple
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from functools import cache
from math import cos, isfinite, sin
from operator import attrgetter
from typing import Any, ClassVar, NamedTuple, Protocol, Self

from boatsim.errors import BadInput
from boatsim.physics.content import snake_case
from boatsim.physics.param import UNSET, Checked


@cache
def _named(fields: tuple[str, ...]) -> Callable[..., tuple[float, ...]]:
    """The NamedTuple type of these fields; entries over one law share it, so that the law is compiled once for all."""
    return namedtuple("Given", fields)


@dataclass(frozen=True)
class Role:
    """A signal that a law takes, whatever the vessel calls its channel: `thrust`, `angle`, `shaft`."""

    unit: str
    words: str
    # what it is where nothing is bound to it; None: a channel must be named
    fixed: float | None = None


@dataclass(frozen=True)
class Effect(Checked):
    """One instance of an idea on a vessel. Subclasses are of one or several of the kinds in this folder."""

    # the sentence a report prints: "a steady wind pushes the hull downwind ..."
    words: ClassVar[str] = ""
    words_above: ClassVar[str] = ""  # the same where the factor by which it weakens is above one
    shown_by: ClassVar[str] = ""  # the manoeuvre that shows it best
    kind: ClassVar[str] = "physics"  # or "measurement"
    source: ClassVar[str] = ""  # paper, equation or table of the law
    # parameters that say how strong it is; empty: all that may be fitted
    strength: ClassVar[tuple[str, ...]] = ()
    # fact in a recording's notes -> the parameters it states
    facts: ClassVar[Mapping[str, tuple[str, ...]]] = {}
    # where a fit starts; empty: a tenth of each spread
    starts: ClassVar[tuple[Mapping[str, float], ...]] = ()
    # parameter -> starts in largest commands recorded
    thresholds: ClassVar[Mapping[str, tuple[float, ...]]] = {}
    # signals its law takes as its third argument, each with a channel
    roles: ClassVar[Mapping[str, Role]] = {}
    # those of a lower one come first in the program; else the order is that of the files
    stage: ClassVar[int] = 0
    # freedoms without which it can not act, besides those of its parameters
    needs: ClassVar[tuple[str, ...]] = ()
    # fact -> what it must say for the effect not to act
    ruled_out_by: ClassVar[Mapping[str, tuple[object, ...]]] = {}
    # entries that show the same: it is tried only where somebody asks for it
    told_by: ClassVar[tuple[str, ...]] = ()
    # only its spectrum can be fitted: the filter follows its course, a free run can not
    random: ClassVar[bool] = False
    alone: ClassVar[bool] = False  # a vessel that has one is not suspected of another
    # a law that the diagnosis writes itself, of terms: no entry of the library
    described: ClassVar[bool] = False
    # its law takes all actuators besides: `act`, `at`, the place of what it recalls
    sees_held: ClassVar[bool] = False
    # idea whose every instance it acts at: its law takes their signals and their values
    rides: ClassVar[str] = ""

    filled: frozenset[str] = field(  # parameters by `completed`, which nobody stated
        default=frozenset(), kw_only=True, repr=False, compare=False, metadata={"ours": True}
    )
    # of this instance; that of the idea where there is one only
    name: str = field(default="", kw_only=True)
    # role -> channel or a number that is held; or the channels, or the instances it rides on, that
    # it acts on
    on: Mapping[str, str | float] | Sequence[str] = field(default=(), kw_only=True, hash=False)

    def __post_init__(self) -> None:
        super().__post_init__()
        object.__setattr__(self, "name", self.name or type(self).idea())
        object.__setattr__(self, "on", self._acting_on())

    def _acting_on(self) -> Mapping[str, str | float] | tuple[str, ...]:
        """`on` as the class takes it. Raises BadInput."""
        on, wants_table = self.on, bool(type(self).roles)
        if isinstance(on, str):
            on = (on,)
        if isinstance(on, Mapping):
            numbers = [c for c in on.values() if not isinstance(c, str)]
            good = wants_table and all(type(c) in (int, float) and isfinite(c) for c in numbers)
        else:
            good = (
                isinstance(on, list | tuple)
                and all(isinstance(c, str) for c in on)
                and not (wants_table and on)
            )
        if not good:
            allowed = (
                f"a table of {', '.join(type(self).roles)}"
                if wants_table
                else "a name or a list of names"
            )
            raise BadInput(f"{self.name}: on = {self.on!r}; allowed is {allowed}")
        return dict(on) if isinstance(on, Mapping) else tuple(on)

    @classmethod
    def idea(cls) -> str:
        """File name, and the word that files `use`."""
        return snake_case(cls.__name__)

    @classmethod
    def values_type(cls) -> Callable[..., tuple[float, ...]]:
        """NamedTuple type of the parameters, as the compiled law receives them."""
        return _named(tuple(cls.params()))

    @classmethod
    def signals_type(cls) -> Callable[..., tuple[float, ...]]:
        """NamedTuple type of the signals of its roles, with cosine and sine of those that are angles."""
        angles = [
            f"{part}_{n}"
            for n, role in cls.roles.items()
            if role.unit == "rad"
            for part in ("cos", "sin")
        ]
        return _named((*cls.roles, *angles))

    @classmethod
    def signals(cls, **given: float) -> tuple[float, ...]:
        """Signals of its roles as the law's third argument; one not given is as if nothing were bound to it, or 0."""
        held = {name: role.fixed or 0.0 for name, role in cls.roles.items()} | given
        angles = [name for name, role in cls.roles.items() if role.unit == "rad"]
        parts = {
            f"{part}_{n}": of(held[n]) for n in angles for part, of in (("cos", cos), ("sin", sin))
        }
        return cls.signals_type()(**held, **parts)

    def values(self) -> tuple[float, ...]:
        """The parameters as the law's second argument."""
        given = ((self.stated(n), getattr(self, n)) for n in type(self).params())
        return type(self).values_type()(*(float(x) if there else 0.0 for there, x in given))

    def stated(self, name: str) -> bool:
        """Whether a parameter has a value, be it zero."""
        return getattr(self, name) is not UNSET

    def having(self, values: Mapping[str, Any]) -> Self:
        """The effect with other values of some parameters."""
        return replace(self, **values)

    def completed(self, vessel: "Boat") -> Self:
        """The effect with what nobody stated filled in: what `follows` the vessel, then what `rules` give, else 0.

        What a file states wins. Raises BadInput where the vessel lacks what the effect builds on.
        """
        own = self
        for name, about in type(self).params().items():
            if about.follows and not self.stated(name):
                own = own.having({name: self.followed(about.follows, vessel)})
        ruled = (
            {n: x for n, x in own.rules(vessel).items() if not own.stated(n)} if own._left() else {}
        )
        own = own.having(ruled)
        for fact, names in type(self).facts.items():
            for missing in (n for n in names if not own.stated(n)):
                where = f"state it in its table, or {fact} among the facts of a recording or of the vessel's diagnosis"
                raise BadInput(f"{vessel.name}: {self.name} needs {missing}: {where}")
        return replace(
            own.having(dict.fromkeys(own._left(), 0.0)),
            filled=frozenset(self._left()) | self.filled,
        )

    def ratios(self, vessel: "Boat") -> dict[str, tuple[float, str]]:
        """What recordings really tell where a parameter is but one way to put it: name -> value, meaning in words."""
        return {}

    def shape(self) -> dict[str, object]:
        """What its table states that no fit finds, besides its name and what it acts on."""
        return {n: getattr(self, n) for names in type(self).facts.values() for n in names}

    def rules(self, vessel: "Boat") -> dict[str, float]:
        """Parameters by a rule of the effect's own, for those that nobody states; what follows is filled in before."""
        return {}

    def still_as_on(self, vessel: "Boat") -> bool:
        """Whether what `rules` gave for words that no file may state is still so, now that the vessel is whole."""
        ruled = self.rules(vessel)
        return all(
            ruled[f.name] == getattr(self, f.name)
            for f in fields(self)
            if {"param", "ours"} <= set(f.metadata)
        )

    def _left(self) -> list[str]:
        """Parameters without a value."""
        return [n for n in type(self).params() if not self.stated(n)]

    def followed(self, source: str, vessel: "Boat") -> float:
        """The value of the vessel, or of one of its effects, that a parameter follows. Raises BadInput."""
        owner, _, key = source.removesuffix("?").partition(".")
        if owner == "vessel":
            return float(attrgetter(key)(vessel))
        if source.endswith("?") and vessel.effect(owner) is None:
            return 0.0
        return float(getattr(self.needed(vessel, owner), key))

    def needed(self, vessel: "Boat", owner: str) -> "Effect":
        """The vessel's effect that this one builds on. Raises BadInput where it has none."""
        own = vessel.effect(owner)
        if own is None:
            raise BadInput(f"{vessel.name}: {self.name} needs a vessel with {owner}")
        return own

    @property
    def standing(self) -> int:
        """Where it stands in the program: those with less come first."""
        return type(self).stage

    def seeded(self, seed: int) -> Self:
        """The effect with its random course, if it has one, drawn from a scenario's seed."""
        return self


class Rigid(Protocol):
    """What an effect may ask of the rigid body of its vessel."""

    mass: float  # [kg]
    roll_inertia: float  # [kg m^2]
    yaw_inertia: float  # [kg m^2]


class Boat(Protocol):
    """What an effect may ask of the vessel it is on."""

    @property
    def name(self) -> str:
        """Its name."""

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
    def body(self) -> Rigid:
        """The rigid body."""

    @property
    def described_signals(self) -> Sequence[str]:
        """What described laws see of its actuators: themselves, cosine and sine of angles, the sums of several."""

    def effect(self, name: str) -> Effect | None:
        """Its own effect of that name, or the only one of that idea."""

    def names_of(self, name: str) -> list[str]:
        """Names of its own effects that a word means."""


class Site(NamedTuple):
    """One call of an effect's law: its place in the program and the text of what it is called with."""

    number: int  # of the effect
    values: str  # V3(p[7], p[8])
    # further arguments: the bound signals, and the values of what the effect rides on
    signals: tuple[str, ...] = ()

    def call(self, law: str, *first: str) -> str:
        """Text of a call of one of the effect's compiled functions."""
        return f"{law}{self.number}({', '.join((*first, self.values, *self.signals))})"


class Station(NamedTuple):
    """A place in a composed function where effects may stand, between lines of its own."""

    begin: tuple[str, ...] = ()
    end: tuple[str, ...] = ()
    channel: str = ""  # the actuator whose signal this station works on


class Composed(Protocol):
    """What a kind may ask of the program it is written into."""

    effects: tuple[Effect, ...]
    signals: tuple[str, ...]  # actuators, and readings of what is measured around the boat
    commands: tuple[str, ...]  # what the vessel takes: commands, then what is measured
    # what `act` holds: signals, cosine and sine of angles; for described laws sums, recalled
    held: Sequence[str]
    sums: Mapping[str, Sequence[str]]  # of these, the actuators that each sum is of

    def sites(self, number: int) -> Sequence[Site]:
        """The calls of an effect's laws: one, or one for each instance that it rides on."""

    def targets(self, number: int) -> Sequence[str]:
        """Actuators that a channel effect acts on."""

    def source(self, number: int, actuator: str) -> str | None:
        """The command that feeds an actuator through a channel effect, if it takes one."""

    def side(self, actuator: str) -> float:
        """-1 port, +1 starboard, 0 middle of what an actuator drives."""

    def memory(self, number: int, actuator: str) -> int:
        """Where an effect's memory of an actuator begins."""

    def own(self, number: int) -> int:
        """Place in `held` of what an effect recalls; 0 of one that does not look back."""

    def behind(self, number: int) -> Sequence[int]:
        """The effects that come after one in the program."""


def once(program: Composed) -> Sequence[Station]:
    """One station: the body of a plain sum."""
    return (Station(),)


@dataclass(frozen=True)
class Part:
    """A function of the composed program to which kinds add lines."""

    name: str
    arguments: str
    begin: tuple[str, ...]
    result: str
    compiled: str = "inlined"  # which decorator of `boatsim.physics.kernel.compiling`
    stations: Callable[[Composed], Sequence[Station]] = once


class Kind(Effect):
    """Base of the kinds: what effects of one add to the program."""

    parts: ClassVar[tuple[Part, ...]] = ()  # functions that this kind brings along
    # its compiled functions, those that an effect may leave out being None
    laws: ClassVar[tuple[str, ...]] = ()

    @classmethod
    def lines(cls, part: Part, station: Station, number: int, program: Composed) -> Iterator[str]:
        """Lines that effect `number` of the program adds to a part at a station."""
        yield from ()
