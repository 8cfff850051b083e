"""Course keeping in waves: rms of yaw, roll and rudder angle."""

from dataclasses import dataclass
from math import degrees
from typing import ClassVar

import numpy as np

from boatsim.recordings.table import Recording
from boatsim.simulate.metric import MetricSet, rows_between


@dataclass(frozen=True)
class SeaKeeping(MetricSet):
    """Evaluates root mean squares about zero over the whole run."""

    words: ClassVar[str] = "rms of yaw, roll and rudder angle in a seaway"
    units: ClassVar = {"yaw_rms": "deg", "roll_rms": "deg", "rudder_rms": "deg"}

    heading: str = "psi_rad"
    roll: str = "phi_rad"
    rudder: str = "rudder_rad"

    def values(self, log: Recording) -> dict[str, float]:
        """Return the rms of each signal that the log holds."""
        rows_between(log)
        named = {"yaw_rms": self.heading, "roll_rms": self.roll, "rudder_rms": self.rudder}
        return {norm: rms(log, signal) for norm, signal in named.items() if signal in log.signals}


def rms(log: Recording, signal: str) -> float:
    """Return the root mean square of an angle [deg].

    Args:
        log: Log of the run.
        signal: Column of the angle [rad].
    """
    return degrees(float(np.sqrt(np.mean(log[signal] ** 2))))
