"""Measured relative wind: air drag from the apparent wind of an anemometer on board."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Role, Wrench
from boatsim.physics.effects.fan_wind import air_drag
from boatsim.physics.effects.measured_wind import MeasuredWind


@njit(inline="always")
def law(m: Any, q: Any, s: Any) -> Wrench:
    """Return the air drag of the hull for the apparent wind that an anemometer on board measured.

    Args:
        m: Motion of the hull: velocities [m/s], rates [rad/s], position [m], attitude [rad].
        q: Parameters of the effect, with the names and units of its class.
        s: Signals bound to the roles of the effect.

    Returns:
        Force [N] and moment [N m] in body axes.
    """
    return air_drag(-s.speed * s.cos_comes_from, -s.speed * s.sin_comes_from, q.density, q, q.swing)


@dataclass(frozen=True)
class MeasuredRelativeWind(MeasuredWind):
    """Air drag from the apparent wind as measured on board, not converted to true wind.

    X = 0.5 rho front U^2 cos g,  Y = 0.5 rho side U^2 sin g,  N = (arm + swing cos g) Y

    U is the measured speed [m/s], g the direction the air moves to, from the bow. Parameters are
    those of `measured_wind`. A diagnosis tests it for a vessel that names `apparent_wind_mps` and
    `apparent_wind_from_rad` in [measured], if they are recorded.
    """

    formula: ClassVar[str] = (
        r"X = \tfrac{1}{2} \rho A_x U^2 \cos\gamma, \quad Y = \tfrac{1}{2} \rho A_y U^2 "
        r"\sin\gamma, \quad N = (l + l_1 \cos\gamma) \, Y, \quad \gamma = "
        r"\gamma_\mathrm{from} + \pi"
    )
    symbols: ClassVar = {
        "front": "A_x",
        "side": "A_y",
        "arm": "l",
        "swing": "l_1",
        "density": r"\rho",
    }

    recorded_as: ClassVar = {
        "speed": "apparent_wind_mps",
        "comes_from": "apparent_wind_from_rad",
    }
    # the reading is relative to the hull, so no frame of reference is needed
    tied_to: ClassVar[str] = ""
    law: ClassVar = law
    roles: ClassVar = {
        "speed": Role("m/s", "speed of the air past the hull"),
        "comes_from": Role("rad", "direction the air comes from, clockwise from the bow"),
    }
