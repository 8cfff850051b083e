"""Reader of tables: Parquet, and CSV with any separator, comments and units."""

import csv
import re
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from itertools import repeat
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from boatsim.physics.base import Array
from boatsim.recordings.importing.cells import (
    EMPTY_WORDS,
    Cells,
    column_of_cells,
    number_of_cell,
)
from boatsim.recordings.importing.clocks import time_column, times_in_seconds
from boatsim.recordings.importing.dates import seconds_from_dates
from boatsim.recordings.importing.log import (
    MAX_SIGNALS,
    MAX_TEXT_BYTES,
    Log,
    MemoryBudget,
    Signal,
    damaged_log_error,
)
from boatsim.recordings.notes import unit_of
from boatsim.recordings.raw_table import check_unique_names, file_error

if TYPE_CHECKING:
    from pyarrow import ChunkedArray

SUFFIXES = (".csv", ".tsv", ".parquet", ".pq")
SEPARATORS = ",;\t|"
BLANK = " "  # any number of blanks between the cells
COMMENT = ("#", "%", "//")
BRACKETS = re.compile(r"[\[(]([^\])]*)[\])]\s*$")  # Heading [deg]
PER_SECOND = re.compile(r"(?:^|[_ ])(rad|deg|m)[_ ](?:per[_ ])?s(?:ec)?$")
MAX_HEAD = 1_000_000  # [bytes] that are read to find names and units
csv.field_size_limit(1_000_000)


def read(path: Path) -> Log:
    """Return all columns with numbers, at the times of the time column. Raises BadInput."""
    if path.suffix.lower() in (".parquet", ".pq"):
        return _log(path, _parquet(path), {})
    return _csv(path)


def _log(
    path: Path,
    columns: Mapping[str, Array],
    units: Mapping[str, str],
    remarks: tuple[str, ...] = (),
    dates: Collection[str] = (),
) -> Log:
    clock = time_column(columns, dates)
    count = len(next(iter(columns.values()), ()))
    if clock is None:
        t = np.arange(count, dtype=float)
    else:
        t = times_in_seconds(clock, columns[clock])
    signals: dict[str, Signal] = {}
    for name, values in columns.items():
        if np.isfinite(values).any():
            unit = units.get(name, "") or _unit(name)
            if name == clock:
                unit = "s"
            signals[name] = Signal(t, values, unit)
    if clock in dates or (clock and clock.startswith("column_")):
        remarks = (*remarks, f"{path}: the times are those of column {clock}")
    if not clock:
        no_time = (
            f"{path}: no column holds times: rows are counted; the map can name it with `time`"
        )
        remarks = (*remarks, no_time)
    return Log(path, signals, remarks=remarks)


def _unit(name: str) -> str:
    """The unit by the end of a name; `yaw_rate_deg_s` is in deg/s."""
    per = PER_SECOND.search(name.lower())
    if per:
        return f"{per[1]}/s"
    return unit_of(name)


def _parquet(path: Path) -> dict[str, Array]:
    import pyarrow as pa  # 60 ms, comes with rerun-sdk
    from pyarrow import parquet

    try:
        file = parquet.ParquetFile(path)
        MemoryBudget(path).count_values(
            file.metadata.num_rows * file.metadata.num_columns, file.metadata.num_columns
        )
        numeric = [f.name for f in file.schema_arrow if _is_number(pa.types, f.type)]
        table = file.read(columns=numeric)
    except (pa.ArrowException, OSError, ValueError) as error:
        raise damaged_log_error(path, "Parquet", error) from error
    check_unique_names(path, table.column_names)
    columns: dict[str, Array] = {}
    for name, column in zip(table.column_names, table.columns, strict=True):
        if pa.types.is_timestamp(column.type):
            stamps = column.cast(pa.timestamp("us"), safe=False).to_numpy().astype("M8[us]")
            columns[name] = np.where(np.isnat(stamps), np.nan, stamps.astype("i8") * 1e-6)
        if pa.types.is_boolean(column.type):
            column = column.cast("int8")
        if name not in columns:
            columns[name] = np.asarray(column.cast("float64", safe=False).to_numpy(), dtype=float)
    return columns


def _is_number(types: Any, kind: Any) -> bool:
    """Whether a column has numbers, truth values or times; texts are not unpacked."""
    names = ("integer", "floating", "decimal", "boolean", "timestamp")
    return any(getattr(types, f"is_{name}")(kind) for name in names)


