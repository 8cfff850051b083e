"""CSV: comma separated, a point in decimal numbers, one header row."""

import csv
from io import StringIO
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from boatsim.physics.base import Array
from boatsim.recordings.limits import LONGEST_HEADER, MOST_CELLS, check_shape
from boatsim.recordings.raw_table import Raw, no_twins, numbers, refuse

if TYPE_CHECKING:
    from pyarrow import ChunkedArray, Table


BLOCK = 1 << 20  # bytes


def read(path: Path) -> Raw:
    """Comma separated, one header row; blank lines are skipped."""
    with path.open("rb") as file:
        first = file.readline(LONGEST_HEADER + 1)
    if len(first) > LONGEST_HEADER:
        raise refuse(path, f"the first line has more than {LONGEST_HEADER} bytes", 1)
    _check_cells(path, first.count(b",") + 1)
    content = path.read_bytes()
    return _quick(path, first, content) or _line_by_line(path, content)


def _check_cells(path: Path, columns: int) -> None:
    """Refuse more cells than a recording may have as soon as so many are counted, before memory is taken for any."""
    cells = 0
    with path.open("rb") as file:
        check_shape(path, columns)
        while block := file.read(BLOCK):
            cells += block.count(b",") + block.count(b"\n")
            if cells > MOST_CELLS:
                raise refuse(
                    path, f"has more than {MOST_CELLS:.3g} cells; a recording has at most so many"
                )
        check_shape(path, columns, cells)


def _quick(path: Path, first: bytes, content: bytes) -> Raw | None:
    """The table read by native code, where a row is a line and nothing is wrong with any; None of another."""
    header = _header(first)
    if header is None or b"\0" in content or content.count(b"\r") > content.count(b"\r\n"):
        return None
    if (table := _table(header, content)) is None:
        return None
    if (
        content.count(b"\n") + (not content.endswith(b"\n")) != 1 + table.num_rows
    ):  # a blank line, or none of ours
        return None
    raw = Raw(path, {}, range(2, 2 + table.num_rows))
    for name, column in zip(header, table.columns, strict=True):
        raw.columns[name] = _numbers(raw, name, column)
    empty = np.all([np.isnan(values) for values in raw.columns.values()], axis=0)
    return None if empty.any() else raw


def _header(first: bytes) -> list[str] | None:
    """Names of columns in a first line that has nothing odd about it."""
    try:
        line = first.decode("utf-8-sig").removesuffix("\n").removesuffix("\r")
    except UnicodeDecodeError:
        return None
    if not line.isprintable():
        return None
    header = [name.strip() for name in next(csv.reader([line]), [])]
    return header if len(set(header)) == len(header) > 1 else None


def _table(header: list[str], content: bytes) -> "Table | None":
    """All cells as texts; None where rows differ in length, or where it is no text."""
    import pyarrow as pa  # 60 ms, comes with rerun-sdk
    from pyarrow import csv as arrow

    texts = arrow.ConvertOptions(
        column_types=dict.fromkeys(header, pa.string()), strings_can_be_null=False
    )
    try:
        return arrow.read_csv(
            pa.BufferReader(content),
            arrow.ReadOptions(skip_rows=1, column_names=header),
            None,
            texts,
        )
    except pa.ArrowException:
        return None


def _numbers(raw: Raw, name: str, column: "ChunkedArray") -> Array:
    """(N,) floats of a column of texts; one with something else than numbers in it is looked at cell by cell."""
    import pyarrow as pa
    from pyarrow import compute

    try:
        filled = compute.if_else(compute.equal(column, ""), pa.scalar(None, pa.string()), column)
        found = np.array(filled.cast(pa.float64()).to_numpy(), dtype=float)
    except pa.ArrowException:
        return numbers(raw, name, column.to_pylist())
    plain = (
        np.isnan(found).sum() == filled.null_count
    )  # what else is called nan there need not be so here
    return found if plain else numbers(raw, name, column.to_pylist())


def _line_by_line(path: Path, content: bytes) -> Raw:
    """The table, or what is wrong with it and in which line."""
    header, rows, lines = _cells(path, content)
    for row, cells in zip(lines, rows, strict=True):
        if len(cells) != len(header):
            raise refuse(path, f"has {len(cells)} cells; the header has {len(header)} columns", row)
    raw = Raw(path, {}, lines)
    by_column = list(zip(*rows, strict=True)) or [()] * len(header)
    for name, column in zip(header, by_column, strict=True):
        raw.columns[name] = numbers(raw, name, column)
    return raw


def _cells(path: Path, content: bytes) -> tuple[list[str], list[list[str]], list[int]]:
    """Header, rows of cells, line number of each row."""
    try:
        text = content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise refuse(
            path, "is not a text file; a recording is CSV, Parquet or the .rrd of a run"
        ) from error
    if "\0" in text:
        raise refuse(path, "is not a text file; a recording is CSV, Parquet or the .rrd of a run")
    reader = csv.reader(StringIO(text, newline=None))
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
            raise refuse(
                path,
                f"is separated by {called}; allowed are commas, with a point in decimal numbers",
                1,
            )
    no_twins(path, header)
    return header, rows[1:], lines[1:]
