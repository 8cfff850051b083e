"""Clock rate: the clock of the log runs too fast or too slowly, which velocities and poses show."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import MeasuredMotion, Measurement, param
from boatsim.physics.recorded_channels import P, Q, R, U, V, W, with_channel


@njit(inline="always")
def apply_measurement_error(m: MeasuredMotion, q: Any) -> MeasuredMotion:
    """Return the motion as recorded by rows whose clock has a wrong rate.

    The motion is that by the clock of the rows: velocities are the rates of the recorded poses. The
    sensors of the velocities do not depend on this clock, so that they differ by its rate.

    Args:
        m: Motion by the clock of the rows: position [m], attitude [rad], velocities, rates.
        q: Parameters of the effect, with the names and units of its class.

    Returns:
        The recorded motion.
    """
    share = 1.0 / (1.0 + q.fraction)
    m = with_channel(with_channel(m, U, share * m.u), V, share * m.v)
    m = with_channel(with_channel(m, W, share * m.w), P, share * m.p)
    return with_channel(with_channel(m, Q, share * m.q), R, share * m.r)


@dataclass(frozen=True)
class ClockRate(Measurement):
    """Constant error of the rate of the clock by which the rows of a log are stamped.

    A recorded second lasts 1 + fraction true seconds. All recorded velocities and rates of turn are
    then smaller than the rates of change of the recorded poses, by the same factor. A single sensor
    with a wrong gain changes one of them. A clock that wanders is found by the checks of the log
    (`clock_wanders`).
    """

    formula: ClassVar[str] = r"\nu_\mathrm{recorded} = \frac{1}{1 + \epsilon} \, \nu"
    symbols: ClassVar = {"fraction": r"\epsilon"}
    of_columns: ClassVar = ("u_mps", "v_mps", "r_radps")
    needs_columns: ClassVar = ("u_mps", "r_radps")
    needs: ClassVar = ("surge", "yaw")
    words: ClassVar[str] = "the clock of the log runs at a wrong rate (not physics)"
    shown_by: ClassVar[str] = "turns at a steady speed"
    source: ClassVar[str] = "kinematics: velocities are rates of change of the pose"
    apply_measurement_error: ClassVar = apply_measurement_error

    fraction: float = param(
        0.0,
        low=-0.5,
        high=2.0,
        unit="",
        words="true seconds per recorded second, minus one",
        fit=True,
        spread=0.05,
        in_per_cent="a second of the log lasts {more} than a true second",
    )
