"""Added mass error: the water that moves with the hull is more or less than stated."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Force, Inertia, Mass, Wrench, param
from boatsim.physics.effects import added_mass


@njit(inline="always")
def inertia(q: Any) -> Mass:
    """The difference (factor - 1) M_A to the vessel's own added mass."""
    sway, at = (q.sway_factor - 1.0) * q.sway, q.sway_at
    yaw = (q.yaw_factor - 1.0) * q.yaw
    return Mass((q.surge_factor - 1.0) * q.surge, sway, sway * at, yaw + sway * at * at, 0.0, 0.0, 0.0)


@njit(inline="always")
def law(m: Any, q: Any) -> Wrench:
    """Coriolis force of the difference, Munk moment included."""
    sway = q.coriolis * (q.sway_factor - 1.0) * q.sway
    along = q.coriolis * (q.surge_factor - 1.0) * q.surge * m.ur
    across = sway * (m.vr + q.sway_at * m.r)
    return Wrench(across * m.r, -along * m.r, 0.0, along * m.vr - across * m.ur)


@dataclass(frozen=True)
class AddedMassError(Inertia, Force):
    """Added mass off by a factor in each axis: another draught, shallow water, a wrong formula."""

    words: ClassVar[str] = "the added mass is off: the hull lies deeper or shallower than stated"
    shown_by: ClassVar[str] = "sharp starts and stops in sway and yaw"
    source: ClassVar[str] = added_mass.AddedMass.source
    moves_with: ClassVar[str] = "water"
    inertia: ClassVar = inertia
    law: ClassVar = law

    surge_factor: float = param(
        1.0, low=0.1, high=5.0, unit="", words="surge", fit=True, spread=0.4, axis="surge", absent=1.0
    )
    sway_factor: float = param(
        1.0, low=0.1, high=5.0, unit="", words="sway", fit=True, spread=0.4, axis="sway", absent=1.0
    )
    yaw_factor: float = param(
        1.0, low=0.1, high=5.0, unit="", words="yaw", fit=True, spread=0.4, axis="yaw", absent=1.0
    )
    surge: float = param(0.0, low=0.0, high=1e9, unit="kg", words="the vessel's", follows="added_mass.surge")
    sway: float = param(0.0, low=0.0, high=1e9, unit="kg", words="the vessel's", follows="added_mass.sway")
    sway_at: float = param(0.0, low=-500.0, high=500.0, unit="m", words="where it acts", follows="added_mass.sway_at")
    yaw: float = param(0.0, low=0.0, high=1e13, unit="kg m^2", words="the vessel's", follows="added_mass.yaw")
    coriolis: float = param(
        1.0, low=0.0, high=1.0, unit="", words="share of its Coriolis force", follows="added_mass.coriolis"
    )
