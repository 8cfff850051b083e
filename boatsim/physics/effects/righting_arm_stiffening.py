"""Righting arm stiffening: the righting moment is not in proportion to the heel."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Force, Wrench, param


@njit(inline="always")
def law(m: Any, q: Any) -> Wrench:
    """Cubic term of GZ: stiffness (1 + cubic phi^2) instead of stiffness."""
    return Wrench(0.0, 0.0, -q.stiffness * q.cubic * m.phi * m.phi * m.phi, 0.0)


@dataclass(frozen=True)
class RightingArmStiffening(Force):
    """GZ bends away from its tangent: the roll period depends on the amplitude."""

    words: ClassVar[str] = (
        "the righting moment is not in proportion to the heel, so the roll period changes with amplitude"
    )
    shown_by: ClassVar[str] = "a roll decay from a large heel"
    law: ClassVar = law

    cubic: float = param(
        0.0,
        low=-20.0,
        high=20.0,
        unit="1/rad^2",
        words="relative change per heel squared",
        fit=True,
        spread=3.0,
        axis="roll",
    )
    stiffness: float = param(
        0.0, low=0.0, high=1e13, unit="N m", words="the vessel's m g GM", follows="righting_arm.stiffness"
    )
