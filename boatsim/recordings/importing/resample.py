"""Resampling of signals with different clocks to common rows, without interpolation.

A measurement is written to the row at its time; rows between samples are empty (nan). A
command is in force from its own time until the next one.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from boatsim.physics.base import Array
from boatsim.recordings.importing.log import median_sampling_rate

# A command without a new value for this many median steps and this long [s] may be lost
LOST_STEPS = 5.0
MIN_LOST = 2.0
SAME_TIME = 1e-6  # [s] resolution of times; those since 1970 are exact to a quarter of it


@dataclass(frozen=True)
class Samples:
    """Samples of one signal: sorted, one per time, all finite.

    Attributes:
        t: Times (K,) [s].
        values: Values (K,).
    """

    t: Array
    values: Array

    @property
    def rate(self) -> float:
        """Rate of the samples [Hz]."""
        return median_sampling_rate(self.t)


def clean_samples(t: Array, values: Array) -> Samples:
    """Return the samples sorted by time, without nan.

    Of two at one time the later logged is kept.
    """
    finite = np.isfinite(t) & np.isfinite(values)
    t, values = t[finite], values[finite]
    order = np.argsort(t, kind="stable")
    t, values = t[order], values[order]
    last = np.append(np.diff(t) > 0.0, True)[: len(t)]
    return Samples(t[last], values[last])


def count_unordered_samples(t: Array) -> tuple[int, int, float]:
    """Count the samples that `clean_samples` sorts, and those that it drops for another one.

    Args:
        t: Times (N,) [s] as logged.

    Returns:
        Number of samples after a later one, number of samples at the time of another one, and the
        first time of either [s]; 0 without any.
    """
    t = t[np.isfinite(t)]
    late = t < np.maximum.accumulate(t) if len(t) else np.zeros(0, dtype=np.bool_)
    times = np.sort(t)
    doubled = times[1:][np.diff(times) == 0.0]
    first = np.concatenate([t[late], doubled])
    return int(late.sum()), len(doubled), float(first.min()) if len(first) else 0.0


def row_times(base: Array, others: Sequence[Samples], near: float) -> Array:
    """Return the times (N,) of rows [s]: `base`, and samples farther than `near` [s] from it."""
    rows = base
    for given in others:
        t = given.t[(given.t >= base[0] - near) & (given.t <= base[-1] + near)]
        rows = np.sort(np.concatenate([rows, t[_distance(rows, t) > near]]))
    return rows


def _distance(rows: Array, t: Array) -> Array:
    after = np.searchsorted(rows, t).clip(1, len(rows) - 1)
    return np.asarray(np.minimum(np.abs(t - rows[after - 1]), np.abs(t - rows[after])))


def nearest_samples(rows: Array, given: Samples, near: float) -> Array:
    """Return the nearest sample of each row (N,).

    Nan where none is within `near` [s] or nearest to this row.
    """
    found = np.full(len(rows), np.nan)
    if not len(given.t) or len(rows) < 2:
        return found
    nearest = np.searchsorted(0.5 * (rows[1:] + rows[:-1]), given.t)
    off = np.abs(given.t - rows[nearest])
    order = np.argsort(-off, kind="stable")  # the nearest sample of a row is written last
    order = order[off[order] <= near]
    found[nearest[order]] = given.values[order]
    return found


def mean_held_values(rows: Array, given: Samples) -> Array:
    """Return the mean until the next row (N,) of a signal that holds each sample until the next.

    Nan before the first.

    Without a new sample between two rows this is the last sample. The mean is used because commands
    of a recording hold from row to row: a command sent just after a row would otherwise be delayed
    by a whole row.
    """
    found = np.full(len(rows), np.nan)
    if not len(given.t):
        return found
    last = np.searchsorted(given.t, rows + SAME_TIME, side="right") - 1
    known = last >= 0
    found[known] = given.values[last[known]]
    # Integral of the held value at each sample
    area = np.append(0.0, np.cumsum(given.values[:-1] * np.diff(given.t)))
    at = np.where(known, area[last] + given.values[last] * (rows - given.t[last]), np.nan)
    newest = np.searchsorted(given.t, rows[1:] - SAME_TIME) - 1  # before the next row
    changed = np.flatnonzero(known[:-1] & (newest > last[:-1]))
    found[changed] = (at[changed + 1] - at[changed]) / (rows[changed + 1] - rows[changed])
    return found


def longest_command_gap(rows: Array, given: Samples) -> float:
    """Return the longest time [s] without a new value of a command, 0 if its rate explains it."""
    if len(given.t) < 2:
        return 0.0
    gaps = np.diff(np.append(given.t, max(float(rows[-1]), float(given.t[-1]))))
    usual = float(np.median(gaps))
    longest = float(gaps.max())
    if longest > max(LOST_STEPS * usual, MIN_LOST):
        return longest
    return 0.0
