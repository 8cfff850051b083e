"""Docking along a planned path: errors of the path, and pose and speed at the end."""

from dataclasses import dataclass
from math import degrees, hypot, pi
from typing import ClassVar

from boatsim.control.base import wrap
from boatsim.metrics.path_following import PathFollowing
from boatsim.physics.base import param
from boatsim.recordings.table import Recording


@dataclass(frozen=True)
class Docking(PathFollowing):
    """Metric set of a vessel that ends at a berth, after it has followed a path.

    The metrics of `path_following` are completed by the distance from the berth and the deviation
    of the heading at the end of the log.
    """

    words: ClassVar[str] = "distance and heading error in a berth, and cross-track error on the way"
    units: ClassVar = {**PathFollowing.units, "berth_distance": "m", "berth_heading": "deg"}

    x: float = param(0.0, low=-1e6, high=1e6, unit="m", words="berth, in start axes")
    y: float = param(0.0, low=-1e6, high=1e6, unit="m", words="berth, in start axes")
    psi: float = param(0.0, low=-2.0 * pi, high=2.0 * pi, unit="rad", words="heading in the berth")

    def values(self, log: Recording) -> dict[str, float]:
        """Return the metrics of the path, and the errors of the pose at the end.

        Args:
            log: Log of the run.

        Raises:
            BadInput: The controller logs no foot point.
        """
        found = super().values(log)
        away = log["x_m"][-1] - self.x, log["y_m"][-1] - self.y
        found["berth_distance"] = hypot(away[0], away[1])
        found["berth_heading"] = abs(degrees(wrap(log["psi_rad"][-1] - self.psi)))
        return found
