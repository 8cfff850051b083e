"""Fan wind: a steady stream of air over a hull whose areas are known."""

from dataclasses import dataclass
from math import cos, pi, sin, sqrt
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Force, Wrench, param, wrench

AIR_DENSITY = 1.2  # [kg/m^3] dry air at 20 deg C, 1013 hPa


@njit(inline="always")
def law(m: Any, q: Any) -> Wrench:
    """Quadratic drag in the air's velocity past the hull."""
    north, east = q.speed * cos(q.toward), q.speed * sin(q.toward)
    along = m.cos_psi * north + m.sin_psi * east - m.u  # [m/s] air past the hull, body axes
    across = m.cos_psi * east - m.sin_psi * north - m.v
    pressure = 0.5 * AIR_DENSITY * sqrt(along * along + across * across)
    Y = pressure * q.side * across
    return wrench(X=pressure * q.front * along, Y=Y, N=q.arm * Y)


@dataclass(frozen=True)
class FanWind(Force):
    """Drag of the hull in air moving past it at a constant speed and direction."""

    words: ClassVar[str] = "a steady wind pushes the hull downwind and swings its bow"
    shown_by: ClassVar[str] = "turning through all headings while holding the thrust"
    source: ClassVar[str] = "checked specification of Bayless 2017, section 7 (wind model [A])"
    anchored: ClassVar[str] = "the air"
    law: ClassVar = law
    of_air: ClassVar = True

    speed: float = param(1.5, low=0.0, high=40.0, unit="m/s", words="air speed")
    toward: float = param(0.0, low=-pi, high=pi, unit="rad", words="where the air goes")
    front: float = param(0.021, low=0.0, high=5000.0, unit="m^2", words="drag area bow-on")
    side: float = param(0.114, low=0.0, high=20000.0, unit="m^2", words="drag area beam-on")
    arm: float = param(-0.02, low=-200.0, high=200.0, unit="m", words="side push acts this far forward")
