"""Rudder stall: beyond an angle the blade gives no more force."""

from dataclasses import dataclass
from math import pi
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Force, Wrench, param

NEVER = 0.5 * pi  # [rad] no rudder turns further


@njit(inline="always")
def law(m: Any, q: Any) -> Wrench:
    """What is lost of the linear rudder's force: it stays what it was at the angle of stall."""
    lost = min(max(m.delta_rad, -q.angle), q.angle) - m.delta_rad  # [rad]
    return Wrench(0.0, q.sway * lost, q.roll * lost, q.yaw * lost)


@dataclass(frozen=True)
class RudderStall(Force):
    """The flow leaves the blade: its force grows no further with the angle."""

    words: ClassVar[str] = "the rudder stalls: beyond an angle its force grows no further"
    shown_by: ClassVar[str] = "turns at small and at large rudder angles"
    source: ClassVar[str] = "L. F. Whicker, L. F. Fehlner, DTMB report 933, 1958: lift of low aspect ratio surfaces"
    law: ClassVar = law
    starts: ClassVar = ({"angle": 0.2}, {"angle": 0.35}, {"angle": 0.5})

    angle: float = param(
        NEVER, low=0.02, high=NEVER, unit="rad", words="angle of stall", fit=True, spread=1.0, absent=NEVER
    )
    sway: float = param(0.0, low=-1e11, high=1e11, unit="N/rad", words="the rudder's", follows="rudder.sway")
    yaw: float = param(0.0, low=-1e13, high=1e13, unit="N m/rad", words="the rudder's", follows="rudder.yaw")
    roll: float = param(0.0, low=-1e13, high=1e13, unit="N m/rad", words="the rudder's", follows="rudder.roll")
