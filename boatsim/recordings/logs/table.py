"""Reader of tables: Parquet, and CSV with any separator, comments and units."""

import codecs
import csv
import re
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import repeat
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from boatsim.errors import BadInput
from boatsim.physics.base import Array
from boatsim.recordings.importing.cells import (
    EMPTY_WORDS,
    Cells,
    is_number,
)
from boatsim.recordings.importing.clock_units import SECONDS, unit_of_clock, with_unit
from boatsim.recordings.importing.clocks import (
    calendar_times,
    is_called_a_time,
    seconds_and_fraction,
    time_column,
    times_in_seconds,
    times_of_day_from_digits,
    unit_of_counted_times,
)
from boatsim.recordings.importing.coarse_times import share_of_equal_times, spread_coarse_times
from boatsim.recordings.importing.coordinates import (
    degrees_of_degrees_and_minutes,
    kind_of_place,
    places_of_hemispheres,
)
from boatsim.recordings.importing.dates import may_be_digits_of_date, seconds_from_dates
from boatsim.recordings.importing.day_counts import day_count
from boatsim.recordings.importing.late_rows import late_rows_remark
from boatsim.recordings.importing.log import (
    MAX_SIGNALS,
    MAX_TEXT_BYTES,
    Log,
    MemoryBudget,
    Signal,
    damaged_log_error,
)
from boatsim.recordings.importing.long_format import SAMPLE, may_be_long
from boatsim.recordings.importing.long_table import LongTable, signals_of_long_table
from boatsim.recordings.importing.lost_points import may_have_lost_points
from boatsim.recordings.importing.table_columns import (
    column_of_texts,
    unit_by_ending,
    without_placeholders,
)
from boatsim.recordings.importing.table_layout import (
    BLANK,
    cells_of_line,
    header_line,
    is_row_of_numbers,
    is_row_of_table,
    separator_of,
)
from boatsim.recordings.raw_table import check_unique_names, file_error

if TYPE_CHECKING:
    from pyarrow import ChunkedArray, Table

SUFFIXES = (".csv", ".tsv", ".parquet", ".pq")
COMMENT = ("#", "%", "//")
BRACKETS = re.compile(r"[\[(]([^\])]*)[\])]\s*$")  # Heading [deg]
LONG_UNITS = {"min": "minutes", "h": "hours", "d": "days"}  # of a clock, which get a remark
# Share of rows with the time of the row before; a few rows may be simultaneous
MIN_EQUAL_TIMES = 0.3
MAX_HEAD = 1_000_000  # [bytes] that are read to find names and units
# Share of the rows that may have another number of cells than the header, because a write was cut
MAX_CUT_ROWS = 0.05
MAX_SHOWN = 40  # characters of a line in a remark
csv.field_size_limit(1_000_000)


def read(path: Path) -> Log:
    """Return all columns with numbers, at the times of the time column. Raises BadInput."""
    if path.suffix.lower() in (".parquet", ".pq"):
        long = _long_parquet(path)
        if long is not None:
            return long
        columns, remarks = dict[str, Array](), list[str]()
        for name, values in _parquet(path).items():
            cells = without_placeholders(Cells(values))
            columns[name] = cells.values
            for message, row in cells.remarks:
                remarks.append(f"{path}: row {row + 1}, column {name}: {message}")
        return _log(path, columns, {}, tuple(remarks))
    return _csv(path)


def _log(
    path: Path,
    columns: Mapping[str, Array],
    units: Mapping[str, str],
    remarks: tuple[str, ...] = (),
    dates: Collection[str] = (),
) -> Log:
    clock = time_column(columns, dates)
    t, how = _times(columns, clock, units.get(clock or "", ""), clock in dates)
    has_times = clock is not None or bool(how)
    if clock is not None and not how:
        how = late_rows_remark(columns, t, (clock,))
    if not has_times:
        how += _constant_clock_remark(columns)
        how += ("no column holds times: rows are counted; the map can name it with `time`",)
    elif clock in dates or (clock and clock.startswith("column_")):
        how = (f"the times are those of column {clock}", *how)
    spread = None
    if has_times:
        others = [values for name, values in columns.items() if name != clock]
        spread = spread_coarse_times(t, others)
        share = share_of_equal_times(t, others)
        if spread is None and share >= MIN_EQUAL_TIMES:
            how += (
                f"{100.0 * share:.3g} % of the rows have the time of the row before: if the "
                "times have too few digits, write them with more",
            )
    if spread is not None:
        t = spread.t
        of_column = f" of column {clock}" if clock is not None else ""
        how += (
            f"{spread.rows:g} rows share each time{of_column}, every {spread.step:g} s; "
            "they are spread evenly until the next time",
        )
    signals: dict[str, Signal] = {}
    for name, values in columns.items():
        if np.isfinite(values).any():
            unit = units.get(name, "") or unit_by_ending(name)
            if name == clock:
                unit = "s"
            signals[name] = Signal(t, values, unit)
    return Log(path, signals, remarks=(*remarks, *(f"{path}: {text}" for text in how)))


