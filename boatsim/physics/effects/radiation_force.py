"""Radiation force of one axis: damping and added mass that depend on the frequency."""

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numba import njit
from numpy.typing import NDArray

from boatsim.physics.base import (
    Array,
    MotionMemory,
    ParameterChanges,
    Wrench,
    param,
    preset_effect,
    wrench,
)
from boatsim.physics.coefficients.memory_step import oscillator_factors

# floats of the memory: place and rate of the oscillator; speeds at the begin of the last step and
# of the one before, and the lengths of both; factors of a whole step and of its first half
PLACE, RATE, SPEED, EARLIER, LAST, BEFORE, WHOLE, HALF, STATES = 0, 1, 2, 3, 4, 5, 6, 16, 26
# Shortest earlier step, in steps, from which the curvature of the speed is taken: a difference of
# speeds over a shorter one contains mostly the corrections of a filter.
SHORT = 0.3


@njit(inline="always")
def speed_of_axis(m: Any, q: Any) -> float:
    """Return the speed of the effect's axis through the water [m/s] or its rate [rad/s].

    Args:
        m: Motion of the hull.
        q: Parameters of the effect.
    """
    return float(q.in_sway * m.vr + q.in_heave * m.wr + q.in_roll * m.p + q.in_pitch * m.q)


@njit
def store_factors(a: float, b: float, h: float, memory: Array, at: Any) -> None:
    """Store the factors of a step of the oscillator x'' + a x' + b x = u.

    They are those of `oscillator_factors`, then place and rate after the input s (s - h).

    Args:
        a: Damping [1/s].
        b: Stiffness [1/s^2].
        h: Length of the step [s].
        memory: States of all effects.
        at: Index of the first factor.
    """
    oscillator_factors(a, b, h, memory, at)
    # the particular solution of the input s^2 is s^2 / b + slope s + level
    slope, level = -2.0 * a / (b * b), 2.0 * (a * a - b) / (b * b * b)
    place = h * h / b + slope * h + level - memory[at] * level - memory[at + 1] * slope
    rate = 2.0 * h / b + slope - memory[at + 2] * level - memory[at + 3] * slope
    memory[at + 8] = place - h * h * memory[at + 6]
    memory[at + 9] = rate - h * h * memory[at + 7]


@njit(inline="always")
def curvature_weights(h: float, before: float) -> tuple[float, float, float]:
    """Return the weights of three speeds in half the second derivative of a parabola through them.

    The speeds are those at the begin of an earlier step, between the steps and at the end.

    Args:
        h: Length of the later step [s].
        before: Length of the earlier step [s]; where it is short all weights are zero.
    """
    if before < SHORT * h:
        return 0.0, 0.0, 0.0
    both = h + before
    return 1.0 / (before * both), -1.0 / (before * h), 1.0 / (h * both)


