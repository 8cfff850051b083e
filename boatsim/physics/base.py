"""What an effect is: parameters with bounds, the motion it sees, the force, inertia, flow or signal it gives.

An effect is one idea of physics in one file of `boatsim/physics/effects/`. Its law is a small compiled function that
the MuJoCo callback, the twin and the diagnosis filter all call, so that simulator and diagnosis can not disagree.
Axes are SNAME: x forward, y starboard, z down, heading and yaw rate clockwise seen from above.
"""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, fields, replace
from functools import cache
from operator import attrgetter
from types import new_class
from typing import Any, ClassVar, NamedTuple, Self, TypeVar

import numpy as np
from numpy.typing import NDArray

from boatsim.errors import BadInput, unknown_name
from boatsim.physics.content import snake_case

Array = NDArray[np.float64]
E = TypeVar("E", bound="Effect")
UNSET = math.nan  # a parameter that nobody stated: filled in on a vessel by `follows` or `Effect.rules`, else 0
AXES = ("surge", "sway", "roll", "yaw")  # order of every vector over the freedoms: (u, v, p, r), (X, Y, K, N)


class Wrench(NamedTuple):
    """Force on the hull in body axes about the origin of motion."""

    X: float  # [N] surge
    Y: float  # [N] sway
    K: float  # [N m] roll
    N: float  # [N m] yaw


class Mass(NamedTuple):
    """Symmetric inertia over the freedoms of a hull with port-starboard symmetry (all other entries are zero)."""

    surge: float  # [kg]
    sway: float  # [kg]
    sway_yaw: float  # [kg m]
    yaw: float  # [kg m^2]
    sway_roll: float = 0.0  # [kg m]
    roll: float = 0.0  # [kg m^2]
    roll_yaw: float = 0.0  # [kg m^2]

    def matrix(self) -> Array:
        """(4, 4) over (surge, sway, roll, yaw)."""
        return np.array(
            [
                [self.surge, 0.0, 0.0, 0.0],
                [0.0, self.sway, self.sway_roll, self.sway_yaw],
                [0.0, self.sway_roll, self.roll, self.roll_yaw],
                [0.0, self.sway_yaw, self.roll_yaw, self.yaw],
            ]
        )


class Motion(NamedTuple):
    """What a force law may look at. A vessel's own motion type has its actuator channels as further fields."""

    t: float  # [s]
    x: float  # [m] north or forward at the start
    y: float  # [m] east or starboard at the start
    psi: float  # [rad] heading
    phi: float  # [rad] roll, starboard down
    u: float  # [m/s] surge over ground
    v: float  # [m/s] sway over ground
    p: float  # [rad/s] roll rate
    r: float  # [rad/s] yaw rate
    ur: float  # [m/s] surge through the water
    vr: float  # [m/s] sway through the water
    cos_psi: float
    sin_psi: float


class Shown(NamedTuple):
    """What instruments show of a motion; a measurement effect changes it on its way into the recording."""

    x: float  # [m]
    y: float  # [m]
    psi: float  # [rad]
    phi: float  # [rad]
    u: float  # [m/s]
    v: float  # [m/s]
    p: float  # [rad/s]
    r: float  # [rad/s]


class Swell(NamedTuple):
    """A lightly damped oscillator per axis, driven by noise: a force that comes and goes with one frequency."""

    X: float  # [N] rms
    Y: float  # [N] rms
    K: float  # [N m] rms
    N: float  # [N m] rms
    frequency: float  # [rad/s]
    damping: float  # share of the critical one


def angle_fields(actuators: tuple[str, ...]) -> tuple[str, ...]:
    """cos_steer_port_rad, sin_steer_port_rad, ...: actuators are held over a step, so these are computed once."""
    return tuple(f"{part}_{name}" for name in actuators if name.endswith("_rad") for part in ("cos", "sin"))


def fixed_fields(actuators: tuple[str, ...]) -> dict[str, float]:
    """cos_steer_port_rad 1, sin_steer_port_rad 0, ...: a thruster without a steering channel points straight ahead."""
    steers = [n.replace("thrust_", "steer_").removesuffix("_N") + "_rad" for n in actuators if n.startswith("thrust_")]
    fixed = [steer for steer in steers if steer not in actuators]
    return {f"{part}_{steer}": value for part, value in (("cos", 1.0), ("sin", 0.0)) for steer in fixed}