def _constant_clock_remark(columns: Mapping[str, Array]) -> tuple[str, ...]:
    """The remark on a column of times that has one value in all rows, such as 1.71387E+12."""
    for name, values in columns.items():
        finite = values[np.isfinite(values)]
        if is_called_a_time(name) and len(finite) > 1 and not np.ptp(finite) > 0.0:
            value = f"{finite[0]:.10g}"
            return (
                f"column {name} is {value} in all rows: were its times written with too few "
                "digits?",
            )
    return ()


def _times(
    columns: Mapping[str, Array], clock: str | None, unit: str, are_dates: bool
) -> tuple[Array, tuple[str, ...]]:
    """Times (N,) [s] of the rows, and remarks on the columns from which they follow.

    `unit` is the one that the table has for its clock outside of the name; dates are in s already.
    """
    parts = calendar_times(columns)
    if parts is None or clock not in (None, *parts.names):
        parts = seconds_and_fraction(columns, clock)
    if parts is not None:
        named = f"{', '.join(parts.names[:-1])} and {parts.names[-1]}"
        late = late_rows_remark(columns, parts.t, parts.names)
        return parts.t, (f"the times are those of columns {named}", *late)
    if clock is None:
        return np.arange(len(next(iter(columns.values()), ())), dtype=float), ()
    if are_dates:
        return columns[clock], ()
    named = with_unit(clock, unit)
    of_day = times_of_day_from_digits(columns[clock])
    if of_day is not None and unit_of_clock(named) in ("", "s"):
        return of_day, (f"the times of column {clock} are read as hours, minutes and seconds",)
    counted = unit_of_counted_times(named, columns[clock])
    if counted:
        step = float(np.nanmedian(np.diff(columns[clock])))
        return times_in_seconds(clock, columns[clock], counted), (
            f"the times of column {clock} are taken as {counted}: they are whole numbers, "
            f"{step:g} from row to row",
        )
    t = times_in_seconds(named, columns[clock])
    days = day_count(columns[clock][np.isfinite(columns[clock])])
    if days is not None and days.name:
        return t, (f"the times of column {clock} are read as {days.name}",)
    word = unit_of_clock(named)
    if word in LONG_UNITS and np.array_equal(t, columns[clock] * SECONDS[word], equal_nan=True):
        return t, (f"the times of column {clock} are in {LONG_UNITS[word]}",)
    return t, ()


def _long_parquet(path: Path) -> Log | None:
    """The log of a Parquet file in long format; None for another table."""
    import pyarrow as pa  # 60 ms, comes with rerun-sdk
    from pyarrow import parquet

    try:
        file = parquet.ParquetFile(path)
        kinds = {field.name: field.type for field in file.schema_arrow}
        texts = [name for name, kind in kinds.items() if _is_text(pa.types, kind)]
        if not texts:
            return None
        first = next(file.iter_batches(SAMPLE), None)
        if first is None:
            return None
        begin = _texts_of_parquet(pa.Table.from_batches([first]))
        if not may_be_long(begin, ","):
            return None
        MemoryBudget(path).count_values(file.metadata.num_rows * len(kinds), len(kinds))
        columns = _texts_of_parquet(file.read())
    except (pa.ArrowException, OSError, ValueError) as error:
        raise damaged_log_error(path, "Parquet", error) from error
    long = _long_table(path, columns, ",", {})
    if long is None:
        return None
    remarks = [*long.remarks, *(f"row {row + 1}, {message}" for message, row in long.cells)]
    return Log(path, long.signals, remarks=tuple(f"{path}: {text}" for text in remarks))


