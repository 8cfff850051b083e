"""Coupling of sway and roll by the water that a hull moves in beam waves."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Force, Inertia, MassMatrix, Wrench, mass_matrix, param, wrench


@njit(inline="always")
def inertia(q: Any) -> MassMatrix:
    """Return the added mass that couples sway and roll.

    Args:
        q: Parameters of the effect, with the names and units of its class.

    Returns:
        Entries of the mass matrix [kg m] about the origin of motion.
    """
    return mass_matrix(sway_roll=q.added_mass)


@njit(inline="always")
def law(m: Any, q: Any) -> Wrench:
    """Return the damping that couples sway and roll, equal in both directions.

    Args:
        m: Motion of the hull: velocities [m/s], rates [rad/s], position [m], attitude [rad].
        q: Parameters of the effect, with the names and units of its class.

    Returns:
        Force [N] and moment [N m] in body axes.
    """
    return wrench(Y=-q.damping * m.p, K=-q.damping * m.vr)


@dataclass(frozen=True)
class SwayRollRadiation(Inertia, Force):
    """Added mass and wave damping that couple sway and roll of a hull without speed ahead.

    Y = -A p' - D p,  K = -A v' - D v_r

    Both couplings are symmetric (Haskind). A lever between the centre of the wave-making and the
    origin causes them, so that roll radiates waves as sway does.
    """

    formula: ClassVar[str] = (
        r"Y = Y_{\dot p} \, \dot p + Y_p \, p, \quad K = Y_{\dot p} \, \dot v + Y_p \, v_r"
    )
    symbols: ClassVar = {"added_mass": r"-Y_{\dot p}", "damping": "-Y_p"}
    needs: ClassVar = ("sway", "roll")
    requires: ClassVar = {"guided": (True,)}
    words: ClassVar[str] = "sway and roll act on one another through the water that they move"
    shown_by: ClassVar[str] = "beam waves, or a roll decay of a hull that is free to sway"
    source: ClassVar[str] = (
        "O. M. Faltinsen, Sea Loads on Ships and Offshore Structures, 1990, section 3.3"
    )
    moves_with: ClassVar[str] = "water"
    inertia: ClassVar = inertia
    law: ClassVar = law
    strength: ClassVar = ("added_mass", "damping")

    added_mass: float = param(
        0.0,
        low=-1e9,
        high=1e9,
        unit="kg m",
        words="added mass that couples sway and roll, -Y_pdot",
        fit=True,
        spread=0.2,
        calibrates="added_mass",
    )
    damping: float = param(
        0.0,
        low=-1e9,
        high=1e9,
        unit="N s",
        words="damping that couples sway and roll, -Y_p",
        fit=True,
        spread=1.0,
        calibrates="damping",
    )
