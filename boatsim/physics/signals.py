"""Signals of a moving hull: name, unit, degree of freedom and default sensor noise.

Arguments and results of laws.

Axes are SNAME: x forward, y starboard, z down, heading and yaw rate clockwise seen from above.
Vectors over the degrees of freedom have the order of `AXES`, without those that a vessel does not
have.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from boatsim.physics.compiler_internals import register_with_numba

Array = NDArray[np.float64]

AXES = ("surge", "sway", "heave", "roll", "pitch", "yaw")
PLANAR_DOF = frozenset(("surge", "sway", "yaw"))
ROTATIONS = ("roll", "pitch", "yaw")
# force columns by degree of freedom
COMPONENTS = dict(zip(AXES, ("X_N", "Y_N", "Z_N", "K_Nm", "M_Nm", "N_Nm"), strict=True))


@dataclass(frozen=True)
class Signal:
    """Declaration of a motion signal: one coordinate of a hull or its rate.

    It has a symbol, a column name, a degree of freedom and a default sensor noise.
    """

    symbol: str  # field of `Motion`, `MeasuredMotion` and the engine's `State`
    column: str  # in recordings and logs, with its unit
    axis: str  # degree of freedom
    rate: bool  # a body-axes rate, else a coordinate
    noise: str  # noise family: the instruments that measure it
    # [unit of the column] start of the fit where neither recording nor vessel specifies one
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
POSE = tuple(s.column for s in STATE[:6])
RATES = tuple(s.column for s in STATE[6:])
NOISE = {s.noise: s.noise_sd for s in STATE}


def motion_signals(dof: tuple[str, ...]) -> tuple[Signal, ...]:
    """Return the motion signals of a vessel: its coordinates, then their rates.

    They have the order of `AXES`.

    Args:
        dof: Degrees of freedom of the vessel.
    """
    return tuple(s for s in STATE if s.axis in dof)


def measured_column_for_goal(goal: str) -> str | None:
    """Return the measured column that a controller's goal sets, as v_mps for `sway_mps`.

    None if no column corresponds to the goal.

    Args:
        goal: Name of a column, or of a degree of freedom with a unit.
    """
    names = {s.column: s.column for s in STATE}
    names |= {f"{s.axis}_{s.column.partition('_')[2]}": s.column for s in STATE}
    return names.get(goal)


class Motion(NamedTuple):
    """Motion of the hull as an argument of force laws: time, position, attitude and velocities.

    Values of a degree of freedom that the vessel does not have are zero.
    """

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
    water_north: float  # [m/s] velocity of the water over ground to north
    water_east: float  # [m/s] to east
    carried_north: float  # [m] distance since t = 0 of the water on which waves travel
    carried_east: float  # [m] the same to east


class MeasuredMotion(NamedTuple):
    """Position, attitude and velocities of the hull as instruments measure and record them.

    A measurement effect changes them.
    """

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
    """Force and moment on the hull in body axes about the origin of motion.

    Compiled laws build it with `wrench`.
    """

    X: float = 0.0  # [N] surge
    Y: float = 0.0  # [N] sway
    Z: float = 0.0  # [N] heave
    K: float = 0.0  # [N m] roll
    M: float = 0.0  # [N m] pitch
    N: float = 0.0  # [N m] yaw


def wrench(
    X: float = 0.0, Y: float = 0.0, Z: float = 0.0, K: float = 0.0, M: float = 0.0, N: float = 0.0
) -> Wrench:
    """Return a `Wrench` (force and moment on the hull) from named components.

    The others are zero.
    """
    return Wrench(X, Y, Z, K, M, N)


class MassMatrix(NamedTuple):
    """Mass matrix of a hull that is symmetric to port and starboard, by its nonzero entries."""

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
        """Return the full mass matrix (6, 6) over `AXES`."""
        full = np.zeros((6, 6))
        for value, (i, j) in zip(self, MASS_ENTRIES, strict=True):
            full[i, j] = full[j, i] = value
        return full


MASS_ENTRIES = tuple(
    (AXES.index(name.partition("_")[0]), AXES.index(name.partition("_")[2] or name))
    for name in MassMatrix._fields
)


def mass_matrix(
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
) -> MassMatrix:
    """Return a `MassMatrix` of a symmetric hull from named entries; the others are zero."""
    diagonal = (surge, sway, heave, roll, pitch, yaw)
    couplings = (surge_heave, surge_pitch, heave_pitch, sway_roll, sway_yaw, roll_yaw)
    return MassMatrix(*diagonal, *couplings)


class OscillatingForce(NamedTuple):
    """Model of a random oscillating force: a damped oscillator per axis, driven by white noise."""

    X: float  # [N] rms
    Y: float  # [N] rms
    Z: float  # [N] rms
    K: float  # [N m] rms
    M: float  # [N m] rms
    N: float  # [N m] rms
    frequency: float  # [rad/s]
    damping: float  # damping ratio


def oscillating_force(
    X: float = 0.0,
    Y: float = 0.0,
    Z: float = 0.0,
    K: float = 0.0,
    M: float = 0.0,
    N: float = 0.0,
    frequency: float = 0.0,
    damping: float = 1.0,
) -> OscillatingForce:
    """Return an `OscillatingForce`, a model of random wave forces, from named fields.

    A frequency of zero means that there is none.
    """
    return OscillatingForce(X, Y, Z, K, M, N, frequency, damping)


class InstrumentDrift(NamedTuple):
    """Model of slowly varying instrument errors: rms and correlation time.

    Each error is a first-order Gauss-Markov process.
    """

    position: float  # [m] rms, north and east alike
    heading: float  # [rad] rms
    time: float  # [s] correlation time


for _constructor, _record in (
    (wrench, Wrench),
    (mass_matrix, MassMatrix),
    (oscillating_force, OscillatingForce),
):
    register_with_numba(_constructor, _record)


class SignalSegment(NamedTuple):
    """Actuator signal over one step, by its values at begin, middle and end of the step.

    A Runge-Kutta step weighs the three by Simpson's rule. The middle is chosen so that this gives
    the mean of the signal over the step exactly, and thus the right impulse of a motor that reaches
    its command within the step.
    """

    begin: float
    middle: float
    end: float


@njit(inline="always")
def segment_with_mean(begin: float, mean: float, end: float) -> SignalSegment:
    """Return an actuator signal over a step from its begin, end and exact mean.

    A constant signal is exactly constant.
    """
    return SignalSegment(begin, mean + 0.25 * ((mean - begin) + (mean - end)), end)


# [s] Shortest step that a lag requires: over a shorter one only the mean of the signal matters.
BRIEF = 0.02


@njit(inline="always")
def longest_lag_step(lag: float) -> float:
    """Return the longest step [s] over which three points describe a first-order lag.

    It is one time constant of the lag.
    """
    return max(lag, BRIEF) if lag > 0.0 else np.inf


@njit(inline="always")
def first_order_lag(
    x: SignalSegment, time_constant: float, memory: Array, at: int, dt: float
) -> SignalSegment:
    """Return an actuator signal after a first-order lag, exact if the input is a parabola.

    The state of the lag is memory[at]. T y' = x - y with x = b + c s + d s^2, s in steps, has the
    solution f + g s + d s^2 plus a decaying exponential. A constant x leaves only f.

    Args:
        x: Input signal over the step.
        time_constant: T [s].
        memory: States of the actuators.
        at: Index of the state of the lag in `memory`.
        dt: Length of the step [s].
    """
    y, quick = memory[at], dt / time_constant
    decay = np.exp(-quick)
    if x.middle == x.begin and x.end == x.begin:
        rest = y - x.begin
        memory[at] = x.begin + rest * decay
        return segment_with_mean(y, x.begin + rest * (1.0 - decay) / quick, memory[at])
    c, d = 4.0 * x.middle - 3.0 * x.begin - x.end, 2.0 * (x.begin + x.end) - 4.0 * x.middle
    g = c - 2.0 * d / quick
    f = x.begin - g / quick
    memory[at] = f + g + d + (y - f) * decay
    return segment_with_mean(y, f + 0.5 * g + d / 3.0 + (y - f) * (1.0 - decay) / quick, memory[at])


@njit(inline="always")
def segment_mean(x: SignalSegment) -> float:
    """Return the mean of an actuator signal over one step, by Simpson's rule.

    The mean of a constant signal is exactly the signal.
    """
    return x.begin + (4.0 * (x.middle - x.begin) + (x.end - x.begin)) / 6.0
