"""The signals of a moving hull in one table: name, unit, freedom, and what an instrument that shows them is off by.

Axes are SNAME: x forward, y starboard, z down, heading and yaw rate clockwise seen from above. Vectors over the
freedoms have the order of `AXES`, those of them that a vessel has.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from boatsim.physics.compiler_internals import known_to_numba

Array = NDArray[np.float64]

AXES = ("surge", "sway", "heave", "roll", "pitch", "yaw")
COMPONENTS = dict(
    zip(AXES, ("X_N", "Y_N", "Z_N", "K_Nm", "M_Nm", "N_Nm"), strict=True)
)  # force columns, by freedom


@dataclass(frozen=True)
class Signal:
    """One coordinate of a hull's motion, or its rate, as files and controllers know it."""

    symbol: str  # field of `Motion`, `Shown` and the engine's `State`
    column: str  # in recordings and logs, with its unit
    axis: str  # freedom it belongs to
    rate: bool  # a body-axes rate, else a coordinate
    noise: str  # family of the instruments that measure it
    # [unit of the column] where neither recording nor vessel states one: fitted from here, widely
    noise_sd: float


STATE = (
    Signal("x", "x_m", "surge", False, "position_sd_m", 0.01),
    Signal("y", "y_m", "sway", False, "position_sd_m", 0.01),
    Signal("z", "z_m", "heave", False, "heave_sd_m", 0.01),
    Signal("phi", "phi_rad", "roll", False, "roll_sd_rad", 0.002),
    Signal("theta", "theta_rad", "pitch", False, "pitch_sd_rad", 0.002),
    Signal("psi", "psi_rad", "yaw", False, "heading_sd_rad", 0.01),
    Signal("u", "u_mps", "surge", True, "speed_sd_mps", 0.02),
    Signal("v", "v_mps", "sway", True, "speed_sd_mps", 0.02),
    Signal("w", "w_mps", "heave", True, "heave_rate_sd_mps", 0.02),
    Signal("p", "p_radps", "roll", True, "roll_rate_sd_radps", 0.005),
    Signal("q", "q_radps", "pitch", True, "pitch_rate_sd_radps", 0.005),
    Signal("r", "r_radps", "yaw", True, "yaw_rate_sd_radps", 0.005),
)
POSE = tuple(s.column for s in STATE if not s.rate)
RATES = tuple(s.column for s in STATE if s.rate)
NOISE = {s.noise: s.noise_sd for s in STATE}


def signals_of(dof: tuple[str, ...]) -> tuple[Signal, ...]:
    """Coordinates, then rates, of a vessel with these freedoms, in the order of `AXES`."""
    return tuple(s for s in STATE if s.axis in dof)


def follower(goal: str) -> str | None:
    """Column of what is to follow a goal: of its name, or of the freedom it names: v_mps of `sway_mps`; None: none."""
    names = {s.column: s.column for s in STATE}
    names |= {f"{s.axis}_{s.column.partition('_')[2]}": s.column for s in STATE}
    return names.get(goal)


class Motion(NamedTuple):
    """What a force law may look at; a freedom that the vessel has not is zero."""

    t: float  # [s]
    x: float  # [m] north or forward at the start
    y: float  # [m] east or starboard at the start
    z: float  # [m] down
    phi: float  # [rad] roll, starboard down
    theta: float  # [rad] pitch, bow up
    psi: float  # [rad] heading
    u: float  # [m/s] surge over ground
    v: float  # [m/s] sway over ground
    w: float  # [m/s] heave
    p: float  # [rad/s] roll rate
    q: float  # [rad/s] pitch rate
    r: float  # [rad/s] yaw rate
    ur: float  # [m/s] surge through the water
    vr: float  # [m/s] sway through the water
    wr: float  # [m/s] heave through the water
    cos_psi: float
    sin_psi: float


class Shown(NamedTuple):
    """What instruments show of a motion; a measurement effect changes it on its way into the recording."""

    x: float  # [m]
    y: float  # [m]
    z: float  # [m]
    phi: float  # [rad]
    theta: float  # [rad]
    psi: float  # [rad]
    u: float  # [m/s]
    v: float  # [m/s]
    w: float  # [m/s]
    p: float  # [rad/s]
    q: float  # [rad/s]
    r: float  # [rad/s]


class Wrench(NamedTuple):
    """Force on the hull in body axes about the origin of motion; `wrench` builds one in a compiled law."""

    X: float = 0.0  # [N] surge
    Y: float = 0.0  # [N] sway
    Z: float = 0.0  # [N] heave
    K: float = 0.0  # [N m] roll
    M: float = 0.0  # [N m] pitch
    N: float = 0.0  # [N m] yaw


def wrench(
    X: float = 0.0, Y: float = 0.0, Z: float = 0.0, K: float = 0.0, M: float = 0.0, N: float = 0.0
) -> Wrench:
    """`Wrench` by the names of its components, the others zero."""
    return Wrench(X, Y, Z, K, M, N)