@dataclass(frozen=True)
class _Header:
    """Names, separator and units at the begin of a table."""

    columns: list[str]
    separator: str
    units: dict[str, str]
    row: int  # line of the first row of numbers, counted from 0


def _csv(path: Path) -> Log:
    head = _read_header(path)
    remarks: tuple[str, ...] = ()
    columns = _read_fast(path, head)
    if columns is None:
        columns, remarks = _read_line_by_line(path, head)
    values, dates = dict[str, Array](), list[str]()
    for name, cells in columns.items():
        values[name] = cells.values
        if cells.are_dates:
            dates.append(name)
    remarks = (*remarks, *_cell_remarks(path, head, columns))
    return _log(path, values, head.units, remarks, dates)


def _cell_remarks(path: Path, head: "_Header", columns: Mapping[str, Cells]) -> list[str]:
    """Remarks on cells that were changed or left empty, with column and line of the file."""
    found = []
    lines: list[int] = []
    for name, cells in columns.items():
        for message, row in cells.remarks:
            lines = lines or _lines_of_rows(path, head)
            found.append(f"{path}: row {lines[row]}, column {name}: {message}")
    return found


def _lines_of_rows(path: Path, head: "_Header") -> list[int]:
    """Line of the file of each row of numbers, counted from 1."""
    lines = enumerate(_text(path, path.read_bytes()).splitlines(), 1)
    rows = []
    for i, line in lines:
        if i > head.row and line.strip() and not line.lstrip().startswith(COMMENT):
            rows.append(i)
    return rows


def _read_header(path: Path) -> _Header:
    """Separator, names and units of a table. Raises BadInput."""
    with path.open("rb") as file:
        begin = _text(path, file.read(MAX_HEAD))
    lines = [(i, line) for i, line in enumerate(begin.splitlines()) if line.strip()]
    while lines and lines[0][1].lstrip().startswith(COMMENT) and not _may_be_header(lines):
        lines.pop(0)
    if not lines:
        raise file_error(path, "is empty")
    if len(lines) < 2:
        raise file_error(path, "has a header and no rows")
    first = lines[0][1].lstrip("#%/ ")
    separator = _separator(first, lines[1][1])
    header = _names(_cells(first, separator))
    if len(header) > MAX_SIGNALS:
        raise file_error(path, f"has {len(header)} columns; no log of a boat has as many")
    check_unique_names(path, header)
    if None not in map(number_of_cell, header, repeat(separator)):
        raise file_error(
            path,
            "has no header: its first row is numbers; names of columns are needed",
            lines[0][0] + 1,
        )
    units: dict[str, str] = {}
    for name in header:
        if found := BRACKETS.search(name):
            units[name] = found[1].strip()
    below = _cells(lines[1][1], separator)
    if len(below) == len(header) and _is_units(below, header, separator):
        if len(lines) < 3:
            raise file_error(path, "has a header and no rows")
        units = dict(zip(header, map(str.strip, below, repeat("[]() ")), strict=True))
        lines.pop(0)
    return _Header(header, separator, units, lines[1][0])


def _separator(header: str, row: str) -> str:
    """Separator of the cells of a table; blanks if header and row have equally many words."""
    best = max(SEPARATORS, key=header.count)
    if best not in header and len(header.split()) == len(row.split()) > 1:
        return BLANK
    return best


def _cells(line: str, separator: str) -> list[str]:
    """Cells of a line. Raises csv.Error."""
    if separator == BLANK:
        return line.split()
    return next(csv.reader([line], delimiter=separator), [])


def _names(header: Sequence[str]) -> list[str]:
    """Names of the columns; one without a name is called by its number."""
    names = list(map(str.strip, header))
    for i, name in enumerate(names, 1):
        if not name and f"column_{i}" not in names:
            names[i - 1] = f"column_{i}"
    return names


