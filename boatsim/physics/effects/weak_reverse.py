"""Weak reverse: a propeller made for going ahead pushes less astern."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Array, Channel, Course, param
from boatsim.physics.kinds.channel import DEEDS


@njit(inline="always")
def weakened(x: float, q: Any) -> float:
    """Astern thrust times a factor."""
    return x * q.astern_factor if x < 0.0 else x


@njit(inline="always")
def channel(
    x: Course, side: float, source: float, memory: Array, at: int, dt: float, q: Any
) -> Course:
    """At each instant for itself."""
    return Course(weakened(x.begin, q), weakened(x.middle, q), weakened(x.end, q))


@dataclass(frozen=True)
class WeakReverse(Channel):
    """Astern thrust is a fraction of what was commanded."""

    words: ClassVar[str] = "the propellers push less astern than commanded"
    words_above: ClassVar[str] = "the propellers push more astern than commanded"
    shown_by: ClassVar[str] = "turning on the spot or swaying with one motor astern"
    source: ClassVar[str] = "J. A. Bayless 2017, Appendix H (motor calibration 0.70)"
    acts_on: ClassVar[str] = "thrust|shaft"
    stage: ClassVar[int] = DEEDS
    either_side: ClassVar[bool] = True
    channel: ClassVar = channel

    astern_factor: float = param(
        1.0,
        low=0.05,
        high=1.5,
        unit="",
        words="astern thrust per commanded thrust",
        fit=True,
        spread=0.3,
        absent=1.0,
    )
