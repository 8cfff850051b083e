"""Linear damping: resistance in proportion to the velocity through the water."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Force, Wrench, param


@njit(inline="always")
def law(m: Any, q: Any) -> Wrench:
    """-D nu_r."""
    return Wrench(
        -q.surge * m.ur,
        -q.sway * m.vr - q.sway_by_yaw * m.r,
        -q.roll * m.p,
        -q.yaw * m.r - q.yaw_by_sway * m.vr,
    )


@dataclass(frozen=True)
class LinearDamping(Force):
    """Damping of a slow or small motion: skin friction, wave making, lift of the hull at small angles."""

    words: ClassVar[str] = "the water resists in proportion to the speed"
    shown_by: ClassVar[str] = "coasting down from a low speed"
    source: ClassVar[str] = "T. I. Fossen, Handbook of Marine Craft Hydrodynamics, 2nd ed. 2021, section 6.4"
    law: ClassVar = law

    surge: float = param(0.0, low=0.0, high=1e9, unit="N s/m", words="-X_u", calibrates="damping", axis="surge")
    sway: float = param(0.0, low=0.0, high=1e9, unit="N s/m", words="-Y_v", calibrates="damping", axis="sway")
    yaw: float = param(0.0, low=0.0, high=1e13, unit="N m s", words="-N_r", calibrates="damping", axis="yaw")
    roll: float = param(0.0, low=0.0, high=1e13, unit="N m s", words="-K_p", calibrates="damping", axis="roll")
    sway_by_yaw: float = param(0.0, low=-1e11, high=1e11, unit="N s", words="-Y_r", calibrates="damping")
    yaw_by_sway: float = param(0.0, low=-1e11, high=1e11, unit="N s", words="-N_v", calibrates="damping")
