"""Surge drag: friction and form resistance of a hull going straight ahead or astern."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Force, Wrench, param, wrench


@njit(inline="always")
def law(m: Any, q: Any) -> Wrench:
    """X = -(linear + quadratic |u|) u."""
    return wrench(X=-(q.linear + q.quadratic * abs(m.ur)) * m.ur)


@dataclass(frozen=True)
class SurgeDrag(Force):
    """Resistance in surge, linear and quadratic in the speed through the water."""

    words: ClassVar[str] = "the hull resists going ahead"
    shown_by: ClassVar[str] = "coasting straight ahead"
    law: ClassVar = law

    linear: float = param(0.0, low=0.0, high=1e9, unit="N s/m", words="-X_u", calibrates="damping")
    quadratic: float = param(
        0.0, low=0.0, high=1e9, unit="N s^2/m^2", words="-X_u|u|", calibrates="damping"
    )