@njit
def remember_motion(
    m: Any,
    act: Array,
    held: Any,
    own: Any,
    memory: Array,
    at: Any,
    dt: float,
    q: Any,
    p: Array,
    first: Any,
) -> None:
    """Advance the oscillator to the begin of a step, and store the forces of the step.

    Each row of `act` receives the force for a speed of zero there, and the force per speed. The
    oscillator is x'' + 2 zeta omega x' + omega^2 x = nu, and the force 2 zeta omega B x'. Over a
    step nu is the parabola through the speeds at its ends and at the begin of the step before.

    Args:
        m: Motion of the hull at the begin of the step.
        act: Signals of the laws; the forces of the step are stored in them.
        held: Number of signals in a row.
        own: Index of the first signal of the effect.
        memory: States of all effects.
        at: Index of the first state of the effect.
        dt: Length of the step that begins [s].
        q: Parameters of the effect.
        p: Parameters and tables of all effects.
        first: Index of the effect's table, which is empty.
    """
    speed, last = speed_of_axis(m, q), memory[at + LAST]
    x, v, u = memory[at + PLACE], memory[at + RATE], memory[at + SPEED]
    if last > 0.0:
        f = at + WHOLE
        w0, w1, w2 = curvature_weights(last, memory[at + BEFORE])
        bend = w0 * memory[at + EARLIER] + w1 * u + w2 * speed
        place = memory[f] * x + memory[f + 1] * v + memory[f + 4] * u + memory[f + 6] * speed
        rate = memory[f + 2] * x + memory[f + 3] * v + memory[f + 5] * u + memory[f + 7] * speed
        x, v = place + bend * memory[f + 8], rate + bend * memory[f + 9]
    a, b = 2.0 * q.damping_ratio * q.frequency, q.frequency * q.frequency
    if dt != last:
        store_factors(a, b, dt, memory, at + WHOLE)
        store_factors(a, b, 0.5 * dt, memory, at + HALF)
    size = a * q.damping
    act[own], act[own + 1] = size * v, 0.0
    for row in range(1, 3):
        f = at + (HALF if row == 1 else WHOLE)
        w0, w1, w2 = curvature_weights(0.5 * row * dt, last)
        rest = memory[f + 2] * x + memory[f + 3] * v + memory[f + 5] * speed
        rest += (w0 * u + w1 * speed) * memory[f + 9]
        act[row * held + own] = size * rest
        act[row * held + own + 1] = size * (memory[f + 7] + w2 * memory[f + 9])
    memory[at + PLACE], memory[at + RATE] = x, v
    memory[at + EARLIER], memory[at + SPEED] = u, speed
    memory[at + BEFORE], memory[at + LAST] = last, dt


@njit
def law(m: Any, q: Any, act: Array, at: Any, own: Any, p: Array, first: Any) -> Wrench:
    """Return the force of the waves that the hull has radiated.

    Args:
        m: Motion of the hull: velocities [m/s], rates [rad/s], position [m], attitude [rad].
        q: Parameters of the effect, with the names and units of its class.
        act: Signals of the laws.
        at: Index of the row of the signals.
        own: Index of the first signal of the effect in the row.
        p: Parameters and tables of all effects.
        first: Index of the effect's table, which is empty.

    Returns:
        Force [N] and moment [N m] in body axes.
    """
    force = -act[at + own] - act[at + own + 1] * speed_of_axis(m, q)
    return wrench(
        Y=q.in_sway * force, Z=q.in_heave * force, K=q.in_roll * force, M=q.in_pitch * force
    )


def axis_parameter(axis: str, nominal: float = 0.0) -> float:
    """Declare whether the force acts in an axis as a parameter of an effect."""
    return param(nominal, low=0.0, high=1.0, unit="", words=f"1: it acts in {axis}; 0: it does not")


