"""Rate limit: a signal follows its command no faster than a rate, the last of the way as a lag where it has one."""

from dataclasses import dataclass
from math import inf
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Array, Channel, Course, followed, mean_of, param, preset
from boatsim.physics.effects.servo import NONE, ramp, towards

SAME = 1e-9  # of a ramp: what is left of it before zero is nothing
NEVER = 1e6  # [1/s] nothing is that quick: the command is followed at once
INSTANT = 2.0  # [rad/s] 115 deg/s; a steering that turns faster follows its command at once


@njit(inline="always")
def channel(
    x: Course, side: float, source: float, memory: Array, at: int, dt: float, q: Any
) -> Course:
    """A ramp to the command, then its lag, then the command."""
    if q.rate >= q.instant:
        memory[at] = x.end
        return x
    return towards(mean_of(x), memory, at, dt, q.rate, q.lag)


@njit(inline="always")
def pause(x: float, memory: Array, at: int, q: Any) -> float:
    """Until the ramp ends or passes zero, where laws of thrust bend; after it as far as its lag reaches."""
    y = memory[at]
    gap = abs(x - y)
    if gap == 0.0 or q.rate >= q.instant:
        return inf
    left = ramp(gap, q.rate, q.lag)
    if left <= 0.0:
        return followed(q.lag if q.lag >= NONE else 0.0)
    return min(left, abs(y) / q.rate) if x * y < 0.0 and abs(y) > SAME * gap else left


@dataclass(frozen=True)
class RateLimit(Channel):
    """A handle, a rudder or a thrust that moves at one rate at most."""

    words: ClassVar[str] = "what is commanded is followed at one rate at most"
    shown_by: ClassVar[str] = "large steps of the command"
    acts_on: ClassVar[str] = ""
    slots: ClassVar[int] = 1
    channel: ClassVar = channel
    pause: ClassVar = pause

    rate: float = param(
        NEVER,
        low=1e-6,
        high=NEVER,
        unit="1/s",
        words="fastest change, in the channel's unit a second",
    )
    instant: float = param(
        NEVER, low=1e-3, high=NEVER, unit="1/s", words="from which the command is followed at once"
    )
    lag: float = param(
        0.0, low=0.0, high=60.0, unit="s", words="time constant of the last of the way"
    )


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
            "low": 0.0005,
            "high": 50.0,
            "unit": "rad/s",
            "words": "fastest turning",
            "spread": 2.0,
            "absent": INSTANT,
        },
        "lag": {"spread": 0.3},
    },
    fixed={"instant": INSTANT},
)