ALSO_CALLED = {"delta_rad": "rudder_rad"}  # what laws call a channel -> how some vessels' recordings name it


def alias_fields(actuators: tuple[str, ...]) -> dict[str, str]:
    """The rudder's angle under the name that laws know, for a vessel that has it under another."""
    return {law: own for law, own in ALSO_CALLED.items() if own in actuators and law not in actuators}


@cache
def motion_type(actuators: tuple[str, ...]) -> Any:
    """NamedTuple type of a vessel: fields of `Motion`, its actuators, cosine and sine of each angle, other names."""
    from collections import namedtuple

    angles = (*angle_fields(actuators), *fixed_fields(actuators), *alias_fields(actuators))
    return namedtuple("VesselMotion", (*Motion._fields, *actuators, *angles))


def motion(current: tuple[float, float] = (0.0, 0.0), **given: float) -> Any:
    """A motion for tests and plots: everything not given is zero, water velocities follow from the current [m/s]."""
    actuators = tuple(n for n in given if n not in Motion._fields)
    c, s = math.cos(given.get("psi", 0.0)), math.sin(given.get("psi", 0.0))
    full = {n: 0.0 for n in (*Motion._fields, *actuators)} | {"cos_psi": c, "sin_psi": s}
    full["ur"] = given.get("u", 0.0) - (c * current[0] + s * current[1])
    full["vr"] = given.get("v", 0.0) - (c * current[1] - s * current[0])
    for name in (n for n in actuators if n.endswith("_rad")):
        full[f"cos_{name}"], full[f"sin_{name}"] = math.cos(given[name]), math.sin(given[name])
    full |= fixed_fields(actuators) | {law: given[own] for law, own in alias_fields(actuators).items()}
    return motion_type(actuators)(**(full | given))


class Param(NamedTuple):
    """What is known of a parameter before any data: bounds, unit, words, and whether a diagnosis may fit it."""

    low: float
    high: float
    unit: str
    words: str
    fit: bool = False
    spread: float = 0.0  # prior sd when fitted, in the unit, for a 1.2 m boat of 4.6 kg; scaled by Froude's law
    axis: str = ""  # freedom it belongs to ("roll", ...); fitted only on vessels that have it
    absent: float = 0.0  # value at which the effect is not there
    calibrates: str = ""  # "damping", "thrust", ...: a coefficient of the nominal that is never known exactly
    follows: str = ""  # left unset: the vessel's "linear_damping.surge" or "vessel.body.mass"; "?" ends an optional one
    releases: tuple[str, ...] = ()  # "linear_damping.surge", "body.mass": numbers of the vessel that may be off,
    how: str = "sets"  # or "scales" or "shifts": what a released number undergoes


def param(
    nominal: float,
    *,
    low: float,
    high: float,
    unit: str,
    words: str,
    fit: bool = False,
    spread: float = 0.0,
    axis: str = "",
    absent: float = 0.0,
    calibrates: str = "",
    follows: str = "",
    releases: tuple[str, ...] = (),
    how: str = "sets",
) -> Any:
    """Dataclass field of a checked number; `nominal` may be UNSET.

    `unit` is "" for a ratio; `spread` is the prior sd of a fitted parameter.
    """
    about = Param(low, high, unit, words, fit, spread, axis, absent, calibrates, follows, releases, how)
    return field(default=nominal, metadata={"param": about})


def factor(*releases: str, words: str, spread: float = 0.4, axis: str = "", low: float = 0.1, high: float = 5.0) -> Any:
    """Field of a `Release`: numbers of the vessel that may be off by one factor."""
    return param(
        1.0, low=low, high=high, unit="", words=words, fit=True, spread=spread, axis=axis, absent=1.0,
        releases=releases, how="scales",
    )  # fmt: skip


