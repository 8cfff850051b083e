"""Mass centre shift: the mass centre of the hull lies ahead of or behind its modelled place."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import (
    UNSET,
    Force,
    Inertia,
    MassMatrix,
    Wrench,
    mass_matrix,
    param,
    wrench,
)


@njit(inline="always")
def inertia(q: Any) -> MassMatrix:
    """Return the change of the mass matrix when the hull's mass centre lies ahead of the origin.

    It holds the first and second moment of the shifted mass; the mass itself belongs to the hull.

    Args:
        q: Parameters of the effect, with the names and units of its class.

    Returns:
        Entries of the mass matrix [kg, kg m, kg m^2] about the origin of motion.
    """
    first = q.hull_mass * q.shift
    return mass_matrix(sway_yaw=first, yaw=first * q.shift)


@njit(inline="always")
def law(m: Any, q: Any) -> Wrench:
    """Return the Coriolis and centripetal force that a shift of the mass centre adds.

    The mass centre lies ahead of or behind the origin of motion.

    Args:
        m: Motion of the hull: velocities [m/s], rates [rad/s], position [m], attitude [rad].
        q: Parameters of the effect, with the names and units of its class.

    Returns:
        Force [N] and moment [N m] in body axes.
    """
    first = q.hull_mass * q.shift
    return wrench(X=first * m.r * m.r, N=-first * m.u * m.r)


@dataclass(frozen=True)
class MassCentreShift(Inertia, Force):
    """Mass centre of the hull ahead of the origin of motion.

    Thrusters and damping keep their places.

    M = m [0, x_g; x_g, x_g^2] in sway and yaw,  X = m x_g r^2,  N = -m x_g u r

    x_g is the `shift` [m], m the `hull_mass` [kg].
    """

    formula: ClassVar[str] = (
        r"X = m x_g r^2, \quad Y = -m x_g \dot r, \quad N = -m x_g (\dot v + u r) - m "
        r"x_g^2 \dot r"
    )
    symbols: ClassVar = {"shift": "x_g", "hull_mass": "m"}
    needs: ClassVar = ("sway", "yaw")
    words: ClassVar[str] = "the mass centre lies ahead of or behind its modelled place"
    refines: ClassVar[str] = "mass_centre"
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
        words="shift of the mass centre, positive forward",
        fit=True,
        spread=0.1,
        within=(-0.6, 0.6),
    )
    hull_mass: float = param(
        UNSET,
        low=0.0,
        high=1e9,
        unit="kg",
        words="mass of the hull; default: that of the vessel",
        follows="vessel.body.mass",
    )
