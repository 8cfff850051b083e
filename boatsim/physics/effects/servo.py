"""Servo: a steering machine with a range, a rate limit and a lag."""

from dataclasses import dataclass
from math import exp, pi
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Array, Channel, Course, course, followed, mean_of, param

NONE = 1e-4  # [s] a shorter lag is none


@njit(inline="always")
def ramp(gap: float, rate: float, lag: float) -> float:
    """Time [s] at the largest rate until the lag alone would be as slow."""
    slow = rate * lag if lag >= NONE else 0.0
    return max(abs(gap) - slow, 0.0) / rate


@njit(inline="always")
def towards(goal: float, memory: Array, at: int, dt: float, rate: float, lag: float) -> Course:
    """To a goal at the largest rate, then as a first-order lag: exact for a held one."""
    y = memory[at]
    gap = goal - y
    needed = ramp(gap, rate, lag)
    turning = min(needed, dt)
    turned = rate * turning if gap > 0.0 else -rate * turning
    rest, left = gap - turned, dt - turning
    area = 0.5 * turned * turning + turned * left  # [rad s] by which the angle is beyond y
    if lag >= NONE:
        decay = exp(-left / lag)
        area += rest * (left - lag * (1.0 - decay))
        rest *= decay
    elif needed <= dt:
        # there, to the last bit: a ramp that is left over would ask for a step of its own
        rest = 0.0
    memory[at] = goal - rest
    return course(y, y + area / dt, memory[at])


@njit(inline="always")
def channel(
    x: Course, side: float, source: float, memory: Array, at: int, dt: float, q: Any
) -> Course:
    """Towards the limited command."""
    return towards(min(max(mean_of(x), -q.range), q.range), memory, at, dt, q.rate, q.lag)


@njit(inline="always")
def pause(x: float, memory: Array, at: int, q: Any) -> float:
    """Until the ramp ends, then as far as the lag's course is followed."""
    left = ramp(min(max(x, -q.range), q.range) - memory[at], q.rate, q.lag)
    return left if left > 0.0 else followed(q.lag if q.lag >= NONE else 0.0)


@dataclass(frozen=True)
class Servo(Channel):
    """An angle follows its command through a first-order lag inside a range and a rate limit."""

    words: ClassVar[str] = "the steering follows with a limited rate and range"
    shown_by: ClassVar[str] = "quick steering reversals"
    source: ClassVar[str] = (
        "J. van Amerongen, Adaptive Steering of Ships, PhD, Delft 1982 (steering machine); values: checked "
        "specification of Bayless 2017, section 4: 0.06 s, 400 deg/s [A], 0 to 45 deg (T9)"
    )
    acts_on: ClassVar[str] = "angle"
    slots: ClassVar[int] = 1
    channel: ClassVar = channel
    pause: ClassVar = pause

    range: float = param(pi / 4, low=0.0, high=pi, unit="rad", words="largest angle either way")
    rate: float = param(
        400.0 * pi / 180.0, low=0.001, high=1e3, unit="rad/s", words="fastest turning"
    )
    lag: float = param(0.06, low=0.0, high=60.0, unit="s", words="time constant")
