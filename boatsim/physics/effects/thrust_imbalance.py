"""Thrust imbalance: one side pushes more than the other."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Array, Channel, Course, param
from boatsim.physics.kinds.channel import DEEDS


@njit(inline="always")
def channel(
    x: Course, side: float, source: float, memory: Array, at: int, dt: float, q: Any
) -> Course:
    """Port thrust times 1 + f, starboard times 1 - f."""
    share = 1.0 - side * q.fraction
    return Course(x.begin * share, x.middle * share, x.end * share)


@dataclass(frozen=True)
class ThrustImbalance(Channel):
    """Port and starboard thrust differ for the same command, ahead and astern alike."""

    words: ClassVar[str] = "one side pushes harder than the other for the same command"
    shown_by: ClassVar[str] = "straight runs ahead and astern with equal commands"
    acts_on: ClassVar[str] = "thrust|shaft"
    stage: ClassVar[int] = DEEDS
    channel: ClassVar = channel

    fraction: float = param(
        0.0,
        low=-0.6,
        high=0.6,
        unit="",
        words="port times 1 + f, starboard times 1 - f",
        fit=True,
        spread=0.15,
    )
