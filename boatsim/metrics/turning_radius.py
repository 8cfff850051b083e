"""Radius of a turn under thrust, from speed and yaw rate and from the width of the track."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from boatsim.recordings.table import Recording
from boatsim.simulate.metric import MetricSet


@dataclass(frozen=True)
class TurningRadius(MetricSet):
    """Metric set of the radius of a turn, evaluated while a signal such as thrust is not zero."""

    words: ClassVar[str] = "radius of the tightest turn"
    units: ClassVar = {"radius": "m", "half_width": "m", "time": "s"}

    while_on: str = "thrust_N"  # signal that is not zero during the turn

    def explain_missing_value(self, metric: str, log: Recording) -> str:
        """Explain in words why there is no turn to measure: no thrust, or no rate of turn."""
        return f"{self.while_on} is always zero, or the boat does not turn"

    def values(self, log: Recording) -> dict[str, float]:
        """Return radius, half width and end time of a turn, computed from the log of a run.

        The radius is the median of speed over yaw rate; the half width is half the extent of the
        track in y.
        """
        on = (log[self.while_on] != 0.0) & (log["r_radps"] != 0.0)
        if not on.any():
            return {}
        speed, y = np.hypot(log["u_mps"][on], log["v_mps"][on]), log["y_m"][on]
        return {
            "radius": float(np.median(speed / np.abs(log["r_radps"][on]))),
            "half_width": float(0.5 * np.ptp(y)),
            "time": float(log.t[on][-1]),
        }
