"""Activity of a command channel: its largest value and the rms of its rate."""

from dataclasses import dataclass
from math import degrees
from typing import ClassVar

import numpy as np

from boatsim.physics.base import param
from boatsim.recordings.notes import unit_of
from boatsim.recordings.table import Recording
from boatsim.simulate.metric import MetricSet, rows_between


@dataclass(frozen=True)
class Activity(MetricSet):
    """Metric set of a command channel: its largest absolute value and the rms of its rate.

    Rows of the log from the time `since` on are evaluated. The rate is the difference between
    successive rows, so a coarse log lowers it.
    """

    words: ClassVar[str] = "largest value of a command and rms of its rate"
    units: ClassVar = {"peak": "", "rate_rms": ""}

    signal: str = "jet_rad"
    since: float = param(0.0, low=0.0, high=1e6, unit="s", words="start of the evaluated interval")

    def unit(self, metric: str) -> str:
        """Return the unit of a metric of a command channel.

        The largest value has the unit of the command, with degrees for angles, and the rms rate has
        that unit per second.
        """
        own = unit_of(self.signal).replace("rad", "deg")
        return own if metric == "peak" else f"{own or '1'}/s"

    def values(self, log: Recording) -> dict[str, float]:
        """Return the largest absolute value of a command in a log and the rms of its rate."""
        rows = rows_between(log, self.since, least=2)
        y = (degrees(1.0) if unit_of(self.signal) == "rad" else 1.0) * log[self.signal][rows]
        rate = np.diff(y) / np.diff(log.t[rows])
        return {"peak": float(np.abs(y).max()), "rate_rms": float(np.sqrt(np.mean(rate**2)))}
