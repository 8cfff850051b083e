"""Push: a steady force and moment on the hull for a while, to see what a controller does about it."""

from dataclasses import dataclass, replace
from typing import Any, ClassVar, Self

from numba import njit

from boatsim.physics.base import Force, Wrench, param


@njit(inline="always")
def law(m: Any, q: Any) -> Wrench:
    """Body-fixed, between two instants; on a hull whose sway accelerates it in roll, the sway force does so too."""
    there = 1.0 if q.begin <= m.t < q.end else 0.0
    return Wrench(there * q.surge, there * q.sway, there * (q.roll + q.arm * q.sway), there * q.yaw)


@dataclass(frozen=True)
class Push(Force):
    """A disturbance of stated size and duration."""

    words: ClassVar[str] = "something pushes the hull for a while"
    shown_by: ClassVar[str] = "holding course and speed"
    law: ClassVar = law

    surge: float = param(0.0, low=-1e9, high=1e9, unit="N", words="ahead")
    sway: float = param(0.0, low=-1e9, high=1e9, unit="N", words="to starboard")
    roll: float = param(0.0, low=-1e11, high=1e11, unit="N m", words="starboard down", axis="roll")
    yaw: float = param(0.0, low=-1e13, high=1e13, unit="N m", words="clockwise")
    begin: float = param(0.0, low=-1e6, high=1e6, unit="s", words="it begins")
    end: float = param(1e6, low=-1e6, high=1e6, unit="s", words="it ends")
    arm: float = param(
        0.0, low=-100.0, high=100.0, unit="m", words="the vessel's roll by sway; filled in if it has one"
    )

    def completed(self, vessel: Any) -> Self:
        """With the vessel's roll moment by sway force, where it has one."""
        return replace(super().completed(vessel), arm=getattr(vessel.effect("linear_hull"), "arm", self.arm))
