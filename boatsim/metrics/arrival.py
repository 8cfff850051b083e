"""Arrival at a point: when, after what way, and how close a boat came that never got there."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from boatsim.physics.base import Array, param
from boatsim.recordings.table import Recording
from boatsim.simulate.metric import MetricSet, first_crossing, rows_between, surge_distance


@dataclass(frozen=True)
class Arrival(MetricSet):
    """For a boat on its way to one point."""

    words: ClassVar[str] = "time and way to a point, or how close a boat came"
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
    radius: float = param(2.5, low=0.0, high=1e4, unit="m", words="this close is there")
    x_signal: str = "x_m"
    y_signal: str = "y_m"

    def why(self, metric: str, log: Recording) -> str:
        """How close it came."""
        away = np.hypot(self.x - log[self.x_signal], self.y - log[self.y_signal])
        closest = (
            f"closest {np.nanmin(away):.4g}"
            if np.isfinite(away).any()
            else "its place was not recorded"
        )
        return f"never within {self.radius:.4g} m of the point: {closest}"

    def values(self, log: Recording) -> dict[str, float]:
        """Time, integral of the surge speed and straight line until there; closest and last place of the whole run."""
        rows_between(log)
        x, y = log[self.x_signal], log[self.y_signal]
        away = np.hypot(self.x - x, self.y - y)
        found = {"closest": float(away.min()), "end_x": float(x[-1]), "end_y": float(y[-1])}
        time = first_crossing(log.t, self.radius - away)
        return found if time is None else found | {"time": time} | self._way(log, x, y, time)

    def _way(self, log: Recording, x: Array, y: Array, time: float) -> dict[str, float]:
        line = np.hypot(x - x[0], y - y[0])
        return {
            "distance": float(np.interp(time, log.t, surge_distance(log))),
            "straight_line": float(np.interp(time, log.t, line)),
        }
