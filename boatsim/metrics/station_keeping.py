"""Station keeping: errors of position and heading, and work of the thrusters."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import degrees, pi
from typing import ClassVar

import numpy as np

from boatsim.errors import BadInput, unknown_name_message
from boatsim.physics.base import Array, param
from boatsim.recordings.table import Recording
from boatsim.simulate.metric import MetricSet, rows_between

ACTUAL = "actual_"  # prefix of the column of an actuator behind its lags and rates
GOALS = ("x_m", "y_m", "psi_rad")
SECONDS_PER_MINUTE = 60.0


@dataclass(frozen=True)
class StationKeeping(MetricSet):
    """Metric set of a vessel that holds a position and heading, or follows a moving one.

    Rows from the time `since` on are evaluated. Errors are those against the controller's logged
    reference, `reference_x_m` and so on, or else against its goals. Thrusters are the columns
    `thrusters` and `azimuths`, by default all actuators in N and in rad. Their work is described by
    the mean of the sum of the magnitudes, the mean rate of changes, and the angle that azimuth
    thrusters turn.
    """

    words: ClassVar[str] = "errors of position and heading, thrust and its changes"
    units: ClassVar = {
        "position_rms": "m",
        "position_mean": "m",
        "position_max": "m",
        "heading_rms": "deg",
        "heading_mean": "deg",
        "heading_max": "deg",
        "thrust_mean": "N",
        "thrust_rate": "N/s",
        "azimuth_rate": "deg/min",
    }

    since: float = param(0.0, low=0.0, high=1e6, unit="s", words="start of the evaluated interval")
    thrusters: Sequence[str] = ()
    azimuths: Sequence[str] = ()

    def values(self, log: Recording) -> dict[str, float]:
        """Return errors and thruster work of a log.

        `position_mean` is the distance of the mean position from the reference, and
        `heading_mean` the magnitude of the mean heading error: they are zero with integral action
        under a constant load.

        Raises:
            BadInput: A named column does not exist.
        """
        rows = rows_between(log, self.since, least=2)
        t = log.t[rows]
        north, east, turn = (_error(log, name)[rows] for name in GOALS)
        distance = np.hypot(north, east)
        heading = np.degrees((turn + pi) % (2.0 * pi) - pi)
        found = {
            "position_rms": float(np.sqrt(np.mean(distance**2))),
            "position_mean": float(np.hypot(north.mean(), east.mean())),
            "position_max": float(distance.max()),
            "heading_rms": float(np.sqrt(np.mean(heading**2))),
            "heading_mean": float(abs(heading.mean())),
            "heading_max": float(np.abs(heading).max()),
        }
        span = float(t[-1] - t[0])
        thrusts = [log[name][rows] for name in self._columns(log, self.thrusters, "N")]
        if thrusts:
            found["thrust_mean"] = float(sum(np.mean(np.abs(x)) for x in thrusts))
            found["thrust_rate"] = sum(map(_travel, thrusts)) / span
        turned = [log[name][rows] for name in self._columns(log, self.azimuths, "rad")]
        if turned:
            found["azimuth_rate"] = degrees(sum(map(_travel, turned))) / span * SECONDS_PER_MINUTE
        return found

    def _columns(self, log: Recording, given: Sequence[str], unit: str) -> list[str]:
        """The named columns, or all commands of the controller with a unit."""
        names = [given] if isinstance(given, str) else list(given)
        for name in names:
            if name not in log.signals:
                raise BadInput(unknown_name_message("station_keeping: column", name, log.signals))
        if names:
            return names
        for name in log.signals:
            command = name.removeprefix(ACTUAL)
            if name.startswith(ACTUAL) and log.unit(command) == unit:
                names.append(name)
        return names


def _error(log: Recording, name: str) -> Array:
    """Deviation of a signal from the controller's reference, or from the goal."""
    for column in (f"reference_{name}", f"goal_{name}"):
        if column in log.signals:
            return np.asarray(log[name] - log[column])
    return np.asarray(log[name] - log[name][0])


def _travel(x: Array) -> float:
    """Sum of the changes of a signal."""
    return float(np.abs(np.diff(x)).sum())
