"""Detection of values that a logger repeats until the next measurement."""

import numpy as np
from numpy.typing import NDArray

MIN_GAPS = 10  # fewer gaps between new values do not show a regular period
# Share of the gaps that must be as long as the median one, to a row or a tenth
MIN_REGULAR_SHARE = 0.8
# A column that repeats in more rows than this holds its values, or hardly changes
MAX_STALE_SHARE = 0.5
STALE_FACTOR = 5.0  # as many repeats as this times those expected by chance do not arise by chance
# With fewer separate parts of repeated samples the value must change at both ends of each: a vessel
# that begins on a steady course ends it by a command
MIN_PARTS = 5
# Share of new values whose step is the resolution itself: more are of a sensor that hardly changes
MAX_SMALLEST_STEPS = 0.2
# A vessel at rest repeats a value for longer than this times the median gap between new values
LONG_GAPS = 5.0
# Share of the usual step of a value that it makes next to stale samples; next to steady ones the
# steps are near the resolution
MIN_STEP_AROUND = 0.5


def repeated_rows(fixes: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Return a mask (N,) of the rows in which a logger repeated measured values (N, C).

    Rows count as repeated if new values come at a regular period, or if most rows repeat all values
    although these usually change by far more than their resolution: messages that came in bursts.
    Rows in which the values hardly change before and after do not count: a vessel at rest.
    """
    new = np.append(True, (np.diff(fixes, axis=0) != 0.0).any(axis=1))
    if _come_at_a_regular_period(new):
        return ~new
    steady = _steady_rows(fixes, new)
    if _come_in_bursts(fixes, new, steady):
        return ~new & ~steady
    return np.zeros(len(fixes), dtype=np.bool_)


def _come_at_a_regular_period(new: NDArray[np.bool_]) -> bool:
    """Whether rows with new values (N,) have the same number of rows between them."""
    gaps = np.diff(np.flatnonzero(new))
    if len(gaps) < MIN_GAPS or (usual := float(np.median(gaps))) < 2.0:
        return False
    regular = np.abs(gaps - usual) <= max(1.0, 0.1 * usual)
    return float(regular.mean()) >= MIN_REGULAR_SHARE


def _steady_rows(fixes: NDArray[np.float64], new: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Rows (N,) that long repeat values (N, C) which hardly change before and after: at rest.

    A sensor that fails while the vessel moves has a usual step before the first repetition, and a
    large one after the last.
    """
    steady = ~new
    gaps = np.diff(np.flatnonzero(new))
    least = LONG_GAPS * float(np.median(gaps)) if len(gaps) else 0.0
    steps = np.abs(np.diff(fixes, axis=0))
    bounds = np.flatnonzero(np.diff(np.concatenate(([False], ~new, [False])).astype(int)))
    for values in steps.T:
        moved = values[values > 0.0]
        slow = MIN_STEP_AROUND * float(np.median(moved)) if len(moved) else 0.0
        for begin, end in bounds.reshape(-1, 2).tolist():  # rows that repeat, without the end
            around = [*values[begin - 2 : begin - 1], *values[end - 1 : end]]
            if end - begin < least or any(step > slow for step in around):
                steady[begin:end] = False
    return steady


def _come_in_bursts(
    fixes: NDArray[np.float64], new: NDArray[np.bool_], steady: NDArray[np.bool_]
) -> bool:
    """Whether most rows repeat values (N, C) that usually change by more than their resolution.

    Rows in which the values are steady do not count.
    """
    if new.sum() < MIN_GAPS or new.sum() > (1.0 - MAX_STALE_SHARE) * (~steady).sum():
        return False
    for values in fixes[new].T:
        steps = np.abs(np.diff(values))
        moved = steps[steps > 0.0]
        if not len(moved) or np.mean(steps < 1.5 * moved.min()) > MAX_SMALLEST_STEPS:
            return False
    return True


def stale_rows(values: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Return a mask (N,) of the rows in which a value (N,) was not measured again.

    A sensor with noise seldom gives the same number twice in a row: about half as often as two
    numbers that differ by its smallest step, the resolution. More repeats than that come from a
    program that writes rows when no new message has arrived, unless the value hardly changes
    before and after them: a vessel at rest or on a steady course.
    """
    steps = np.abs(np.diff(values))
    none = np.zeros(len(values), dtype=np.bool_)
    repeats = steps == 0.0
    if not repeats.any() or repeats.mean() > MAX_STALE_SHARE:
        return none
    resolution = float(steps[~repeats].min())
    by_chance = 0.5 * float(np.sum(steps[~repeats] < 1.5 * resolution))
    if repeats.sum() < STALE_FACTOR * (by_chance + 1.0):
        return none
    begin = np.flatnonzero(repeats[1:] & ~repeats[:-1])  # steps before and after each stale part
    end = np.flatnonzero(repeats[:-1] & ~repeats[1:]) + 1
    if len(begin) == 0 or len(end) == 0:
        return none
    summary = np.median if min(len(begin), len(end)) >= MIN_PARTS else np.min
    around = float(summary(steps[np.concatenate([begin, end])]))
    if around < MIN_STEP_AROUND * float(np.median(steps[~repeats])):
        return none
    return np.append(False, repeats)