def _is_text(types: Any, kind: Any) -> bool:
    """Whether a column has texts, maybe each written once."""
    if types.is_dictionary(kind):
        kind = kind.value_type
    return bool(types.is_string(kind) or types.is_large_string(kind))


def _texts_of_parquet(table: "Table") -> dict[str, list[str]]:
    """Column -> texts (N,) of the columns that are no lists."""
    import pyarrow as pa

    found: dict[str, list[str]] = {}
    for name, column in zip(table.column_names, table.columns, strict=True):
        try:
            cells = column.cast(pa.string()).to_pylist()
        except pa.ArrowException:
            continue
        found[name] = ["" if cell is None else cell for cell in cells]
    return found


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
    remarks: tuple[str, ...] = ()


def _csv(path: Path) -> Log:
    head = _read_header(path)
    table = _read_fast(path, head) or _read_line_by_line(path, head)
    if may_be_long(table.texts(SAMPLE), head.separator):
        long = _long_table(path, table.texts(), head.separator, head.units)
        if long is not None:
            return _long_log(path, head, table, long)
    remarks, lines = table.remarks, table.lines
    columns = table.numbers(head.separator)
    values, dates = dict[str, Array](), list[str]()
    words, units = dict[str, str](), dict(head.units)
    columns = {name: without_placeholders(cells) for name, cells in columns.items()}
    for name, cells in columns.items():
        values[name] = cells.values
        words[name] = cells.word
        units[name] = units.get(name, "") or cells.unit
        if cells.are_dates:
            dates.append(name)
    remarks = (*head.remarks, *remarks, *_cell_remarks(path, head, columns, lines))
    signed = places_of_hemispheres(values, words)
    values |= signed
    for name in signed:
        letters = "S" if kind_of_place(name) == "latitude" else "W"
        remarks = (*remarks, f"{path}: {name} is negative: its hemisphere is {letters}")
    places = degrees_of_degrees_and_minutes(values)
    if places:
        values |= places
        named = " and ".join(places)
        remarks = (*remarks, f"{path}: {named} are degrees and minutes (ddmm.mmm): read as degrees")
    return _log(path, values, units, remarks, dates)


def _cell_remarks(
    path: Path, head: "_Header", columns: Mapping[str, Cells], lines: list[int]
) -> list[str]:
    """Remarks on cells that were changed or left empty, with column and line of the file.

    `lines` are the lines of the rows of numbers, counted from 1; [] if all lines are rows.
    """
    found = []
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
    lines, remarks = _without_preamble(path, lines)
    if len(lines) < 2:
        raise file_error(path, "has a header and no rows")
    first = lines[0][1].lstrip("#%/ ")
    separator = separator_of(first, lines[1][1])
    header = _names(cells_of_line(first, separator))
    if len(header) > MAX_SIGNALS:
        raise file_error(path, f"has {len(header)} columns; no log of a boat has as many")
    below = [line for _, line in lines[1:SAMPLE]]
    if is_row_of_numbers(header, separator) or is_row_of_table(header, below, separator):
        names = [f"column_{i}" for i in range(1, len(header) + 1)]
        remark = f"{path}: has no header; its columns are called {names[0]} to {names[-1]}"
        return _Header(names, separator, {}, lines[0][0], (*remarks, remark))
    check_unique_names(path, header)
    units: dict[str, str] = {}
    for name in header:
        if found := BRACKETS.search(name):
            units[name] = found[1].strip()
    below = cells_of_line(lines[1][1], separator)
    if len(below) == len(header) and _is_units(below, header, separator):
        if len(lines) < 3:
            raise file_error(path, "has a header and no rows")
        units = dict(zip(header, map(str.strip, below, repeat("[]() ")), strict=True))
        lines.pop(0)
    return _Header(header, separator, units, lines[1][0], remarks)


