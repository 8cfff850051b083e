"""Tracking: how far a signal is from the one it is to follow."""

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
    """From `since` to `until`. `reference` is another signal of the log; without one the reference is 0."""

    words: ClassVar[str] = "rms and largest error of a signal against its reference"
    units: ClassVar = {"rms": "", "max": "", "rms_goal": "", "goal_error": ""}

    signal: str = "psi_rad"
    reference: str = ""
    goal: str = ""  # a second reference: what the first one follows itself
    since: float = param(0.0, low=0.0, high=1e6, unit="s", words="beginning of what is looked at")
    until: float = param(0.0, low=0.0, high=1e6, unit="s", words="its end; 0: that of the log")

    def unit(self, metric: str) -> str:
        """That of the signal, angles in degrees."""
        return unit_of(self.signal).replace("rad", "deg")

    def why(self, metric: str, log: Recording) -> str:
        """Norms against a goal need one."""
        return "" if self.goal else "the measure names no goal"

    def values(self, log: Recording) -> dict[str, float]:
        """Rms and largest error; rms of the error against the goal, and that error's mean over the last second."""
        rows = rows_between(log, self.since, self.until or inf)
        scale = degrees(1.0) if unit_of(self.signal).startswith("rad") else 1.0

        def error(name: str) -> Array:
            return np.asarray(scale * (log[self.signal] - (log[name] if name else 0.0))[rows])

        off = error(self.reference)
        found = {"rms": float(np.sqrt(np.mean(off**2))), "max": float(np.abs(off).max())}
        if self.goal:
            off = error(self.goal)
            late = log.t[rows] > log.t[rows][-1] - 1.0
            found |= {
                "rms_goal": float(np.sqrt(np.mean(off**2))),
                "goal_error": float(np.mean(off[late])),
            }
        return found
