"""Roll damping: linear damping as a share of the critical damping."""

from dataclasses import dataclass
from math import sqrt
from typing import Any, ClassVar

from numba import njit

from boatsim.physics import particulars
from boatsim.physics.base import UNSET, Boat, Force, Wrench, param, wrench


@njit(inline="always")
def law(m: Any, q: Any) -> Wrench:
    """Return the linear damping moment in roll, -roll p.

    Args:
        m: Motion of the hull: velocities [m/s], rates [rad/s], position [m], attitude [rad].
        q: Parameters of the effect, with the names and units of its class.

    Returns:
        Force [N] and moment [N m] in body axes.
    """
    return wrench(K=-q.roll * m.p)


@dataclass(frozen=True)
class RollDamping(Force):
    """Linear roll damping from the damping ratio, the roll stiffness and the total roll inertia.

    K = -2 zeta sqrt(m g GM (I_x + added inertia)) p

    The damping ratio zeta is `at_rest`, for a round bilge larger at speed by the formula of the
    source.
    """

    formula: ClassVar[str] = r"K = -2 \zeta \sqrt{m g \, GM \left(I_x - K_{\dot p}\right)} \; p"
    symbols: ClassVar = {"at_rest": r"\zeta", "stiffness": r"m g \, GM"}
    words: ClassVar[str] = "the roll damping is proportional to the roll rate"
    shown_by: ClassVar[str] = "a roll decay"
    source: ClassVar[str] = (
        "C. R. Martin, Rudder Roll Reduction for Small Ships, UBC 1993, Appendix IV"
    )
    law: ClassVar = law

    at_rest: float = param(
        0.09,
        low=0.0,
        high=2.0,
        unit="",
        words="damping ratio without forward speed; 0.09: hard chine",
    )
    round_bilge: float = param(
        0.0,
        low=0.0,
        high=1.0,
        unit="",
        words="1: damping grows with forward speed by the published formula",
    )
    roll: float = param(
        UNSET, low=0.0, high=1e13, unit="N m s", words="-K_p", calibrates="damping", axis="roll"
    )
    stiffness: float = param(
        UNSET,
        low=0.0,
        high=1e13,
        unit="N m",
        words="roll stiffness of the vessel, m g GM",
        follows="righting_arm.stiffness",
    )

    def derived_parameters(self, vessel: Boat) -> dict[str, float]:
        """Return the default roll damping coefficient from stiffness, inertia, hull form and speed.

        Args:
            vessel: Vessel with body and righting arm.

        Raises:
            BadInput: The vessel lacks an effect on which the rule builds.
        """
        inertia = vessel.body.roll_inertia + self._added_roll_inertia(vessel)
        ratio = self.at_rest + (
            self._damping_ratio_from_speed(vessel, self.stiffness) if self.round_bilge else 0.0
        )
        return {"roll": 2.0 * ratio * sqrt(self.stiffness * inertia)}

    def _damping_ratio_from_speed(self, vessel: Boat, stiffness: float) -> float:
        """Return the damping ratio that forward speed adds."""
        block, speed = (
            self.inherited_value(f"linear_hull.{key}", vessel) for key in ("block", "speed")
        )
        height = stiffness / (vessel.body.mass * particulars.GRAVITY)
        return particulars.roll_damping_ratio_by_speed(
            vessel.length, vessel.beam, block, height, speed
        )

    def _added_roll_inertia(self, vessel: Boat) -> float:
        """Return the roll added inertia about the origin [kg m^2]."""
        roll, sway, below = (
            self.inherited_value(f"added_mass.{key}?", vessel)
            for key in ("roll", "sway", "sway_below")
        )
        return roll + sway * below**2
