"""Signatures of a vessel's laws, in place of which `boatsim.physics.compose` generates a file.

p: parameters of all effects, flat. on: 1 for each effect that acts. act: actuators, and the cosine
    and sine of those
that are angles, HELD numbers each at the begin, in the middle and at the end of a step.
"""

from typing import Any

from boatsim.physics.signals import (
    Array,
    InstrumentDrift,
    MeasuredMotion,
    Motion,
    OscillatingForce,
    Wrench,
)

HELD = 0
MEMORY = 1  # floats of the state of all channels
CANDIDATES = 0  # number of effects that a switch turns on
HAS_TIME_TO_DISCONTINUITY = (
    False  # whether the signal of any channel may jump or bend while its command is held
)
HAS_ADVANCE_MOTION_MEMORY = False  # whether any effect remembers the motion of the hull
HAS_AIR_WRENCH = False  # whether any effect is a force of the air
HAS_OSCILLATING_FORCE = False  # whether any effect is a random oscillating force
HAS_INSTRUMENT_DRIFT = False  # whether any instrument has a slowly varying error


def wrench(m: Motion, p: Array, on: Any, act: Array, at: int) -> Wrench:
    """Return the total force of all effects of a vessel, with the actuators act[at:]."""
    raise NotImplementedError


def air_wrench(m: Motion, p: Array, on: Any, act: Array, at: int) -> Wrench:
    """Return the force of the effects of the air on a vessel, with the actuators act[at:]."""
    raise NotImplementedError


def water_velocity(
    t: float, x: float, y: float, p: Array, on: Any, act: Array, at: Any
) -> tuple[float, float]:
    """Return the velocity of the water over the ground (north, east) at a time and place [m/s].

    Measured quantities of the surroundings are among the actuators act[at:].
    """
    raise NotImplementedError


def water_change(
    t: float, x: float, y: float, p: Array, on: Any
) -> tuple[float, float, float, float, float, float]:
    """Return the derivatives of the velocity of the water by time and place.

    They are those of the velocity north by time [m/s^2], x and y [1/s], then of that east.
    """
    raise NotImplementedError


def water_displacement(t: float, p: Array, on: Any) -> tuple[float, float]:
    """Return how far the water on which waves travel has moved since t = 0 (north, east) [m]."""
    raise NotImplementedError


def add_inertias(p: Array, on: Any, water: Array, hull: Array) -> None:
    """Add the mass matrices of all effects to `water` (added mass) and `hull` (ballast).

    Each is an array of 12 `MassMatrix` entries.
    """
    raise NotImplementedError


def advance_channels(
    commands: Array, memory: Array, dt: float, p: Array, on: Any, act: Array, held: Any
) -> None:
    """Advance the actuators of a vessel by one step of dt [s]; fill act (3 held,)."""
    raise NotImplementedError


def advance_motion_memory(
    m: Motion, memory: Array, dt: float, p: Array, on: Any, act: Array, held: Any
) -> None:
    """Advance the states of effects that remember the motion of the hull; fill act (3 held,).

    m is the motion at the begin of a step of dt [s]. The states are those at the begin of the step
    before, which this function stored with its motion.
    """
    raise NotImplementedError


def time_to_discontinuity(commands: Array, memory: Array, p: Array, on: Any) -> float:
    """Return the time [s] until an actuator's signal jumps or bends while its command is held."""
    raise NotImplementedError


def apply_measurement_errors(m: MeasuredMotion, t: float, p: Array, on: Any) -> MeasuredMotion:
    """Return the motion that a recording shows of a true motion, with all measurement errors.

    The time is t [s] after the first row.
    """
    raise NotImplementedError


def has_measurement_errors(on: Any) -> bool:
    """Return whether an active effect makes a recording differ from the true motion."""
    raise NotImplementedError


def motion_latency(p: Array, on: Any) -> float:
    """Return the delay of the recorded motion behind the recorded commands [s]."""
    raise NotImplementedError


def oscillating_force(p: Array, on: Any) -> OscillatingForce:
    """Return the model of the random oscillating force on a vessel; frequency 0: none."""
    raise NotImplementedError


def instrument_drift(p: Array, on: Any) -> InstrumentDrift:
    """Return the noise model of slowly varying instrument errors; zeros: none."""
    raise NotImplementedError
