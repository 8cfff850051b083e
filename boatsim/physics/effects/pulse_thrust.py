"""Pulse thrust: what a thruster gives for the servo pulse its speed controller is sent."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Array, Channel, param

FULL = 400.0  # [us] from neutral to full, as the common hobby speed controllers have it (1100 to 1900 us)


@njit(inline="always")
def channel(x: float, side: float, pulse: float, memory: Array, at: int, dt: float, q: Any) -> float:
    """Thrust command plus full thrust in proportion to the pulse's distance from neutral."""
    return x + q.full * (pulse - q.neutral) / FULL


@dataclass(frozen=True)
class PulseThrust(Channel):
    """Thrust in proportion to a servo pulse, ahead above neutral; a thrust command on the same side adds to it."""

    words: ClassVar[str] = "thrust follows the servo pulse in proportion"
    shown_by: ClassVar[str] = "a staircase of pulse widths"
    source: ClassVar[str] = "an assumption: the simplest map there is"
    acts_on: ClassVar[str] = "thrust"
    source_family: ClassVar[str] = "pulse"
    channel: ClassVar = channel

    full: float = param(1.0, low=0.0, high=1e6, unit="N", words="thrust 400 us from neutral")
    neutral: float = param(1500.0, low=0.0, high=2500.0, unit="", words="pulse that gives none [us]")
