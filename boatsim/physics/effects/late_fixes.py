"""Late fixes: positions that reach the log later than the headings beside them."""

from dataclasses import dataclass
from math import cos, sin
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Measurement, Shown, param


@njit(inline="always")
def shown(m: Shown, q: Any) -> Shown:
    """Where she was `latency` ago, in the turn that she is in; its chord is taken for its arc."""
    middle = m.psi - 0.5 * q.latency * m.r
    c, s = cos(middle), sin(middle)
    x, y = m.x - q.latency * (c * m.u - s * m.v), m.y - q.latency * (s * m.u + c * m.v)
    return Shown(x, y, m.z, m.phi, m.theta, m.psi, m.u, m.v, m.w, m.p, m.q, m.r)


@dataclass(frozen=True)
class LateFixes(Measurement):
    """A satellite receiver reports where it was; compass and rate gyro report at once.

    What the boat speeds up within the latency is left out: that part of a long one shows as a late command.
    """

    of_columns: ClassVar = ("x_m", "y_m")
    needs: ClassVar = ("surge", "sway", "yaw")
    ruled_out_by: ClassVar = {
        "position_fix": ("camera", "tracking")
    }  # one picture shows place and heading
    words: ClassVar[str] = (
        "recorded positions are older than the headings beside them (not physics)"
    )
    shown_by: ClassVar[str] = "sharp turns at full speed"
    source: ClassVar[str] = "kinematics: a steady turn over the delay"
    shown: ClassVar = shown

    latency: float = param(
        0.0,
        low=0.0,
        high=60.0,
        unit="s",
        words="positions older by",
        fit=True,
        spread=0.2,
        within=(0.0, 1.0),
    )
