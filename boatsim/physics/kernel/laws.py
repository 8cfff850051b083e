"""Signatures of what a vessel's effects compose to. `boatsim.physics.program` puts the real ones in place of this file.

p is the flat array of all effects' parameters, on says which optional effects act, act holds the actuators and the
cosine and sine of those that are angles.
"""

from typing import Any

from boatsim.physics.base import Array, Shown, Swell, Wrench

HELD = 0  # length of act
MEMORY = 1  # floats that all channels together remember
PAUSES = False  # whether the signal of any channel may jump while its command is held
SWELLS = False  # whether any effect of the vessel is a swell


def sees(
    t: float, x: float, y: float, psi: float, phi: float, u: float, v: float, p: float, r: float,
    ur: float, vr: float, c: float, s: float, act: Array,
) -> Any:  # fmt: skip
    """The vessel's own motion tuple."""
    raise NotImplementedError


def wrench(m: Any, p: Array, on: Any) -> Wrench:
    """Sum of all force laws."""
    raise NotImplementedError


def flow(p: Array, on: Any) -> tuple[float, float]:
    """Velocity of the water over the ground (north, east) [m/s]."""
    raise NotImplementedError


def inertias(p: Array, on: Any, water: Array, hull: Array) -> None:
    """Add the `Mass` entries (7,) of effects that move with the water and with the hull."""
    raise NotImplementedError


def actuate(commands: Array, memory: Array, dt: float, p: Array, on: Any, act: Array) -> None:
    """One step of all channels: commands (those the vessel takes) to act, the mean over the step that begins now."""
    raise NotImplementedError


def pause(commands: Array, memory: Array, p: Array, on: Any) -> float:
    """Time until a channel's signal jumps of itself [s]; a step must not reach beyond it."""
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
