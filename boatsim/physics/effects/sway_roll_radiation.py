"""Coupling of sway and roll by the water that a hull moves in beam waves."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Force, Wrench, param, wrench


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
class SwayRollRadiation(Force):
    """Wave damping that couples sway and roll of a hull without speed ahead.

    Y = -D p,  K = -D v_r

    The coupling is symmetric (Haskind): roll radiates waves as sway does, and both cross terms are
    equal. The added mass that couples them is `sway_below` of `added_mass`.
    """

    formula: ClassVar[str] = r"Y = Y_p \, p, \quad K = Y_p \, v_r"
    symbols: ClassVar = {"damping": "-Y_p"}
    needs: ClassVar = ("sway", "roll")
    required_facts: ClassVar = {"guided": True}
    words: ClassVar[str] = "sway and roll act on one another through the water that they move"
    shown_by: ClassVar[str] = "beam waves, or a roll decay of a hull that is free to sway"
    source: ClassVar[str] = (
        "O. M. Faltinsen, Sea Loads on Ships and Offshore Structures, 1990, section 3.3"
    )
    law: ClassVar = law

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
