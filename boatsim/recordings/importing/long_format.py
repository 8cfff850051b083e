"""Tables in long format: a row for each value, with the name of its signal in another column.

Loggers of CAN, MQTT and time series write them. Each signal becomes a column on its own times.
"""

import json
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from boatsim.recordings.importing.cells import NUMBER_AND_UNIT, number_of_cell
from boatsim.recordings.importing.clocks import is_called_a_time
from boatsim.recordings.importing.dates import seconds_from_dates
from boatsim.recordings.importing.drive_names import OUTPUTS
from boatsim.recordings.importing.log import MAX_SIGNALS
from boatsim.recordings.importing.motion_names import MOTIONS, POSE_WORDS
from boatsim.recordings.importing.signal_words import tokenize_name

# Words of the column with the names of the signals, the most specific first: where a table has a
# device and a quantity, the quantity is the name
NAME_WORDS = (
    *("signal", "signals", "field", "variable", "parameter", "param", "quantity", "metric"),
    *("item", "key", "tag", "tagname", "point", "channel", "topic", "measurement", "name"),
    *("sensor", "series", "object", "entity", "message", "id", "pgn", "device", "node", "source"),
)
VALUE_WORDS = {"value", "values", "val", "reading", "payload", "data", "state"}
UNIT_WORDS = {"unit", "units", "uom"}
# Words of columns that describe a row or its quality, and are no part of the name of a signal
DESCRIPTIONS = {"quality", "status", "qos", "retain", "type", "datatype", "flag", "flags"}
SAMPLE = 400  # rows by which the content of the columns is known
MIN_WORDS = 0.9  # share of the filled cells that are words, in a column of names
# A signal has at least this many rows on average; texts that hardly repeat are messages
MIN_ROWS = 3.0
# Share of the rows after which another signal follows, where only one column is known by its name;
# the mode of a vessel stays for many rows
MIN_CHANGES = 0.3
MIN_BACKWARD = 0.5  # share of the changes of the signal at which the time goes back: one by one
# Words of a column that is one signal itself, in a table with a row for each time
QUANTITIES = {*POSE_WORDS, *OUTPUTS, *MOTIONS, "lat", "lon", "latitude", "longitude", "rate"}
MAX_NUMBERED = 256  # signals that are named by whole numbers, such as channels


@dataclass(frozen=True)
class LongFormat:
    """Columns of a table in long format.

    Attributes:
        names: Columns whose texts together are the name of a signal.
        values: Columns with its value, of which one is filled in each row.
        unit: Column with its unit; "" without one.
        others: Other columns, one of which holds the times.
        is_certain: Whether the columns of names and values are both called so.
    """

    names: tuple[str, ...]
    values: tuple[str, ...]
    unit: str
    others: tuple[str, ...]
    is_certain: bool


@dataclass(frozen=True)
class LongSignal:
    """Cells of one signal.

    Attributes:
        rows: Rows (N,) of the table.
        cells: Texts (N,) of the values.
        unit: Its unit; "" where none or several are stated.
        units: All units that are stated.
    """

    rows: "np.ndarray[tuple[int, ...], np.dtype[np.int64]]"
    cells: list[str]
    unit: str
    units: tuple[str, ...]


def may_be_long(sample: Mapping[str, Sequence[str]], separator: str) -> bool:
    """Return whether the first rows of a table may be those of a long format.

    Args:
        sample: Column -> texts of the first rows.
        separator: Separator of the table.
    """
    return _columns_by_name(sample, separator) is not None


def long_format(columns: Mapping[str, Sequence[str]], separator: str) -> LongFormat | None:
    """Return the columns of a table that has a row for each value; None for another table.

    Two signs are needed: columns of names and of values that are called so, or one of them and
    names that change from row to row, as no state of a vessel does.

    Args:
        columns: Column -> texts (N,).
        separator: Separator of the table.
    """
    sample = {name: cells[:SAMPLE] for name, cells in columns.items()}
    found = _columns_by_name(sample, separator)
    if found is None:
        return None
    form, labels = found
    primary = form.names[0]
    count = Counter(columns[primary])
    most = MAX_SIGNALS if primary in labels else MAX_NUMBERED
    rows = len(columns[primary])
    if len(count) > most or rows < MIN_ROWS * len(count):
        return None
    if not form.is_certain and not _changes_as_signals_do(
        columns[primary], form, columns, separator
    ):
        return None
    further = []
    for label in labels:
        if label != primary and _tells_signals_apart(columns[label], columns[primary]):
            further.append(label)
    return replace(form, names=(*further, primary))


def _columns_by_name(
    sample: Mapping[str, Sequence[str]], separator: str
) -> tuple[LongFormat, list[str]] | None:
    """The columns by their names and the first rows, and the columns of words.

    None for a table that is not in long format.
    """
    words = {name: tokenize_name(name) for name in sample}
    labels = [name for name in sample if _has_words(sample[name], separator)]
    units = [name for name in labels if UNIT_WORDS & set(words[name])]
    described = [name for name in sample if DESCRIPTIONS & set(words[name])]
    values = []
    for name in sample:
        if VALUE_WORDS & set(words[name]) and not (UNIT_WORDS | DESCRIPTIONS) & set(words[name]):
            if name not in labels or "payload" in words[name]:
                values.append(name)
    free = [name for name in labels if name not in (*units, *described, *values)]
    primary = _column_of_names(free, words)
    is_named = primary != ""
    if not primary and values:
        primary = _column_of_names(_numbered(sample, separator, values), words)
        is_named = primary != ""
    if not primary and len(free) == 1:
        primary = free[0]
    if not primary:
        return None
    has_values = bool(values)
    others = [n for n in sample if n not in (*labels, *values, *described, primary)]
    if not values:
        values = _only_numbers(sample, others, separator)
        if not is_named and QUANTITIES & set(words[values[0]] if values else ()):
            return None
    others = [name for name in others if name not in values]
    is_certain = is_named and has_values
    if not values or not (others or is_certain):
        return None
    unit = units[0] if units else ""
    return LongFormat((primary,), tuple(values), unit, tuple(others), is_certain), free


