"""Throttle rate limit: the handle is moved no faster than a rate."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Array, Channel, param

INSTANT = 1e3  # [1/s] whatever is quicker follows its command at once


@njit(inline="always")
def channel(x: float, side: float, source: float, memory: Array, at: int, dt: float, q: Any) -> float:
    """A ramp to the command, then the command; the mean over the step is exact."""
    gap = x - memory[at]
    needed = 0.0 if q.rate >= INSTANT else abs(gap) / q.rate  # [s]
    if needed <= dt:
        memory[at] = x
        return x - 0.5 * gap * needed / dt
    turn = q.rate * dt if gap > 0.0 else -q.rate * dt
    memory[at] += turn
    return memory[at] - 0.5 * turn


@dataclass(frozen=True)
class ThrottleRateLimit(Channel):
    """The throttle handle follows its command no faster than a rate."""

    words: ClassVar[str] = "the throttle moves at one rate at most"
    shown_by: ClassVar[str] = "throttle steps from idle to full"
    source: ClassVar[str] = "C. Svendsen et al., IFAC MCMC 2012, section III-A: a rate limit is named, its value is not"
    acts_on: ClassVar[str] = "throttle"
    slots: ClassVar[int] = 1
    channel: ClassVar = channel
    starts: ClassVar = ({"rate": 0.5}, {"rate": 3.0})

    rate: float = param(
        INSTANT, low=0.01, high=1e6, unit="1/s", words="fastest change of the handle", fit=True, spread=3.0,
        absent=INSTANT,
    )  # fmt: skip
