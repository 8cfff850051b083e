"""Staircase: responses to a sequence of equal steps, with metrics for each step."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from boatsim.metrics.step_response import rise_time, time_to_fraction
from boatsim.physics.base import param
from boatsim.recordings.notes import unit_of
from boatsim.recordings.table import Recording
from boatsim.simulate.metric import MetricSet, TooShort, rows_between

MOST_STEPS = 8


@dataclass(frozen=True)
class Staircase(MetricSet):
    """Metric set of a signal that shall follow a staircase of equal steps; each step has metrics.

    The steps have the height `height` and begin every `every` seconds, the first at the time
    `since` from the value `bottom`. Each step is measured from the nominal end of the previous one.
    """

    words: ClassVar[str] = (
        "time to 95 %, rise time, largest overshoot and end error of the steps of a staircase"
    )
    units: ClassVar = {
        f"{what}_{i}": "s" for what in ("time_95", "rise") for i in range(1, MOST_STEPS + 1)
    } | {
        "overshoot": "",
        "end_error": "",
    }

    signal: str = "u_mps"
    bottom: float = param(
        0.0, low=-1e9, high=1e9, unit="", words="value before the first step, in the signal's unit"
    )
    height: float = param(
        1.0, low=-1e9, high=1e9, unit="", words="height of each step, in the signal's unit"
    )
    since: float = param(0.0, low=0.0, high=1e6, unit="s", words="time of the first step")
    every: float = param(10.0, low=1e-3, high=1e6, unit="s", words="time between two steps")

    def unit(self, metric: str) -> str:
        """Return the unit of a metric of a staircase: s for times, the signal's unit for errors."""
        return self.units[metric] or unit_of(self.signal)

    def explain_missing_value(self, metric: str, log: Recording) -> str:
        """Explain in words why a staircase step lacks a metric, with the percentage it reached.

        The reason may also be that the run ends before the step is over or that nothing was
        recorded.
        """
        number = int(metric.rpartition("_")[2]) if metric[-1].isdigit() else 1
        begin = self.since + (number - 1) * self.every
        rows = (log.t >= begin - 1e-9) & (log.t < begin + self.every - 1e-9)
        if log.t[-1] + 1e-6 * self.every < begin + self.every:
            return f"the run ends at {log.t[-1]:.4g} s, before step {number} is over"
        done = (log[self.signal][rows] - self.bottom) / self.height - (number - 1)
        if not np.isfinite(done).any():
            return f"nothing was recorded of step {number}"
        done = done[np.isfinite(done)]
        return f"made at most {100.0 * done.max():.3g} % of step {number}"

    def values(self, log: Recording) -> dict[str, float]:
        """Return response times of the steps of a staircase, worst overshoot and worst end error.

        Only complete steps count. Times that a step does not reach are missing.
        """
        rows_between(log, self.since)
        count = min(MOST_STEPS, int((log.t[-1] - self.since) / self.every + 1e-6))
        if count < 1:
            return {}
        found: dict[str, float | None] = {}
        worst = {"overshoot": 0.0, "end_error": 0.0}
        for i in range(count):
            begin = self.since + i * self.every
            rows = (log.t >= begin - 1e-9) & (log.t < begin + self.every - 1e-9)
            if not rows.any():
                raise TooShort(f"{log.name}: no rows from {begin:g} s on")
            t, done = log.t[rows] - begin, (log[self.signal][rows] - self.bottom) / self.height - i
            found[f"time_95_{i + 1}"] = time_to_fraction(t, done, 0.95)
            found[f"rise_{i + 1}"] = rise_time(t, done)
            worst["overshoot"] = max(worst["overshoot"], float(done.max() - 1.0) * abs(self.height))
            worst["end_error"] = max(worst["end_error"], abs(float(done[-1] - 1.0) * self.height))
        return {name: value for name, value in (found | worst).items() if value is not None}
