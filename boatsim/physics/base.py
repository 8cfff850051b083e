"""What an effect is: parameters with bounds, the motion it sees, the force, inertia, flow or signal it gives.

An effect is one idea of physics in one file of `boatsim/physics/effects/`. Its law is a small compiled function that
the MuJoCo callback, the twin and the diagnosis filter all call, so that simulator and diagnosis can not disagree.
Axes are SNAME: x forward, y starboard, z down, heading and yaw rate clockwise seen from above.
"""

import math
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, fields, replace
from functools import cache
from operator import attrgetter
from typing import Any, ClassVar, NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from boatsim.errors import BadInput, unknown_name

Array = NDArray[np.float64]
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


@dataclass(frozen=True)
class Param:
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
    follows: str = ""  # "linear_damping.surge" of the vessel, or "vessel.body.mass" where none is given
    scales: str = ""  # "linear_damping.surge": the vessel's coefficient that this factor multiplies


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
    scales: str = "",
) -> Any:
    """Dataclass field of a checked number. `unit` is "" for a ratio; `spread` is the prior sd of a fitted parameter."""
    about = Param(low, high, unit, words, fit, spread, axis, absent, calibrates, follows, scales)
    return field(default=nominal, metadata={"param": about})


class Checked:
    """Mixin of dataclasses whose `param` fields are checked on construction and whose unknown settings are named."""

    @classmethod
    def params(cls) -> dict[str, Param]:
        """Name -> `Param` of every checked field, in order of declaration."""
        return {f.name: f.metadata["param"] for f in fields(cls) if "param" in f.metadata}  # type: ignore[arg-type]

    @classmethod
    def from_settings(cls, settings: Mapping[str, Any]) -> Self:
        """Build from a file's table; raises BadInput with the nearest valid name for a setting that does not exist."""
        names = [f.name for f in fields(cls) if f.init]  # type: ignore[arg-type]
        for key in settings:
            if key not in names:
                raise BadInput(unknown_name(f"{cls.__name__}: setting", key, names))
        return cls(**settings)

    def __post_init__(self) -> None:
        for name, about in type(self).params().items():
            value = getattr(self, name)
            if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
                raise BadInput(f"{type(self).__name__}.{name} = {value!r}; allowed is a number ({about.words})")
            if not about.low <= value <= about.high:
                raise BadInput(
                    f"{type(self).__name__}.{name} = {value:g} {about.unit}; allowed {about.low:g} to "
                    f"{about.high:g} {about.unit} ({about.words})"
                )


def snake_case(name: str) -> str:
    """FanWind -> fan_wind: the name of an effect or controller is its file's name."""
    return re.sub(r"(?<!^)(?=[A-Z])", "_", name).lower()


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
        return type(self).values_type()(*(float(getattr(self, n)) for n in type(self).params()))

    def completed(self, vessel: Any) -> Self:
        """The effect with what it must know of the vessel it is put on (`follows`) filled in. Raises BadInput."""
        taken = {}
        for name, about in type(self).params().items():
            owner, _, key = about.follows.partition(".")
            if owner == "vessel":
                taken[name] = getattr(self, name) or attrgetter(key)(vessel)
            elif owner:
                taken[name] = getattr(self.needed(vessel, owner), key)
        return replace(self, **taken)

    def needed(self, vessel: Any, owner: str) -> Any:
        """The vessel's effect that this one builds on. Raises BadInput where it has none."""
        own = vessel.effect(owner)
        if own is None:
            raise BadInput(f"{vessel.name}: {self.name()} needs a vessel with {owner}")
        return own

    def seeded(self, seed: int) -> Self:
        """The effect with its random course, if it has one, drawn from a scenario's seed."""
        return self


@dataclass(frozen=True)
class Force(Effect):
    """Memoryless force: compiled `law(motion, values) -> Wrench`."""

    law: ClassVar[Callable[[Any, Any], Wrench]]
    of_air: ClassVar[bool] = False  # a force of the air, which a run logs apart

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
