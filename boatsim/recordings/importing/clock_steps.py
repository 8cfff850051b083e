"""Clocks of loggers that were set back, or that began again, while rows went on.

A satellite receiver or a network sets the clock of a logger during a run, a counter overflows, or
the logger is started again and appends to its file. Rows sorted by such times would mix two parts
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


class ClockStep(NamedTuple):
    """A step back of a clock: row after it, counted from 0, its time [s], and its size [s]."""

    row: int
    time: float
    seconds: float


def continue_clock(t: Array, columns: Mapping[str, Array]) -> tuple[Array, list[ClockStep]]:
    """Return times that go on where a clock was set back, by one usual step.

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
    for _ in range(MAX_STEPS):
        times = found[known]
        back = np.flatnonzero(np.diff(times) < 0.0) + 1
        at = next((k for k in back.tolist() if _is_set_back(times, k, columns, known)), None)
        if at is None:
            break
        size = float(times[at - 1] - times[at])
        steps.append(ClockStep(int(known[at]), float(times[at - 1]), size))
        found[known[at:]] += size + usual
    return found, steps


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
