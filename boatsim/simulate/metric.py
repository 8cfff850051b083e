"""Base class of metric sets, which compute named numbers from the log of a run."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import inf
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from boatsim.errors import BoatsimError
from boatsim.physics.base import Array, CheckedParameters
from boatsim.recordings.table import Recording

# last part of a metric's name -> how it summarises a signal
KINDS = {
    "inf": "largest",
    "max": "largest",
    "largest": "largest",
    "rms": "rms",
    "mean": "mean",
    "l1": "time integral",
    "l2": "root of integrated squares",
    "integral": "time integral",
}
TIME_TOLERANCE = 1e-9  # [s] by which the time of a row may differ from a limit through rounding


class TooShort(BoatsimError):
    """Raised if a log ends before the data that a metric set needs, as after an interruption."""


@dataclass(frozen=True)
class MetricSet(CheckedParameters):
    """Base class of metric sets, which compute named numbers from the log of a run."""

    words: ClassVar[str] = ""  # one line for `boatsim list`
    units: ClassVar[Mapping[str, str]] = {}  # metric -> its unit

    def unit(self, metric: str) -> str:
        """Return the unit of a metric; in sets that work on any signal it may be the signal's unit.

        Args:
            metric: Name of one of the metrics.
        """
        return type(self).units[metric]

    def kind(self, metric: str) -> str:
        """Return how a metric summarises its signal over a run, such as "rms" or "largest".

        The result is "" for metrics that are none of `KINDS`.

        Args:
            metric: Name of one of the metrics.
        """
        return KINDS.get(metric.rpartition("_")[2], "")

    def explain_missing_value(self, metric: str, log: Recording) -> str:
        """Explain in a few words why a run has no value of a metric; "" if the reason is unknown.

        Args:
            metric: Name of the metric without a value.
            log: The log of the run.
        """
        return ""

    def values(self, log: Recording) -> dict[str, float]:
        """Compute all metrics of this set from the log of a run.

        Args:
            log: The log of the run.

        Returns:
            Value by metric, without the metrics whose condition the run did not reach.

        Raises:
            TooShort: If the log is too short for every metric.
        """
        raise NotImplementedError


def rows_between(
    log: Recording, since: float = -inf, until: float = inf, least: int = 1
) -> NDArray[np.bool_]:
    """Return a mask of the rows of a log that lie between two times.

    Args:
        log: Log with N rows.
        since: First time [s].
        until: Last time [s].
        least: Smallest number of rows required.

    Returns:
        Mask (N,).

    Raises:
        TooShort: If there are fewer than `least` rows.
    """
    found = (log.t >= since - TIME_TOLERANCE) & (log.t <= until + TIME_TOLERANCE)
    count = int(np.count_nonzero(found))
    if count < least:
        raise TooShort(f"{log.name}: {count} rows where at least {least} are needed")
    return np.asarray(found)


def describe_closest_value(x: Array, level: float, unit: str = "") -> str:
    """Describe in words how close a signal came to a level that it did not cross.

    Args:
        x: Signal (N,).
        level: The level, in the signal's unit.
        unit: The signal's unit.
    """
    x = x[np.isfinite(x)]
    if not len(x):
        return "the signal has no values in this interval"
    closest = f"smallest {x.min():.4g}"
    if x.max() < level:
        closest = f"largest {x.max():.4g}"
    return f"never reached {level:.4g} {unit}".rstrip() + f": {closest}"


def first_crossing(t: Array, above: Array) -> float | None:
    """Return the first time [s] at which a signal is zero or positive, interpolated between rows.

    Args:
        t: Times (N,) [s].
        above: Signal (N,).

    Returns:
        The time, or None if the signal is always negative.
    """
    at = int(np.argmax(above >= 0.0))
    if above[at] < 0.0:
        return None
    if at == 0:
        return float(t[0])
    share = above[at - 1] / (above[at - 1] - above[at])
    return float(t[at - 1] + share * (t[at] - t[at - 1]))


def surge_distance(log: Recording) -> Array:
    """Return the time integral of the surge speed (N,) from the first row of a log on [m].

    It is computed by the trapezoidal rule.
    """
    u = log["u_mps"]
    return np.concatenate(([0.0], np.cumsum(0.5 * (u[1:] + u[:-1]) * np.diff(log.t))))


def value_at(log: Recording, time: float, name: str) -> float:
    """Return the value of a column of a log at a time [s], by linear interpolation."""
    return float(np.interp(time, log.t, log[name]))


def distance_travelled(log: Recording) -> Array:
    """Return the distance along the boat's own horizontal track to each row, (N,) [m]."""
    return np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(log["x_m"]), np.diff(log["y_m"])))])
