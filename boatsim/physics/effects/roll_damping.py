"""Roll damping: a share of the critical one, larger with headway where the bilge is round."""

from dataclasses import dataclass
from math import sqrt
from typing import Any, ClassVar

from numba import njit

from boatsim.physics import particulars
from boatsim.physics.base import UNSET, Boat, Force, Wrench, param, wrench


@njit(inline="always")
def law(m: Any, q: Any) -> Wrench:
    """K = -roll p."""
    return wrench(K=-q.roll * m.p)


@dataclass(frozen=True)
class RollDamping(Force):
    """Linear roll damping from the hull's form, its righting arm and its roll inertia, water included."""

    words: ClassVar[str] = "the hull's roll is damped in proportion to its rate"
    shown_by: ClassVar[str] = "a roll decay"
    source: ClassVar[str] = (
        "C. R. Martin, Rudder Roll Reduction for Small Ships, UBC 1993, Appendix IV"
    )
    law: ClassVar = law

    at_rest: float = param(
        0.09, low=0.0, high=2.0, unit="", words="per critical, without headway; 0.09: hard chine"
    )
    round_bilge: float = param(
        0.0, low=0.0, high=1.0, unit="", words="1: grows with headway by the published formula"
    )
    roll: float = param(
        UNSET, low=0.0, high=1e13, unit="N m s", words="-K_p", calibrates="damping", axis="roll"
    )
    stiffness: float = param(
        UNSET,
        low=0.0,
        high=1e13,
        unit="N m",
        words="the vessel's m g GM",
        follows="righting_arm.stiffness",
    )

    def rules(self, vessel: Boat) -> dict[str, float]:
        """The coefficient of the vessel's own stiffness, inertia, form and speed. Raises BadInput."""
        inertia = vessel.body.roll_inertia + self._water(vessel)
        ratio = self.at_rest + (
            self._with_headway(vessel, self.stiffness) if self.round_bilge else 0.0
        )
        return {"roll": 2.0 * ratio * sqrt(self.stiffness * inertia)}

    def _with_headway(self, vessel: Boat, stiffness: float) -> float:
        """Share of the critical damping that headway adds."""
        block, speed = (self.followed(f"linear_hull.{key}", vessel) for key in ("block", "speed"))
        height = stiffness / (vessel.body.mass * particulars.GRAVITY)
        return particulars.roll_ratio_by_speed(vessel.length, vessel.beam, block, height, speed)

    def _water(self, vessel: Boat) -> float:
        """Roll inertia of the water about the origin."""
        roll, sway, below = (
            self.followed(f"added_mass.{key}?", vessel) for key in ("roll", "sway", "sway_below")
        )
        return roll + sway * below**2
