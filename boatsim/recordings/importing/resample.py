"""Many clocks on one, without inventing data: what was measured stays at its sample, what was commanded is held.

A measured value goes into the row nearest in time and into no other; rows between samples are empty (nan). A command
fills every row from its own time until the next one.
"""

from dataclasses import dataclass

import numpy as np

from boatsim.physics.base import Array
from boatsim.recordings.importing.log import rate_of

LOST = 5.0  # of its usual steps after which a command is no longer taken for held on purpose,
LEAST_LOST = 2.0  # [s] and at least so long


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


def placed(rows: Array, given: Samples) -> Array:
    """(N,) the sample nearest to each row, nan where none is nearer to it than to its neighbours."""
    found = np.full(len(rows), np.nan)
    if not len(given.t) or len(rows) < 2:
        return found
    nearest = np.searchsorted(0.5 * (rows[1:] + rows[:-1]), given.t)
    off = np.abs(given.t - rows[nearest])
    order = np.argsort(-off, kind="stable")  # of two in one row the nearer is written last
    order = order[
        off[order] <= float(np.median(np.diff(rows)))
    ]  # one step: in a gap of the rows there is no row for it
    found[nearest[order]] = given.values[order]
    return found


def held(rows: Array, given: Samples) -> Array:
    """(N,) the last sample at or before each row, nan before the first."""
    found = np.full(len(rows), np.nan)
    if len(given.t):
        last = np.searchsorted(given.t, rows + 1e-9, side="right") - 1
        found[last >= 0] = given.values[last[last >= 0]]
    return found


def longest_hold(rows: Array, given: Samples) -> float:
    """[s] over which a command is held beyond what its rate explains; 0 where it is not."""
    if len(given.t) < 2:
        return 0.0
    gaps = np.diff(np.append(given.t, max(float(rows[-1]), float(given.t[-1]))))
    usual = float(np.median(gaps))
    longest = float(gaps.max())
    return longest if longest > max(LOST * usual, LEAST_LOST) else 0.0