def shift(*releases: str, words: str, unit: str, spread: float, low: float, high: float, axis: str = "") -> Any:
    """Field of a `Release`: numbers of the vessel that may be off by one addend."""
    return param(
        0.0, low=low, high=high, unit=unit, words=words, fit=True, spread=spread, axis=axis, releases=releases,
        how="shifts",
    )  # fmt: skip


def number(
    *releases: str, words: str, unit: str, spread: float, low: float, high: float, absent: float, axis: str = ""
) -> Any:
    """Field of a `Release`: a number of the vessel that is not what is stated, but this; `absent` is the stated one."""
    return param(
        absent, low=low, high=high, unit=unit, words=words, fit=True, spread=spread, axis=axis, absent=absent,
        releases=releases,
    )  # fmt: skip


class Checked:
    """Mixin of dataclasses whose `param` fields are checked on construction and whose unknown settings are named."""

    @classmethod
    def params(cls) -> dict[str, Param]:
        """Name -> `Param` of every checked field, in order of declaration."""
        return {f.name: f.metadata["param"] for f in fields(cls) if "param" in f.metadata}  # type: ignore[arg-type]

    @classmethod
    def from_settings(cls, settings: Mapping[str, Any]) -> Self:
        """Build from a file's table; raises BadInput with the nearest valid name for a setting that does not exist."""
        names = [f.name for f in fields(cls) if f.init and not f.kw_only]  # type: ignore[arg-type]
        for key in settings:
            if key not in names:
                raise BadInput(unknown_name(f"{cls.__name__}: setting", key, names))
        return cls(**settings)

    def __post_init__(self) -> None:
        for name, about in type(self).params().items():
            value = getattr(self, name)
            if value is UNSET:
                continue
            if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
                raise BadInput(f"{type(self).__name__}.{name} = {value!r}; allowed is a number ({about.words})")
            if not about.low <= value <= about.high:
                raise BadInput(
                    f"{type(self).__name__}.{name} = {value:g} {about.unit}; allowed {about.low:g} to "
                    f"{about.high:g} {about.unit} ({about.words})"
                )


@dataclass(frozen=True)
class Effect(Checked):
    """One idea of physics or of measurement. Subclasses are of one or several of the kinds below."""

    words: ClassVar[str] = ""  # the sentence a report prints: "a steady wind pushes the hull downwind ..."
    shown_by: ClassVar[str] = ""  # the manoeuvre that shows it best
    kind: ClassVar[str] = "physics"  # or "measurement"
    source: ClassVar[str] = ""  # paper, equation or table of the law
    strength: ClassVar[tuple[str, ...]] = ()  # parameters that say how strong it is; empty: all that may be fitted
    facts: ClassVar[Mapping[str, tuple[str, ...]]] = {}  # fact in a recording's notes -> the parameters it states
    starts: ClassVar[tuple[Mapping[str, float], ...]] = ()  # where a fit starts; empty: a tenth of each spread

    filled: frozenset[str] = field(default=frozenset(), kw_only=True, repr=False, compare=False)  # by `completed`

    @classmethod
    def name(cls) -> str:
        """File name, and the name used everywhere: simulator, scenario, diagnosis, report."""
        return snake_case(cls.__name__)

    @classmethod
    @cache
    def values_type(cls) -> Any:
        """NamedTuple type of the parameters, as the compiled law receives them."""
        from collections import namedtuple

        return namedtuple(f"{cls.__name__}Values", list(cls.params()))

    def values(self) -> Any:
        """The parameters as the law's second argument."""
        given = ((self.stated(n), getattr(self, n)) for n in type(self).params())
        return type(self).values_type()(*(float(x) if there else 0.0 for there, x in given))

    def stated(self, name: str) -> bool:
        """Whether a parameter has a value, be it zero."""
        return getattr(self, name) is not UNSET

    def having(self, values: Mapping[str, Any]) -> Self:
        """The effect with other values of some parameters."""
        return replace(self, **values)

    def completed(self, vessel: Any) -> Self:
        """The effect with what nobody stated filled in: what `follows` the vessel, then what `rules` give, else 0.

        What a file states wins. Raises BadInput where the vessel lacks what the effect builds on.
        """
        own = self
        for name, about in type(self).params().items():
            if about.follows and not self.stated(name):
                own = own.having({name: self._followed(about.follows, vessel)})
        ruled = {n: x for n, x in own.rules(vessel).items() if not own.stated(n)} if own._left() else {}
        own = own.having(ruled)
        for fact, names in type(self).facts.items():
            for missing in (n for n in names if not own.stated(n)):
                where = f"state it in its table, or {fact} among the facts of a recording or of the vessel's diagnosis"
                raise BadInput(f"{vessel.name}: {self.name()} needs {missing}: {where}")
        return replace(own.having(dict.fromkeys(own._left(), 0.0)), filled=frozenset(self._left()) | self.filled)

    def rules(self, vessel: Any) -> dict[str, float]:
        """Parameters by a rule of the effect's own, for those that nobody states; what follows is filled in before."""
        return {}

    def _left(self) -> list[str]:
        """Parameters without a value."""
        return [n for n in type(self).params() if not self.stated(n)]

    def _followed(self, source: str, vessel: Any) -> float:
        """The value of the vessel, or of one of its effects, that a parameter follows. Raises BadInput."""
        owner, _, key = source.removesuffix("?").partition(".")
        if owner == "vessel":
            return float(attrgetter(key)(vessel))
        if source.endswith("?") and vessel.effect(owner) is None:
            return 0.0
        return float(getattr(self.needed(vessel, owner), key))

    def needed(self, vessel: Any, owner: str) -> Any:
        """The vessel's effect that this one builds on. Raises BadInput where it has none."""
        own = vessel.effect(owner)
        if own is None:
            raise BadInput(f"{vessel.name}: {self.name()} needs a vessel with {owner}")
        return own

    def seeded(self, seed: int) -> Self:
        """The effect with its random course, if it has one, drawn from a scenario's seed."""
        return self


