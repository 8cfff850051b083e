"""Nonlinear passive observer: low-frequency motion, velocity and bias force from position fixes.

The motion of a vessel at first-order waves, which thrusters cannot oppose, is separated from the
slow motion by a notch filter for each axis. Only position and heading are measured.

T. I. Fossen, J. P. Strand, Passive nonlinear observer design for ships using Lyapunov methods:
full-scale experiments with a supply vessel, Automatica 35, 1999.
"""

from math import ceil, cos, isnan, pi, sin
from typing import NamedTuple

import numpy as np

from boatsim.errors import BadInput
from boatsim.physics.base import Array
from boatsim.physics.kernel.compiling import compiled

# Damping ratio of the wave model and of the notch: at the wave frequency the filter passes their
# ratio, 1/10. Fossen & Strand 1999 use 0.1 and 1.0.
WAVE_DAMPING, NOTCH_DAMPING = 0.1, 1.0
# Cutoff frequency over wave frequency; it must exceed 1, Fossen & Strand 1999 use 1.1 to 1.2.
CUTOFF_SHARE = 1.1
# Gain of the velocity over inertia and squared wave frequency. The velocity then follows with
# 0.3 of the wave frequency: slower than the waves and faster than a control loop at 0.1 of it.
VELOCITY_SHARE = 0.1
# Gain of the bias over that of the velocity and the wave frequency. 1 / T < K3 / K4 < w0 < wc is
# the condition of Fossen & Strand for passivity.
BIAS_SHARE = 0.1
# Time constant of the bias times the wave frequency: 1000 s in waves of 6 s, as in the source.
BIAS_MEMORY = 1000.0
# [rad] largest wave phase in one step of the Runge-Kutta method: its error is then below 1e-5
LARGEST_PHASE = 0.2
SIZE = 15  # xi (6), eta (3), bias (3), nu (3)


class ObserverDesign(NamedTuple):
    """Numbers of the model of a passive observer, and its gains."""

    inverse_mass: Array  # (3, 3)
    damping: Array  # (3, 3)
    frequency: float  # [rad/s] of the waves
    gains: Array  # (5, 3): K1 upper half, K1 lower half, K2, K3 and K4
    bias_time: float  # [s] time constant of the bias force


@compiled
def observer_rates(
    state: Array,
    measured: Array,
    force: Array,
    design: ObserverDesign,
) -> Array:
    """Return the time derivative of the state of a passive observer (15,).

    Args:
        state: Wave states (6,), position x, y [m] and heading [rad] without waves (3,), bias force
            in earth axes (3,) and velocity u, v [m/s], r [rad/s] (3,).
        measured: Measured x, y [m] and heading [rad] (3,); nan where there is no measurement, and
            the model alone predicts.
        force: Force and moment of thrusters and wind in body axes (3,).
        design: Numbers of the model and gains.
    """
    rates = np.zeros(15)
    gains = design.gains
    estimate = state[6:9] + state[3:6]
    error = measured - estimate
    error[2] = (error[2] + pi) % (2.0 * pi) - pi
    for i in range(3):
        if isnan(measured[i]):
            error[i] = 0.0
    heading = estimate[2] if isnan(measured[2]) else measured[2]
    c, s = cos(heading), sin(heading)
    u, v, r = state[12], state[13], state[14]
    for i in range(3):
        w = design.frequency
        rates[i] = state[3 + i] + gains[0, i] * error[i]
        rates[3 + i] = (
            -w * w * state[i] - 2.0 * WAVE_DAMPING * w * state[3 + i] + gains[1, i] * error[i]
        )
        rates[9 + i] = -state[9 + i] / design.bias_time + gains[3, i] * error[i]
    rates[6] = c * u - s * v + gains[2, 0] * error[0]
    rates[7] = s * u + c * v + gains[2, 1] * error[1]
    rates[8] = r + gains[2, 2] * error[2]
    # bias and corrections of the velocity act in body axes
    north = state[9] + gains[4, 0] * error[0]
    east = state[10] + gains[4, 1] * error[1]
    total = np.zeros(3)
    total[0] = force[0] + c * north + s * east
    total[1] = force[1] - s * north + c * east
    total[2] = force[2] + state[11] + gains[4, 2] * error[2]
    for i in range(3):
        for j in range(3):
            total[i] -= design.damping[i, j] * state[12 + j]
    for i in range(3):
        for j in range(3):
            rates[12 + i] += design.inverse_mass[i, j] * total[j]
    return rates


