"""Clocks of loggers that were set back, or that began again, while rows went on.

A satellite receiver or a network sets the clock of a logger during a run, a counter overflows, or
the logger is started again and appends to its file. A clock of local time changes by an hour to and
from summer time. Rows sorted by such times would mix two parts
of a run.
"""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from boatsim.physics.base import Array

# Rows after a step back that lie in time that other rows fill already. Messages out of order are
# fewer, and late messages fill a gap
MIN_OVERLAP_ROWS = 10
MIN_FILLED = 0.5  # rows of the same time before the step, relative to those after it
MIN_FORWARD = 0.9  # share of the steps after the step back that go forward: the clock goes on
MAX_COPIES = 0.9  # share of equal values at equal times: rows that were written twice
MAX_STEPS = 20  # of a log; more are no clock
HOUR = 3600.0  # [s] by which a clock of local time changes to and from summer time
# [s] from a whole hour; real pauses are as near to it once in 2000 times
HOUR_TOLERANCE = 1.0
# The step of a value over the change, relative to its usual steps: the vessel did not go on unseen
GOES_ON_PERCENTILE = 99.0
MAX_STEP_RATIO = 3.0


class ClockStep(NamedTuple):
    """A step back of a clock: row after it, counted from 0, its time [s], and its size [s].

    The size of a step forward, to summer time, is negative.
    """

    row: int
    time: float
    seconds: float


def continue_clock(t: Array, columns: Mapping[str, Array]) -> tuple[Array, list[ClockStep]]:
    """Return times that go on where a clock was set back, or by an hour, by one usual step.

    Args:
        t: Times (N,) [s] in the order of the log.
        columns: Name -> values (N,) at these times, which show whether rows were written twice.

    Returns:
        Times (N,) [s], and the steps that were removed.
    """
    known = np.flatnonzero(np.isfinite(t))
    if len(known) < 2 * MIN_OVERLAP_ROWS:
        return t, []
    found = t.copy()
    steps: list[ClockStep] = []
    usual = float(np.median(np.abs(np.diff(t[known]))))
    without_clock = {}
    for name, values in columns.items():
        if not np.array_equal(values[known], t[known]):
            without_clock[name] = values
    for _ in range(MAX_STEPS):
        times = found[known]
        back = np.flatnonzero(np.diff(times) < 0.0) + 1
        at = next((k for k in back.tolist() if _is_set_back(times, k, columns, known)), None)
        if at is None:
            at = _hour_step(times, usual, without_clock, known)
        if at is None:
            break
        size = float(times[at - 1] - times[at])
        steps.append(ClockStep(int(known[at]), float(times[at - 1]), size))
        found[known[at:]] += size + usual
    return found, steps


def _hour_step(
    times: Array,
    usual: float,
    columns: Mapping[str, Array],
    known: "np.ndarray[tuple[int], np.dtype[np.int64]]",
) -> int | None:
    """Row after the first step of an hour over which the motion goes on; None without one."""
    steps = np.diff(times)
    for k in (np.flatnonzero(np.abs(np.abs(steps - usual) - HOUR) < HOUR_TOLERANCE) + 1).tolist():
        after = np.diff(times[k:])
        is_alone = len(after) >= MIN_OVERLAP_ROWS and k >= MIN_OVERLAP_ROWS
        if is_alone and np.mean(after >= 0.0) >= MIN_FORWARD and _goes_on(columns, known, k):
            return int(k)
    return None


def _goes_on(
    columns: Mapping[str, Array], known: "np.ndarray[tuple[int], np.dtype[np.int64]]", k: int
) -> bool:
    """Whether no value changes more over a step than it usually does from row to row."""
    changes = False
    for values in columns.values():
        rows = values[known]
        if not np.isfinite(rows[k - 1 : k + 1]).all():
            continue
        usual = np.abs(np.diff(rows[np.isfinite(rows)]))
        changes = changes or bool(usual.any())
        limit = MAX_STEP_RATIO * float(np.percentile(usual, GOES_ON_PERCENTILE))
        if abs(float(rows[k] - rows[k - 1])) > limit:
            return False
    return changes


def _is_set_back(
    times: Array,
    at: int,
    columns: Mapping[str, Array],
    known: "np.ndarray[tuple[int], np.dtype[np.int64]]",
) -> bool:
    """Whether the clock is set back at a row, and the rows are neither late, nor copies."""
    before, after = times[:at], times[at:]
    last = float(before.max())
    length = int(np.argmax(after > last)) if (after > last).any() else len(after)
    block = after[:length]
    if length < MIN_OVERLAP_ROWS or np.mean(np.diff(block) > 0.0) < MIN_FORWARD:
        return False
    filled = np.flatnonzero((before >= block[0]) & (before <= block[-1]))
    if len(filled) < MIN_FILLED * length:
        return False
    _, first, second = np.intersect1d(before[filled], block, return_indices=True)
    if len(first) < MIN_FILLED * length:
        return True
    old, new = known[filled[first]], known[at + second]
    for values in columns.values():
        both = np.isfinite(values[old]) & np.isfinite(values[new])
        if both.any() and np.mean(values[old][both] == values[new][both]) < MAX_COPIES:
            return True
    return False
