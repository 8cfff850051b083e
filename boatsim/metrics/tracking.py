"""Tracking error of a signal against its reference."""

from dataclasses import dataclass
from math import degrees, inf
from typing import ClassVar

import numpy as np

from boatsim.physics.base import Array, param
from boatsim.recordings.notes import unit_of
from boatsim.recordings.table import Recording
from boatsim.simulate.metric import MetricSet, rows_between


@dataclass(frozen=True)
class Tracking(MetricSet):
    """Metric set of the error between a signal and its reference, which is another signal or zero.

    Rows of the log from the time `since` to `until` are evaluated.
    """

    words: ClassVar[str] = "rms and largest error of a signal against its reference"
    units: ClassVar = {"rms": "", "max": "", "rms_goal": "", "goal_error": ""}

    signal: str = "psi_rad"
    reference: str = ""
    # a second reference, which the first one follows
    goal: str = ""
    since: float = param(0.0, low=0.0, high=1e6, unit="s", words="start of the evaluated interval")
    until: float = param(
        0.0, low=0.0, high=1e6, unit="s", words="end of the evaluated interval; 0: end of the log"
    )

    def unit(self, metric: str) -> str:
        """Return the unit of a tracking error: that of the signal, with degrees for angles."""
        return unit_of(self.signal).replace("rad", "deg")

    def explain_missing_value(self, metric: str, log: Recording) -> str:
        """Explain in words that a metric set has no goal, so no error; "" if it has one."""
        return "" if self.goal else "the measure names no goal"

    def values(self, log: Recording) -> dict[str, float]:
        """Return rms and largest error of a signal against its reference in the log of a run.

        If a goal is specified, the rms error against the goal and the mean error of the last second
        are returned too.
        """
        rows = rows_between(log, self.since, self.until or inf)
        scale = degrees(1.0) if unit_of(self.signal).startswith("rad") else 1.0

        def error_from_reference(name: str) -> Array:
            return np.asarray(scale * (log[self.signal] - (log[name] if name else 0.0))[rows])

        off = error_from_reference(self.reference)
        found = {"rms": float(np.sqrt(np.mean(off**2))), "max": float(np.abs(off).max())}
        if self.goal:
            off = error_from_reference(self.goal)
            late = log.t[rows] > log.t[rows][-1] - 1.0
            found |= {
                "rms_goal": float(np.sqrt(np.mean(off**2))),
                "goal_error": float(np.mean(off[late])),
            }
        return found
