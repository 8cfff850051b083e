"""Thrust lag: motor and propeller take time to follow the command."""

from dataclasses import dataclass
from math import exp, inf, log
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Array, Channel, Course, course, followed, param

NONE = 1e-4  # [s] a shorter lag is none
SAME = 1e-9  # of a command: what is left of the other way round is nothing


@njit(inline="always")
def channel(x: Course, side: float, source: float, memory: Array, at: int, dt: float, q: Any) -> Course:
    """First-order lag, exact for a command whose course is a parabola.

    T y' = x - y with x = b + c s + d s^2, s in steps, has the solution f + g s + d s^2 beside a decaying rest.
    """
    y = memory[at]
    if q.time_constant < NONE:
        memory[at] = x.end
        return x
    quick = dt / q.time_constant
    c, d = 4.0 * x.middle - 3.0 * x.begin - x.end, 2.0 * (x.begin + x.end) - 4.0 * x.middle
    g = c - 2.0 * d / quick
    f = x.begin - g / quick
    decay = exp(-quick)
    memory[at] = f + g + d + (y - f) * decay
    return course(y, f + 0.5 * g + d / 3.0 + (y - f) * (1.0 - decay) / quick, memory[at])


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
