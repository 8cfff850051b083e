"""Course keeping: heading error and steering activity."""

from dataclasses import dataclass
from math import degrees
from typing import ClassVar

import numpy as np

from boatsim.physics.base import param
from boatsim.recordings.table import Recording
from boatsim.simulate.metric import MetricSet, rows_between


@dataclass(frozen=True)
class HeadingHold(MetricSet):
    """Metric set of course keeping: errors of the heading against a target, and steering activity.

    Rows of the log from the time `since` on are evaluated.
    """

    words: ClassVar[str] = (
        "mean, rms and largest heading error, rms of steering angle and of its rate"
    )
    units: ClassVar = {
        "psi_mean": "deg",
        "psi_rms": "deg",
        "psi_max": "deg",
        "steering_mean": "deg",
        "steering_rms": "deg",
        "steering_rate_rms": "deg/s",
    }

    # command channel
    steering: str = "delta_rad"
    target: float = param(0.0, low=-100.0, high=100.0, unit="rad", words="heading to hold")
    since: float = param(0.0, low=0.0, high=1e6, unit="s", words="start of the evaluated interval")

    def values(self, log: Recording) -> dict[str, float]:
        """Return heading errors (mean, rms, largest) and steering (mean, rms, rms rate) of a log.

        The rms of the heading and of the steering angle are about their means. Rates are central
        differences of the rows of the log.
        """
        rows = rows_between(log, self.since, least=2)
        off, angle = log["psi_rad"][rows] - self.target, log[self.steering][rows]
        rate = np.gradient(angle, log.t[rows])
        found = (
            off.mean(),
            off.std(),
            abs(off).max(),
            angle.mean(),
            angle.std(),
            np.sqrt(np.mean(rate**2)),
        )
        return {name: degrees(x) for name, x in zip(type(self).units, found, strict=True)}
