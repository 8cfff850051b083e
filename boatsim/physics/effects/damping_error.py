"""Damping error: the linear damping coefficients are far from their stated values."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Force, Wrench, param


@njit(inline="always")
def law(m: Any, q: Any) -> Wrench:
    """The difference (factor - 1) D nu_r to the vessel's own linear damping."""
    return Wrench(
        -(q.surge_factor - 1.0) * q.surge * m.ur,
        -(q.sway_factor - 1.0) * q.sway * m.vr,
        -(q.roll_factor - 1.0) * q.roll * m.p,
        -(q.yaw_factor - 1.0) * q.yaw * m.r,
    )


@dataclass(frozen=True)
class DampingError(Force):
    """Linear damping is off by more than its stated uncertainty."""

    words: ClassVar[str] = "the linear damping coefficients are off by more than their stated uncertainty"
    shown_by: ClassVar[str] = "coasting down in each axis"
    law: ClassVar = law

    surge_factor: float = param(
        1.0, low=0.1, high=5.0, unit="", words="surge", fit=True, spread=0.4, axis="surge", absent=1.0,
        scales="linear_damping.surge",
    )  # fmt: skip
    sway_factor: float = param(
        1.0, low=0.1, high=5.0, unit="", words="sway", fit=True, spread=0.4, axis="sway", absent=1.0,
        scales="linear_damping.sway",
    )  # fmt: skip
    yaw_factor: float = param(
        1.0, low=0.1, high=5.0, unit="", words="yaw", fit=True, spread=0.4, axis="yaw", absent=1.0,
        scales="linear_damping.yaw",
    )  # fmt: skip
    roll_factor: float = param(
        1.0, low=0.1, high=5.0, unit="", words="roll", fit=True, spread=0.4, axis="roll", absent=1.0,
        scales="linear_damping.roll",
    )  # fmt: skip
    surge: float = param(0.0, low=0.0, high=1e9, unit="N s/m", words="the vessel's", follows="linear_damping.surge")
    sway: float = param(0.0, low=0.0, high=1e9, unit="N s/m", words="the vessel's", follows="linear_damping.sway")
    yaw: float = param(0.0, low=0.0, high=1e13, unit="N m s", words="the vessel's", follows="linear_damping.yaw")
    roll: float = param(0.0, low=0.0, high=1e13, unit="N m s", words="the vessel's", follows="linear_damping.roll")
