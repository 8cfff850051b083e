"""Righting arm: buoyancy turns a heeled hull upright."""

from dataclasses import dataclass, replace
from typing import Any, ClassVar, Self

from numba import njit

from boatsim.physics import particulars
from boatsim.physics.base import Force, Wrench, param


@njit(inline="always")
def law(m: Any, q: Any) -> Wrench:
    """K = -stiffness phi: the tangent of the righting arm curve at zero heel."""
    return Wrench(0.0, 0.0, -q.stiffness * (m.phi - q.list), 0.0)


@dataclass(frozen=True)
class RightingArm(Force):
    """Linear restoring moment in roll, m g GM."""

    words: ClassVar[str] = "buoyancy rights the hull in proportion to its heel"
    shown_by: ClassVar[str] = "a roll decay"
    law: ClassVar = law

    stiffness: float = param(
        1.0, low=0.0, high=1e13, unit="N m", words="m g GM, per rad", calibrates="restoring", axis="roll"
    )
    list: float = param(0.0, low=-0.5, high=0.5, unit="rad", words="heel at rest", axis="roll")
    metacentric_height: float = param(
        0.0, low=0.0, high=50.0, unit="m", words="GM, from which the stiffness follows; 0: stiffness as given"
    )

    def completed(self, vessel: Any) -> Self:
        """With the stiffness of the vessel's weight at the given GM."""
        own = super().completed(vessel)
        stiffness = vessel.body.mass * particulars.GRAVITY * self.metacentric_height
        return replace(own, stiffness=stiffness) if self.metacentric_height else own
