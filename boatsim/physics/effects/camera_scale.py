"""Camera scale: a length in the recording is not that length in the tank."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Measurement, Shown, param


@njit(inline="always")
def shown(m: Shown, q: Any) -> Shown:
    """Recorded x = (1 + x_fraction) x about the origin of the tank, y alike."""
    return Shown(
        (1.0 + q.x_fraction) * m.x,
        (1.0 + q.y_fraction) * m.y,
        m.z,
        m.phi,
        m.theta,
        m.psi,
        m.u,
        m.v,
        m.w,
        m.p,
        m.q,
        m.r,
    )


@dataclass(frozen=True)
class CameraScale(Measurement):
    """Positions stretched along the axes of the tank."""

    of_columns: ClassVar = ("x_m", "y_m")
    ruled_out_by: ClassVar = {"position_fix": ("gnss", "inertial")}
    needs: ClassVar = ("surge", "sway")
    words: ClassVar[str] = (
        "the camera's length scale is off, so recorded positions are stretched (not physics)"
    )
    shown_by: ClassVar[str] = "the same straight run along x and along y"
    shown: ClassVar = shown

    x_fraction: float = param(
        0.0, low=-0.4, high=0.4, unit="", words="x off by", fit=True, spread=0.1
    )
    y_fraction: float = param(
        0.0, low=-0.4, high=0.4, unit="", words="y off by", fit=True, spread=0.1
    )