def _without_preamble(
    path: Path, lines: list[tuple[int, str]]
) -> tuple[list[tuple[int, str]], tuple[str, ...]]:
    """The lines from the header on, and a remark on those before it."""
    begin = header_line([line for _, line in lines])
    first = lines[begin][1].lstrip("#%/ ")
    below = lines[min(begin + 1, len(lines) - 1)][1]
    separator = separator_of(first, below)
    if begin == 0 or is_row_of_numbers(cells_of_line(first, separator), separator):
        return lines, ()
    shown = lines[0][1].strip()[:MAX_SHOWN]
    what = "1 line before the header is" if begin == 1 else f"{begin} lines before the header are"
    return lines[begin:], (f"{path}: {what} left out, the first is {shown!r}",)


def _names(header: Sequence[str]) -> list[str]:
    """Names of the columns; one without a name is called by its number."""
    names = list(map(str.strip, header))
    for i, name in enumerate(names, 1):
        if not name and f"column_{i}" not in names:
            names[i - 1] = f"column_{i}"
    return names


@dataclass(frozen=True)
class _Texts:
    """Texts of a table.

    Attributes:
        columns: Column -> texts (N,), as a column of native code or a sequence.
        lines: Line of the file of each row, counted from 1; [] if all lines are rows.
        remarks: Messages about rows that were left out.
    """

    columns: "Mapping[str, ChunkedArray | Sequence[str]]"
    lines: list[int] = field(default_factory=list)
    remarks: tuple[str, ...] = ()

    def numbers(self, separator: str) -> dict[str, Cells]:
        """Return the numbers of the columns."""
        found = {}
        for name, cells in self.columns.items():
            if isinstance(cells, Sequence):
                found[name] = column_of_texts(name, cells, separator)
            else:
                found[name] = _numbers_of_texts(cells, name, separator)
        return found

    def texts(self, rows: int | None = None) -> dict[str, Sequence[str]]:
        """Return the texts of the first rows, or of all."""
        found: dict[str, Sequence[str]] = {}
        for name, cells in self.columns.items():
            begin = cells[:rows]
            found[name] = begin if isinstance(begin, Sequence) else begin.to_pylist()
        return found


def _long_table(
    path: Path, columns: Mapping[str, Sequence[str]], separator: str, units: Mapping[str, str]
) -> LongTable | None:
    """The signals of a table in long format; None for another table. Raises BadInput."""
    try:
        return signals_of_long_table(columns, separator, units)
    except BadInput as error:
        raise file_error(path, str(error)) from None


def _long_log(path: Path, head: _Header, table: _Texts, long: LongTable) -> Log:
    """The log of a table in long format, with the lines of its remarks."""
    remarks = [f"{path}: {text}" for text in long.remarks]
    lines = table.lines
    for message, row in long.cells:
        lines = lines or _lines_of_rows(path, head)
        remarks.append(f"{path}: row {lines[row]}, {message}")
    MemoryBudget(path).count_values(0, len(long.signals))
    return Log(path, long.signals, remarks=(*head.remarks, *table.remarks, *remarks))