def preset(
    law: type[E],
    name: str,
    *,
    frees: Mapping[str, Mapping[str, Any]] | None = None,
    fixed: Mapping[str, float] | None = None,
    otherwise: Mapping[str, float] | None = None,
    **about: Any,
) -> type[E]:
    """Another entry over the same law, under a name of its own; `about` is its words, shown_by, source, starts ...

    `frees` are the parameters that a diagnosis may fit, with what is otherwise known of them (`Param`); `fixed` are
    those that make the entry what it is. The rest stays open to a file, with `otherwise` as its other nominal values.
    """
    types: dict[str, type] = {}
    namespace: dict[str, Any] = {**about, "__doc__": about["words"], "__module__": law.__module__}
    namespace["__annotations__"] = types
    for key, known in law.params().items():
        nominal = next(f.default for f in fields(law) if f.name == key)
        if key in (frees or {}):
            known = known._replace(**{"fit": True, "calibrates": "", **(frees or {})[key]})
            nominal = known.absent
        elif key in (fixed or {}):
            nominal = (fixed or {})[key]
            known = known._replace(low=nominal, high=nominal, fit=False, calibrates="", follows="")
        else:
            nominal = (otherwise or {}).get(key, nominal)
            known = known._replace(fit=False)
        namespace[key] = field(default=nominal, metadata={"param": known})
        types[key] = float
    made: type[E] = dataclass(frozen=True)(new_class(name, (law,), exec_body=lambda body: body.update(namespace)))
    return made


class Change(NamedTuple):
    """What a parameter of a release does to one number of a vessel."""

    parameter: str  # of the release
    owner: str  # the vessel's effect, or "body"
    key: str
    how: str  # "sets", "scales" or "shifts"
    weight: float  # of a shift

    def of(self, stated: float, value: float) -> float:
        """The number in place of the stated one where the parameter has this value."""
        if self.how == "scales":
            return stated * value
        return stated + self.weight * value if self.how == "shifts" else value


