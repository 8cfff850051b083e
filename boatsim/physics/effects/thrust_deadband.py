"""Thrust and shaft deadband: small commands do not turn the propeller, and larger ones lack what it takes."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Array, Channel, Course, param, preset
from boatsim.physics.kinds.channel import COMMANDS


@njit(inline="always")
def beyond(x: float, q: Any) -> float:
    """Nothing inside the half width, the rest of the command beyond it."""
    return x - min(max(x, -q.width), q.width)


@njit(inline="always")
def channel(
    x: Course, side: float, source: float, memory: Array, at: int, dt: float, q: Any
) -> Course:
    """At each instant for itself."""
    return Course(beyond(x.begin, q), beyond(x.middle, q), beyond(x.end, q))


@dataclass(frozen=True)
class ThrustDeadband(Channel):
    """Friction of motor and shaft: thrust begins at a threshold, ahead and astern alike."""

    words: ClassVar[str] = "small thrust commands do nothing and all thrust is less by a constant"
    shown_by: ClassVar[str] = "slow runs at several small thrust levels"
    acts_on: ClassVar[str] = "thrust"
    stage: ClassVar[int] = COMMANDS
    either_side: ClassVar[bool] = True
    channel: ClassVar = channel
    thresholds: ClassVar = {"width": (0.02, 0.1, 0.3)}

    width: float = param(0.0, low=0.0, high=1e7, unit="N", words="half width", fit=True, spread=0.1)


ShaftDeadband = preset(
    ThrustDeadband,
    "ShaftDeadband",
    words="small commands do not turn the shaft and all rates are less by a constant",
    acts_on="shaft",
    frees={
        "width": {
            "high": 1e4,
            "unit": "1/s",
            "words": "half width, in the unit of the command",
            "spread": 0.1,
        }
    },
)
