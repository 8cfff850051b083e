"""Course keeping in waves: rms of yaw, roll and rudder angle."""

from dataclasses import dataclass
from math import degrees
from typing import ClassVar

import numpy as np

from boatsim.recordings.table import Recording
from boatsim.simulate.metric import MetricSet, rows_between


@dataclass(frozen=True)
class SeaKeeping(MetricSet):
    """Metric set of course keeping in waves: rms of yaw, roll and rudder angle.

    The root mean squares are about zero and over the whole run.
    """

    words: ClassVar[str] = "rms of yaw, roll and rudder angle in a seaway"
    units: ClassVar = {"yaw_rms": "deg", "roll_rms": "deg", "rudder_rms": "deg"}

    heading: str = "psi_rad"
    roll: str = "phi_rad"
    rudder: str = "rudder_rad"

    def values(self, log: Recording) -> dict[str, float]:
        """Return the rms of yaw, roll and rudder angle over a run, as far as the log has them."""
        rows_between(log)
        named = {"yaw_rms": self.heading, "roll_rms": self.roll, "rudder_rms": self.rudder}
        return {
            norm: rms_angle_deg(log, signal)
            for norm, signal in named.items()
            if signal in log.signals
        }


def rms_angle_deg(log: Recording, signal: str) -> float:
    """Return the root mean square of an angle over all rows of a log [deg].

    Args:
        log: Log of the run.
        signal: Column of the angle [rad].
    """
    return degrees(float(np.sqrt(np.mean(log[signal] ** 2))))
