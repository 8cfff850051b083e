"""Rudder race: a rudder behind a propeller turns its race aside, at rest too."""

from dataclasses import dataclass
from math import copysign
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import UNSET, Boat, Force, Role, Wrench, param, wrench


@njit(inline="always")
def law(m: Any, q: Any, s: Any) -> Wrench:
    """A force normal to the blade, in proportion to the thrust ahead: a propeller that backs washes no rudder."""
    force = q.normal_force_per_thrust * max(s.thrust, 0.0) * s.sin_angle
    Y = q.side * force * s.cos_angle
    return wrench(X=-force * s.sin_angle, Y=Y, N=q.at * Y)


@dataclass(frozen=True)
class RudderRace(Force):
    """What the race of one propeller adds to the force of the vessel's rudder in open water.

    By momentum theory the race is faster than the boat by V_R^2 - u^2 = 8 T / (pi rho D^2), so that at any speed a
    blade's force gains in proportion to the thrust T.
    """

    needs: ClassVar = ("surge", "sway", "yaw")
    words: ClassVar[str] = (
        "the rudder stands in the propeller's race: it steers by the thrust too, at rest as well"
    )
    shown_by: ClassVar[str] = "short bursts of thrust with the rudder over, from rest"
    source: ClassVar[str] = (
        "H. Yasukawa, Y. Yoshimura, J. Mar. Sci. Technol. 20, 2015, equation 28, in its limit of a race that reaches "
        "the rudder in full"
    )
    roles: ClassVar = {
        "angle": Role("rad", "the rudder, positive where its coefficients say"),
        "thrust": Role("N", "thrust of the propeller ahead of it, ahead positive"),
    }
    alone: ClassVar[bool] = True
    law: ClassVar = law

    normal_force_per_thrust: float = param(
        0.0,
        low=0.0,
        high=5.0,
        unit="",
        words="at a right angle to the race",
        fit=True,
        spread=0.7,
        calibrates="thrust",
    )
    at: float = param(
        UNSET,
        low=-500.0,
        high=500.0,
        unit="m",
        words="rudder ahead of the mass centre; else by its own",
    )
    side: float = param(
        UNSET,
        low=-1.0,
        high=1.0,
        unit="",
        words="where a positive angle pushes, 1 starboard; else as the rudder's own",
    )

    def rules(self, vessel: Boat) -> dict[str, float]:
        """Place and side as of the vessel's rudder. Raises BadInput where it has none."""
        sway, yaw = (self.followed(f"rudder.{axis}", vessel) for axis in ("sway", "yaw"))
        return {"at": yaw / sway if sway else -0.5 * vessel.length, "side": copysign(1.0, sway)}
