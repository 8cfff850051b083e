"""Roll coupling: rolling pushes a hull aside and turns it; drifting and turning roll it."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Force, Wrench, param, wrench


@njit(inline="always")
def law(m: Any, q: Any) -> Wrench:
    """What the linear damping matrix has outside its diagonal in the row and the column of roll."""
    return wrench(
        Y=-q.sway_by_roll * m.p,
        K=-q.roll_by_sway * m.vr - q.roll_by_yaw * m.r,
        N=-q.yaw_by_roll * m.p,
    )


@dataclass(frozen=True)
class RollCoupling(Force):
    """Linear hydrodynamic coupling of roll with sway and yaw."""

    words: ClassVar[str] = "rolling pushes and turns the hull, drifting and turning roll it"
    shown_by: ClassVar[str] = "steering reversals with the roll recorded"
    source: ClassVar[str] = (
        "T. I. Fossen, Handbook of Marine Craft Hydrodynamics, 2nd ed. 2021, section 6.6"
    )
    law: ClassVar = law

    sway_by_roll: float = param(
        0.0, low=-1e11, high=1e11, unit="N s", words="-Y_p", calibrates="damping"
    )
    yaw_by_roll: float = param(
        0.0, low=-1e13, high=1e13, unit="N m s", words="-N_p", calibrates="damping"
    )
    roll_by_sway: float = param(
        0.0, low=-1e11, high=1e11, unit="N s", words="-K_v", calibrates="damping"
    )
    roll_by_yaw: float = param(
        0.0, low=-1e13, high=1e13, unit="N m s", words="-K_r", calibrates="damping"
    )
