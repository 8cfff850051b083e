"""Rows of a recording: their times, the part to use, and those that are complete."""

from collections.abc import Mapping

import numpy as np

from boatsim.errors import BadInput
from boatsim.physics.base import Array
from boatsim.physics.signals import POSE, RATES
from boatsim.recordings.conversion import Allocation, Curve, Range
from boatsim.recordings.importing.conversion_remarks import remark_rates
from boatsim.recordings.importing.conversion_state import HELD, ConversionState, signal_of
from boatsim.recordings.importing.resample import mean_held_values, row_times
from boatsim.recordings.importing.several_logs import file_begin_line
from boatsim.recordings.importing.time_zones import shifts_of_zones
from boatsim.recordings.raw_table import file_error, select_rows
from boatsim.recordings.table import FEWEST_ROWS, allowed_empty_rows

FASTER = 1.5  # commands set the clock if their rate is this many times that of the poses
ROW_TOLERANCE = 0.05  # a sample is in a row if it is nearer than this share of the step of the rows
MAX_ROUNDS = 4
MAX_ROWS = 5_000_000


def row_times_of_columns(work: ConversionState) -> tuple[Array, float]:
    """Return times (N,) of the rows [s], and the largest distance of a sample from its row [s].

    The rows are the samples of the fastest signal and those of others at other times, or evenly
    spaced at the rate of the map.

    Args:
        work: State of the conversion, which gets remarks.

    Raises:
        BadInput: The signals have too little time in common, or there would be too many rows.
    """
    poses, commands = [], []
    for name, column in work.columns.items():
        if name in (*POSE, *RATES):
            poses.append(column.given)
        if column.held and not name.startswith(HELD):
            commands.append(column.given)
    fastest = max(poses, key=lambda one: one.rate)
    quick = max(commands, key=lambda one: one.rate, default=fastest)
    if quick.rate > FASTER * fastest.rate:
        fastest = quick
    begin = min(float(one.t[0]) for one in poses)
    for one in commands:
        begin = max(begin, float(one.t[0]))
    end = _last_time(work, max(float(one.t[-1]) for one in poses))
    if work.map.rate:
        if (end - begin) * work.map.rate > MAX_ROWS:
            raise BadInput(
                f"{work.file}: rate = {work.map.rate:g} Hz over {end - begin:g} s is more than "
                f"{MAX_ROWS:,} rows"
            )
        rows = begin + np.arange(0.0, max(end - begin, 0.0) + 1e-9, 1.0 / work.map.rate)
    else:
        rows = fastest.t[(fastest.t >= begin - 1e-9) & (fastest.t <= end + 1e-9)]
    rows = rows[rows_in_use(work, rows)]
    if len(rows) < FEWEST_ROWS:
        span = "no time at all"
        if end > begin:
            span = f"{end - begin:.3g} s"
        raise file_error(
            work.log.path,
            f"poses and commands have {span} in common, in which the fastest has {len(rows)} "
            "samples; at least "
            f"{FEWEST_ROWS} are needed{_spans_hint(work)}",
        )
    remark_rates(work, rows)
    if work.map.rate:
        work.remark(
            f"measurements are put into the nearest row, up to {0.5 / work.map.rate:.3g} s from "
            "its own time"
        )
        return rows, 1.0 / work.map.rate
    near = ROW_TOLERANCE * float(np.median(np.diff(rows)))
    others = [one for one in poses if one is not fastest]
    others.sort(key=lambda one: -one.rate)
    rows = row_times(rows, others, near)
    return rows[rows_in_use(work, rows)], near


def rows_in_use(
    work: ConversionState, t: Array
) -> "np.ndarray[tuple[int, ...], np.dtype[np.bool_]]":
    """Return which times lie from the first to the last part to use.

    The notes select the parts among these rows.

    Args:
        work: State of the conversion.
        t: Times (N,) [s].
    """
    if not work.map.use:
        return np.ones(len(t), dtype=np.bool_)
    since = t - work.begin
    first, last = work.map.use[0][0], work.map.use[-1][1]
    return np.asarray((since >= first - 1e-9) & (since <= last + 1e-9))


def parts_of_rows(work: ConversionState, rows: Array) -> tuple[tuple[float, float], ...]:
    """Return the parts to use by the clock of the rows [s], if the map has several, else ().

    Args:
        work: State of the conversion.
        rows: Times (N,) of the rows [s].
    """
    if len(work.map.use) < 2:
        return ()
    shift = float(rows[0]) - work.begin
    parts = []
    for begin, end in work.map.use:
        parts.append((round(max(begin - shift, 0.0), 6), round(end - shift, 6)))
    return tuple(parts)


