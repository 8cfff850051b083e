"""Measured wind: the push of the air on a hull that carries an anemometer, or has one beside it."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Force, Role, Wrench, param
from boatsim.physics.effects.fan_wind import AIR_DENSITY, pushed


@njit(inline="always")
def law(m: Any, q: Any, s: Any) -> Wrench:
    """Drag in the true wind, less the hull's own velocity over ground."""
    north, east = -s.speed * s.cos_comes_from, -s.speed * s.sin_comes_from
    along = m.cos_psi * north + m.sin_psi * east - m.u
    across = m.cos_psi * east - m.sin_psi * north - m.v
    return pushed(along, across, q.density, q, q.swing)


@dataclass(frozen=True)
class MeasuredWind(Force):
    """Drag of the hull in a wind whose speed over ground and direction are recorded.

    X = rho/2 front U^2 cos g, Y = rho/2 side U^2 sin g, N = (arm + swing cos g) Y; U is the air's speed past the hull,
    g where it goes, from the bow. `front` and `side` are areas times their coefficients: of a regression whose C_N has
    N1 sin g + N2 sin 2 g, over length and side area, arm = N1 L / C_Y and swing = 2 N2 L / C_Y.
    """

    words: ClassVar[str] = "the measured wind pushes the hull downwind and swings its bow"
    shown_by: ClassVar[str] = "turning through all headings while holding the thrust"
    source: ClassVar[str] = (
        "T. I. Fossen, Handbook of Marine Craft Hydrodynamics, 2nd ed. 2021, section 10.1"
    )
    anchored: ClassVar[str] = "the air"
    law: ClassVar = law
    of_air: ClassVar = True
    roles: ClassVar = {
        "speed": Role("m/s", "the wind's speed over ground"),
        "comes_from": Role("rad", "where the wind comes from, clockwise from the x axis"),
    }

    front: float = param(
        0.021, low=0.0, high=5000.0, unit="m^2", words="drag area bow-on", calibrates="wind"
    )
    side: float = param(
        0.114, low=0.0, high=20000.0, unit="m^2", words="drag area beam-on", calibrates="wind"
    )
    arm: float = param(
        0.0,
        low=-200.0,
        high=200.0,
        unit="m",
        words="side push acts this far forward",
        calibrates="wind",
    )
    swing: float = param(
        0.0,
        low=-200.0,
        high=200.0,
        unit="m",
        words="further forward with the wind from astern",
        calibrates="wind",
    )
    density: float = param(AIR_DENSITY, low=0.5, high=2.0, unit="kg/m^3", words="of the air")
