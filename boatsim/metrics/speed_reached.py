"""Time and distance in which a boat reaches a surge speed."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from boatsim.physics.base import param
from boatsim.recordings.table import Recording
from boatsim.simulate.metric import (
    MetricSet,
    describe_closest_value,
    first_crossing,
    rows_between,
    surge_distance,
)


@dataclass(frozen=True)
class SpeedReached(MetricSet):
    """Metric set of an acceleration: time and distance until a target surge speed is reached."""

    words: ClassVar[str] = "time and distance to a surge speed, and the top speed"
    units: ClassVar = {"time": "s", "distance": "m", "straight_line": "m", "top_speed": "m/s"}

    speed: float = param(1.0, low=0.0, high=100.0, unit="m/s", words="target surge speed")

    def explain_missing_value(self, metric: str, log: Recording) -> str:
        """Explain in words that a boat never reached its target speed, and how close it came."""
        return describe_closest_value(log["u_mps"], self.speed, "m/s")

    def values(self, log: Recording) -> dict[str, float]:
        """Return the metrics of an acceleration to a target surge speed, computed from a log.

        They are the time until the speed is reached, the integral of the surge speed and the
        straight-line distance up to then, and the top speed of the whole run.
        """
        rows_between(log)
        found, u = {"top_speed": float(log["u_mps"].max())}, log["u_mps"]
        time = first_crossing(log.t, u - self.speed)
        if time is None:
            return found
        line = np.hypot(log["x_m"] - log["x_m"][0], log["y_m"] - log["y_m"][0])
        return found | {
            "time": time,
            "distance": float(np.interp(time, log.t, surge_distance(log))),
            "straight_line": float(np.interp(time, log.t, line)),
        }
