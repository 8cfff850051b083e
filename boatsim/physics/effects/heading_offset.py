"""Heading offset: the recorded heading is turned by a constant angle."""

from dataclasses import dataclass
from math import cos, sin
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Measurement, Shown, param


@njit(inline="always")
def shown(m: Shown, q: Any) -> Shown:
    """Recorded psi = psi + offset; speeds are resolved along the recorded heading."""
    c, s = cos(q.offset), sin(q.offset)
    return Shown(m.x, m.y, m.psi + q.offset, m.phi, c * m.u + s * m.v, c * m.v - s * m.u, m.p, m.r)


@dataclass(frozen=True)
class HeadingOffset(Measurement):
    """Compass or marker mounted askew, declination not applied."""

    words: ClassVar[str] = "the recorded heading is off by a constant angle (not physics)"
    shown_by: ClassVar[str] = "a straight run ahead followed by one astern"
    shown: ClassVar = shown

    offset: float = param(0.0, low=-1.0, high=1.0, unit="rad", words="heading too large by", fit=True, spread=0.1)