def _read_fast(path: Path, head: _Header) -> _Texts | None:
    """The texts of a table, read by native code.

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
    if _repeats_header(found, head.columns):
        return None
    return _Texts({name: found[name] for name in head.columns})


def _repeats_header(found: "Table", header: Sequence[str]) -> bool:
    """Whether a row is the header again, as loggers write that are started again."""
    from pyarrow import compute

    rows = None
    for name in header[:2]:  # two cells are enough
        same = compute.equal(compute.utf8_trim_whitespace(found[name]), name)
        rows = same if rows is None else compute.and_(rows, same)
    return bool(compute.any(rows).as_py())


def _numbers_of_texts(column: "ChunkedArray", name: str, separator: str) -> Cells:
    """Numbers of a column of texts, by native code if all cells are numbers or empty."""
    import pyarrow as pa
    from pyarrow import compute

    texts = column
    if separator != ",":
        texts = compute.replace_substring(column, ",", ".")
    empty = compute.is_in(compute.utf8_lower(texts), pa.array(EMPTY_WORDS))
    try:
        filled = compute.if_else(empty, pa.scalar(None, pa.string()), texts)
        has_dates = may_be_digits_of_date(next(filter(str.strip, column[:SAMPLE].to_pylist()), ""))
        if has_dates or _may_separate_thousands(column, separator):
            return column_of_texts(name, column.to_pylist(), separator)
        values = np.array(filled.cast(pa.float64()).to_numpy(), dtype=float)
    except pa.ArrowException:
        return column_of_texts(name, column.to_pylist(), separator)
    if may_have_lost_points(values):
        return column_of_texts(name, column.to_pylist(), separator)
    return Cells(values)


def _may_separate_thousands(column: "ChunkedArray", separator: str) -> bool:
    """Whether commas or points may separate thousands, in a table without commas between cells."""
    from pyarrow import compute

    if separator == ",":
        return False
    has_points = bool(compute.any(compute.match_substring(column, ".")).as_py())
    has_commas = bool(compute.any(compute.match_substring(column, ",")).as_py())
    if has_points and has_commas:
        return True
    if not has_points and not has_commas:
        return False
    whole = compute.match_substring_regex(column, r"^\s*([+-]?\d{1,3}([.,]\d{3})*)?\s*$")
    return bool(compute.all(whole).as_py())


def _read_line_by_line(path: Path, head: _Header) -> _Texts:
    """The texts of any other table, the lines of its rows, and remarks.

    Raises BadInput with the line of a mistake.
    """
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
    rows, numbers, remarks = _rows(path, kept, head)
    if not rows:
        raise file_error(path, "has a header and no rows")
    cells_of = zip(*rows, strict=True)
    return _Texts(dict(zip(head.columns, cells_of, strict=True)), numbers, remarks)


def _text(path: Path, found: bytes) -> str:
    if found.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        return found[: len(found) // 2 * 2].decode("utf-16", errors="replace")
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
    separator = separator_of(lines[1][1], "")
    return lines[0][1].count(separator) == lines[1][1].count(separator) > 0


def _rows(
    path: Path, lines: Sequence[tuple[int, str]], head: _Header
) -> tuple[list[list[str]], list[int], tuple[str, ...]]:
    """Rows with as many cells as the header, their lines, and remarks on the others.

    Raises BadInput if many rows have another number of cells.
    """
    width = len(head.columns)
    rows, numbers = list[list[str]](), list[int]()
    again, cut = list[int](), list[tuple[int, int]]()
    for number, line in lines:
        if line.lstrip().startswith(COMMENT):
            continue
        try:
            cells = cells_of_line(line, head.separator)
        except csv.Error as error:
            raise file_error(path, f"is not CSV ({error})", number) from error
        if len(cells) == width + 1 and not cells[-1].strip():
            cells.pop()  # a separator at the end
        if len(cells) != width:
            cut.append((number, len(cells)))
        elif list(map(str.strip, cells)) == head.columns:
            again.append(number)
        else:
            rows.append(cells)
            numbers.append(number)
    remarks = []
    if again:
        repeats = _rows_are(len(again), "the header again")
        remarks.append(f"{path}: row {again[0]}: {repeats} and left out")
    if cut:
        remarks.append(_cut_remark(path, cut, lines[-1][0], len(rows), width))
    return rows, numbers, tuple(remarks)


def _cut_remark(
    path: Path, cut: Sequence[tuple[int, int]], last: int, complete: int, width: int
) -> str:
    """Remark on rows with another number of cells. Raises BadInput if these are many.

    Args:
        path: The table.
        cut: Line and number of cells of each such row.
        last: Last line of the table.
        complete: Number of the other rows.
        width: Number of columns.
    """
    number, cells = cut[0]
    if len(cut) == 1 and number == last:
        return f"{path}: its last row is cut and left out"
    if len(cut) > MAX_CUT_ROWS * (complete + len(cut)):
        raise file_error(path, f"has {cells} cells; the header has {width} columns", number)
    return (
        f"{path}: row {number}: {_rows_are(len(cut), 'cut or joined')} and left out, the first "
        f"has {cells} cells, the header {width} columns"
    )


def _rows_are(count: int, what: str) -> str:
    """Number of rows with the verb of a sentence."""
    if count == 1:
        return f"1 row is {what}"
    return f"{count} rows are {what}"


def _is_units(row: Sequence[str], header: Sequence[str], separator: str) -> bool:
    """Whether the row below the header has units: short words and no numbers."""
    filled = list(filter(str.strip, row))
    if not filled or 2 * len(filled) < len(header):
        return False
    for cell in filled:
        if is_number(cell, separator) or len(cell.strip()) > 10:
            return False
        if seconds_from_dates([cell]) is not None:
            return False
    return True
