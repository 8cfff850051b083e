"""Steering drag: a rudder at an angle holds the ship back."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Force, Wrench, param, wrench


@njit(inline="always")
def law(m: Any, q: Any, s: Any, t: Any) -> Wrench:
    """X = -drag delta^2: the lift's part along the ship."""
    return wrench(X=-q.drag * s.angle * s.angle)


@dataclass(frozen=True)
class SteeringDrag(Force):
    """Resistance with the square of the rudder angle, X_delta delta."""

    words: ClassVar[str] = "the rudder brakes with the square of its angle"
    shown_by: ClassVar[str] = "large rudder angles that reverse before the ship turns"
    source: ClassVar[str] = (
        "T. I. Fossen, Handbook of Marine Craft Hydrodynamics, 2nd ed. 2021, chapter 9"
    )
    rides: ClassVar[str] = "rudder"
    law: ClassVar = law

    drag: float = param(
        0.0, low=0.0, high=1e11, unit="N/rad^2", words="-X_delta_delta", fit=True, spread=0.1
    )
