"""Approach balance: propeller and resistance hold a speed, linear about the approach."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Force, Role, Wrench, param, wrench


@njit(inline="always")
def law(m: Any, q: Any, s: Any) -> Wrench:
    """X = -damping (u - gain speed n / shaft_rate): at a shaft rate n the hull settles at a speed in proportion."""
    return wrench(X=-q.damping * (m.ur - q.gain * q.speed * s.shaft / q.shaft_rate))


@dataclass(frozen=True)
class ApproachBalance(Force):
    """Thrust less resistance near the approach speed, whose propeller turns with the shaft."""

    words: ClassVar[str] = "propeller and resistance hold the approach speed"
    shown_by: ClassVar[str] = "a straight run from a slightly different speed"
    source: ClassVar[str] = (
        "M. A. Abkowitz, Lectures on Ship Hydrodynamics, 1964: the linear term in u - U0"
    )
    roles: ClassVar = {"shaft": Role("1/s", "the propeller's rate, ahead positive")}
    law: ClassVar = law

    damping: float = param(
        0.0,
        low=0.0,
        high=1e9,
        unit="N s/m",
        words="resistance less thrust per speed, -X_u",
        calibrates="damping",
    )
    speed: float = param(1.0, low=0.01, high=50.0, unit="m/s", words="approach speed, U0")
    shaft_rate: float = param(
        1.0, low=0.01, high=1e3, unit="1/s", words="propeller's rate at that speed, n0"
    )
    gain: float = param(
        1.0, low=0.1, high=5.0, unit="", words="speed held per stated one", calibrates="thrust"
    )
