"""Roll offset: an inclinometer mounted askew, or zeroed on a hull that had a list."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Measurement, Shown, param


@njit(inline="always")
def shown(m: Shown, q: Any) -> Shown:
    """Recorded phi = phi + offset."""
    return Shown(m.x, m.y, m.z, m.phi + q.offset, m.theta, m.psi, m.u, m.v, m.w, m.p, m.q, m.r)


@dataclass(frozen=True)
class RollOffset(Measurement):
    """The hull rolls about upright and is shown to roll about another angle.

    A constant moment does the same to a righting arm in proportion to the heel alone: one that bends does so about
    upright, wherever the zero of the instrument lies.
    """

    of_columns: ClassVar = ("phi_rad",)
    needs: ClassVar = ("roll",)
    words: ClassVar[str] = "the recorded roll is off by a constant angle (not physics)"
    shown_by: ClassVar[str] = "a roll decay from a large heel"
    source: ClassVar[str] = "instrument not zeroed on the upright hull"
    shown: ClassVar = shown

    offset: float = param(
        0.0, low=-0.5, high=0.5, unit="rad", words="roll off by", fit=True, spread=0.05
    )