@dataclass(frozen=True)
class Release(Effect):
    """A suspicion that stated numbers of the vessel are off: no law of its own, the vessel's own effects feel it.

    Each parameter names the numbers it `releases`; those the vessel does not have are left out. In a vessel or scenario
    file it changes them at once, in a diagnosis they are fitted, in a patched file they are written.
    """

    def changes(self, vessel: Any) -> list[Change]:
        """What it does to the numbers that the vessel has."""
        found, weights = [], self.weights(vessel)
        for name, about in type(self).params().items():
            for place in about.releases:
                owner, _, key = place.partition(".")
                if owner == "body" or vessel.effect(owner) is not None:
                    found.append(Change(name, owner, key, about.how, weights.get(place, 1.0)))
        return found

    def weights(self, vessel: Any) -> dict[str, float]:
        """What a number is shifted by per shift of the parameter; 1 where it is not said."""
        return {}

    def completed(self, vessel: Any) -> Self:
        """Raises BadInput where the vessel has none of the numbers."""
        if not self.changes(vessel):
            places = (p for about in type(self).params().values() for p in about.releases)
            self.needed(vessel, next(places).partition(".")[0])
        return super().completed(vessel)


@dataclass(frozen=True)
class Force(Effect):
    """Memoryless force: compiled `law(motion, values) -> Wrench`."""

    law: ClassVar[Callable[[Any, Any], Wrench]]

    def wrench(self, m: Any) -> Wrench:
        """The force at one motion."""
        return Wrench(*type(self).law(m, self.values()))


@dataclass(frozen=True)
class Reaction(Effect):
    """A force that depends on the others: compiled `reaction(motion, wrench, values) -> Wrench`.

    `wrench` is the sum of all laws that stand before it: the vessel's own in the order of its file, then the suspects.
    """

    reaction: ClassVar[Callable[[Any, Wrench, Any], Wrench]]


@dataclass(frozen=True)
class Inertia(Effect):
    """Inertia carried along: compiled `inertia(values) -> Mass`; its Coriolis force is the effect's own law.

    `moves_with` says whose acceleration it feels: "water" (added mass: relative to the water) or "hull" (ballast).
    """

    moves_with: ClassVar[str] = "water"
    inertia: ClassVar[Callable[[Any], Mass]]

    def matrix(self) -> Array:
        """(4, 4) over (surge, sway, roll, yaw), kg, kg m, kg m^2."""
        return Mass(*type(self).inertia(self.values())).matrix()


@dataclass(frozen=True)
class Flow(Effect):
    """Water that moves under the hull: compiled `flow(values) -> (north, east)` in m/s."""

    flow: ClassVar[Callable[[Any], tuple[float, float]]]


@dataclass(frozen=True)
class Channel(Effect):
    """A signal on its way from command to actuator, once for every actuator of the family `acts_on`.

    compiled `channel(x, side, source, memory, at, dt, values) -> float`: x is the signal so far, side -1 port,
    +1 starboard, 0 middle, source the raw command of the same side in the family `source_family`, memory[at:at +
    slots] this actuator's own memory. The value returned is the mean over the step dt [s] that begins now.
    `pause(x, memory, at, values)`, where there is one, says in how many s the signal will jump while its command x is
    held (a delayed command arrives): no step reaches beyond.
    """

    acts_on: ClassVar[str] = "thrust"
    source_family: ClassVar[str] = ""
    slots: ClassVar[int] = 0
    pause: ClassVar[Callable[[float, Array, int, Any], float] | None] = None
    channel: ClassVar[Callable[[float, float, float, Array, int, float, Any], float]]


@dataclass(frozen=True)
class Measurement(Effect):
    """What a recording shows differs from what the boat did: compiled `shown(Shown, values) -> Shown`.

    Acts in the diagnosis filter and in `replay`; the simulated boat itself does not feel it. `late(values)`, where
    there is one, is the time [s] by which the recorded motion is late behind the recorded commands (negative: early).
    """

    kind: ClassVar[str] = "measurement"
    shown: ClassVar[Callable[[Shown, Any], Shown] | None] = None
    late: ClassVar[Callable[[Any], float] | None] = None


@dataclass(frozen=True)
class Unsteady(Force):
    """A force with a random course in time: compiled `swell(values) -> Swell`, and `law` for one realisation.

    The simulator feels the realisation that `law` gives; the diagnosis filter follows the oscillators of `swell`
    instead and silences the law by setting the parameter `realisation` to 0.
    """

    swell: ClassVar[Callable[[Any], Swell]]
