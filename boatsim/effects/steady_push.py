"""Steady push: a constant force that turns with the hull."""

from dataclasses import dataclass, replace
from typing import Any, ClassVar, Self

from numba import njit

from boatsim.base import Force, Wrench, param


@njit(inline="always")
def law(m: Any, q: Any) -> Wrench:
    """The same in every motion; on a hull whose sway accelerates it in roll, the sway force does so too."""
    return Wrench(q.surge, q.sway, q.roll + q.arm * q.sway, q.yaw)


@dataclass(frozen=True)
class SteadyPush(Force):
    """A constant force and moment in body axes: the yaw moment of a test, a rudder fixed askew, a heeling weight."""

    words: ClassVar[str] = "a constant force that turns with the hull pushes it"
    shown_by: ClassVar[str] = "a straight run with everything amidships"
    law: ClassVar = law

    surge: float = param(0.0, low=-1e9, high=1e9, unit="N", words="ahead")
    sway: float = param(0.0, low=-1e9, high=1e9, unit="N", words="to starboard")
    roll: float = param(0.0, low=-1e11, high=1e11, unit="N m", words="starboard down", axis="roll")
    yaw: float = param(0.0, low=-1e11, high=1e11, unit="N m", words="to starboard")
    arm: float = param(
        0.0, low=-100.0, high=100.0, unit="m", words="the vessel's roll by sway; filled in if it has one"
    )

    def completed(self, vessel: Any) -> Self:
        """With the vessel's roll moment by sway force, where it has one."""
        return replace(super().completed(vessel), arm=getattr(vessel.effect("linear_hull"), "arm", self.arm))
