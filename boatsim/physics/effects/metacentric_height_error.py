"""Metacentric height error: the hull is stiffer or more tender than its stability booklet says."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Force, Wrench, param


@njit(inline="always")
def law(m: Any, q: Any) -> Wrench:
    """The difference (factor - 1) m g GM to the vessel's own righting moment."""
    return Wrench(0.0, 0.0, -(q.factor - 1.0) * q.stiffness * (m.phi - q.list), 0.0)


@dataclass(frozen=True)
class MetacentricHeightError(Force):
    """The righting moment is off by more than its stated uncertainty."""

    words: ClassVar[str] = "the metacentric height is off by more than its stated uncertainty"
    shown_by: ClassVar[str] = "the period of a roll decay"
    source: ClassVar[str] = "T. I. Fossen, Handbook of Marine Craft Hydrodynamics, 2nd ed. 2021, chapter 4"
    law: ClassVar = law

    factor: float = param(
        1.0, low=0.1, high=5.0, unit="", words="GM per stated GM", fit=True, spread=0.4, absent=1.0, axis="roll",
        scales="righting_arm.stiffness",
    )  # fmt: skip
    stiffness: float = param(
        0.0, low=0.0, high=1e13, unit="N m", words="the vessel's m g GM", follows="righting_arm.stiffness"
    )
    list: float = param(0.0, low=-0.5, high=0.5, unit="rad", words="its heel at rest", follows="righting_arm.list")
