"""Conversion of a log by its map to a recording: SI units, SNAME axes and one clock.

Remarks of the recording list all samples that were left out or held.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from datetime import UTC, datetime
from math import degrees, isfinite, radians
from pathlib import Path

import numpy as np

from boatsim.errors import BadInput, nearest_hint, unknown_name_message
from boatsim.physics.base import Array
from boatsim.physics.signals import POSE, RATES
from boatsim.recordings.conversion import Allocation, Curve, Range
from boatsim.recordings.expression import Expression, parse
from boatsim.recordings.importing.clock_steps import continue_clock
from boatsim.recordings.importing.clocks import YEAR_2000, YEAR_2100
from boatsim.recordings.importing.frames import local_position
from boatsim.recordings.importing.log import HUGE, Log, Signal, median_sampling_rate
from boatsim.recordings.importing.mapping import Map, Position
from boatsim.recordings.importing.queued_messages import (
    Queue,
    late_samples,
    queued_positions,
)
from boatsim.recordings.importing.regular_times import regular_times, values_at_rows
from boatsim.recordings.importing.resample import (
    MIN_LOST,
    Samples,
    clean_samples,
    count_unordered_samples,
    longest_command_gap,
    mean_held_values,
    nearest_samples,
    row_times,
)
from boatsim.recordings.importing.several_logs import (
    Span,
    align_clocks,
    file_begin_line,
    file_spans,
)
from boatsim.recordings.importing.track import constant_heading_fault
from boatsim.recordings.importing.waves import WaveProbes, wave_at
from boatsim.recordings.notes import Notes
from boatsim.recordings.raw_table import file_error, select_rows
from boatsim.recordings.repeated_values import repeated_rows, stale_rows
from boatsim.recordings.table import FEWEST_ROWS, MAX_GAP, Recording, allowed_empty_rows, is_command

# Columns of one fix
PLACE = ("x_m", "y_m")
TOGETHER = (PLACE, ("psi_rad",))
# Prefixes of columns that, like commands, are in force until the next value
HELD = (
    "stick_",
    "sent_",
    "reference_",
)
FASTER = 1.5  # commands set the clock if their rate is this many times that of the poses
ROW_TOLERANCE = 0.05  # a sample is in a row if it is nearer than this share of the step of the rows
MOST_IN_ROWS = 0.9  # of the positions are in rows of others; queued angles may have been omitted
MAX_ROUNDS = 4
# A track begins with positions that were not measured if it leaps from 0 by this many usual steps
MIN_LEAP, USUAL_STEP_PERCENTILE = 10.0, 99.0
UNEQUAL = 0.1  # share of a step by which the steps of wave probes may differ
MAX_ROWS = 5_000_000
MAX_FILES = 20  # of which the remarks list the spans


@dataclass(frozen=True)
class Column:
    """A column before resampling to the rows; `held` values are in force until the next sample."""

    given: Samples
    held: bool


@dataclass
class _Work:
    """State of a conversion, with the remarks on it."""

    log: Log
    file: str  # of the map, for messages
    map: Map
    channels: Mapping[str, tuple[float, float]]
    columns: dict[str, Column] = field(default_factory=dict)
    remarks: list[str] = field(default_factory=list)
    begin: float = 0.0  # [s] first time of the log
    spans: Mapping[str, Span] = field(default_factory=dict)  # of each file of the log

    def remark(self, text: str) -> None:
        self.remarks.append(f"{self.log.path}: {text}")


def convert_log(
    log: Log, map: Map, file: str, channels: Mapping[str, tuple[float, float]] | None = None
) -> Recording:
    """Convert a log to a recording, with the signals that a map assigns to the columns.

    Args:
        log: The log.
        map: Signals of the columns.
        file: Name of the map in messages.
        channels: Allowed range (low, high) of the vessel's commands.

    Raises:
        BadInput: One line with the key of the map for a signal that does not exist or cannot be
            converted.
    """
    log = _with_continued_clocks(_with_time_of_map(log, map, file))
    log = align_clocks(log, map.begins, file)
    spans = file_spans(log)
    begin = min((span.begin for span in spans.values()), default=0.0)
    remarks = list(log.remarks)
    work = _Work(log, file, map, channels or {}, remarks=remarks, begin=begin, spans=spans)
    if map.position:
        _add_position(work, map.position)
    disorder: dict[tuple[int, int, float], list[str]] = {}
    for name, what in map.columns.items():
        t, values = _column(work, name, what)
        t = t - map.latency.get(name, 0.0)
        known = np.isfinite(values)  # of a table whose sensors share the rows
        disorder.setdefault(count_unordered_samples(t[known]), []).append(name)
        is_held = name in work.channels or is_command(name) or name.startswith(HELD)
        work.columns[name] = Column(_check_values(work, name, clean_samples(t, values)), is_held)
    _remark_disorder(work, disorder)
    _check_heading(work)
    _drop_unfixed(work)
    _drop_repeats(work)
    queues = _position_queues(work)
    # before the rhythm of the positions, which would move theirs and leave the angles late
    _drop_queued(work, queues, PLACE)
    _regularize_positions(work)
    rows, near = _row_times(work)
    # after the times of the rows, in which commands go on
    _drop_queued(work, queues, (*POSE, *RATES))
    _drop_stale(work)
    signals: dict[str, Array] = {}
    for name, column in work.columns.items():
        if column.held:
            signals[name] = mean_held_values(rows, column.given)
        else:
            signals[name] = nearest_samples(rows, column.given, near)
    _remark_held(work, rows)
    rows, signals = _complete_rows(work, rows, signals)
    for name, probes in map.waves.items():
        signals[name] = np.interp(rows, *_wave(work, name, probes))
    _remark_spans(work, rows)
    _remark_times(work, rows)
    return Recording(
        log.path.stem,
        np.round(rows - rows[0], 6),
        signals,
        notes=Notes(use=_parts_of_rows(work, rows)),
        remarks=tuple(work.remarks),
        path=log.path,
    )


def _remark_disorder(work: _Work, disorder: Mapping[tuple[int, int, float], list[str]]) -> None:
    """Add remarks on samples out of order and on several samples at one time, by columns."""
    for (late, doubled, first), names in disorder.items():
        where = f"first {first - work.begin:.3f} s after the log begins"
        if late:
            work.remark(
                f"{', '.join(names)}: {late} samples are logged after a later one, {where}; "
                "they are sorted by time"
            )
        if doubled:
            work.remark(
                f"{', '.join(names)}: {doubled} samples have the time of another one, {where}; "
                "of these the one logged last is used"
            )


def _check_heading(work: _Work) -> None:
    """Refuse a heading that the program wrote although no sensor sent one. Raises BadInput."""
    there = [work.columns.get(name) for name in ("x_m", "y_m", "psi_rad")]
    x, y, psi = there
    if x is None or y is None or psi is None or len(x.given.t) != len(y.given.t):
        return
    fault = constant_heading_fault(x.given.t, x.given.values, y.given.values, psi.given.values)
    if fault:
        raise BadInput(f"{work.file}: columns.psi_rad {fault}")


def _signal(work: _Work, key: str, text: str) -> tuple[Signal, Expression]:
    """The signal of an expression, with the time of the map."""
    try:
        found = parse(text, work.log.signals.keys())
    except BadInput as error:
        raise BadInput(f"{work.file}: {key} = {text[:80]!r}: {error}") from None
    if found.signal not in work.log.signals:
        hint = nearest_hint(found.signal, work.log.signals)
        raise BadInput(
            f"{work.file}: {key} = {text[:80]!r}: {work.log.path.name} has no signal "
            f"{found.signal!r}{hint} (it has "
            f"{len(work.log.signals)}; boatsim import {work.log.path.name} lists them)"
        )
    return work.log.signals[found.signal], found


def _with_time_of_map(log: Log, map: Map, file: str) -> Log:
    """The log with the times of the map. Raises BadInput."""
    if not map.time:
        return log
    given = map.time
    names = {signal.source for signal in log.signals.values()}
    if isinstance(given, str):
        given = dict.fromkeys(sorted(names)[:1], given)
        if len(names) > 1:
            raise BadInput(f"{file}: time is one expression; of several files write time.FILE")
    signals = dict(log.signals)
    for source, text in given.items():
        if source not in names:
            raise BadInput(f"{file}: {unknown_name_message('time: file', source, sorted(names))}")
        clock, how = _signal(_Work(log, file, map, {}), "time", text)
        t = how.convert(clock.values)
        for name, signal in signals.items():
            if signal.source == source and len(signal.values) == len(t):
                signals[name] = replace(signal, t=t)
    return replace(log, signals=signals)


def _with_continued_clocks(log: Log) -> Log:
    """The log with times that go on where a clock was set back, and remarks on these steps."""
    streams: dict[int, dict[str, Array]] = {}
    for name, signal in log.signals.items():
        streams.setdefault(id(signal.t), {})[name] = signal.values
    times: dict[int, Array] = {}
    remarks = dict[str, None]()
    for name, signal in log.signals.items():
        key = id(signal.t)
        if key in times:
            continue
        times[key], steps = continue_clock(signal.t, streams[key])
        for step in steps:
            stream = signal.source or name.rpartition(".")[0] or log.path.name
            moved = f"goes back by {step.seconds:.6g} s"
            if step.seconds < 0.0:
                moved = f"is put forward by {-step.seconds:.6g} s"
            text = (
                f"{log.path}: {stream}: the clock {moved} after sample {step.row}, but the samples "
                "go on; the later ones are moved so that they follow. "
                "If the log was begun again there, cut it"
            )
            remarks[text] = None
    if not remarks:
        return log
    signals: dict[str, Signal] = {}
    for name, signal in log.signals.items():
        signals[name] = replace(signal, t=times[id(signal.t)])
    return replace(log, signals=signals, remarks=(*log.remarks, *remarks))


def _column(work: _Work, name: str, what: str | Range | Curve | Allocation) -> tuple[Array, Array]:
    """Times (N,) [s] and values (N,) of a column."""
    if isinstance(what, Allocation):
        t, values = _sum_of_terms(work, name, what)
    else:
        t, values = _term(work, name, f"columns.{name}", what)
    if isinstance(what, Allocation):
        _remark_limits(work, f"{name}: the sum of its terms", values, what)
        return t, what.convert(values)
    return t, values


def _term(work: _Work, name: str, key: str, what: str | Range | Curve) -> tuple[Array, Array]:
    """Times (N,) [s] and values (N,) of one signal and its conversion."""
    if isinstance(what, str):
        signal, how = _signal(work, key, what)
        return signal.t, how.convert(signal.values)
    signal, how = _signal(work, f"{key}.signal", what.signal)
    values = how.convert(signal.values)
    _remark_limits(work, name, values, what)
    return signal.t, what.convert(values)


def _remark_limits(work: _Work, name: str, values: Array, what: Range | Curve | Allocation) -> None:
    lowest, highest = what.unclipped_range
    if beyond := int(np.sum((values < lowest) | (values > highest))):
        work.remark(
            f"{name}: {beyond} of {len(values)} samples are outside {lowest:g} to "
            f"{highest:g} and are set to "
            "the limit"
        )


def _sum_of_terms(work: _Work, name: str, what: Allocation) -> tuple[Array, Array]:
    """Times (N,) [s] and the sum (N,) of terms; each holds its value until its next sample."""
    terms = []
    for i, term in enumerate(what.sum):
        terms.append(_term(work, name, f"columns.{name}.sum[{i}]", term))
    t = terms[0][0]
    if all(len(other) == len(t) and np.array_equal(other, t, equal_nan=True) for other, _ in terms):
        return t, np.asarray(np.sum([values for _, values in terms], axis=0))
    samples = [clean_samples(*term) for term in terms]
    rows = np.unique(np.concatenate([one.t for one in samples]))
    total = np.zeros(len(rows))
    for one in samples:
        last = np.searchsorted(one.t, rows, side="right") - 1
        total += np.where(last >= 0, one.values[last], np.nan)
    return rows, total


def _wave(work: _Work, name: str, given: WaveProbes) -> tuple[Array, Array]:
    """Times (N,) [s] and elevation (N,) [m] of the wave at the hull. Raises BadInput."""
    where = f"waves.{name}.probes"
    signals = [_signal(work, where, text) for text in given.probes]
    t = signals[0][0].t
    measured = np.isfinite(t)
    elevations = []
    for signal, how in signals:
        if not np.array_equal(signal.t, t, equal_nan=True):
            raise BadInput(f"{work.file}: {where}: allowed are probes with the same times")
        elevations.append(how.convert(signal.values))
        measured &= np.isfinite(elevations[-1])
    t = t[measured]
    steps = np.diff(t)
    if len(t) < FEWEST_ROWS or not np.ptp(steps) < UNEQUAL * float(np.median(steps)):
        raise BadInput(
            f"{work.file}: {where}: allowed are at least {FEWEST_ROWS} samples at equal steps of "
            "time"
        )
    step = float(np.median(steps))
    return t, wave_at(step, [values[measured] for values in elevations], given)


def _add_position(work: _Work, position: Position) -> None:
    north, how_north = _signal(work, "position.latitude", position.latitude)
    east, how_east = _signal(work, "position.longitude", position.longitude)
    if len(north.t) != len(east.t) or not np.array_equal(north.t, east.t, equal_nan=True):
        raise BadInput(
            f"{work.file}: position: latitude and longitude are of two streams; allowed are "
            "those of one"
        )
    t, lat, lon = north.t, how_north.convert(north.values), how_east.convert(east.values)
    there = np.isfinite(t) & np.isfinite(lat) & np.isfinite(lon)
    if there.any() and max(np.abs(lat[there]).max() / 0.5, np.abs(lon[there]).max()) > np.pi + 1e-9:
        largest = float(np.abs(lat[there]).max())
        raise BadInput(
            f"{work.file}: position: latitudes up to {largest:g} rad; are they in degrees? write "
            "`* deg` behind them"
        )
    nowhere = there & (lat == 0.0) & (lon == 0.0)
    if nowhere.any():
        count = int(nowhere.sum())
        fixes = "1 fix" if count == 1 else f"{count} fixes"
        work.remark(f"omitted {fixes} at latitude and longitude 0, before satellites were found")
    there &= ~nowhere
    inside = there & _rows_in_use(work, t)
    if not inside.any():
        raise BadInput(
            f"{work.file}: position: there is no fix of {position.latitude!r} in the part to use"
        )
    t, lat, lon = t[inside], lat[inside], lon[inside]
    first = int(np.argmin(t))
    at = position.origin or (degrees(lat[first]), degrees(lon[first]))
    x, y = local_position(lat, lon, (radians(at[0]), radians(at[1])))
    work.remark(f"x_m and y_m are counted from latitude {at[0]:.8f}, longitude {at[1]:.8f}")
    for name, values in (("x_m", x), ("y_m", y)):
        work.columns[name] = Column(
            clean_samples(t - work.map.latency.get(name, 0.0), values), False
        )


def _rows_in_use(work: _Work, t: Array) -> "np.ndarray[tuple[int, ...], np.dtype[np.bool_]]":
    """The rows from the first to the last part to use; the notes select the parts among them."""
    if not work.map.use:
        return np.ones(len(t), dtype=np.bool_)
    since = t - work.begin
    first, last = work.map.use[0][0], work.map.use[-1][1]
    return np.asarray((since >= first - 1e-9) & (since <= last + 1e-9))


def _parts_of_rows(work: _Work, rows: Array) -> tuple[tuple[float, float], ...]:
    """The parts to use by the clock of the rows, if the map has several."""
    if len(work.map.use) < 2:
        return ()
    shift = float(rows[0]) - work.begin
    parts = []
    for begin, end in work.map.use:
        parts.append((round(max(begin - shift, 0.0), 6), round(end - shift, 6)))
    return tuple(parts)


def _check_values(work: _Work, name: str, given: Samples) -> Samples:
    if not len(given.t):
        raise BadInput(f"{work.file}: columns.{name} has no number in {work.log.path.name}")
    largest = float(np.abs(given.values).max())
    if largest >= HUGE:
        raise BadInput(
            f"{work.file}: columns.{name} = {largest:.3g}; no measurement is as large as {HUGE:g}"
        )
    return given


def _drop_unfixed(work: _Work) -> None:
    """Remove positions of exactly 0 and 0 before the first fix, from which the track leaps away."""
    x, y = work.columns.get("x_m"), work.columns.get("y_m")
    if x is None or y is None or not np.array_equal(x.given.t, y.given.t):
        return
    track = x.given.values + 1j * y.given.values
    moved = track != 0.0
    first = int(np.argmax(moved))
    if first == 0 or len(track) - first < FEWEST_ROWS:
        return
    usual = float(np.percentile(np.abs(np.diff(track[first:])), USUAL_STEP_PERCENTILE))
    if abs(track[first]) < MIN_LEAP * usual:
        return
    work.remark(
        f"x_m, y_m: omitted {first} positions of 0, 0 before the first fix, which is "
        f"{abs(track[first]):.3g} m away"
    )
    for name, column in (("x_m", x), ("y_m", y)):
        kept = Samples(column.given.t[first:], column.given.values[first:])
        work.columns[name] = replace(column, given=kept)


def _drop_repeats(work: _Work) -> None:
    """Remove fixes that the logger repeated, for they are not measurements."""
    for names in TOGETHER:
        there = [work.columns[n] for n in names if n in work.columns]
        if len(there) < len(names) or any(len(c.given.t) != len(there[0].given.t) for c in there):
            continue
        repeated = repeated_rows(np.column_stack([c.given.values for c in there]))
        if repeated.any():
            work.remark(
                f"{', '.join(names)}: {int(repeated.sum())} of {len(repeated)} samples repeat "
                "the one before and are "
                "not measurements; they are left empty"
            )
            for name, c in zip(names, there, strict=True):
                work.columns[name] = replace(
                    c, given=Samples(c.given.t[~repeated], c.given.values[~repeated])
                )


def _position_queues(work: _Work) -> list[Queue]:
    """Intervals in which positions were read that had queued during a stall."""
    x, y = work.columns.get("x_m"), work.columns.get("y_m")
    if x is None or y is None or not np.array_equal(x.given.t, y.given.t):
        return []
    t, north, east = x.given.t, x.given.values, y.given.values
    if np.isfinite(work.begin) and work.begin < t[0]:  # rows without a fix at the beginning
        t = np.append(work.begin, t)
        north, east = np.append(np.nan, north), np.append(np.nan, east)
    return list(queued_positions(t, north, east))


def _drop_queued(work: _Work, queues: Sequence[Queue], names: Sequence[str]) -> None:
    """Remove samples of some poses and rates that had queued with the positions."""
    for queue in queues:
        dropped = []
        for name in names:
            column = work.columns.get(name)
            if column is None or column.held:
                continue
            t, values = column.given.t, column.given.values
            late = late_samples(t, values, queue)
            if late.any() and not late.all():
                work.columns[name] = replace(column, given=Samples(t[~late], values[~late]))
                dropped.append(name)
        if dropped:
            work.remark(
                f"{', '.join(dropped)}: the samples from {queue.begin - work.begin:.4g} s to "
                f"{queue.end - work.begin:.4g} s after the beginning had queued since "
                f"{queue.last - work.begin:.4g} s: {queue.evidence}; they are omitted"
            )


def _regularize_positions(work: _Work) -> None:
    """Correct positions that a program read late, where their sensor measures in a rhythm.

    In a table the program wrote them into the rows of other sensors. There they are moved along the
    track to the times of these rows: rows of their own would make a recording half as long again,
    and a diagnosis as slow.
    """
    x, y = work.columns.get("x_m"), work.columns.get("y_m")
    if x is None or y is None or not np.array_equal(x.given.t, y.given.t):
        return
    read = x.given.t
    found = regular_times(read, x.given.values + 1j * y.given.values)
    if found is None:
        return
    t, period = found
    shift = float(np.sqrt(np.mean((t - read) ** 2)))
    in_rows = _are_in_rows_of_others(work, read)
    how = "moved to the times of that rhythm"
    if in_rows:
        how = "moved along the track from the times of that rhythm to those of their rows"
    work.remark(
        f"x_m, y_m: the sensor measured every {period:.4g} s, but the program read it late; the "
        f"samples are {how}, by {shift:.2g} s rms"
    )
    for name, column in (("x_m", x), ("y_m", y)):
        samples = Samples(t, column.given.values)
        if in_rows:
            samples = Samples(read, values_at_rows(read, t, column.given.values))
        work.columns[name] = replace(column, given=samples)


def _are_in_rows_of_others(work: _Work, t: Array) -> bool:
    """Whether most positions have the times of samples of another pose or rate."""
    for name, column in work.columns.items():
        if name in (*POSE, *RATES) and name not in PLACE and not column.held:
            if np.isin(t, column.given.t).mean() > MOST_IN_ROWS:
                return True
    return False


def _drop_stale(work: _Work) -> None:
    """Remove angles and rates that a logger wrote again because no new message had arrived."""
    for name in (*POSE, *RATES):
        column = work.columns.get(name)
        if column is None or column.held:
            continue
        given = column.given
        stale = stale_rows(given.values)
        if not stale.any():
            continue
        longest = _longest_stale(given.t, stale)
        work.remark(
            f"{name}: {int(stale.sum())} of {len(stale)} samples repeat the one before exactly, "
            f"for up to {longest:.3g} s, because no new message had arrived; they are left empty"
        )
        fresh = Samples(given.t[~stale], given.values[~stale])
        work.columns[name] = replace(column, given=fresh)


def _longest_stale(t: Array, stale: "np.ndarray[tuple[int, ...], np.dtype[np.bool_]]") -> float:
    """Longest time [s] from a new sample to the next one."""
    return float(np.diff(t[~stale]).max(initial=0.0))


def _row_times(work: _Work) -> tuple[Array, float]:
    """Times (N,) of the rows [s], and the largest distance of a sample from its row [s].

    The rows are the samples of the fastest signal and those of others at other times, or evenly
    spaced at the rate of the map.
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
    rows = rows[_rows_in_use(work, rows)]
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
    _remark_rates(work, rows)
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
    return rows[_rows_in_use(work, rows)], near


