"""The log of a run of any length in a fixed number of samples, as a page draws it.

Rows are joined to buckets of 1, 2, 4, ... rows. A bucket keeps its first value and its extremes, so
that an oscillation that is faster than the buckets still shows its amplitude.
"""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from boatsim.physics.base import Array
from boatsim.recordings.table import Recording

BUCKETS = 2000  # at least so many for a long run, twice as many at most: more than a screen shows


class Samples(NamedTuple):
    """A log reduced for plotting to B buckets of consecutive rows.

    Attributes:
        t: Time of the first row of each bucket (B,) [s].
        first: Signal -> value of the first row (B,).
        lowest: Signal -> smallest value (B,).
        highest: Signal -> largest value (B,).
        rows: Number of rows of the log.
        end: Time of the last row [s].
    """

    t: Array
    first: Mapping[str, Array]
    lowest: Mapping[str, Array]
    highest: Mapping[str, Array]
    rows: int
    end: float

    def thinned_curve(self, name: str) -> tuple[Array, Array]:
        """Return times and values of a signal's curve, with the extremes of all buckets.

        Args:
            name: Name of the signal.

        Returns:
            Times [s] and values, each (B,) or, with buckets of several rows, (2 B,).
        """
        low, high = self.lowest[name], self.highest[name]
        if self.rows <= len(self.t):
            return self.t, self.first[name]
        return np.repeat(self.t, 2), np.column_stack([low, high]).ravel()


class ThinnedLog:
    """Collects the rows of a run's log in a bounded number of buckets."""

    def __init__(self) -> None:
        """Begin with an empty log."""
        self._names: list[str] = []
        self._size = 1  # rows of a bucket
        self._rows = 0
        self._end = 0.0
        self._waiting = np.zeros((0, 0))  # rows that do not fill a bucket yet (C, n)
        # three values (3, C, B) of each column in each bucket: first, lowest, highest
        self._buckets: list[Array] = []

    def add_rows(self, rows: Recording) -> None:
        """Add the next rows of the log; they have the columns of the first ones.

        Args:
            rows: Rows that follow those added before.
        """
        if not len(rows):
            return
        if not self._names:
            self._names = list(rows.signals)
            self._waiting = np.zeros((1 + len(self._names), 0))
        gap = np.full(len(rows), np.nan)
        new = np.stack([rows.t, *(rows.signals.get(name, gap) for name in self._names)])
        self._rows += len(rows)
        self._end = float(rows.t[-1])
        self._waiting = np.concatenate([self._waiting, new], axis=1)
        whole = self._waiting.shape[1] // self._size * self._size
        self._buckets.append(_joined(_as_buckets(self._waiting[:, :whole]), self._size))
        self._waiting = self._waiting[:, whole:]
        while sum(part.shape[2] for part in self._buckets) > 2 * BUCKETS:
            self._halve()

    def _halve(self) -> None:
        """Join each two buckets to one."""
        buckets = np.concatenate(self._buckets, axis=2)
        odd = buckets.shape[2] % 2
        if odd:  # the last one has no partner: its rows are represented by its values
            buckets = np.concatenate([buckets, buckets[:, :, -1:]], axis=2)
        self._buckets = [_joined(buckets, 2)]
        self._size *= 2

    def samples(self) -> Samples | None:
        """Return the thinned log so far; None without rows.

        It has the first, the lowest and the highest value of each signal in each bucket of rows.
        """
        if not self._rows:
            return None
        parts = list(self._buckets)
        if self._waiting.shape[1]:
            parts.append(_joined(_as_buckets(self._waiting), self._waiting.shape[1]))
        first, low, high = np.concatenate(parts, axis=2)
        return Samples(
            first[0],
            self._by_name(first),
            self._by_name(low),
            self._by_name(high),
            self._rows,
            self._end,
        )

    def _by_name(self, values: Array) -> dict[str, Array]:
        """Return the values (C, B) of all columns by the names of the signals."""
        return dict(zip(self._names, values[1:], strict=True))


def _as_buckets(rows: Array) -> Array:
    """Return rows (C, n) as buckets (3, C, n) of one row each."""
    return np.stack([rows, rows, rows])


def _joined(buckets: Array, count: int) -> Array:
    """Join each `count` consecutive buckets (3, C, B) to one."""
    if count == 1:
        return buckets
    _, columns, number = buckets.shape
    first, low, high = buckets.reshape(3, columns, number // count, count)
    # fmin and fmax pass over nan, where a sensor has measured nothing
    return np.stack([first[:, :, 0], np.fmin.reduce(low, axis=2), np.fmax.reduce(high, axis=2)])