def complete_rows(
    work: ConversionState, rows: Array, signals: dict[str, Array]
) -> tuple[Array, dict[str, Array]]:
    """Remove rows without a command, and rows in which a pose or rate is lost.

    A column that is empty in many rows is measured less often; one that is empty in a few rows has
    lost samples.

    Args:
        work: State of the conversion, which gets remarks.
        rows: Times (N,) of the rows [s].
        signals: Column -> values (N,).

    Returns:
        Times (M,) of the rows that are left [s], and column -> values (M,).

    Raises:
        BadInput: Too few rows are left.
    """
    kept = np.ones(len(rows), dtype=np.bool_)
    for name, values in signals.items():
        if work.columns[name].held and not name.startswith(HELD):
            kept &= np.isfinite(values)
    kept &= _rows_of_measurements(signals)
    for _ in range(MAX_ROUNDS):
        if kept.sum() < FEWEST_ROWS:
            break
        # the removal of rows may change which columns are slow
        allowed = allowed_empty_rows(select_rows(signals, kept))
        missing = np.zeros(int(kept.sum()), dtype=np.bool_)
        for name, values in signals.items():
            if name in (*POSE, *RATES):
                missing |= np.isnan(values[kept]) & ~np.asarray(allowed.get(name, False))
        lost = np.flatnonzero(kept)[missing]
        if not len(lost):
            break
        count = "1 row is" if len(lost) == 1 else f"{len(lost)} rows are"
        work.remark(
            f"{count} left out, because a pose or rate is missing that the others have, "
            f"{work.first_of(rows[lost])}"
        )
        kept[lost] = False
    if kept.sum() < FEWEST_ROWS:
        raise file_error(
            work.log.path,
            f"{int(kept.sum())} rows are complete; at least {FEWEST_ROWS} are needed"
            f"{_spans_hint(work)}",
        )
    for name, values in signals.items():
        if name in (*POSE, *RATES) and np.isfinite(values[kept]).sum() < FEWEST_ROWS:
            raise file_error(
                work.log.path,
                f"{name} has fewer than {FEWEST_ROWS} samples in the rows",
                column=name,
            )
    found = select_rows(signals, kept)
    if not kept.all():
        for name, column in work.columns.items():
            if column.held:  # the means until the next row that is left
                found[name] = mean_held_values(rows[kept], column.given)
    return rows[kept], found


def _last_time(work: ConversionState, end: float) -> float:
    """The last time of rows [s]: after the end of a file its commands are not known."""
    if len(work.spans) < 2:
        return end
    for name, what in work.map.columns.items():
        if work.columns[name].held and not name.startswith(HELD):
            for text in _signal_texts(what):
                signal, _ = signal_of(work, f"columns.{name}", text)
                end = min(end, work.spans[signal.source].end)
    return end


def _signal_texts(what: str | Range | Curve | Allocation) -> list[str]:
    """The expressions of the signals of a column."""
    if isinstance(what, str):
        return [what]
    if isinstance(what, Allocation):
        texts = []
        for term in what.sum:
            texts += _signal_texts(term)
        return texts
    return [what.signal]


def _spans_hint(work: ConversionState) -> str:
    """The spans of several files, and the line that shifts one of them."""
    if len(work.spans) < 2:
        return ""
    spans = [f"{name} {span.in_words()}" for name, span in work.spans.items()]
    line = file_begin_line(list(work.spans)[-1])
    for name, shift in shifts_of_zones(work.spans).items():
        line = file_begin_line(name, shift.seconds, shift.in_words())
    return f" ({'; '.join(spans)}); if a clock is wrong, write into {work.file}: {line}"


def _rows_of_measurements(
    signals: Mapping[str, Array],
) -> "np.ndarray[tuple[int, ...], np.dtype[np.bool_]]":
    """The rows (N,) from the first to the last one with a pose or rate."""
    measured = np.zeros(len(next(iter(signals.values()))), dtype=np.bool_)
    for name, values in signals.items():
        if name in (*POSE, *RATES):
            measured |= np.isfinite(values)
    inside = np.zeros(len(measured), dtype=np.bool_)
    rows = np.flatnonzero(measured)
    if len(rows):
        inside[rows[0] : rows[-1] + 1] = True
    return inside
