"""Sway-yaw coupling: side force of turning and moment of drifting that grow with the speed ahead."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Force, Wrench, param


@njit(inline="always")
def law(m: Any, q: Any) -> Wrench:
    """Y_ur u r and N_uv u v: they change sign with the way of the boat."""
    return Wrench(0.0, -q.sway * m.ur * m.r, 0.0, -q.yaw * m.ur * m.vr)


@dataclass(frozen=True)
class SwayYawCoupling(Force):
    """Cross terms of hull lift and added mass at a small angle to the flow; a moment alone is the Munk moment."""

    words: ClassVar[str] = "a hull with way on feels a side force when it turns and a moment when it drifts"
    shown_by: ClassVar[str] = "the same turns at two speeds ahead, and astern"
    source: ClassVar[str] = "T. I. Fossen, Handbook of Marine Craft Hydrodynamics, 2nd ed. 2021, chapter 6"
    law: ClassVar = law

    sway: float = param(0.0, low=-1e9, high=1e9, unit="kg", words="-Y_ur", fit=True, spread=5.0)
    yaw: float = param(0.0, low=-1e9, high=1e9, unit="kg", words="-N_uv", fit=True, spread=5.0)
