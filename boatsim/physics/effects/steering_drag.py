"""Steering drag: resistance of a deflected rudder."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Force, Wrench, param, wrench


@njit(inline="always")
def law(m: Any, q: Any, s: Any, t: Any) -> Wrench:
    """Return the resistance of a deflected rudder, X = -drag delta^2.

    It is the component of the rudder force along the ship.

    Args:
        m: Motion of the hull: velocities [m/s], rates [rad/s], position [m], attitude [rad].
        q: Parameters of the effect, with the names and units of its class.
        s: Signals of the rudder on which the effect acts.
        t: Parameters of that rudder.

    Returns:
        Force [N] and moment [N m] in body axes.
    """
    return wrench(X=-q.drag * s.angle * s.angle)


@dataclass(frozen=True)
class SteeringDrag(Force):
    """Resistance proportional to the square of the rudder angle, X = X_delta_delta delta^2."""

    formula: ClassVar[str] = r"X = X_{\delta\delta} \delta^2"
    symbols: ClassVar = {"drag": r"-X_{\delta\delta}"}
    words: ClassVar[str] = "the resistance grows with the square of the rudder angle"
    shown_by: ClassVar[str] = "large rudder angles that reverse before the ship turns"
    source: ClassVar[str] = (
        "T. I. Fossen, Handbook of Marine Craft Hydrodynamics, 2nd ed. 2021, chapter 9"
    )
    per_instance_of: ClassVar[str] = "rudder"
    law: ClassVar = law

    drag: float = param(
        0.0, low=0.0, high=1e11, unit="N/rad^2", words="-X_delta_delta", fit=True, spread=0.1
    )
