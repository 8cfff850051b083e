"""Heading deviation: a compass error, constant or depending on the heading."""

from dataclasses import dataclass
from math import cos, sin
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Measurement, Shown, param, preset


@njit(inline="always")
def shown(m: Shown, q: Any) -> Shown:
    """Recorded psi = psi + offset + cos cos(psi) + sin sin(psi); speeds are resolved along the recorded heading."""
    off = q.offset + q.cos * cos(m.psi) + q.sin * sin(m.psi)
    rate = (q.sin * cos(m.psi) - q.cos * sin(m.psi)) * m.r
    c, s = cos(off), sin(off)
    return Shown(
        m.x,
        m.y,
        m.z,
        m.phi,
        m.theta,
        m.psi + off,
        c * m.u + s * m.v,
        c * m.v - s * m.u,
        m.w,
        m.p,
        m.q,
        m.r + rate,
    )


@dataclass(frozen=True)
class HeadingDeviation(Measurement):
    """Semicircular deviation of a compass, from iron or current-carrying wires aboard."""

    of_columns: ClassVar = ("psi_rad",)
    needs: ClassVar = ("surge", "yaw")
    words: ClassVar[str] = "the compass deviates with the heading (not physics)"
    shown_by: ClassVar[str] = "straight runs on four headings, or a slow full turn"
    source: ClassVar[str] = (
        "coefficients B and C of the classical deviation formula (Archibald Smith)"
    )
    shown: ClassVar = shown

    cos: float = param(
        0.0, low=-0.6, high=0.6, unit="rad", words="error heading north", fit=True, spread=0.1
    )
    sin: float = param(
        0.0, low=-0.6, high=0.6, unit="rad", words="error heading east", fit=True, spread=0.1
    )
    offset: float = param(0.0, low=-1.0, high=1.0, unit="rad", words="on every heading")


HeadingOffset = preset(
    HeadingDeviation,
    "HeadingOffset",
    words="the recorded heading is off by a constant angle (not physics)",
    shown_by="a straight run ahead followed by one astern",
    source="compass or marker mounted askew, declination not applied",
    frees={"offset": {"words": "heading off by", "spread": 0.1}},
    fixed={"cos": 0.0, "sin": 0.0},
)
