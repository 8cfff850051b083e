"""Return to a berth the other way round: how far from the first place, on what other heading."""

from dataclasses import dataclass
from math import degrees, hypot, pi
from typing import ClassVar

import numpy as np

from boatsim.control.base import wrap
from boatsim.recordings.table import Recording
from boatsim.simulate.metric import MetricSet, rows_between


@dataclass(frozen=True)
class Berth(MetricSet):
    """For a boat that is to turn half round and come back."""

    words: ClassVar[str] = "distance and heading of a return to the berth, the other way round"
    units: ClassVar = {"return_distance": "m", "return_heading": "deg", "wall_contacts": ""}

    def values(self, log: Recording) -> dict[str, float]:
        """Distance of the CG from its first place, heading beside the half turn, steps with the hull at a wall."""
        rows_between(log)
        x, y, psi = (log[name][-1] - log[name][0] for name in ("x_m", "y_m", "psi_rad"))
        return {
            "return_distance": hypot(x, y),
            "return_heading": abs(degrees(wrap(psi - pi))),
            "wall_contacts": float(np.count_nonzero(log["contacts"])),
        }
