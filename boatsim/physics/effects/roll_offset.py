"""Roll offset: zero error of the roll sensor."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import MeasuredMotion, Measurement, param
from boatsim.physics.recorded_channels import PHI, with_channel


@njit(inline="always")
def apply_measurement_error(m: MeasuredMotion, q: Any) -> MeasuredMotion:
    """Return the motion as recorded by a roll sensor with a constant error.

    Args:
        m: True motion: position [m], attitude [rad], velocities [m/s], rates [rad/s].
        q: Parameters of the effect, with the names and units of its class.

    Returns:
        The recorded motion.
    """
    return with_channel(m, PHI, m.phi + q.offset)


@dataclass(frozen=True)
class RollOffset(Measurement):
    """Constant error of the recorded roll angle: phi_recorded = phi + offset.

    It is the offset of a `sensor_error` of roll.

    For a linear righting arm a constant heeling moment looks the same. A nonlinear righting arm
    differs, because it is symmetric about upright and not about the zero of the instrument.
    """

    formula: ClassVar[str] = r"\phi_\mathrm{recorded} = \phi + b"
    symbols: ClassVar = {"offset": "b"}
    of_columns: ClassVar = ("phi_rad",)
    needs: ClassVar = ("roll",)
    words: ClassVar[str] = "the recorded roll has a constant error (not physics)"
    shown_by: ClassVar[str] = "a roll decay from a large heel"
    source: ClassVar[str] = "sensor misaligned, or set to zero on a hull with a list"
    apply_measurement_error: ClassVar = apply_measurement_error

    offset: float = param(
        0.0,
        low=-0.5,
        high=0.5,
        unit="rad",
        words="constant error of the roll",
        fit=True,
        spread=0.05,
    )
