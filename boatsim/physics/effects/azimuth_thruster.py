"""Azimuth thruster: one thrust that points any way, on the centreline."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Force, Wrench, param


@njit(inline="always")
def law(m: Any, q: Any) -> Wrench:
    """T (cos b, sin b) at (x, 0)."""
    X, Y = q.gain * m.thrust_N * m.cos_azimuth_rad, q.gain * m.thrust_N * m.sin_azimuth_rad
    return Wrench(X, Y, 0.0, q.x * Y)


@dataclass(frozen=True)
class AzimuthThruster(Force):
    """A thruster that turns about the vertical; ahead of the origin a push to starboard turns to starboard."""

    words: ClassVar[str] = "one thruster on the centreline pushes and steers"
    shown_by: ClassVar[str] = "any manoeuvre"
    source: ClassVar[str] = "Y. Huang and Z. Ji, Autonomous boat dynamics, eqs 4-6"
    law: ClassVar = law

    x: float = param(0.4, low=-500.0, high=500.0, unit="m", words="ahead of the origin; negative: at the stern")
    gain: float = param(1.0, low=0.1, high=5.0, unit="", words="thrust per commanded thrust", calibrates="thrust")