def _last_time(work: _Work, end: float) -> float:
    """The last time of rows [s]: after the end of a file its commands are not known."""
    if len(work.spans) < 2:
        return end
    for name, what in work.map.columns.items():
        if work.columns[name].held and not name.startswith(HELD):
            for text in _signal_texts(what):
                signal, _ = _signal(work, f"columns.{name}", text)
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


def _spans_hint(work: _Work) -> str:
    """The spans of several files, and the line that shifts one of them."""
    if len(work.spans) < 2:
        return ""
    spans = [f"{name} {span.in_words()}" for name, span in work.spans.items()]
    line = file_begin_line(list(work.spans)[-1])
    return f" ({'; '.join(spans)}); if a clock is wrong, write into {work.file}: {line}"


def _remark_spans(work: _Work, rows: Array) -> None:
    """Remark the part that several files have in common."""
    for name, span in list(work.spans.items())[:MAX_FILES]:
        if len(work.spans) > 1:
            before, after = rows[0] - span.begin, span.end - rows[-1]
            file = work.log.path.with_name(name)
            work.remarks.append(
                f"{file}: {span.in_words()}; {max(before, 0.0):.3g} s before and "
                f"{max(after, 0.0):.3g} s after the rows are left out"
            )


def _remark_rates(work: _Work, rows: Array) -> None:
    """Remark signals that are measured less often or more often than rows are written."""
    rate = median_sampling_rate(rows)
    slow: dict[str, list[str]] = {}
    quick: dict[str, list[str]] = {}
    for name, c in work.columns.items():
        inside = int(np.sum((c.given.t >= rows[0] - 1e-9) & (c.given.t <= rows[-1] + 1e-9)))
        if not c.held and c.given.rate < 0.9 * rate:
            slow.setdefault(f"{c.given.rate:.3g}", []).append(name)
        elif c.given.rate > 1.1 * rate and inside > len(rows):
            quick.setdefault(
                f"{c.given.rate:.3g} times a second: {inside - len(rows)} samples", []
            ).append(name)
    for times, names in slow.items():
        work.remark(
            f"{', '.join(names)}: measured {times} times a second; the other rows, {rate:.3g} a "
            "second, are empty"
        )
    for what, names in quick.items():
        work.remark(
            f"{', '.join(names)}: logged {what} between the {rate:.3g} rows a second are left out"
        )


