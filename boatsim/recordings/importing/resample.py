"""Many clocks on one, without inventing data: what was measured stays at its sample, what was commanded is held.

A measured value goes into one row, that of its own time; rows between samples are empty (nan). A command
is in force from its own time until the next one.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from boatsim.physics.base import Array
from boatsim.recordings.importing.log import rate_of

LOST = 5.0  # of its usual steps after which a command is no longer taken for held on purpose,
LEAST_LOST = 2.0  # [s] and at least so long
SAME = 1e-6  # [s] times since 1970 are known to a quarter of that


@dataclass(frozen=True)
class Samples:
    """One signal with the times it was logged at, sorted, each time once, without what is not a number."""

    t: Array  # (K,) s
    values: Array  # (K,)

    @property
    def rate(self) -> float:
        """Samples a second."""
        return rate_of(self.t)


def samples(t: Array, values: Array) -> Samples:
    """Sorted by time, of two at one time the later logged; nan left out."""
    there = np.isfinite(t) & np.isfinite(values)
    t, values = t[there], values[there]
    order = np.argsort(t, kind="stable")
    t, values = t[order], values[order]
    last = np.append(np.diff(t) > 0.0, True) if len(t) else np.zeros(0, dtype=bool)
    return Samples(t[last], values[last])


def clock(base: Array, others: Sequence[Samples], near: float) -> Array:
    """(N,) times of rows: those of the base, and of every sample of the others that is not `near` [s] to one."""
    rows = base
    for given in others:
        t = given.t[(given.t >= base[0] - near) & (given.t <= base[-1] + near)]
        rows = np.sort(np.concatenate([rows, t[_distance(rows, t) > near]]))
    return rows


def _distance(rows: Array, t: Array) -> Array:
    after = np.searchsorted(rows, t).clip(1, len(rows) - 1)
    return np.asarray(np.minimum(np.abs(t - rows[after - 1]), np.abs(t - rows[after])))


def placed(rows: Array, given: Samples, near: float) -> Array:
    """(N,) the sample nearest to each row, nan where none is `near` [s] to it or each is nearer to another row."""
    found = np.full(len(rows), np.nan)
    if not len(given.t) or len(rows) < 2:
        return found
    nearest = np.searchsorted(0.5 * (rows[1:] + rows[:-1]), given.t)
    off = np.abs(given.t - rows[nearest])
    order = np.argsort(-off, kind="stable")  # of two in one row the nearer is written last
    order = order[off[order] <= near]
    found[nearest[order]] = given.values[order]
    return found


def held(rows: Array, given: Samples) -> Array:
    """(N,) mean until the next row of a value that is in force from each sample to the next; nan before the first.

    Where none comes between two rows that is the last sample itself. The mean, because a recording's commands are held
    from row to row: taken at the row, a command given just behind it would be late by a whole row.
    """
    found = np.full(len(rows), np.nan)
    if not len(given.t):
        return found
    last = np.searchsorted(given.t, rows + SAME, side="right") - 1
    known = last >= 0
    found[known] = given.values[last[known]]
    area = np.append(
        0.0, np.cumsum(given.values[:-1] * np.diff(given.t))
    )  # under the held value, at each sample
    at = np.where(known, area[last] + given.values[last] * (rows - given.t[last]), np.nan)
    newest = np.searchsorted(given.t, rows[1:] - SAME) - 1  # before the next row
    changed = np.flatnonzero(known[:-1] & (newest > last[:-1]))
    found[changed] = (at[changed + 1] - at[changed]) / (rows[changed + 1] - rows[changed])
    return found


def longest_hold(rows: Array, given: Samples) -> float:
    """[s] over which a command is held beyond what its rate explains; 0 where it is not."""
    if len(given.t) < 2:
        return 0.0
    gaps = np.diff(np.append(given.t, max(float(rows[-1]), float(given.t[-1]))))
    usual = float(np.median(gaps))
    longest = float(gaps.max())
    return longest if longest > max(LOST * usual, LEAST_LOST) else 0.0
