"""Reader of CSV: commas between cells, a point in decimal numbers, one header row."""

import csv
from io import StringIO
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from boatsim.physics.base import Array
from boatsim.recordings.limits import MAX_CELLS, MAX_HEADER_BYTES, check_table_size
from boatsim.recordings.raw_table import Raw, check_unique_names, file_error, parse_numbers

if TYPE_CHECKING:
    from pyarrow import ChunkedArray, Table


BLOCK_BYTES = 1 << 20
NOT_TEXT = "is not a text file; a recording is CSV, Parquet or the .rrd of a run"


def read(path: Path) -> Raw:
    """Return the table of a CSV file; blank lines are skipped. Raises BadInput."""
    with path.open("rb") as file:
        first = file.readline(MAX_HEADER_BYTES + 1)
    if len(first) > MAX_HEADER_BYTES:
        raise file_error(path, f"the first line has more than {MAX_HEADER_BYTES} bytes", 1)
    _check_cells(path, first.count(b",") + 1)
    content = path.read_bytes()
    return _read_fast(path, first, content) or _read_line_by_line(path, content)


def _check_cells(path: Path, columns: int) -> None:
    """Count the cells before memory is allocated for any. Raises BadInput for too many."""
    cells = 0
    with path.open("rb") as file:
        check_table_size(path, columns)
        while block := file.read(BLOCK_BYTES):
            cells += block.count(b",") + block.count(b"\n")
            if cells > MAX_CELLS:
                raise file_error(
                    path, f"has more than {MAX_CELLS:.3g} cells, the limit of a recording"
                )
        check_table_size(path, columns, cells)


def _read_fast(path: Path, first: bytes, content: bytes) -> Raw | None:
    """The table read by native code; None if a row is not a line or a row has a mistake."""
    header = _header(first)
    if header is None or b"\0" in content or content.count(b"\r") > content.count(b"\r\n"):
        return None
    if (table := _table(header, content)) is None:
        return None
    lines = content.count(b"\n") + (not content.endswith(b"\n"))
    if lines != 1 + table.num_rows:  # there is a blank line, or a cell of several lines
        return None
    raw = Raw(path, {}, range(2, 2 + table.num_rows))
    for name, column in zip(header, table.columns, strict=True):
        raw.columns[name] = _numbers(raw, name, column)
    empty = np.isnan(list(raw.columns.values())).all(axis=0)
    if empty.any():
        return None
    return raw


def _header(first: bytes) -> list[str] | None:
    """Names of the columns; None for a first line that is not printable or has duplicate names."""
    try:
        line = first.decode("utf-8-sig").removesuffix("\n").removesuffix("\r")
    except UnicodeDecodeError:
        return None
    if not line.isprintable():
        return None
    header = list(map(str.strip, next(csv.reader([line]), [])))
    if len(set(header)) == len(header) > 1:
        return header
    return None


def _table(header: list[str], content: bytes) -> "Table | None":
    """All cells as texts; None if rows differ in length or the file is not a text."""
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
    """Numbers (N,) of a column of texts, cell by cell if some are not numbers."""
    import pyarrow as pa
    from pyarrow import compute

    try:
        filled = compute.if_else(compute.equal(column, ""), pa.scalar(None, pa.string()), column)
        found = np.array(filled.cast(pa.float64()).to_numpy(), dtype=float)
    except pa.ArrowException:
        return parse_numbers(raw, name, column.to_pylist())
    if np.isnan(found).sum() == filled.null_count:
        return found
    # pyarrow reads further words as nan
    return parse_numbers(raw, name, column.to_pylist())


def _read_line_by_line(path: Path, content: bytes) -> Raw:
    """The table. Raises BadInput with the line of the first mistake."""
    header, rows, lines = _cells(path, content)
    for row, cells in zip(lines, rows, strict=True):
        if len(cells) != len(header):
            raise file_error(
                path, f"has {len(cells)} cells; the header has {len(header)} columns", row
            )
    raw = Raw(path, {}, lines)
    by_column = list(zip(*rows, strict=True)) or [()] * len(header)
    for name, column in zip(header, by_column, strict=True):
        raw.columns[name] = parse_numbers(raw, name, column)
    return raw


def _cells(path: Path, content: bytes) -> tuple[list[str], list[list[str]], list[int]]:
    """Header, rows of cells, line number of each row."""
    try:
        text = content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise file_error(path, NOT_TEXT) from error
    if "\0" in text:
        raise file_error(path, NOT_TEXT)
    reader = csv.reader(StringIO(text, newline=None))
    rows, lines = [], []
    try:
        for cells in reader:
            if any(cells):
                rows.append(cells)
                lines.append(reader.line_num)
    except csv.Error as error:
        raise file_error(path, f"is not CSV ({error})", reader.line_num) from error
    if not rows:
        raise file_error(path, "is empty")
    header = list(map(str.strip, rows[0]))
    for character, called in ((";", "semicolons"), ("\t", "tabs")):
        if len(header) == 1 and character in header[0]:
            raise file_error(
                path,
                f"is separated by {called}; allowed are commas, with a point in decimal numbers",
                1,
            )
    check_unique_names(path, header)
    return header, rows[1:], lines[1:]
