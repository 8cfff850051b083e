"""Rudder: side force and moments linear in the rudder angle at the approach speed."""

from dataclasses import dataclass
from math import pi
from typing import Any, ClassVar

from numba import njit

from boatsim.physics import particulars
from boatsim.physics.base import (
    UNSET,
    Boat,
    CoefficientRelease,
    Force,
    Role,
    Wrench,
    param,
    replacement_parameter,
    wrench,
)

NEVER = 0.5 * pi  # [rad] larger than any rudder angle: no stall


@njit(inline="always")
def law(m: Any, q: Any, s: Any) -> Wrench:
    """Return the side force, roll and yaw moment of a rudder, linear in its angle up to stall.

    Beyond the stall angle they are constant.

    Args:
        m: Motion of the hull: velocities [m/s], rates [rad/s], position [m], attitude [rad].
        q: Parameters of the effect, with the names and units of its class.
        s: Signals bound to the roles of the effect.

    Returns:
        Force [N] and moment [N m] in body axes.
    """
    angle = min(max(s.angle, -q.stall), q.stall)
    return wrench(Y=q.sway * angle, K=q.roll * angle, N=q.yaw * angle)


@dataclass(frozen=True)
class Rudder(Force):
    """Linear rudder; the signs of the coefficients define the sense of the angle.

    Y = Y_delta delta,  K = K_delta delta,  N = N_delta delta,  |delta| <= stall

    With `area` given, the coefficients are estimated: normal force from area, aspect ratio and
    inflow speed, increased by the share induced on the hull, acting at `at` ahead of and `below`
    the mass centre. A positive angle then turns to starboard.
    """

    formula: ClassVar[str] = (
        r"Y = Y_\delta \delta, \quad K = K_\delta \delta, \quad N = N_\delta \delta, "
        r"\quad |\delta| \le \delta_\mathrm{stall}"
    )
    symbols: ClassVar = {
        "sway": r"Y_\delta",
        "roll": r"K_\delta",
        "yaw": r"N_\delta",
        "stall": r"\delta_\mathrm{stall}",
    }
    words: ClassVar[str] = "the rudder force is proportional to the rudder angle"
    shown_by: ClassVar[str] = "a zig-zag at small rudder angles"
    source: ClassVar[str] = (
        "T. I. Fossen, Handbook of Marine Craft Hydrodynamics, 2nd ed. 2021, chapter 9; blade: "
        "Inoue et al. 1981"
    )
    roles: ClassVar = {
        "angle": Role("rad", "rudder angle; the signs of the coefficients define its sense")
    }
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
        NEVER,
        low=0.02,
        high=NEVER,
        unit="rad",
        words="stall angle, beyond which the force is constant",
    )
    area: float = param(
        0.0, low=0.0, high=500.0, unit="m^2", words="rudder area; 0: coefficients as given"
    )
    aspect: float = param(1.5, low=0.1, high=10.0, unit="", words="aspect ratio, span over chord")
    inflow: float = param(
        0.0, low=0.0, high=50.0, unit="m/s", words="speed of the water at the rudder, V_R"
    )
    at: float = param(
        0.0, low=-500.0, high=500.0, unit="m", words="place of the rudder ahead of the mass centre"
    )
    below: float = param(
        0.0, low=-100.0, high=100.0, unit="m", words="place of the rudder below the mass centre"
    )

    def derived_parameters(self, vessel: Boat) -> dict[str, float]:
        """Return default force coefficients of a rudder, estimated from its area.

        The result is empty if no area is given.

        Args:
            vessel: Vessel with a `linear_hull`.

        Raises:
            BadInput: The vessel has no `linear_hull`.
        """
        if not self.area:
            return {}
        density, block, arm = (
            self.inherited_value(f"linear_hull.{key}", vessel)
            for key in ("density", "block", "arm")
        )
        slope = particulars.rudder_force_slope(self.area, self.aspect, self.inflow, density)
        sway = -(1.0 + particulars.hull_force_ratio(block)) * slope
        return {"sway": sway, "yaw": self.at * sway, "roll": (arm - self.below) * sway}


@dataclass(frozen=True)
class RudderStall(CoefficientRelease):
    """Stall of the rudder: its force is constant beyond an angle."""

    formula: ClassVar[str] = r"\delta_\mathrm{stall} = \mathrm{angle}"
    words: ClassVar[str] = "the rudder stalls: beyond an angle its force does not increase"
    shown_by: ClassVar[str] = "turns at small and at large rudder angles"
    source: ClassVar[str] = (
        "L. F. Whicker, L. F. Fehlner, DTMB report 933, 1958: lift of low aspect ratio surfaces"
    )
    limits: ClassVar = ("angle",)
    thresholds: ClassVar = {"angle": (0.3, 0.45, 0.6, 0.75, 0.9)}

    angle: float = replacement_parameter(
        "rudder.stall",
        "mmg_rudder.stall",
        "mmg_low_speed_rudder.stall",
        words="stall angle",
        unit="rad",
        spread=1.0,
        low=0.02,
        high=NEVER,
        inactive_value=NEVER,
    )
