"""Late fixes: recorded positions are older than the headings in the same row."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import MeasuredMotion, Measurement, param
from boatsim.physics.recorded_channels import X, Y, delayed_channel, with_channel


@njit(inline="always")
def apply_measurement_error(m: MeasuredMotion, q: Any) -> MeasuredMotion:
    """Return the motion as recorded with position fixes that are older than the headings.

    The position is that of the time `latency` earlier, assuming a steady turn whose chord stands
    for its arc.

    Args:
        m: True motion: position [m], attitude [rad], velocities [m/s], rates [rad/s].
        q: Parameters of the effect, with the names and units of its class.

    Returns:
        The recorded motion.
    """
    x, y = delayed_channel(m, X, q.latency), delayed_channel(m, Y, q.latency)
    return with_channel(with_channel(m, X, x), Y, y)


@dataclass(frozen=True)
class LateFixes(Measurement):
    """Latency of the positions of a satellite receiver behind compass and rate gyro.

    x_recorded = x - latency (u cos(psi_m) - v sin(psi_m)),  psi_m = psi - 0.5 latency r

    and y likewise: the delay of a `sensor_error` of x and of y. Acceleration within the latency is
    neglected; that part of a long latency appears as a delayed command.
    """

    formula: ClassVar[str] = (
        r"\begin{aligned} x_\mathrm{recorded} &= x - \tau \left(u \cos\psi_m - v "
        r"\sin\psi_m\right) \\ y_\mathrm{recorded} &= y - \tau \left(u \sin\psi_m + v "
        r"\cos\psi_m\right), \quad \psi_m = \psi - \tfrac{1}{2} \tau r \end{aligned}"
    )
    symbols: ClassVar = {"latency": r"\tau"}
    of_columns: ClassVar = ("x_m", "y_m")
    needs: ClassVar = ("surge", "sway", "yaw")
    # one camera image gives position and heading at the same time
    ruled_out_by: ClassVar = {"position_fix": ("camera", "tracking")}
    words: ClassVar[str] = (
        "recorded positions are older than the headings in the same row (not physics)"
    )
    shown_by: ClassVar[str] = "sharp turns at full speed"
    source: ClassVar[str] = "kinematics: a steady turn over the delay"
    apply_measurement_error: ClassVar = apply_measurement_error

    latency: float = param(
        0.0,
        low=0.0,
        high=60.0,
        unit="s",
        words="latency of the positions",
        fit=True,
        spread=0.2,
        within=(0.0, 1.0),
    )
