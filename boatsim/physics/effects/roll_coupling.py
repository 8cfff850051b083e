"""Roll coupling: linear damping coupling of roll with sway and yaw."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Force, Wrench, param, wrench


@njit(inline="always")
def law(m: Any, q: Any) -> Wrench:
    """Return the forces by linear damping that couples roll with sway and yaw.

    Args:
        m: Motion of the hull: velocities [m/s], rates [rad/s], position [m], attitude [rad].
        q: Parameters of the effect, with the names and units of its class.

    Returns:
        Force [N] and moment [N m] in body axes.
    """
    return wrench(
        Y=-q.sway_by_roll * m.p,
        K=-q.roll_by_sway * m.vr - q.roll_by_yaw * m.r,
        N=-q.yaw_by_roll * m.p,
    )


@dataclass(frozen=True)
class RollCoupling(Force):
    """Linear hydrodynamic coupling of roll with sway and yaw.

    Y = Y_p p,  K = K_v v_r + K_r r,  N = N_p p
    """

    formula: ClassVar[str] = r"Y = Y_p p, \quad K = K_v v_r + K_r r, \quad N = N_p p"
    symbols: ClassVar = {
        "sway_by_roll": "-Y_p",
        "roll_by_sway": "-K_v",
        "roll_by_yaw": "-K_r",
        "yaw_by_roll": "-N_p",
    }
    words: ClassVar[str] = (
        "roll causes sway and yaw forces, and drift and yaw rate cause a roll moment"
    )
    shown_by: ClassVar[str] = "steering reversals with roll recorded"
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