@dataclass(frozen=True)
class HeaveRadiation(MotionMemory):
    """Radiation force in heave: the waves that the hull radiates act on it later.

    F = -K(s) nu,  K(s) = 2 zeta omega B s / (s^2 + 2 zeta omega s + omega^2)

    It is one section of the memory of Cummins' equation. B is the damping at the frequency omega.
    It vanishes at very low and at very high frequencies, as damping by waves does. K is positive
    real: the force never supplies more energy than it received. At low frequencies the force is an
    added mass 2 zeta B / omega, at high ones a stiffness 2 zeta omega B.
    """

    formula: ClassVar[str] = (
        r"F = -K(s) \, \nu, \quad K(s) = B \, \frac{2 \zeta \omega s}{s^2 + 2 \zeta \omega s + "
        r"\omega^2}"
    )
    symbols: ClassVar = {"damping": "B", "frequency": r"\omega", "damping_ratio": r"\zeta"}
    ruled_out_by: ClassVar = {"no_water": (True,)}
    words: ClassVar[str] = (
        "the damping and the added mass in heave depend on the frequency: the hull radiates waves"
    )
    shown_by: ClassVar[str] = "oscillations in heave at several frequencies"
    source: ClassVar[str] = (
        "T. Perez and T. I. Fossen, Joint identification of infinite-frequency added mass and "
        "fluid-memory models of marine structures, Modeling, Identification and Control 29(3), "
        "2008: passive, zero at zero frequency, relative degree one"
    )
    memory_signals: ClassVar[int] = 2
    law: ClassVar = law
    remember_motion: ClassVar = remember_motion
    strength: ClassVar = ("damping",)
    contained_in: ClassVar = {"damping": "linear_damping.heave"}
    starts: ClassVar = (
        {"damping": 3.0, "frequency": 3.0},
        {"damping": 3.0, "frequency": 6.0},
        {"damping": 3.0, "frequency": 12.0},
    )

    damping: float = param(
        0.0,
        low=0.0,
        high=1e13,
        unit="N s/m",
        words="largest damping in heave, at the frequency `frequency`",
        fit=True,
        spread=100.0,
        axis="heave",
        calibrates="damping",
    )
    frequency: float = param(
        6.0,
        low=0.05,
        high=200.0,
        unit="rad/s",
        words="frequency of the largest damping",
        fit=True,
        spread=4.0,
        axis="heave",
        inactive_value=6.0,
        within=(1.5, 25.0),
    )
    damping_ratio: float = param(
        0.5,
        low=0.1,
        high=1.0,
        unit="",
        words="damping ratio of the memory; a large one: damping over a wide band of frequencies",
        fit=True,
        spread=0.3,
        axis="heave",
        inactive_value=0.5,
    )
    in_sway: float = axis_parameter("sway")
    in_heave: float = axis_parameter("heave", 1.0)
    in_roll: float = axis_parameter("roll")
    in_pitch: float = axis_parameter("pitch")

    @property
    def memory_states(self) -> int:
        """Number of floats stored from step to step: speed, oscillator and factors of a step."""
        return STATES

    def response(self, frequency: Array) -> NDArray[np.complex128]:
        """Return the force per speed of a harmonic motion, with the sign of a damping.

        Args:
            frequency: (N,) frequencies of the motion [rad/s].

        Returns:
            (N,) complex values [N s/m or N m s]: the real part is the damping, the imaginary part
            over the frequency the added mass.
        """
        w, a = frequency, 2.0 * self.damping_ratio * self.frequency
        return self.damping * 1j * a * w / (self.frequency**2 - w**2 + 1j * a * w)


def parameters_of_axis(axis: str, spread: float) -> dict[str, ParameterChanges]:
    """Return the free parameters of the radiation moment about one axis.

    Args:
        axis: The axis, "roll" for example.
        spread: Prior standard deviation of the damping [N m s].
    """
    damping: ParameterChanges = {
        "unit": "N m s",
        "words": f"largest damping in {axis}, at the frequency `frequency`",
        "spread": spread,
        "axis": axis,
        "calibrates": "damping",
    }
    return {"damping": damping, "frequency": {"axis": axis}, "damping_ratio": {"axis": axis}}


RollRadiation = preset_effect(
    HeaveRadiation,
    "RollRadiation",
    words=(
        "the damping and the added mass in roll depend on the frequency: the hull radiates waves"
    ),
    shown_by="oscillations in roll at several frequencies",
    contained_in={"damping": "linear_damping.roll"},
    frees=parameters_of_axis("roll", 0.2),
    fixed={"in_sway": 0.0, "in_heave": 0.0, "in_roll": 1.0, "in_pitch": 0.0},
    starts=(
        {"damping": 0.01, "frequency": 3.0},
        {"damping": 0.01, "frequency": 6.0},
        {"damping": 0.01, "frequency": 12.0},
    ),
)

PitchRadiation = preset_effect(
    HeaveRadiation,
    "PitchRadiation",
    words=(
        "the damping and the added mass in pitch depend on the frequency: the hull radiates waves"
    ),
    shown_by="oscillations in pitch at several frequencies",
    contained_in={"damping": "linear_damping.pitch"},
    frees=parameters_of_axis("pitch", 5.0),
    fixed={"in_sway": 0.0, "in_heave": 0.0, "in_roll": 0.0, "in_pitch": 1.0},
    starts=(
        {"damping": 0.1, "frequency": 3.0},
        {"damping": 0.1, "frequency": 6.0},
        {"damping": 0.1, "frequency": 12.0},
    ),
)
