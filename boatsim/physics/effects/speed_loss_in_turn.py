"""Speed loss in a turn: the water that drifts sideways with a turning hull holds it back."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Force, Wrench, param


@njit(inline="always")
def law(m: Any, q: Any) -> Wrench:
    """X = mass v r, negative in a steady turn, in which the hull drifts outwards; beside the rigid hull's own m v r."""
    return Wrench(q.mass * m.vr * m.r, 0.0, 0.0, 0.0)


@dataclass(frozen=True)
class SpeedLossInTurn(Force):
    """Surge force in proportion to sway times yaw rate, X_vr: mostly the sway added mass."""

    words: ClassVar[str] = "a hull that drifts while it turns loses speed, in proportion to drift times yaw rate"
    shown_by: ClassVar[str] = "turning circles and large zig-zags with the propeller held"
    source: ClassVar[str] = "H. Yasukawa, Y. Yoshimura, J. Mar. Sci. Technol. 20, 2015: m_y + X_vr"
    law: ClassVar = law

    mass: float = param(0.0, low=-1e9, high=1e9, unit="kg", words="m_y + X_vr", fit=True, spread=4.0)
