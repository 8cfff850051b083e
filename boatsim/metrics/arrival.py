"""Arrival at a point: time, distance travelled, and the closest approach."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from boatsim.physics.base import Array, param
from boatsim.recordings.table import Recording
from boatsim.simulate.metric import MetricSet, first_crossing, rows_between, surge_distance


@dataclass(frozen=True)
class Arrival(MetricSet):
    """Metric set of a boat that travels to a point: time, distance and closest approach."""

    words: ClassVar[str] = "time and distance to a point, and the closest approach"
    units: ClassVar = {
        "time": "s",
        "distance": "m",
        "straight_line": "m",
        "closest": "m",
        "end_x": "m",
        "end_y": "m",
    }

    x: float = param(0.0, low=-1e6, high=1e6, unit="m", words="the point, in start axes")
    y: float = param(0.0, low=-1e6, high=1e6, unit="m", words="the point, in start axes")
    radius: float = param(
        2.5, low=0.0, high=1e4, unit="m", words="distance from the point that counts as arrival"
    )
    x_signal: str = "x_m"
    y_signal: str = "y_m"

    def explain_missing_value(self, metric: str, log: Recording) -> str:
        """Explain in words that a boat never arrived at its target point, and how close it came."""
        away = np.hypot(self.x - log[self.x_signal], self.y - log[self.y_signal])
        closest = "its position was not recorded"
        if np.isfinite(away).any():
            closest = f"closest {np.nanmin(away):.4g}"
        return f"never within {self.radius:.4g} m of the point: {closest}"

    def values(self, log: Recording) -> dict[str, float]:
        """Return the metrics of a boat's arrival at a target point, computed from the log of a run.

        They are the time until the arrival, the integral of the surge speed and the straight-line
        distance from the start up to the arrival, and the closest approach and the last position of
        the whole run.

        Args:
            log: Log of the run.
        """
        rows_between(log)
        x, y = log[self.x_signal], log[self.y_signal]
        away = np.hypot(self.x - x, self.y - y)
        found = {"closest": float(away.min()), "end_x": float(x[-1]), "end_y": float(y[-1])}
        time = first_crossing(log.t, self.radius - away)
        if time is None:
            return found
        return found | {"time": time} | self._travelled_distances(log, x, y, time)

    def _travelled_distances(
        self, log: Recording, x: Array, y: Array, time: float
    ) -> dict[str, float]:
        line = np.hypot(x - x[0], y - y[0])
        return {
            "distance": float(np.interp(time, log.t, surge_distance(log))),
            "straight_line": float(np.interp(time, log.t, line)),
        }
