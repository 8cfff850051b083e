"""Tables that grow by rows, in memory or in a file, which keeps the memory of a long run small."""

from collections.abc import Callable, Sequence
from pathlib import Path
from tempfile import TemporaryFile
from typing import TypeAlias

import numpy as np

from boatsim.files import AppendedFile
from boatsim.physics.base import Array
from boatsim.recordings.table import Notes, Recording

PIECE = 500  # [rows] of a table in a file that are held in memory


class GrowingTable:
    """Table of floats in memory to which rows are appended, stored by columns."""

    def __init__(self, names: list[str], expected: int) -> None:
        """Create an empty table.

        Args:
            names: Names of the columns; the first one is the time.
            expected: Expected number of rows; the operating system assigns memory as rows come.
        """
        self.names = names
        self.count = 0
        self._columns = np.empty((len(names), expected))

    def append_row(self, row: list[float]) -> None:
        """Append a row with one value per column to the table."""
        if self.count == self._columns.shape[1]:
            self._columns = np.concatenate([self._columns, np.empty_like(self._columns)], axis=1)
        self._columns[:, self.count] = row
        self.count += 1

    def append_rows(self, parts: Sequence[Array]) -> None:
        """Append several rows to the table.

        Args:
            parts: Groups of columns (rows, columns), in the order of the table.
        """
        end = self.count + len(parts[0])
        while end > self._columns.shape[1]:
            self._columns = np.concatenate([self._columns, np.empty_like(self._columns)], axis=1)
        _write_parts(self._columns[:, self.count : end], parts, 0)
        self.count = end

    def replace_last_values(self, first: int, values: Array) -> None:
        """Replace the values of the table's last row from column number `first` on."""
        self._columns[first:, self.count - 1] = values

    def rows(self, start: int, end: int) -> Array:
        """Return table rows from `start` up to, not including, `end`; shape (columns, rows)."""
        return self._columns[:, start:end]

    def recording(
        self, name: str, notes: Notes, start: int = 0, end: int | None = None
    ) -> Recording:
        """Return rows of the table as a recording, whose time is the first column.

        Args:
            name: Name of the recording.
            notes: Notes of the recording.
            start: First row.
            end: Row after the last one; default: all rows.
        """
        t, *signals = self.rows(start, self.count if end is None else end)
        return Recording(name, t, dict(zip(self.names[1:], signals, strict=True)), notes)


class FileTable(GrowingTable):
    """Growing table in an unnamed temporary file, which is mapped into memory for reading."""

    def __init__(self, names: list[str], folder: Path) -> None:
        """Create an empty table.

        Args:
            names: Names of the columns; the first one is the time.
            folder: Folder on the disk that holds the file.
        """
        super().__init__(names, PIECE)
        self._file = TemporaryFile(dir=folder, buffering=0)
        self._pieces = AppendedFile(self._file, folder)
        self._written = 0  # [rows] in the file

    def append_row(self, row: list[float]) -> None:
        """Append a row with one value per column to the table in the file.

        Raises:
            OSError: If the disk is full.
        """
        at = self.count - self._written
        if at == PIECE:
            self._write_piece()
            at = 0
        self._columns[:, at] = row
        self.count += 1

    def append_rows(self, parts: Sequence[Array]) -> None:
        """Append several rows to the table in the file.

        Args:
            parts: Groups of columns (rows, columns), in the order of the table.

        Raises:
            OSError: If the disk is full.
        """
        begin, end = 0, len(parts[0])
        while begin < end:
            at = self.count - self._written
            if at == PIECE:
                self._write_piece()
                at = 0
            rows = min(PIECE - at, end - begin)
            _write_parts(self._columns[:, at : at + rows], parts, begin)
            self.count += rows
            begin += rows

    def replace_last_values(self, first: int, values: Array) -> None:
        """Replace values of the table's last row, which is always in memory, from `first` on."""
        self._columns[first:, self.count - self._written - 1] = values

    def rows(self, start: int, end: int) -> Array:
        """Return table rows (columns, rows), a view of the file or a copy if all are in memory."""
        width = len(self.names)
        if start >= self._written:
            return self._columns[:, start - self._written : end - self._written].copy()
        waiting = self._columns[:, : self.count - self._written].T
        self._pieces.append(np.ascontiguousarray(waiting).tobytes())
        # the next piece overwrites these rows, because the last one may still change
        self._pieces.truncate_end(waiting.nbytes)
        found = np.memmap(self._file, np.float64, "r", 8 * width * start, (end - start, width))
        return np.asarray(found).T

    def _write_piece(self) -> None:
        self._pieces.append(np.ascontiguousarray(self._columns.T).tobytes())
        self._written += PIECE


def _write_parts(target: Array, parts: Sequence[Array], begin: int) -> None:
    """Write rows of groups of columns, from row `begin` on, to a table (columns, rows)."""
    column, rows = 0, target.shape[1]
    for part in parts:
        target[column : column + part.shape[1]] = part[begin : begin + rows].T
        column += part.shape[1]


# creates a table from the names of its columns and the expected number of rows
MakeTable: TypeAlias = Callable[[list[str], float], GrowingTable]