class Mass(NamedTuple):
    """Symmetric inertia over the freedoms of a hull alike on both sides; all other entries of its matrix are zero."""

    surge: float = 0.0  # [kg]
    sway: float = 0.0  # [kg]
    heave: float = 0.0  # [kg]
    roll: float = 0.0  # [kg m^2]
    pitch: float = 0.0  # [kg m^2]
    yaw: float = 0.0  # [kg m^2]
    surge_heave: float = 0.0  # [kg]
    surge_pitch: float = 0.0  # [kg m]
    heave_pitch: float = 0.0  # [kg m]
    sway_roll: float = 0.0  # [kg m]
    sway_yaw: float = 0.0  # [kg m]
    roll_yaw: float = 0.0  # [kg m^2]

    def matrix(self) -> Array:
        """(6, 6) over `AXES`."""
        full = np.zeros((6, 6))
        for value, (i, j) in zip(self, MASS_ENTRIES, strict=True):
            full[i, j] = full[j, i] = value
        return full


MASS_ENTRIES = tuple(
    (AXES.index(name.partition("_")[0]), AXES.index(name.partition("_")[2] or name))
    for name in Mass._fields
)


def mass(
    surge: float = 0.0,
    sway: float = 0.0,
    heave: float = 0.0,
    roll: float = 0.0,
    pitch: float = 0.0,
    yaw: float = 0.0,
    surge_heave: float = 0.0,
    surge_pitch: float = 0.0,
    heave_pitch: float = 0.0,
    sway_roll: float = 0.0,
    sway_yaw: float = 0.0,
    roll_yaw: float = 0.0,
) -> Mass:
    """`Mass` by the names of its entries, the others zero."""
    return Mass(
        surge,
        sway,
        heave,
        roll,
        pitch,
        yaw,
        surge_heave,
        surge_pitch,
        heave_pitch,
        sway_roll,
        sway_yaw,
        roll_yaw,
    )


class Swell(NamedTuple):
    """A lightly damped oscillator per axis, driven by noise: a force that comes and goes with one frequency."""

    X: float  # [N] rms
    Y: float  # [N] rms
    Z: float  # [N] rms
    K: float  # [N m] rms
    M: float  # [N m] rms
    N: float  # [N m] rms
    frequency: float  # [rad/s]
    damping: float  # share of the critical one


def swell(
    X: float = 0.0,
    Y: float = 0.0,
    Z: float = 0.0,
    K: float = 0.0,
    M: float = 0.0,
    N: float = 0.0,
    frequency: float = 0.0,
    damping: float = 1.0,
) -> Swell:
    """`Swell` by name; a frequency of zero means that there is none."""
    return Swell(X, Y, Z, K, M, N, frequency, damping)


class Wander(NamedTuple):
    """Error of instruments that comes and goes slowly, as that of satellite fixes does (Gauss-Markov, first order)."""

    position: float  # [m] rms, north and east alike
    heading: float  # [rad] rms
    time: float  # [s] correlation time


for _constructor, _record in ((wrench, Wrench), (mass, Mass), (swell, Swell)):
    known_to_numba(_constructor, _record)


class Course(NamedTuple):
    """A signal over one step: at its begin, in its middle and at its end.

    The middle is chosen so that Simpson's rule, by which a Runge-Kutta step weighs the three, gives the signal's mean
    over the step exactly: a motor that follows within the step gives the right impulse.
    """

    begin: float
    middle: float
    end: float


@njit(inline="always")
def course(begin: float, mean: float, end: float) -> Course:
    """The course of a signal with this mean over the step; one that stands still stands still to the last bit."""
    return Course(begin, mean + 0.25 * ((mean - begin) + (mean - end)), end)


# [s] the shortest step that a lag asks for: in so short a one its mean counts, not its course
BRIEF = 0.02


@njit(inline="always")
def followed(lag: float) -> float:
    """How far a step may reach while a signal follows with a lag [s]: three points tell its course over one lag."""
    return max(lag, BRIEF) if lag > 0.0 else np.inf


@njit(inline="always")
def lagged(x: Course, time_constant: float, memory: Array, at: int, dt: float) -> Course:
    """A first-order lag behind a signal, exact where its course is a parabola; memory[at] is its value.

    T y' = x - y with x = b + c s + d s^2, s in steps, has the solution f + g s + d s^2 beside a decaying rest.
    """
    y, quick = memory[at], dt / time_constant
    c, d = 4.0 * x.middle - 3.0 * x.begin - x.end, 2.0 * (x.begin + x.end) - 4.0 * x.middle
    g = c - 2.0 * d / quick
    f = x.begin - g / quick
    decay = np.exp(-quick)
    memory[at] = f + g + d + (y - f) * decay
    return course(y, f + 0.5 * g + d / 3.0 + (y - f) * (1.0 - decay) / quick, memory[at])


@njit(inline="always")
def mean_of(x: Course) -> float:
    """Mean over the step; that of a signal that stands still is the signal, to the last bit."""
    return x.begin + (4.0 * (x.middle - x.begin) + (x.end - x.begin)) / 6.0