@compiled
def advance_observer(
    state: Array,
    measured: Array,
    force: Array,
    design: ObserverDesign,
    period: float,
    parts: int,
) -> Array:
    """Return the state of a passive observer after one period, by the Runge-Kutta method.

    Measurement and force are held over the period.

    Args:
        state: State at the begin (15,).
        measured: Measured x, y [m] and heading [rad] (3,).
        force: Force and moment (3,).
        design: Numbers of the model and gains.
        period: Length of the period [s].
        parts: Number of steps.
    """
    h = period / parts
    y = state.copy()
    for _ in range(parts):
        k1 = observer_rates(y, measured, force, design)
        k2 = observer_rates(y + 0.5 * h * k1, measured, force, design)
        k3 = observer_rates(y + 0.5 * h * k2, measured, force, design)
        k4 = observer_rates(y + h * k3, measured, force, design)
        y += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
    return y


class PassiveObserver:
    """Estimates position, velocity and bias force of a vessel without the motion in waves.

    Attributes:
        design: Numbers of the model and gains.
        state: Wave states (6,), position and heading (3,), bias force in earth axes (3,), velocity
            (3,).
    """

    def __init__(
        self, mass: Array, damping: Array, frequency: float, period: float, filters: bool = True
    ) -> None:
        """Choose the gains of an observer by the wave frequency.

        Args:
            mass: Mass matrix with added mass (3, 3) [kg, kg m, kg m^2].
            damping: Linear damping (3, 3).
            frequency: Frequency at the peak of the wave spectrum [rad/s].
            period: Time between two measurements [s].
            filters: Whether the motion in waves is filtered out; without it the estimate of the
                position follows the measurement with the cutoff frequency.

        Raises:
            BadInput: Frequency or period is not positive.
        """
        if not (frequency > 0.0 and period > 0.0):
            raise BadInput(
                f"passive observer: frequency {frequency:g} rad/s, period {period:g} s; allowed "
                "are numbers above 0"
            )
        self._period = period
        self._parts = ceil(frequency * period / LARGEST_PHASE)
        cutoff = CUTOFF_SHARE * frequency
        width = NOTCH_DAMPING - WAVE_DAMPING if filters else 0.0
        velocity = VELOCITY_SHARE * frequency**2 * np.diag(mass)
        gains = [
            np.full(3, -2.0 * width * cutoff / frequency),
            np.full(3, 2.0 * width * frequency),
            np.full(3, cutoff),
            BIAS_SHARE * frequency * velocity,
            velocity,
        ]
        inverse = np.ascontiguousarray(np.linalg.inv(mass))
        drag = np.ascontiguousarray(damping)
        time = BIAS_MEMORY / frequency
        self.design = ObserverDesign(inverse, drag, frequency, np.array(gains), time)
        self.state = np.zeros(SIZE)

    def reset(self, position: Array) -> None:
        """Begin at a position, at rest and without bias.

        Args:
            position: x, y [m] and heading [rad] (3,).
        """
        self.state = np.zeros(SIZE)
        self.state[6:9] = position

    def step(self, measured: Array, force: Array) -> None:
        """Advance the estimates by one period.

        Args:
            measured: Measured x, y [m] and heading [rad] (3,).
            force: Force X, Y [N] and moment N [N m] of thrusters and wind (3,), held over the
                period.
        """
        self.state = advance_observer(
            self.state, measured, force, self.design, self._period, self._parts
        )

    @property
    def position(self) -> Array:
        """Estimate of x, y [m] and heading [rad] without the motion in waves (3,)."""
        return self.state[6:9]

    @property
    def velocity(self) -> Array:
        """Estimate of u, v [m/s] and r [rad/s] without the motion in waves (3,)."""
        return self.state[12:15]

    @property
    def bias(self) -> Array:
        """Estimate of the slow force in earth axes [N, N, N m] (3,)."""
        return self.state[9:12]

    @property
    def wave_motion(self) -> Array:
        """Estimate of the motion in waves: x, y [m] and heading [rad] (3,)."""
        return self.state[3:6]


def notch_response(frequency: Array, wave_frequency: float) -> Array:
    """Return the transfer function of an observer from measured to estimated position (n,).

    It holds for an observer whose velocity is zero, K3 = K4 = 0:

    wc (s^2 + 2 l w0 s + w0^2) / ((s^2 + 2 z w0 s + w0^2) (s + wc))

    with the damping l of the wave model and z of the notch (Fossen & Strand 1999, section 4.2).

    Args:
        frequency: Frequencies (n,) [rad/s].
        wave_frequency: Wave frequency w0 [rad/s].
    """
    s, w = 1j * np.asarray(frequency), wave_frequency
    cutoff = CUTOFF_SHARE * w
    above = s * s + 2.0 * WAVE_DAMPING * w * s + w * w
    below = (s * s + 2.0 * NOTCH_DAMPING * w * s + w * w) * (s + cutoff)
    return np.asarray(cutoff * above / below)
