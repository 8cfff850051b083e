"""Throttle rate limit: the handle is moved no faster than a rate."""

from dataclasses import dataclass
from typing import ClassVar

from boatsim.base import Channel, param
from boatsim.effects.steering_rate_limit import channel

INSTANT = 1e3  # [1/s] whatever is quicker follows its command at once


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
