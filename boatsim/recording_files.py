"""Tables of named columns from CSV and Parquet files, with the row each bad cell stands in."""

import csv
import os
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from boatsim.base import Array
from boatsim.errors import BadInput


@dataclass(frozen=True)
class Raw:
    """A table as read: empty cells are nan, cells that are not numbers are kept aside with their row."""

    path: Path
    columns: dict[str, Array]  # each (N,)
    rows: Sequence[int]  # line of the file (CSV) or number of the row (Parquet), counted from 1
    text: dict[str, tuple[int, str]] = field(default_factory=dict)  # column -> row and content of its first bad cell


def refuse(path: Path, message: str, row: int | None = None, column: str | None = None) -> BadInput:
    """The one line of a bad recording: file, row, column, what is wrong."""
    where = "".join(f" {what} {value}," for what, value in (("row", row), ("column", column)) if value is not None)
    return BadInput(" ".join(f"{path}:{where.rstrip(',')}{':' if where else ''} {message}".split()))


@contextmanager
def replacing(path: Path | str) -> Iterator[Path]:
    """A temporary name beside `path` to write to; it takes the place of `path` at the end if nothing was raised."""
    path = Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    temporary = path.with_name(f".{os.getpid()}.{path.name}")  # keeps the ending, by which writers choose the format
    try:
        yield temporary
        os.replace(temporary, path)
    finally:
        temporary.unlink(missing_ok=True)


def read_csv(path: Path) -> Raw:
    """Comma separated, one header row; blank lines are skipped."""
    header, rows, lines = _cells(path)
    for row, cells in zip(lines, rows, strict=True):
        if len(cells) != len(header):
            raise refuse(path, f"has {len(cells)} cells; the header has {len(header)} columns", row)
    raw = Raw(path, {}, lines)
    by_column = list(zip(*rows, strict=True)) or [()] * len(header)
    for name, column in zip(header, by_column, strict=True):
        raw.columns[name] = _numbers(raw, name, column)
    return raw


def read_parquet(path: Path) -> Raw:
    """Columns of a Parquet file; nulls are empty cells."""
    from pyarrow import ArrowException, parquet  # 60 ms, comes with rerun-sdk

    try:
        table = parquet.read_table(path)
    except (ArrowException, OSError, ValueError) as error:
        raise refuse(path, f"is not a Parquet file ({error})") from error
    raw = Raw(path, {}, range(1, table.num_rows + 1))
    _no_twins(path, table.column_names)
    for name, column in zip(table.column_names, table.columns, strict=True):
        raw.columns[name] = _numbers(raw, name, ["" if cell is None else cell for cell in column.to_pylist()])
    return raw


def _cells(path: Path) -> tuple[list[str], list[list[str]], list[int]]:
    """Header, rows of cells, line number of each row."""
    try:
        text = path.read_bytes().decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise refuse(path, "is not a text file; a recording is CSV, Parquet or the .rrd of a run") from error
    if "\0" in text:
        raise refuse(path, "is not a text file; a recording is CSV, Parquet or the .rrd of a run")
    reader = csv.reader(text.splitlines())
    rows, lines = [], []
    try:
        for cells in reader:
            if any(cells):
                rows.append(cells)
                lines.append(reader.line_num)
    except csv.Error as error:
        raise refuse(path, f"is not CSV ({error})", reader.line_num) from error
    if not rows:
        raise refuse(path, "is empty")
    header = [name.strip() for name in rows[0]]
    for character, called in ((";", "semicolons"), ("\t", "tabs")):
        if len(header) == 1 and character in header[0]:
            raise refuse(path, f"is separated by {called}; allowed are commas, with a point in decimal numbers", 1)
    _no_twins(path, header)
    return header, rows[1:], lines[1:]


def _no_twins(path: Path, header: list[str]) -> None:
    for name in header:
        if header.count(name) > 1:
            raise refuse(path, "there are two columns of this name", 1, name or "(no name)")


def _numbers(raw: Raw, name: str, cells: Sequence[object]) -> Array:
    """(N,) floats; empty cells become nan, and the first cell that is no number is noted in `raw.text`."""
    try:
        return np.array(list(map(_plain, cells)), dtype=float)
    except (ValueError, TypeError, OverflowError):
        return np.array([_lenient(raw, name, row, cell) for row, cell in zip(raw.rows, cells, strict=True)])


def _plain(cell: object) -> float:
    if isinstance(cell, str) and "_" in cell:  # Python reads 1_000, a CSV file should not say so
        raise ValueError(cell)
    return float(cell)  # type: ignore[arg-type]


def _lenient(raw: Raw, name: str, row: int, cell: object) -> float:
    try:
        return float("nan") if isinstance(cell, str) and not cell.strip() else _plain(cell)
    except (ValueError, TypeError, OverflowError):
        raw.text.setdefault(name, (row, str(cell)[:40]))
        return float("nan")
