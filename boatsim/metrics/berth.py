"""Return to a berth after half a turn: final distance and heading error, and wall contacts."""

from dataclasses import dataclass
from math import degrees, hypot, pi
from typing import ClassVar

import numpy as np

from boatsim.control.base import wrap
from boatsim.recordings.table import Recording
from boatsim.simulate.metric import MetricSet, rows_between


@dataclass(frozen=True)
class Berth(MetricSet):
    """Metric set of a boat that turns by 180 degrees and returns to its first position."""

    words: ClassVar[str] = (
        "final distance and heading error of a return to the berth after half a turn"
    )
    units: ClassVar = {"return_distance": "m", "return_heading": "deg", "wall_contacts": ""}

    def values(self, log: Recording) -> dict[str, float]:
        """Return how well a boat returned to its berth, computed from the log of a run.

        The metrics are the final distance of the CG from its first position, the error of the final
        heading against a turn of 180 degrees, and the number of rows in which the hull touches a
        wall.
        """
        rows_between(log)
        x, y, psi = (log[name][-1] - log[name][0] for name in ("x_m", "y_m", "psi_rad"))
        return {
            "return_distance": hypot(x, y),
            "return_heading": abs(degrees(wrap(psi - pi))),
            "wall_contacts": float(np.count_nonzero(log["contacts"])),
        }
