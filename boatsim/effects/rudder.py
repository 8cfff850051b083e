"""Rudder: a blade behind the propeller, linear in its angle at the approach speed."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.base import Force, Wrench, param


@njit(inline="always")
def law(m: Any, q: Any) -> Wrench:
    """Side force and yaw moment in proportion to the angle."""
    return Wrench(0.0, q.sway * m.delta_rad, 0.0, q.yaw * m.delta_rad)


@dataclass(frozen=True)
class Rudder(Force):
    """Linear rudder; the signs say to which side a positive angle `delta_rad` steers."""

    words: ClassVar[str] = "the rudder steers in proportion to its angle"
    shown_by: ClassVar[str] = "a zig-zag at small rudder angles"
    source: ClassVar[str] = "T. I. Fossen, Handbook of Marine Craft Hydrodynamics, 2nd ed. 2021, chapter 9"
    law: ClassVar = law

    sway: float = param(0.0, low=-1e11, high=1e11, unit="N/rad", words="Y_delta", calibrates="thrust", axis="sway")
    yaw: float = param(0.0, low=-1e13, high=1e13, unit="N m/rad", words="N_delta", calibrates="thrust", axis="yaw")
