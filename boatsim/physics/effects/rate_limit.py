"""Rate limit: an actuator moves at one speed at most."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Array, Channel, param, preset

INSTANT = 2.0  # [rad/s] 115 deg/s; a steering that turns faster follows its command at once
AT_ONCE = 1e3  # [1/s] the same of a handle


@njit(inline="always")
def channel(x: float, side: float, source: float, memory: Array, at: int, dt: float, q: Any) -> float:
    """A ramp to the command, then the command; the mean over the step is exact."""
    gap = x - memory[at]
    needed = 0.0 if q.rate >= q.instant else abs(gap) / q.rate  # [s]
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
    source: ClassVar[str] = "J. van Amerongen, Adaptive Steering of Ships, PhD thesis 1982 (steering machine)"
    acts_on: ClassVar[str] = "steer"
    slots: ClassVar[int] = 1
    channel: ClassVar = channel
    starts: ClassVar = ({"rate": 0.1}, {"rate": 0.4}, {"rate": 1.2})

    rate: float = param(
        INSTANT, low=0.0005, high=50.0, unit="rad/s", words="fastest turning", fit=True, spread=2.0, absent=INSTANT
    )
    instant: float = param(INSTANT, low=0.0, high=1e6, unit="rad/s", words="from this rate on nothing is limited")


ThrottleRateLimit = preset(
    SteeringRateLimit,
    "ThrottleRateLimit",
    words="the throttle moves at one rate at most",
    shown_by="throttle steps from idle to full",
    source="C. Svendsen et al., IFAC MCMC 2012, section III-A: a rate limit is named, its value is not",
    acts_on="throttle",
    starts=({"rate": 0.5}, {"rate": 3.0}),
    frees={
        "rate": {
            "low": 0.01, "high": 1e6, "unit": "1/s", "words": "fastest change of the handle", "spread": 3.0,
            "absent": AT_ONCE,
        }
    },
    fixed={"instant": AT_ONCE},
)  # fmt: skip
