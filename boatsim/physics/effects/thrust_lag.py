"""Thrust lag: motor and propeller take time to follow the command."""

from dataclasses import dataclass
from math import inf, log
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Array, Channel, Course, followed, lagged, param

NONE = 1e-4  # [s] a shorter lag is none
SAME = 1e-9  # of a command: what is left of the other way round is nothing


@njit(inline="always")
def channel(
    x: Course, side: float, source: float, memory: Array, at: int, dt: float, q: Any
) -> Course:
    """First-order lag, exact for a command whose course is a parabola."""
    if q.time_constant < NONE:
        memory[at] = x.end
        return x
    return lagged(x, q.time_constant, memory, at, dt)


@njit(inline="always")
def pause(x: float, memory: Array, at: int, q: Any) -> float:
    """As far as its course is followed, and no further than until the thrust reverses, where laws of thrust bend."""
    if q.time_constant < NONE:
        return inf
    y = memory[at]
    reverses = q.time_constant * log((x - y) / x) if x * y < 0.0 and abs(y) > SAME * abs(x) else inf
    return min(followed(q.time_constant), reverses)


@dataclass(frozen=True)
class ThrustLag(Channel):
    """First-order lag of the thrust behind its command."""

    words: ClassVar[str] = "thrust builds up with a lag behind its command"
    shown_by: ClassVar[str] = "quick steps of the thrust"
    acts_on: ClassVar[str] = "thrust|shaft"
    slots: ClassVar[int] = 1
    channel: ClassVar = channel
    pause: ClassVar = pause

    time_constant: float = param(
        0.15, low=0.0, high=60.0, unit="s", words="time to 63 % of a step", fit=True, spread=0.6
    )
