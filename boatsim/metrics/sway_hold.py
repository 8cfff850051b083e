"""Sway with constant heading: yaw rate, heading change, and the steering angle found."""

from dataclasses import dataclass
from math import sqrt
from typing import ClassVar

import numpy as np

from boatsim.recordings.table import Recording
from boatsim.simulate.metric import MetricSet, rows_between


@dataclass(frozen=True)
class SwayHold(MetricSet):
    """Metric set of a boat that shall move sideways without turning, computed from the log.

    The second half of the run counts as settled.
    """

    words: ClassVar[str] = (
        "yaw rate and heading during a sway, and the neutral steering angle found"
    )
    units: ClassVar = {
        "peak_yaw_rate": "deg/s",
        "rest_yaw_rate": "deg/s",
        "heading": "deg",
        "steering": "deg",
    }

    angle: str = "steer_port_rad"

    def values(self, log: Recording) -> dict[str, float]:
        """Return yaw rates, heading change and steering angle of a boat that moves sideways.

        The largest yaw rate and heading change are those of the whole run. The rms yaw rate and the
        mean steering angle are those of its second half.
        """
        rows_between(log)
        last = log.t >= 0.5 * (log.t[0] + log.t[-1])
        r, psi = np.degrees(log["r_radps"]), np.degrees(log["psi_rad"] - log["psi_rad"][0])
        return {
            "peak_yaw_rate": float(np.abs(r).max()),
            "rest_yaw_rate": sqrt(float(np.mean(r[last] ** 2))),
            "heading": float(np.abs(psi).max()),
            "steering": float(np.degrees(log[self.angle][last]).mean()),
        }
