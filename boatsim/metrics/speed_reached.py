"""How soon, and after what way, a boat has reached a speed ahead."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from boatsim.physics.base import param
from boatsim.recordings.table import Recording
from boatsim.simulate.metric import (
    MetricSet,
    first_crossing,
    rows_between,
    surge_distance,
    why_not_reached,
)


@dataclass(frozen=True)
class SpeedReached(MetricSet):
    """For a boat that starts slower than the speed asked for."""

    words: ClassVar[str] = "time and way to a speed ahead, and the largest speed"
    units: ClassVar = {"time": "s", "distance": "m", "straight_line": "m", "top_speed": "m/s"}

    speed: float = param(1.0, low=0.0, high=100.0, unit="m/s", words="surge speed asked for")

    def why(self, metric: str, log: Recording) -> str:
        """How fast it was."""
        return why_not_reached(log["u_mps"], self.speed, "m/s")

    def values(self, log: Recording) -> dict[str, float]:
        """Time, integral of the surge speed and straight line until then; the largest surge speed of the run."""
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
