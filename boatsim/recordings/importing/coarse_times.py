"""Times of rows whose logger stamped several rows with one whole second."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from boatsim.physics.base import Array

MIN_STAMPS = 10  # fewer do not show a rhythm
# Share of the stamps that have the usual number of rows, and that follow at the usual step
MIN_REGULAR_SHARE = 0.8
ROWS_TOLERANCE = 0.2  # share by which the number of rows of a stamp may differ, or one row
SAME_STEP = 1e-3  # share of a step by which equal steps differ by rounding
MIN_CHANGED = 0.5  # share of the rows of one stamp that differ from the row before: no copies
MIN_SAME_CELLS = 0.9  # share of the rows of one stamp with the same filled cells: one stream


class SpreadTimes(NamedTuple):
    """Times (N,) [s] of rows, with the step of the stamps [s] and the rows of each stamp."""

    t: Array
    step: float
    rows: float


def spread_coarse_times(t: Array, columns: Sequence[Array]) -> SpreadTimes | None:
    """Return times of rows that share stamps, spread evenly from each stamp to the next.

    Rows are spread if they follow at one rate: nearly all stamps have the same number of rows and
    follow at the same step, and the rows of one stamp are neither copies nor of several sensors.

    Args:
        t: Times (N,) [s] as logged.
        columns: Values (N,) of the other columns of the table.

    Returns:
        The spread times; None where each row has a time of its own, or the rows have no rhythm.
    """
    if len(t) < 2 * MIN_STAMPS or not np.isfinite(t).all() or (np.diff(t) < 0.0).any():
        return None
    begins = np.flatnonzero(np.append(True, np.diff(t) > 0.0))
    counts = np.diff(np.append(begins, len(t)))
    usual = float(np.median(counts))
    if len(begins) < MIN_STAMPS or usual < 2.0:
        return None
    steps = np.diff(t[begins])
    step = float(np.median(steps))
    tolerance = max(1.0, ROWS_TOLERANCE * usual)
    has_rhythm = np.mean(np.abs(counts[1:-1] - usual) <= tolerance) >= MIN_REGULAR_SHARE
    is_regular = np.mean(np.abs(steps - step) <= SAME_STEP * step) >= MIN_REGULAR_SHARE
    if not has_rhythm or not is_regular or not _is_one_stream(t, columns):
        return None
    number = np.arange(len(t)) - np.repeat(begins, counts)
    each = np.maximum(counts, usual)  # a stamp with fewer rows lost some, or is the first or last
    first = usual - counts[0] if counts[0] < usual else 0.0  # a log begins within a second
    number = number + np.where(np.arange(len(t)) < counts[0], first, 0.0)
    return SpreadTimes(t + step * number / np.repeat(each, counts), step, usual)


def share_of_equal_times(t: Array, columns: Sequence[Array]) -> float:
    """Return the share of rows with the time of the row before, if the times lack digits.

    Args:
        t: Times (N,) [s] as logged.
        columns: Values (N,) of the other columns of the table.

    Returns:
        The share; 0 if rows of one time are copies, or of several sensors.
    """
    together = np.diff(t) == 0.0
    if not together.any() or not _is_one_stream(t, columns):
        return 0.0
    return float(np.mean(together))


def _is_one_stream(t: Array, columns: Sequence[Array]) -> bool:
    """Whether the rows of one stamp differ from each other and have the same filled cells."""
    together = np.diff(t) == 0.0
    changed = np.zeros(len(t) - 1, dtype=np.bool_)
    same_cells = np.ones(len(t) - 1, dtype=np.bool_)
    for values in columns:
        filled = np.isfinite(values)
        changed |= (values[1:] != values[:-1]) & filled[1:] & filled[:-1]
        same_cells &= filled[1:] == filled[:-1]
    changes = float(np.mean(changed[together]))
    return changes >= MIN_CHANGED and float(np.mean(same_cells[together])) >= MIN_SAME_CELLS
