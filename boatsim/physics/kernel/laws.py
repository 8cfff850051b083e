"""Signatures of what a vessel's effects compose to. `boatsim.physics.compose` writes the real ones in its place.

p is the flat array of all effects' parameters, on says which optional effects act; act holds the actuators and the
cosine and sine of those that are angles, HELD numbers each at begin, middle and end of a step.
"""

from typing import Any

from boatsim.physics.signals import Array, Motion, Shown, Swell, Wander, Wrench

HELD = 0
MEMORY = 1  # floats that all channels together remember
HAS_PAUSE = False  # whether the signal of any channel may jump or bend while its command is held
HAS_SWELL = False  # whether any effect of the vessel is a swell
HAS_WANDER = False  # whether the error of any instrument wanders


def wrench(m: Motion, p: Array, on: Any, act: Array, at: int) -> Wrench:
    """Sum of all force laws under the actuators act[at:]."""
    raise NotImplementedError


def flow(p: Array, on: Any) -> tuple[float, float]:
    """Velocity of the water over the ground (north, east) [m/s]."""
    raise NotImplementedError


def inertias(p: Array, on: Any, water: Array, hull: Array) -> None:
    """Add the `Mass` entries (12,) of effects that move with the water and with the hull."""
    raise NotImplementedError


def actuate(
    commands: Array, memory: Array, dt: float, p: Array, on: Any, act: Array, held: Any
) -> None:
    """One step of all channels: commands (those the vessel takes) to act (3 held,): begin, middle, end of the step."""
    raise NotImplementedError


def pause(commands: Array, memory: Array, p: Array, on: Any) -> float:
    """Time until a channel's signal jumps or bends of itself [s]; a step must not reach beyond it."""
    raise NotImplementedError


def shown(m: Shown, p: Array, on: Any) -> Shown:
    """What the recording shows of a motion."""
    raise NotImplementedError


def distorted(on: Any) -> bool:
    """Whether a recording shows anything but the motion itself."""
    raise NotImplementedError


def late(p: Array, on: Any) -> float:
    """Time by which the recorded motion is late behind the recorded commands [s]."""
    raise NotImplementedError


def swell(p: Array, on: Any) -> Swell:
    """The random oscillating force that acts; frequency 0: none."""
    raise NotImplementedError


def wander(p: Array, on: Any) -> Wander:
    """The slowly varying error of the instruments; zeros: none."""
    raise NotImplementedError