def _read_fast(path: Path, head: _Header) -> dict[str, Cells] | None:
    """The columns of a table, read by native code.

    None if some rows differ from the header in length.
    """
    import pyarrow as pa
    from pyarrow import csv as arrow

    if len(set(head.columns)) < len(head.columns) or head.separator == BLANK:
        return None
    room, batches = MemoryBudget(path), []
    try:
        pieces = arrow.open_csv(
            path,
            arrow.ReadOptions(column_names=head.columns, skip_rows=head.row),
            arrow.ParseOptions(delimiter=head.separator),
            arrow.ConvertOptions(
                column_types=dict.fromkeys(head.columns, pa.string()), strings_can_be_null=False
            ),
        )
        for piece in pieces:
            room.count_values(piece.num_rows * piece.num_columns, piece.num_columns)
            batches.append(piece)
    except (pa.ArrowException, OSError, ValueError):
        return None
    found = pa.Table.from_batches(batches, pieces.schema)
    return {name: _numbers_of_texts(found[name], head.separator) for name in head.columns}


def _numbers_of_texts(column: "ChunkedArray", separator: str) -> Cells:
    """Numbers of a column of texts, by native code if all cells are numbers or empty."""
    import pyarrow as pa
    from pyarrow import compute

    texts = column
    if separator != ",":
        texts = compute.replace_substring(column, ",", ".")
    empty = compute.is_in(compute.utf8_lower(texts), pa.array(EMPTY_WORDS))
    try:
        filled = compute.if_else(empty, pa.scalar(None, pa.string()), texts)
        return Cells(np.array(filled.cast(pa.float64()).to_numpy(), dtype=float))
    except pa.ArrowException:
        return column_of_cells(column.to_pylist(), separator)


def _read_line_by_line(path: Path, head: _Header) -> tuple[dict[str, Cells], tuple[str, ...]]:
    """The columns of any other table, and remarks. Raises BadInput with the line of a mistake."""
    if path.stat().st_size > MAX_TEXT_BYTES:
        raise file_error(
            path,
            f"has rows that differ from its header, and {path.stat().st_size:,} bytes; at most "
            f"{MAX_TEXT_BYTES:,} of such a "
            "table are read",
        )
    lines = enumerate(_text(path, path.read_bytes()).splitlines())
    kept = [(i + 1, line) for i, line in lines if i >= head.row and line.strip()]
    MemoryBudget(path).count_values(len(head.columns) * len(kept), len(head.columns))
    rows, remarks = _rows(path, kept, head.separator, len(head.columns))
    if not rows:
        raise file_error(path, "has a header and no rows")
    cells_of = zip(*rows, strict=True)
    columns: dict[str, Cells] = {}
    for name, cells in zip(head.columns, cells_of, strict=True):
        columns[name] = column_of_cells(cells, head.separator)
    return columns, remarks


def _text(path: Path, found: bytes) -> str:
    if b"\0" in found[:4096]:
        raise file_error(path, "is not a text file")
    try:
        return found.decode("utf-8-sig")
    except UnicodeDecodeError:
        return found.decode("latin-1")  # old programs write degree signs so


def _may_be_header(lines: Sequence[tuple[int, str]]) -> bool:
    """Whether a commented line is the header: the next line is no comment and has as many cells."""
    if len(lines) < 2 or lines[1][1].lstrip().startswith(COMMENT):
        return False
    separator = max(SEPARATORS, key=lines[1][1].count)
    return lines[0][1].count(separator) == lines[1][1].count(separator) > 0


def _rows(
    path: Path, lines: Sequence[tuple[int, str]], separator: str, width: int
) -> tuple[list[list[str]], tuple[str, ...]]:
    """Rows with as many cells as the header, without a last one that is cut. Raises BadInput."""
    rows: list[list[str]] = []
    for k, (number, line) in enumerate(lines):
        if line.lstrip().startswith(COMMENT):
            continue
        try:
            cells = _cells(line, separator)
        except csv.Error as error:
            raise file_error(path, f"is not CSV ({error})", number) from error
        if len(cells) == width + 1 and not cells[-1].strip():
            cells.pop()  # a separator at the end
        if len(cells) != width:
            if k == len(lines) - 1:
                return rows, (f"{path}: its last row is cut and left out",)
            raise file_error(
                path, f"has {len(cells)} cells; the header has {width} columns", number
            )
        rows.append(cells)
    return rows, ()


def _is_units(row: Sequence[str], header: Sequence[str], separator: str) -> bool:
    """Whether the row below the header has units: short words and no numbers."""
    filled = list(filter(str.strip, row))
    if not filled or 2 * len(filled) < len(header):
        return False
    for cell in filled:
        if number_of_cell(cell, separator) is not None or len(cell.strip()) > 10:
            return False
        if seconds_from_dates([cell]) is not None:
            return False
    return True
