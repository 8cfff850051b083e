"""Position frame error: the recorded position is that of another point of the hull."""

from dataclasses import dataclass
from math import cos, sin
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Measurement, Shown, param


@njit(inline="always")
def shown(m: Shown, q: Any) -> Shown:
    """Position and speed of a point `forward` and `starboard` of the mass centre."""
    c, s = cos(m.psi), sin(m.psi)
    x, y = m.x + c * q.forward - s * q.starboard, m.y + s * q.forward + c * q.starboard
    return Shown(
        x,
        y,
        m.z,
        m.phi,
        m.theta,
        m.psi,
        m.u - m.r * q.starboard,
        m.v + m.r * q.forward,
        m.w,
        m.p,
        m.q,
        m.r,
    )


@dataclass(frozen=True)
class PositionFrameError(Measurement):
    """Lever arm: antenna, marker or origin of the recording away from where the model has its origin."""

    of_columns: ClassVar = ("x_m", "y_m")
    needs: ClassVar = ("sway", "yaw")
    words: ClassVar[str] = "recorded positions are those of another point of the hull (not physics)"
    shown_by: ClassVar[str] = "turning on the spot"
    shown: ClassVar = shown

    forward: float = param(
        0.0, low=-400.0, high=400.0, unit="m", words="ahead by", fit=True, spread=0.1
    )
    starboard: float = param(
        0.0, low=-400.0, high=400.0, unit="m", words="to starboard by", fit=True, spread=0.05
    )
