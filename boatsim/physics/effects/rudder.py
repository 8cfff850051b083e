"""Rudder: a blade behind the propeller, linear in its angle at the approach speed."""

from dataclasses import dataclass, replace
from typing import Any, ClassVar, Self

from numba import njit

from boatsim.physics import particulars
from boatsim.physics.base import Force, Wrench, param


@njit(inline="always")
def law(m: Any, q: Any) -> Wrench:
    """Side force, heeling and yaw moment in proportion to the angle."""
    return Wrench(0.0, q.sway * m.delta_rad, q.roll * m.delta_rad, q.yaw * m.delta_rad)


@dataclass(frozen=True)
class Rudder(Force):
    """Linear rudder; the signs say to which side a positive angle `delta_rad` steers.

    With `area` given, the coefficients are those of a blade: normal force by its area, aspect ratio and inflow, more by
    the share of it that the hull before it takes up, at its place ahead of and below the mass centre; a positive angle
    then steers to starboard.
    """

    words: ClassVar[str] = "the rudder steers in proportion to its angle"
    shown_by: ClassVar[str] = "a zig-zag at small rudder angles"
    source: ClassVar[str] = (
        "T. I. Fossen, Handbook of Marine Craft Hydrodynamics, 2nd ed. 2021, chapter 9; blade: Inoue et al. 1981"
    )
    law: ClassVar = law

    sway: float = param(0.0, low=-1e11, high=1e11, unit="N/rad", words="Y_delta", calibrates="thrust", axis="sway")
    yaw: float = param(0.0, low=-1e13, high=1e13, unit="N m/rad", words="N_delta", calibrates="thrust", axis="yaw")
    roll: float = param(0.0, low=-1e13, high=1e13, unit="N m/rad", words="K_delta", calibrates="thrust", axis="roll")
    area: float = param(0.0, low=0.0, high=500.0, unit="m^2", words="of the blade; 0: coefficients as given")
    aspect: float = param(1.5, low=0.1, high=10.0, unit="", words="span per chord")
    inflow: float = param(0.0, low=0.0, high=50.0, unit="m/s", words="speed of the water at the blade, V_R")
    at: float = param(0.0, low=-500.0, high=500.0, unit="m", words="place ahead of the mass centre")
    below: float = param(0.0, low=-100.0, high=100.0, unit="m", words="place below the mass centre")

    def completed(self, vessel: Any) -> Self:
        """With the coefficients of a blade, where one is given. Raises BadInput on a vessel without linear_hull."""
        own = super().completed(vessel)
        if not self.area:
            return own
        hull = self.needed(vessel, "linear_hull")
        slope = particulars.rudder_slope(self.area, self.aspect, self.inflow, hull.density)
        sway = -(1.0 + particulars.hull_share(hull.block)) * slope
        return replace(own, sway=sway, yaw=self.at * sway, roll=(hull.arm - self.below) * sway)
