"""Camera scale: recorded positions are stretched along the axes of the tank."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import MeasuredMotion, Measurement, param
from boatsim.physics.recorded_channels import X, Y, with_channel


@njit(inline="always")
def apply_measurement_error(m: MeasuredMotion, q: Any) -> MeasuredMotion:
    """Return the motion as a camera records it whose scale is wrong along two axes.

    The position is scaled by one factor in x and one in y.

    Args:
        m: True motion: position [m], attitude [rad], velocities [m/s], rates [rad/s].
        q: Parameters of the effect, with the names and units of its class.

    Returns:
        The recorded motion.
    """
    scaled = with_channel(m, X, (1.0 + q.x_fraction) * m.x)
    return with_channel(scaled, Y, (1.0 + q.y_fraction) * m.y)


@dataclass(frozen=True)
class CameraScale(Measurement):
    """Scale error of a camera in each axis of the tank: a `sensor_error` of x and one of y.

    x_recorded = (1 + x_fraction) x,  y_recorded = (1 + y_fraction) y
    """

    formula: ClassVar[str] = (
        r"x_\mathrm{recorded} = (1 + \epsilon_x) \, x, \quad y_\mathrm{recorded} = (1 + "
        r"\epsilon_y) \, y"
    )
    symbols: ClassVar = {"x_fraction": r"\epsilon_x", "y_fraction": r"\epsilon_y"}
    of_columns: ClassVar = ("x_m", "y_m")
    ruled_out_by: ClassVar = {"position_fix": ("gnss", "inertial")}
    needs: ClassVar = ("surge", "sway")
    words: ClassVar[str] = (
        "the length scale of the camera is wrong, so recorded positions are stretched (not physics)"
    )
    shown_by: ClassVar[str] = "the same straight run along x and along y"
    apply_measurement_error: ClassVar = apply_measurement_error

    x_fraction: float = param(
        0.0,
        low=-0.4,
        high=0.4,
        unit="",
        words="relative scale error in x",
        fit=True,
        spread=0.1,
        in_per_cent="distances along x are recorded {larger} than they are",
    )
    y_fraction: float = param(
        0.0,
        low=-0.4,
        high=0.4,
        unit="",
        words="relative scale error in y",
        fit=True,
        spread=0.1,
        in_per_cent="distances along y are recorded {larger} than they are",
    )
