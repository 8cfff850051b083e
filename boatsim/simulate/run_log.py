"""A table that grows by rows, in memory, or in a file: then a long run takes no more memory than a short one."""

from pathlib import Path
from tempfile import TemporaryFile

import numpy as np

from boatsim.files import AppendedFile
from boatsim.physics.base import Array
from boatsim.recordings.table import Notes, Recording

PIECE = 500  # [rows] in memory of a table that lies in a file


class Log:
    """A table filled row by row, one float a column; laid out by columns, so that a recording of it copies nothing."""

    def __init__(self, names: list[str], most: int) -> None:
        """`most` is how many rows are expected; memory is taken only as rows come."""
        self.names, self.count = names, 0
        self._columns = np.empty((len(names), most))

    def add(self, row: list[float]) -> None:
        """One more row."""
        if self.count == self._columns.shape[1]:
            self._columns = np.concatenate([self._columns, np.empty_like(self._columns)], axis=1)
        self._columns[:, self.count] = row
        self.count += 1

    def amend(self, first: int, values: Array) -> None:
        """Other values in the last row, from a column on."""
        self._columns[first:, self.count - 1] = values

    def rows(self, start: int, end: int) -> Array:
        """(columns, rows) from row `start` up to row `end`."""
        return self._columns[:, start:end]

    def recording(
        self, name: str, notes: Notes, start: int = 0, end: int | None = None
    ) -> Recording:
        """The rows from `start` to `end` or the last one; the first column is time."""
        t, *signals = self.rows(start, self.count if end is None else end)
        return Recording(name, t, dict(zip(self.names[1:], signals, strict=True)), notes)


class FiledLog(Log):
    """The same in a file without a name, gone when the process is; what is read of it is mapped, not loaded."""

    def __init__(self, names: list[str], folder: Path) -> None:
        """`folder` says on which disk."""
        super().__init__(names, PIECE)
        self._file = TemporaryFile(dir=folder, buffering=0)
        self._whole = AppendedFile(self._file, folder)
        self._written = 0  # rows

    def add(self, row: list[float]) -> None:
        """One more row. Raises OSError where the disk is full."""
        at = self.count - self._written
        if at == PIECE:
            self._put_away(PIECE)
            at = 0
        self._columns[:, at] = row
        self.count += 1

    def amend(self, first: int, values: Array) -> None:
        """Other values in the last row, which is always in memory."""
        self._columns[first:, self.count - self._written - 1] = values

    def rows(self, start: int, end: int) -> Array:
        """(columns, rows), a view of the file; of rows that are in memory a copy."""
        width = len(self.names)
        if start >= self._written:
            return self._columns[:, start - self._written : end - self._written].copy()
        waiting = self._columns[:, : self.count - self._written].T
        self._whole.add(np.ascontiguousarray(waiting).tobytes())
        self._whole.discard_end(
            waiting.nbytes
        )  # the next piece is written over it: its last row may change
        found = np.memmap(self._file, np.float64, "r", 8 * width * start, (end - start, width))
        return np.asarray(found).T

    def _put_away(self, rows: int) -> None:
        self._whole.add(np.ascontiguousarray(self._columns[:, :rows].T).tobytes())
        self._written += rows
