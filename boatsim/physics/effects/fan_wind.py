"""Fan wind: a steady stream of air over a hull whose areas are known."""

from dataclasses import dataclass
from math import cos, pi, sin, sqrt
from typing import Any, ClassVar

from numba import njit
from numba.extending import register_jitable

from boatsim.physics.base import Force, Wrench, param, wrench

AIR_DENSITY = 1.2  # [kg/m^3] dry air at 20 deg C, 1013 hPa


@register_jitable  # for compiled laws; plain Python where one call needs no compiling
def pushed(along: float, across: float, density: float, q: Any, swing: float) -> Wrench:
    """Quadratic drag in air that moves past the hull [m/s, body axes]; the moment has the terms sin g and sin 2 g."""
    speed = sqrt(along * along + across * across)
    pressure = 0.5 * density * speed
    Y = pressure * q.side * across
    arm = q.arm + (swing * along / speed if speed > 0.0 else 0.0)
    return wrench(X=pressure * q.front * along, Y=Y, N=arm * Y)


@njit(inline="always")
def law(m: Any, q: Any) -> Wrench:
    """Drag in the air's velocity past the hull."""
    north, east = q.speed * cos(q.toward), q.speed * sin(q.toward)
    along = m.cos_psi * north + m.sin_psi * east - m.u
    across = m.cos_psi * east - m.sin_psi * north - m.v
    return pushed(along, across, AIR_DENSITY, q, 0.0)


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
    arm: float = param(
        -0.02, low=-200.0, high=200.0, unit="m", words="side push acts this far forward"
    )
