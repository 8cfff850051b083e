"""Rate limit: a signal follows its command no faster than a rate."""

from dataclasses import dataclass
from math import inf
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Array, Channel, Course, course, mean_of, param, preset

SAME = 1e-9  # of a ramp: what is left of it before zero is nothing
NEVER = 1e6  # [1/s] nothing is that quick: the command is followed at once
INSTANT = 2.0  # [rad/s] 115 deg/s; a steering that turns faster follows its command at once


@njit(inline="always")
def channel(x: Course, side: float, source: float, memory: Array, at: int, dt: float, q: Any) -> Course:
    """A ramp to the command, then the command: exact for a held one."""
    if q.rate >= q.instant:
        memory[at] = x.end
        return x
    y, goal = memory[at], mean_of(x)
    needed = abs(goal - y) / q.rate  # [s]
    turning = min(needed, dt)
    turned = q.rate * turning if goal > y else -q.rate * turning
    memory[at] = goal if needed <= dt else y + turned
    return course(y, y + turned - 0.5 * turned * turning / dt, memory[at])


@njit(inline="always")
def pause(x: float, memory: Array, at: int, q: Any) -> float:
    """Until the ramp ends, and no further than until it passes zero, where laws of thrust bend."""
    y = memory[at]
    gap = abs(x - y)
    if gap == 0.0 or q.rate >= q.instant:
        return inf
    return (abs(y) if x * y < 0.0 and abs(y) > SAME * gap else gap) / q.rate


@dataclass(frozen=True)
class RateLimit(Channel):
    """A handle, a rudder or a thrust that moves at one rate at most."""

    words: ClassVar[str] = "what is commanded is followed at one rate at most"
    shown_by: ClassVar[str] = "large steps of the command"
    acts_on: ClassVar[str] = ""
    slots: ClassVar[int] = 1
    channel: ClassVar = channel
    pause: ClassVar = pause

    rate: float = param(NEVER, low=1e-6, high=NEVER, unit="1/s", words="fastest change, in the channel's unit a second")
    instant: float = param(NEVER, low=1e-3, high=NEVER, unit="1/s", words="from which the command is followed at once")


SteeringRateLimit = preset(
    RateLimit,
    "SteeringRateLimit",
    words="the steering machine is slower than commanded: it turns at one rate at most",
    shown_by="hard-over steering reversals",
    source="J. van Amerongen, Adaptive Steering of Ships, PhD, Delft 1982 (steering machine)",
    acts_on="angle",
    ruled_out_by={"steering_measured": (True,)},
    starts=({"rate": 0.1}, {"rate": 0.4}, {"rate": 1.2}),
    frees={
        "rate": {
            "low": 0.0005, "high": 50.0, "unit": "rad/s", "words": "fastest turning", "spread": 2.0, "absent": INSTANT,
        }
    },
    fixed={"instant": INSTANT},
)  # fmt: skip
