"""Mass centre shift: the hull's own mass lies ahead of or behind where the model has it."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import UNSET, Force, Inertia, Mass, Wrench, mass, param, wrench


@njit(inline="always")
def inertia(q: Any) -> Mass:
    """First and second moment of the shifted mass about the origin of motion; the mass itself is the hull's."""
    first = q.hull_mass * q.shift
    return mass(sway_yaw=first, yaw=first * q.shift)


@njit(inline="always")
def law(m: Any, q: Any) -> Wrench:
    """Coriolis force of that moment: (m x_g r^2, 0, -m x_g u r)."""
    first = q.hull_mass * q.shift
    return wrench(X=first * m.r * m.r, N=-first * m.u * m.r)


@dataclass(frozen=True)
class MassCentreShift(Inertia, Force):
    """The hull's mass centre ahead of the origin of motion; thrusters and damping stay where they are."""

    needs: ClassVar = ("sway", "yaw")
    words: ClassVar[str] = "the mass centre lies ahead of or behind where the model has it"
    shown_by: ClassVar[str] = "sharp starts and stops sideways, and fast turns"
    source: ClassVar[str] = (
        "T. I. Fossen, Handbook of Marine Craft Hydrodynamics, 2nd ed. 2021, section 3.3"
    )
    moves_with: ClassVar[str] = "hull"
    inertia: ClassVar = inertia
    law: ClassVar = law

    shift: float = param(
        0.0,
        low=-200.0,
        high=200.0,
        unit="m",
        words="positive forward",
        fit=True,
        spread=0.1,
        within=(-0.6, 0.6),
    )
    hull_mass: float = param(
        UNSET,
        low=0.0,
        high=1e9,
        unit="kg",
        words="the hull's; if not given, the vessel's own",
        follows="vessel.body.mass",
    )
