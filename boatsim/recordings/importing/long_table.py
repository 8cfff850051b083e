"""Signals of a table in long format, each on its own times."""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from boatsim.errors import BadInput
from boatsim.physics.base import Array
from boatsim.recordings.importing.clocks import (
    time_column,
    times_in_seconds,
    times_of_day_from_digits,
    unit_of_counted_times,
)
from boatsim.recordings.importing.coarse_times import spread_coarse_times
from boatsim.recordings.importing.coordinates import degrees_of_degrees_and_minutes
from boatsim.recordings.importing.log import Signal
from boatsim.recordings.importing.long_format import (
    LongFormat,
    LongSignal,
    long_format,
    rows_one_by_one,
    signals_of,
)
from boatsim.recordings.importing.message_times import with_shared_times
from boatsim.recordings.importing.table_columns import (
    column_of_texts,
    unit_by_ending,
    without_placeholders,
)


class LongTable(NamedTuple):
    """Signals of a table in long format.

    Attributes:
        signals: Name -> signal.
        remarks: Messages about the table.
        cells: Pairs of a message about cells and the index of the first row that it concerns.
    """

    signals: dict[str, Signal]
    remarks: list[str]
    cells: list[tuple[str, int]]


def signals_of_long_table(
    columns: Mapping[str, Sequence[str]], separator: str, units: Mapping[str, str]
) -> LongTable | None:
    """Return the signals of a table that has a row for each value; None for another table.

    Args:
        columns: Column -> texts (N,).
        separator: Separator of the table.
        units: Column -> unit, by the header.

    Raises:
        BadInput: No column holds times; without the name of the file.
    """
    form = long_format(columns, separator)
    if form is None:
        return None
    found = signals_of(columns, form)
    clock, t = _times_of_rows(columns, form, found, separator)
    if not clock and form.is_certain:
        raise BadInput(
            f"has a row for each value (column {form.names[-1]} names the signals), but no column "
            "holds their times; call it time"
        )
    if not clock:
        return None
    remarks: list[str] = []
    of_cells: list[tuple[str, int]] = []
    samples: dict[str, tuple[Array, Array]] = {}
    stated: dict[str, str] = {}
    for name, signal in found.items():
        cells = without_placeholders(column_of_texts(name, signal.cells, separator))
        if not np.isfinite(cells.values).any():
            continue
        known = np.isfinite(cells.values)
        own, values = t[signal.rows][known], cells.values[known]
        spread = spread_coarse_times(own, [values])
        samples[name] = (own if spread is None else spread.t, values)
        stated[name] = signal.unit or cells.unit or units.get(form.values[0], "")
        if len(signal.units) > 1:
            remarks.append(
                f"{name} has values in {' and '.join(signal.units[:2])}: no unit is taken"
            )
        for message, row in cells.remarks:
            of_cells.append((f"signal {name}: {message}", int(signal.rows[row])))
    if not samples:
        return None
    places = degrees_of_degrees_and_minutes({name: values for name, (_, values) in samples.items()})
    for name, values in places.items():
        samples[name] = (samples[name][0], values)
    if places:
        remarks.append(
            f"{' and '.join(places)} are degrees and minutes (ddmm.mmm): read as degrees"
        )
    signals = {}
    for name, (own, values) in with_shared_times(samples).items():
        signals[name] = Signal(own, values, stated[name] or unit_by_ending(name))
    remarks.insert(
        0,
        f"has a row for each value: column {' and '.join(form.names)} names {len(signals)} "
        f"signals, {' and '.join(form.values)} holds their values and {clock} their times; each "
        "becomes a column on its own times",
    )
    return LongTable(signals, remarks, of_cells)


def _times_of_rows(
    columns: Mapping[str, Sequence[str]],
    form: LongFormat,
    found: Mapping[str, LongSignal],
    separator: str,
) -> tuple[str, Array]:
    """The column of the times of a table in long format, "" for none, and the times (N,) [s]."""
    count = len(columns[form.names[0]])
    # times of day go on after midnight in the order of the rows: of all, or of each signal
    parts: list[NDArray[np.int64]] = [np.arange(count)]
    if rows_one_by_one(found, count):
        parts = [signal.rows for signal in found.values()]
    values, dates, called = dict[str, Array](), list[str](), dict[str, str]()
    for name in form.others:
        plain = name.lstrip("_")  # _time
        called[plain], values[plain] = name, np.full(count, np.nan)
        for rows in parts:
            cells = column_of_texts(name, [columns[name][i] for i in rows.tolist()], separator)
            values[plain][rows] = np.where(np.isfinite(cells.values), cells.values, np.nan)
            if cells.are_dates and plain not in dates:
                dates.append(plain)
    most = max(found.values(), key=lambda signal: len(signal.rows)).rows
    usual = {name: whole[most] for name, whole in values.items()}
    clock = time_column(usual, dates)
    if clock is None:
        return "", np.empty(0)
    whole = values[clock]
    if clock in dates:
        return called[clock], whole
    if times_of_day_from_digits(usual[clock]) is None:
        counted = unit_of_counted_times(clock, usual[clock])
        return called[clock], times_in_seconds(clock, whole, counted)
    t = np.full(count, np.nan)
    for rows in parts:
        of_day = times_of_day_from_digits(whole[rows])
        if of_day is not None:
            t[rows] = of_day
    return called[clock], t
