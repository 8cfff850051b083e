"""Rudder race: rudder force in the propeller slipstream, also at rest."""

from dataclasses import dataclass
from math import copysign
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import UNSET, Boat, Force, Role, Wrench, param, wrench


@njit(inline="always")
def law(m: Any, q: Any, s: Any) -> Wrench:
    """Return the rudder force that the slipstream of a propeller adds.

    It acts normal to the rudder and is proportional to the thrust ahead; there is none astern.

    Args:
        m: Motion of the hull: velocities [m/s], rates [rad/s], position [m], attitude [rad].
        q: Parameters of the effect, with the names and units of its class.
        s: Signals bound to the roles of the effect.

    Returns:
        Force [N] and moment [N m] in body axes.
    """
    force = q.normal_force_per_thrust * max(s.thrust, 0.0) * s.sin_angle
    Y = q.side * force * s.cos_angle
    return wrench(X=-force * s.sin_angle, Y=Y, N=q.at * Y)


@dataclass(frozen=True)
class RudderRace(Force):
    """Additional rudder force by the slipstream of one propeller.

    F_N = c max(T, 0) sin(delta),  X = -F_N sin(delta),  Y = side F_N cos(delta),  N = at Y

    By momentum theory the slipstream has V_R^2 - u^2 = 8 T / (pi rho D^2), so that the force of the
    rudder increases in proportion to the thrust T at every speed. c is `normal_force_per_thrust`.
    """

    formula: ClassVar[str] = (
        r"F_N = c \max(T, 0) \sin\delta, \quad X = -F_N \sin\delta, \quad Y = s \, F_N "
        r"\cos\delta, \quad N = x_R Y"
    )
    symbols: ClassVar = {"normal_force_per_thrust": "c", "at": "x_R", "side": "s"}
    needs: ClassVar = ("surge", "sway", "yaw")
    ruled_out_by: ClassVar = {"no_water": (True,)}
    words: ClassVar[str] = (
        "the rudder is in the propeller slipstream: its force grows with the thrust, also at rest"
    )
    shown_by: ClassVar[str] = "short bursts of thrust with the rudder over, from rest"
    source: ClassVar[str] = (
        "H. Yasukawa, Y. Yoshimura, J. Mar. Sci. Technol. 20, 2015, equation 28, in its limit "
        "of a race that reaches "
        "the rudder in full"
    )
    roles: ClassVar = {
        "angle": Role("rad", "rudder angle; the signs of the coefficients define its sense"),
        "thrust": Role("N", "thrust of the propeller ahead of the rudder, positive ahead"),
    }
    alone: ClassVar[bool] = True
    law: ClassVar = law

    normal_force_per_thrust: float = param(
        0.0,
        low=0.0,
        high=5.0,
        unit="",
        words="force normal to the rudder over thrust and sine of the angle",
        fit=True,
        spread=0.7,
        calibrates="thrust",
    )
    at: float = param(
        UNSET,
        low=-500.0,
        high=500.0,
        unit="m",
        words="rudder ahead of the mass centre; default: from the coefficients of the rudder",
    )
    side: float = param(
        UNSET,
        low=-1.0,
        high=1.0,
        unit="",
        words="side of the force at a positive angle, 1: starboard; default: as the rudder",
    )

    def derived_parameters(self, vessel: Boat) -> dict[str, float]:
        """Return the default place and sign of the slipstream force, those of the vessel's rudder.

        Args:
            vessel: Vessel with a `rudder`.

        Raises:
            BadInput: The vessel has no rudder.
        """
        sway, yaw = (self.inherited_value(f"rudder.{axis}", vessel) for axis in ("sway", "yaw"))
        return {"at": yaw / sway if sway else -0.5 * vessel.length, "side": copysign(1.0, sway)}