def _remark_held(work: _Work, rows: Array) -> None:
    for name, c in work.columns.items():
        if c.held and (longest := longest_command_gap(rows, c.given)):
            work.remark(
                f"{name} is held for up to {longest:.3g} s without a new value; was it still in "
                "force?"
            )


def _complete_rows(
    work: _Work, rows: Array, signals: dict[str, Array]
) -> tuple[Array, dict[str, Array]]:
    """Remove rows without a command, and rows in which a pose or rate is lost.

    A column that is empty in many rows is measured less often; one that is empty in a few rows has
    lost samples.
    """
    kept = np.ones(len(rows), dtype=np.bool_)
    for name, values in signals.items():
        if work.columns[name].held and not name.startswith(HELD):
            kept &= np.isfinite(values)
    kept &= _rows_of_measurements(signals)
    for _ in range(MAX_ROUNDS):  # the removal of rows may change which columns are slow
        allowed = allowed_empty_rows(select_rows(signals, kept))
        missing = np.zeros(int(kept.sum()), dtype=np.bool_)
        for name, values in signals.items():
            if name in (*POSE, *RATES):
                missing |= np.isnan(values[kept]) & ~np.asarray(allowed.get(name, False))
        lost = np.flatnonzero(kept)[missing]
        if not len(lost):
            break
        work.remark(
            f"{len(lost)} rows in which a pose or rate is missing that the others have are left out"
        )
        kept[lost] = False
    if kept.sum() < FEWEST_ROWS:
        raise file_error(
            work.log.path,
            f"{int(kept.sum())} rows are complete; at least {FEWEST_ROWS} are needed",
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


def _remark_times(work: _Work, rows: Array) -> None:
    if YEAR_2000 < rows[0] < YEAR_2100:
        work.remark(
            "t_s = 0 is "
            f"{datetime.fromtimestamp(float(rows[0]), UTC).isoformat(timespec='milliseconds')}"
        )
    elif isfinite(work.begin):
        work.remark(f"t_s = 0 is {rows[0] - work.begin:.3f} s after the log begins")
    steps = np.diff(rows)
    if (longest := float(steps.max())) > max(MIN_LOST, 5.0 * float(np.median(steps))):
        where = float(rows[int(np.argmax(steps))] - rows[0])
        more = ""
        if longest > MAX_GAP:
            more = (
                "; a diagnosis refuses it: write into recording.toml use = "
                f"[[0, {where:.6g}], [{where + longest:.6g}, {rows[-1] - rows[0]:.6g}]]"
            )
        work.remark(f"there is a gap of {longest:.3g} s at t = {where:.3f} s{more}")


def position_fix_type(map: Map) -> str | None:
    """Return how positions were measured: "gnss" if the columns are latitudes, else None."""
    if map.position:
        return "gnss"
    return None


def recording_notes_text(
    path: Path, vessel: str, fix: str | None, use: Sequence[tuple[float, float]] = ()
) -> str:
    """Return the text of a recording.toml.

    Args:
        path: File of the recording.
        vessel: Name or path of the vessel.
        fix: The fact `position_fix_type`, None if unknown.
        use: Parts of the recording that are used [s]; () for all of it.
    """
    key = path.stem
    if not (key.replace("_", "").replace("-", "").isalnum() and key.isascii()):
        key = f'"{_quote(key)}"'
    lines = [f"[runs.{key}]", f'vessel = "{_quote(vessel)}"']
    if use:
        lines.append(use_entry_line(use))
    if fix:
        lines.append(f'facts.position_fix = "{fix}"')
    return "\n".join(lines) + "\n"


def use_entry_line(use: Sequence[tuple[float, float]]) -> str:
    """Return the line `use = [...]` of a recording.toml, which selects parts of a recording."""
    return f"use = {list(map(list, use))}"


def _quote(text: str) -> str:
    quoted = ""
    for c in text:
        if ord(c) >= 0x10000:
            continue
        if c.isprintable() and c not in '"\\':
            quoted += c
        else:
            quoted += f"\\u{ord(c):04x}"
    return quoted
