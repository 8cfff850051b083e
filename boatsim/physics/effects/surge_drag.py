"""Surge drag: linear and quadratic resistance in surge."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Force, Wrench, param, wrench


@njit(inline="always")
def law(m: Any, q: Any) -> Wrench:
    """Return the resistance in surge, -(linear + quadratic |u|) u.

    Args:
        m: Motion of the hull: velocities [m/s], rates [rad/s], position [m], attitude [rad].
        q: Parameters of the effect, with the names and units of its class.

    Returns:
        Force [N] and moment [N m] in body axes.
    """
    return wrench(X=-(q.linear + q.quadratic * abs(m.ur)) * m.ur)


@dataclass(frozen=True)
class SurgeDrag(Force):
    """Frictional and form resistance in surge.

    X = -(linear + quadratic |u_r|) u_r,  linear = -X_u,  quadratic = -X_u|u|
    """

    formula: ClassVar[str] = r"X = X_u u_r + X_{|u|u} |u_r| u_r"
    symbols: ClassVar = {"linear": "-X_u", "quadratic": "-X_{|u|u}"}
    words: ClassVar[str] = "resistance of the hull in surge"
    shown_by: ClassVar[str] = "coasting straight ahead"
    law: ClassVar = law

    linear: float = param(0.0, low=0.0, high=1e9, unit="N s/m", words="-X_u", calibrates="damping")
    quadratic: float = param(
        0.0, low=0.0, high=1e9, unit="N s^2/m^2", words="-X_u|u|", calibrates="damping"
    )