def _has_words(cells: Sequence[str], separator: str) -> bool:
    """Whether a column has words, and neither numbers, numbers with units nor dates."""
    filled = [cell.strip() for cell in cells if cell.strip()]
    if not filled:
        return False
    count = 0
    for cell in filled:
        is_number = number_of_cell(cell, separator) is not None
        is_word = not is_number and NUMBER_AND_UNIT.fullmatch(cell) is None
        count += is_word and any(map(str.isalpha, cell)) and not cell.startswith("{")
    return count >= MIN_WORDS * len(filled) and seconds_from_dates(filled[:50]) is None


def _column_of_names(names: Sequence[str], words: Mapping[str, Sequence[str]]) -> str:
    """The column that is called one of names, the most specific word first; "" for none."""
    for word in NAME_WORDS:
        for name in names:
            if word in words[name]:
                return name
    return ""


def _numbered(
    sample: Mapping[str, Sequence[str]], separator: str, values: Sequence[str]
) -> list[str]:
    """Columns of whole numbers that are called neither a time nor a value."""
    found = []
    for name, cells in sample.items():
        if name in values or is_called_a_time(name):
            continue
        numbers = [number_of_cell(cell, separator) for cell in cells]
        if all(number is not None and number == np.round(number) for number in numbers):
            found.append(name)
    return found


def _only_numbers(
    sample: Mapping[str, Sequence[str]], names: Sequence[str], separator: str
) -> list[str]:
    """The only column of numbers that is no time; [] where there are several."""
    found = []
    for name in names:
        numbers = [number_of_cell(cell, separator) for cell in sample[name]]
        known = [number for number in numbers if number is not None]
        is_time = is_called_a_time(name) or _increases(known)
        if 2 * len(known) > len(numbers) and not is_time:
            found.append(name)
    return found if len(found) == 1 else []


def _increases(values: Sequence[float]) -> bool:
    """Whether numbers never decrease, as times do."""
    finite = [value for value in values if np.isfinite(value)]
    return len(finite) > 1 and finite[-1] > finite[0] and all(b >= a for a, b in pairwise(finite))


def _changes_as_signals_do(
    names: Sequence[str], form: LongFormat, columns: Mapping[str, Sequence[str]], separator: str
) -> bool:
    """Whether names change from row to row, or the time goes back where another one begins."""
    changes = [i for i in range(1, len(names)) if names[i] != names[i - 1]]
    if not changes:
        return False
    if len(changes) >= MIN_CHANGES * len(names):
        return True
    for clock in form.others:
        back = 0
        for i in changes:
            before = number_of_cell(columns[clock][i - 1], separator)
            after = number_of_cell(columns[clock][i], separator)
            back += before is not None and after is not None and after < before
        if back >= MIN_BACKWARD * len(changes):
            return True
    return False


def _tells_signals_apart(labels: Sequence[str], names: Sequence[str]) -> bool:
    """Whether one name belongs to several labels, such as the same quantity of two devices."""
    count = Counter(zip(names, labels, strict=True))
    if len(names) < MIN_ROWS * len(count):
        return False
    return len(count) > len(set(names))


def signals_of(columns: Mapping[str, Sequence[str]], form: LongFormat) -> dict[str, LongSignal]:
    """Return the cells of each signal of a table in long format, in the order of their begin.

    A value that is an object of JSON gives a signal for each of its numbers.

    Args:
        columns: Column -> texts (N,).
        form: Columns of names and values.
    """
    rows: dict[str, list[int]] = {}
    cells: dict[str, list[str]] = {}
    units: dict[str, Counter[str]] = {}
    for i, parts in enumerate(zip(*(columns[name] for name in form.names), strict=True)):
        name = ".".join(part.strip() for part in parts if part.strip())
        if form.names[-1] and name.lstrip("-").isdigit():
            name = f"{form.names[-1]}_{name}"
        value = ""
        for column in form.values:
            value = value or columns[column][i].strip()
        unit = columns[form.unit][i].strip() if form.unit else ""
        for key, text in _values_of_cell(value).items():
            full = f"{name}.{key}" if key else name
            rows.setdefault(full, []).append(i)
            cells.setdefault(full, []).append(text)
            units.setdefault(full, Counter())[unit] += 1
    found = {}
    for name, own in rows.items():
        stated = tuple(unit for unit in units[name] if unit)
        unit = stated[0] if len(stated) == 1 else ""
        found[name] = LongSignal(np.array(own, dtype=np.int64), cells[name], unit, stated)
    return found


def _values_of_cell(text: str) -> dict[str, str]:
    """Key -> value of a cell; the key is "" unless the cell is an object of JSON."""
    if not text.startswith("{"):
        return {"": text}
    try:
        content = json.loads(text)
    except (ValueError, RecursionError):
        return {"": text}
    found = {}
    for key, value in content.items():
        if isinstance(value, int | float | str):
            found[str(key)] = str(value)
    return found


def rows_one_by_one(found: Mapping[str, LongSignal], rows: int) -> bool:
    """Return whether a table has the rows of one signal after those of another.

    Args:
        found: Cells of each signal.
        rows: Number of rows.
    """
    begins = 0
    for signal in found.values():
        begins += 1 + int(np.sum(np.diff(signal.rows) > 1))
    return begins < 2 * len(found) + rows // SAMPLE
