"""Path following: cross-track error and speed."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from boatsim.errors import BadInput
from boatsim.physics.base import Array, param
from boatsim.recordings.table import Recording
from boatsim.simulate.metric import MetricSet, rows_between

# the foot point on the path, as path-following controllers log it
FOOT_POINT = ("reference_x_m", "reference_y_m", "reference_course_rad")


@dataclass(frozen=True)
class PathFollowing(MetricSet):
    """Metric set of a vessel that follows a path, whose foot point its controller logs.

    Rows from the time `since` on are evaluated. The cross-track error is that of the true position,
    positive to starboard of the path.
    """

    words: ClassVar[str] = (
        "rms and largest cross-track error of a path, that at the end, and the speed"
    )
    units: ClassVar = {
        "cross_track_rms": "m",
        "cross_track_max": "m",
        "cross_track_end": "m",
        "speed_mean": "m/s",
        "speed_end": "m/s",
    }

    since: float = param(0.0, low=0.0, high=1e6, unit="s", words="start of the evaluated interval")

    def values(self, log: Recording) -> dict[str, float]:
        """Return cross-track errors and speeds over ground.

        Args:
            log: Log of the run.

        Raises:
            BadInput: The controller logs no foot point.
        """
        for name in FOOT_POINT:
            if name not in log.signals:
                raise BadInput(
                    f"path_following needs the column {name}, which controllers that follow a "
                    "path log (los, dock)"
                )
        rows = rows_between(log, self.since, least=2)
        errors = cross_track_errors(log)[rows]
        speeds = np.hypot(log["u_mps"], log["v_mps"])[rows]
        return {
            "cross_track_rms": float(np.sqrt(np.mean(errors**2))),
            "cross_track_max": float(np.abs(errors).max()),
            "cross_track_end": float(errors[-1]),
            "speed_mean": float(speeds.mean()),
            "speed_end": float(speeds[-1]),
        }


def cross_track_errors(log: Recording) -> Array:
    """Return the distance of the true position from the path, positive to starboard (N,) [m].

    Args:
        log: Log of a run whose controller logs the foot point on its path.
    """
    x, y, course = (log[name] for name in FOOT_POINT)
    return np.asarray(-(log["x_m"] - x) * np.sin(course) + (log["y_m"] - y) * np.cos(course))
