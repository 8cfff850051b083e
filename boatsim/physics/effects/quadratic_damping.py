"""Quadratic damping: resistance with the square of the speed, axis by axis."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Force, Wrench, param


@njit(inline="always")
def law(m: Any, q: Any) -> Wrench:
    """Each axis for itself."""
    return Wrench(
        -q.surge * abs(m.ur) * m.ur,
        -q.sway * abs(m.vr) * m.vr,
        -q.roll * abs(m.p) * m.p,
        -q.yaw * abs(m.r) * m.r,
    )


@dataclass(frozen=True)
class QuadraticDamping(Force):
    """Damping that grows with the square of the speed through the water."""

    words: ClassVar[str] = "damping grows with the square of the speed"
    shown_by: ClassVar[str] = "the same motion at a large and at a small amplitude"
    source: ClassVar[str] = "ITTC Recommended Procedure 7.5-02-07-04.5, Estimation of Roll Damping"
    law: ClassVar = law

    surge: float = param(0.0, low=0.0, high=1e9, unit="N s^2/m^2", words="surge", fit=True, spread=4.0, axis="surge")
    sway: float = param(0.0, low=0.0, high=1e9, unit="N s^2/m^2", words="sway", fit=True, spread=40.0, axis="sway")
    yaw: float = param(0.0, low=0.0, high=1e13, unit="N m s^2", words="yaw", fit=True, spread=1.5, axis="yaw")
    roll: float = param(0.0, low=0.0, high=1e13, unit="N m s^2", words="roll", fit=True, spread=0.1, axis="roll")
