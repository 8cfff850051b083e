"""Thrust gain error: every thruster gives more or less than its data sheet says."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Array, Channel, param


@njit(inline="always")
def channel(x: float, side: float, source: float, memory: Array, at: int, dt: float, q: Any) -> float:
    """Thrust times a factor."""
    return x * q.factor


@dataclass(frozen=True)
class ThrustGainError(Channel):
    """All thrust is off by one factor, by more than the stated uncertainty of the thrust coefficient."""

    words: ClassVar[str] = "all thrust is stronger or weaker than stated by one factor"
    shown_by: ClassVar[str] = "runs at several thrust levels"
    acts_on: ClassVar[str] = "thrust"
    channel: ClassVar = channel

    factor: float = param(
        1.0, low=0.2, high=3.0, unit="", words="thrust per stated thrust", fit=True, spread=0.3, absent=1.0,
        scales="outboards.gain",
    )  # fmt: skip
