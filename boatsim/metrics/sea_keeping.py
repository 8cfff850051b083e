"""Keeping a course in waves: how much the ship yaws and rolls, and how hard its rudder works for that."""

from dataclasses import dataclass
from math import degrees
from typing import ClassVar

import numpy as np

from boatsim.recordings.table import Recording
from boatsim.simulate.metric import MetricSet, rows_between


@dataclass(frozen=True)
class SeaKeeping(MetricSet):
    """Root mean squares over the whole run, about zero: what a course keeper is to hold."""

    words: ClassVar[str] = "rms of yaw, roll and rudder angle in a seaway"
    units: ClassVar = {"yaw_rms": "deg", "roll_rms": "deg", "rudder_rms": "deg"}

    heading: str = "psi_rad"
    roll: str = "phi_rad"
    rudder: str = "rudder_rad"

    def values(self, log: Recording) -> dict[str, float]:
        """The three norms; a signal that the log has not is left out."""
        rows_between(log)
        named = {"yaw_rms": self.heading, "roll_rms": self.roll, "rudder_rms": self.rudder}
        return {
            metric: rms(log, signal) for metric, signal in named.items() if signal in log.signals
        }


def rms(log: Recording, signal: str) -> float:
    """Root mean square of an angle [deg]."""
    return degrees(float(np.sqrt(np.mean(log[signal] ** 2))))
