"""Rudder: a blade behind the propeller, linear in its angle at the approach speed."""

from dataclasses import dataclass
from math import pi
from typing import Any, ClassVar

from numba import njit

from boatsim.physics import particulars
from boatsim.physics.base import UNSET, Boat, Force, Release, Role, Wrench, number, param, wrench

NEVER = 0.5 * pi  # [rad] no rudder turns further


@njit(inline="always")
def law(m: Any, q: Any, s: Any) -> Wrench:
    """Side force, heeling and yaw moment in proportion to the angle, up to that of stall."""
    angle = min(max(s.angle, -q.stall), q.stall)
    return wrench(Y=q.sway * angle, K=q.roll * angle, N=q.yaw * angle)


@dataclass(frozen=True)
class Rudder(Force):
    """Linear rudder; the signs say to which side a positive angle steers.

    With `area` given, the coefficients are those of a blade: normal force by its area, aspect ratio and inflow, more by
    the share of it that the hull before it takes up, at its place ahead of and below the mass centre; a positive angle
    then steers to starboard.
    """

    words: ClassVar[str] = "the rudder steers in proportion to its angle"
    shown_by: ClassVar[str] = "a zig-zag at small rudder angles"
    source: ClassVar[str] = (
        "T. I. Fossen, Handbook of Marine Craft Hydrodynamics, 2nd ed. 2021, chapter 9; blade: Inoue et al. 1981"
    )
    roles: ClassVar = {"angle": Role("rad", "the rudder, positive where its coefficients say")}
    law: ClassVar = law

    sway: float = param(
        UNSET, low=-1e11, high=1e11, unit="N/rad", words="Y_delta", calibrates="thrust", axis="sway"
    )
    yaw: float = param(
        UNSET,
        low=-1e13,
        high=1e13,
        unit="N m/rad",
        words="N_delta",
        calibrates="thrust",
        axis="yaw",
    )
    roll: float = param(
        UNSET,
        low=-1e13,
        high=1e13,
        unit="N m/rad",
        words="K_delta",
        calibrates="thrust",
        axis="roll",
    )
    stall: float = param(
        NEVER, low=0.02, high=NEVER, unit="rad", words="angle from which the force grows no further"
    )
    area: float = param(
        0.0, low=0.0, high=500.0, unit="m^2", words="of the blade; 0: coefficients as given"
    )
    aspect: float = param(1.5, low=0.1, high=10.0, unit="", words="span per chord")
    inflow: float = param(
        0.0, low=0.0, high=50.0, unit="m/s", words="speed of the water at the blade, V_R"
    )
    at: float = param(0.0, low=-500.0, high=500.0, unit="m", words="place ahead of the mass centre")
    below: float = param(0.0, low=-100.0, high=100.0, unit="m", words="place below the mass centre")

    def rules(self, vessel: Boat) -> dict[str, float]:
        """The coefficients of a blade, where one is given. Raises BadInput on a vessel without linear_hull."""
        if not self.area:
            return {}
        density, block, arm = (
            self.followed(f"linear_hull.{key}", vessel) for key in ("density", "block", "arm")
        )
        slope = particulars.rudder_slope(self.area, self.aspect, self.inflow, density)
        sway = -(1.0 + particulars.hull_share(block)) * slope
        return {"sway": sway, "yaw": self.at * sway, "roll": (arm - self.below) * sway}


@dataclass(frozen=True)
class RudderStall(Release):
    """The flow leaves the blade: its force grows no further with the angle."""

    words: ClassVar[str] = "the rudder stalls: beyond an angle its force grows no further"
    shown_by: ClassVar[str] = "turns at small and at large rudder angles"
    source: ClassVar[str] = (
        "L. F. Whicker, L. F. Fehlner, DTMB report 933, 1958: lift of low aspect ratio surfaces"
    )
    thresholds: ClassVar = {"angle": (0.3, 0.45, 0.6, 0.75, 0.9)}

    angle: float = number(
        "rudder.stall",
        "mmg_rudder.stall",
        "mmg_low_speed_rudder.stall",
        words="angle of stall",
        unit="rad",
        spread=1.0,
        low=0.02,
        high=NEVER,
        absent=NEVER,
    )
