"""Steering rate limit: the steering machine turns at one speed at most."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Array, Channel, param

INSTANT = 2.0  # [rad/s] 115 deg/s; whatever turns faster follows its command at once


@njit(inline="always")
def channel(x: float, side: float, source: float, memory: Array, at: int, dt: float, q: Any) -> float:
    """A ramp to the command, then the command; the mean over the step is exact."""
    gap = x - memory[at]
    if q.rate >= INSTANT:
        memory[at] = x
        return x
    needed = abs(gap) / q.rate  # [s]
    if needed <= dt:
        memory[at] = x
        return x - 0.5 * gap * needed / dt
    turn = q.rate * dt if gap > 0.0 else -q.rate * dt
    memory[at] += turn
    return memory[at] - 0.5 * turn


@dataclass(frozen=True)
class SteeringRateLimit(Channel):
    """Rudder or thruster angle follows its command no faster than a rate."""

    words: ClassVar[str] = "the steering machine is slower than commanded: it turns at one rate at most"
    shown_by: ClassVar[str] = "hard-over steering reversals"
    source: ClassVar[str] = "J. van Amerongen, Adaptive Steering of Ships, PhD, Delft 1982 (steering machine)"
    acts_on: ClassVar[str] = "steer"
    slots: ClassVar[int] = 1
    channel: ClassVar = channel
    starts: ClassVar = ({"rate": 0.1}, {"rate": 0.4}, {"rate": 1.2})

    rate: float = param(
        INSTANT, low=0.0005, high=50.0, unit="rad/s", words="fastest turning", fit=True, spread=2.0, absent=INSTANT
    )
