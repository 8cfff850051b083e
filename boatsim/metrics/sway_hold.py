"""Sway with constant heading: yaw rate, heading change, and the steering angle found."""

from dataclasses import dataclass
from math import sqrt
from typing import ClassVar

import numpy as np

from boatsim.recordings.table import Recording
from boatsim.simulate.metric import MetricSet, rows_between


@dataclass(frozen=True)
class SwayHold(MetricSet):
    """Evaluates a boat that moves sideways without turning; its second half counts as settled."""

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
        """Return extremes of the run, and rms yaw rate and mean angle of its second half."""
        rows_between(log)
        last = log.t >= 0.5 * (log.t[0] + log.t[-1])
        r, psi = np.degrees(log["r_radps"]), np.degrees(log["psi_rad"] - log["psi_rad"][0])
        return {
            "peak_yaw_rate": float(np.abs(r).max()),
            "rest_yaw_rate": sqrt(float(np.mean(r[last] ** 2))),
            "heading": float(np.abs(psi).max()),
            "steering": float(np.degrees(log[self.angle][last]).mean()),
        }
