"""Position frame error: the recorded position is that of another point of the hull."""

from dataclasses import dataclass
from math import cos, sin
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import MeasuredMotion, Measurement, param


@njit(inline="always")
def apply_measurement_error(m: MeasuredMotion, q: Any) -> MeasuredMotion:
    """Return the motion as recorded at another point of the hull, such as an antenna.

    Position and velocity are those of a point away from the mass centre.

    Args:
        m: True motion: position [m], attitude [rad], velocities [m/s], rates [rad/s].
        q: Parameters of the effect, with the names and units of its class.

    Returns:
        The recorded motion.
    """
    c, s = cos(m.psi), sin(m.psi)
    x, y = m.x + c * q.forward - s * q.starboard, m.y + s * q.forward + c * q.starboard
    return MeasuredMotion(
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
    """Lever arm between the reference point of the recording and the origin of the model.

    The reference point is that of an antenna or a marker.

    x_recorded = x + forward cos(psi) - starboard sin(psi)
    y_recorded = y + forward sin(psi) + starboard cos(psi)
    """

    formula: ClassVar[str] = (
        r"\begin{aligned} x_\mathrm{recorded} &= x + a \cos\psi - b \sin\psi, \quad "
        r"y_\mathrm{recorded} = y + a \sin\psi + b \cos\psi \\ u_\mathrm{recorded} &= u - "
        r"b r, \quad v_\mathrm{recorded} = v + a r \end{aligned}"
    )
    symbols: ClassVar = {"forward": "a", "starboard": "b"}
    of_columns: ClassVar = ("x_m", "y_m")
    needs: ClassVar = ("sway", "yaw")
    words: ClassVar[str] = "recorded positions are those of another point of the hull (not physics)"
    shown_by: ClassVar[str] = "turning on the spot"
    apply_measurement_error: ClassVar = apply_measurement_error

    forward: float = param(
        0.0,
        low=-400.0,
        high=400.0,
        unit="m",
        words="distance of the recorded point ahead of the origin",
        fit=True,
        spread=0.1,
    )
    starboard: float = param(
        0.0,
        low=-400.0,
        high=400.0,
        unit="m",
        words="distance of the recorded point to starboard",
        fit=True,
        spread=0.05,
    )
