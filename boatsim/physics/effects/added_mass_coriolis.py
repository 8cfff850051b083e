"""Added-mass Coriolis force: the Munk moment and its kin that a model of rigid-body Coriolis force leaves out."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Force, Wrench, param


@njit(inline="always")
def law(m: Any, q: Any) -> Wrench:
    """A fraction of -C_A(nu_r) nu_r, the Munk moment (X_udot - Y_vdot) u v in it."""
    along = q.fraction * q.surge * m.ur  # [kg m/s] momentum of the water in surge
    across = q.fraction * q.sway * (m.vr + q.sway_at * m.r - q.sway_below * m.p)
    return Wrench(across * m.r, -along * m.r, 0.0, along * m.vr - across * m.ur)


@dataclass(frozen=True)
class AddedMassCoriolis(Force):
    """What the Coriolis force of the vessel's own added mass has beyond the share its model keeps."""

    words: ClassVar[str] = "the water that moves with the hull turns it broadside to its course (Munk moment)"
    shown_by: ClassVar[str] = "turning while making way sideways and ahead"
    source: ClassVar[str] = "T. I. Fossen, Handbook of Marine Craft Hydrodynamics, 2nd ed. 2021, section 6.3"
    law: ClassVar = law

    fraction: float = param(
        0.0, low=-1.0, high=2.0, unit="", words="share of the force that is missing", fit=True, spread=0.8
    )
    surge: float = param(0.0, low=0.0, high=1e9, unit="kg", words="the vessel's -X_udot", follows="added_mass.surge")
    sway: float = param(0.0, low=0.0, high=1e9, unit="kg", words="the vessel's -Y_vdot", follows="added_mass.sway")
    sway_at: float = param(0.0, low=-500.0, high=500.0, unit="m", words="where it acts", follows="added_mass.sway_at")
    sway_below: float = param(
        0.0, low=-100.0, high=100.0, unit="m", words="how far below", follows="added_mass.sway_below"
    )
