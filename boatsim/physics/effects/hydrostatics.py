"""Hydrostatics: buoyancy holds a floating hull at its draught and trim."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import UNSET, Boat, Force, Wrench, param, wrench
from boatsim.physics.particulars import GRAVITY


@njit(inline="always")
def law(m: Any, q: Any) -> Wrench:
    """-G (z, phi, theta) about the trim at which the displaced mass floats; what weighs more floats deeper."""
    sunk = m.z - q.flotation * m.theta  # [m] of the centre of flotation
    Z = -q.heave * sunk + (q.mass - q.displacement) * GRAVITY
    return wrench(Z=Z, K=-q.roll * m.phi, M=q.flotation * q.heave * sunk - q.pitch * m.theta)


@dataclass(frozen=True)
class Hydrostatics(Force):
    """Linear restoring in heave, roll and pitch of a hull on still water, origin of motion on the waterline at rest."""

    words: ClassVar[str] = "buoyancy holds the hull at its draught and rights it in roll and pitch"
    shown_by: ClassVar[str] = "a release from heave, heel or trim"
    source: ClassVar[str] = (
        "T. I. Fossen, Handbook of Marine Craft Hydrodynamics, 2nd ed. 2021, section 4.2"
    )
    law: ClassVar = law

    heave: float = param(
        0.0,
        low=0.0,
        high=1e12,
        unit="N/m",
        words="rho g A_wp",
        calibrates="restoring",
        axis="heave",
    )
    roll: float = param(
        0.0, low=0.0, high=1e13, unit="N m", words="m g GM_T", calibrates="restoring", axis="roll"
    )
    pitch: float = param(
        0.0,
        low=0.0,
        high=1e15,
        unit="N m",
        words="m g GM_L, about the centre of flotation",
        calibrates="restoring",
        axis="pitch",
    )
    flotation: float = param(
        0.0, low=-250.0, high=250.0, unit="m", words="centre of flotation ahead of the origin"
    )
    mass: float = param(
        UNSET, low=0.0, high=1e12, unit="kg", words="the boat's", follows="vessel.body.mass"
    )
    displacement: float = param(
        UNSET, low=0.0, high=1e12, unit="kg", words="mass it floats with at z = 0"
    )

    def rules(self, vessel: Boat) -> dict[str, float]:
        """The hull floats as drawn with the mass that its file states."""
        return {"displacement": vessel.body.mass}
