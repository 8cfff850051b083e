"""A log by its map as one recording: SI units, our axes, one clock, and remarks on all that was left out or held."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from datetime import UTC, datetime
from difflib import get_close_matches
from math import degrees, isfinite, radians
from pathlib import Path

import numpy as np

from boatsim.errors import BadInput
from boatsim.physics.base import Array
from boatsim.physics.signals import POSE, RATES
from boatsim.recordings.expression import Expression, parse
from boatsim.recordings.importing.clocks import YEAR_2000, YEAR_2100
from boatsim.recordings.importing.frames import local
from boatsim.recordings.importing.log import Log, Signal, rate_of
from boatsim.recordings.importing.mapping import Map, Position, Range
from boatsim.recordings.importing.resample import (
    LEAST_LOST,
    Samples,
    clock,
    held,
    longest_hold,
    placed,
    samples,
)
from boatsim.recordings.raw_table import file_error
from boatsim.recordings.repeated_values import repeated_rows
from boatsim.recordings.table import FEWEST_ROWS, MAX_GAP, Recording, allowed_gaps, is_command

TOGETHER = (("x_m", "y_m"), ("psi_rad",))  # columns that come with one fix
HELD = (
    "stick_",
    "sent_",
    "reference_",
)  # beside commands, what somebody wants is in force until he wants otherwise
ALIKE = 1.5  # times as fast as the poses: from there on commands set the clock
NEAR = 0.05  # of a step of the rows: what is measured so near to a row is in it
ROUNDS = 4
MOST_ROWS = 5_000_000


@dataclass(frozen=True)
class Column:
    """One column before it is put on the common clock."""

    given: Samples
    held: bool


@dataclass
class _Work:
    """What is being made, and what there is to say about it."""

    log: Log
    file: str  # of the map, for messages
    map: Map
    channels: Mapping[str, tuple[float, float]]
    columns: dict[str, Column] = field(default_factory=dict)
    remarks: list[str] = field(default_factory=list)
    begin: float = 0.0  # [s] first time of the log

    def say(self, text: str) -> None:
        self.remarks.append(f"{self.log.path}: {text}")


def convert(
    log: Log, map: Map, file: str, channels: Mapping[str, tuple[float, float]] | None = None
) -> Recording:
    """The recording that a map makes of a log; `channels` are the vessel's commands with their ends.

    Raises BadInput, one line with the map's key, for a signal that is not there and for what can not be converted.
    """
    work = _Work(log, file, map, channels or {}, remarks=list(log.remarks))
    starts = [float(np.nanmin(s.t)) for s in log.signals.values() if np.isfinite(s.t).any()]
    work.begin = min(starts, default=0.0)
    if map.position:
        _add_position(work, map.position)
    for name, what in map.columns.items():
        t, values = _column(work, name, what)
        is_held = name in work.channels or is_command(name) or name.startswith(HELD)
        work.columns[name] = Column(_of_use(work, name, samples(t, values)), is_held)
    _drop_repeats(work)
    rows, near = _clock(work)
    signals = {
        n: held(rows, c.given) if c.held else placed(rows, c.given, near)
        for n, c in work.columns.items()
    }
    _say_what_was_held(work, rows)
    rows, signals = _whole(work, rows, signals)
    _say_times(work, rows)
    return Recording(
        log.path.stem,
        np.round(rows - rows[0], 6),
        signals,
        remarks=tuple(work.remarks),
        path=log.path,
    )


def _signal(work: _Work, key: str, text: str) -> tuple[Signal, Expression]:
    """The signal that an expression names, at the times the map asks for."""
    try:
        found = parse(text, work.log.signals.keys())
    except BadInput as error:
        raise BadInput(f"{work.file}: {key} = {text[:80]!r}: {error}") from None
    if found.signal not in work.log.signals:
        near = get_close_matches(found.signal, list(work.log.signals), n=1, cutoff=0.5)
        hint = f"; did you mean {near[0]!r}?" if near else ""
        raise BadInput(
            f"{work.file}: {key} = {text[:80]!r}: {work.log.path.name} has no signal {found.signal!r}{hint} (it has "
            f"{len(work.log.signals)}; boatsim import {work.log.path.name} lists them)"
        )
    signal = work.log.signals[found.signal]
    if work.map.time and key != "time":
        clock, how = _signal(work, "time", work.map.time)
        if len(clock.values) == len(signal.values):
            signal = replace(signal, t=how.of(clock.values))
    return signal, found


def _column(work: _Work, name: str, what: str | Range) -> tuple[Array, Array]:
    if isinstance(what, str):
        signal, how = _signal(work, f"columns.{name}", what)
        return signal.t, how.of(signal.values)
    signal, how = _signal(work, f"columns.{name}.signal", what.signal)
    values = how.of(signal.values)
    ends = sorted([(what.low, what.least), (what.neutral, 0.0), (what.high, what.most)])
    if beyond := int(np.sum((values < ends[0][0]) | (values > ends[2][0]))):
        work.say(
            f"{name}: {beyond} of {len(values)} samples lie beyond {ends[0][0]:g} to {ends[2][0]:g}, and are taken "
            "as its ends"
        )
    return signal.t, np.interp(
        values, np.array([a for a, _ in ends]), np.array([b for _, b in ends])
    )


def _add_position(work: _Work, position: Position) -> None:
    north, how_north = _signal(work, "position.latitude", position.latitude)
    east, how_east = _signal(work, "position.longitude", position.longitude)
    if len(north.t) != len(east.t) or not np.array_equal(north.t, east.t, equal_nan=True):
        raise BadInput(
            f"{work.file}: position: latitude and longitude are of two streams; name those of one fix"
        )
    t, lat, lon = north.t, how_north.of(north.values), how_east.of(east.values)
    there = np.isfinite(t) & np.isfinite(lat) & np.isfinite(lon)
    if there.any() and max(np.abs(lat[there]).max() / 0.5, np.abs(lon[there]).max()) > np.pi + 1e-9:
        largest = float(np.abs(lat[there]).max())
        raise BadInput(
            f"{work.file}: position: latitudes up to {largest:g} rad; are they in degrees? write `* deg` behind them"
        )
    nowhere = there & (lat == 0.0) & (lon == 0.0)
    if nowhere.any():
        work.say(
            f"{int(nowhere.sum())} fixes at latitude and longitude 0, before satellites were found, are left out"
        )
    there &= ~nowhere
    inside = there & _in_use(work, t)
    if not inside.any():
        raise BadInput(
            f"{work.file}: position: there is no fix of {position.latitude!r} in the part to use"
        )
    t, lat, lon = t[inside], lat[inside], lon[inside]
    first = int(np.argmin(t))
    at = position.origin or (degrees(lat[first]), degrees(lon[first]))
    x, y = local(lat, lon, (radians(at[0]), radians(at[1])))
    work.say(f"x_m and y_m are counted from latitude {at[0]:.8f}, longitude {at[1]:.8f}")
    for name, values in (("x_m", x), ("y_m", y)):
        work.columns[name] = Column(samples(t, values), False)


def _in_use(work: _Work, t: Array) -> "np.ndarray[tuple[int, ...], np.dtype[np.bool_]]":
    if work.map.use is None:
        return np.ones(len(t), dtype=np.bool_)
    since = t - work.begin
    return np.asarray((since >= work.map.use[0] - 1e-9) & (since <= work.map.use[1] + 1e-9))


def _of_use(work: _Work, name: str, given: Samples) -> Samples:
    if not len(given.t):
        raise BadInput(f"{work.file}: columns.{name} has no number in {work.log.path.name}")
    return given


def _drop_repeats(work: _Work) -> None:
    """Without fixes that the logger only repeated: they are no measurements."""
    for names in TOGETHER:
        there = [work.columns[n] for n in names if n in work.columns]
        if len(there) < len(names) or any(len(c.given.t) != len(there[0].given.t) for c in there):
            continue
        repeated = repeated_rows(np.column_stack([c.given.values for c in there]))
        if repeated.any():
            work.say(
                f"{', '.join(names)}: {int(repeated.sum())} of {len(repeated)} samples repeat the one before and are "
                "no measurements; they are left empty"
            )
            for name, c in zip(names, there, strict=True):
                work.columns[name] = replace(
                    c, given=Samples(c.given.t[~repeated], c.given.values[~repeated])
                )


def _clock(work: _Work) -> tuple[Array, float]:
    """(N,) times of the rows [s], of the log's clock, and how near to one a sample is in it [s].

    They are those of the fastest signal, and of what of the others is measured at other times; or evenly at the rate
    that the map asks for.
    """
    poses = {n: c for n, c in work.columns.items() if n in (*POSE, *RATES)}
    orders = {n: c for n, c in work.columns.items() if c.held and not n.startswith(HELD)}
    fastest = max(poses.values(), key=lambda c: c.given.rate)
    quick = max(orders.values(), key=lambda c: c.given.rate, default=fastest)
    if quick.given.rate > ALIKE * fastest.given.rate:
        fastest = quick
    begin = max(
        [
            min(float(c.given.t[0]) for c in poses.values()),
            *(float(c.given.t[0]) for c in orders.values()),
        ]
    )
    end = max(float(c.given.t[-1]) for c in poses.values())
    if work.map.rate:
        if (end - begin) * work.map.rate > MOST_ROWS:
            raise BadInput(
                f"{work.file}: rate = {work.map.rate:g} Hz over {end - begin:g} s is more than {MOST_ROWS:,} rows"
            )
        rows = begin + np.arange(0.0, max(end - begin, 0.0) + 1e-9, 1.0 / work.map.rate)
    else:
        rows = fastest.given.t[(fastest.given.t >= begin - 1e-9) & (fastest.given.t <= end + 1e-9)]
    rows = rows[_in_use(work, rows)]
    if len(rows) < FEWEST_ROWS:
        span = f"{end - begin:.3g} s" if end > begin else "no time at all"
        raise file_error(
            work.log.path,
            f"poses and commands have {span} in common, in which the fastest has {len(rows)} samples; at least "
            f"{FEWEST_ROWS} are needed",
        )
    _say_rates(work, rows)
    if work.map.rate:
        work.say(
            f"what is measured is put into the nearest row, up to {0.5 / work.map.rate:.3g} s from its own time"
        )
        return rows, 1.0 / work.map.rate
    near = NEAR * float(np.median(np.diff(rows)))
    others = sorted((c.given for c in poses.values() if c is not fastest), key=lambda s: -s.rate)
    rows = clock(rows, others, near)
    return rows[_in_use(work, rows)], near


def _say_rates(work: _Work, rows: Array) -> None:
    """What is measured less often than rows are written, and what more often."""
    rate, slow, quick = rate_of(rows), dict[str, list[str]](), dict[str, list[str]]()
    for name, c in work.columns.items():
        inside = int(np.sum((c.given.t >= rows[0] - 1e-9) & (c.given.t <= rows[-1] + 1e-9)))
        if not c.held and c.given.rate < 0.9 * rate:
            slow.setdefault(f"{c.given.rate:.3g}", []).append(name)
        elif c.given.rate > 1.1 * rate and inside > len(rows):
            quick.setdefault(
                f"{c.given.rate:.3g} times a second: {inside - len(rows)} samples", []
            ).append(name)
    for times, names in slow.items():
        work.say(
            f"{', '.join(names)}: measured {times} times a second; the other rows, {rate:.3g} a second, are empty"
        )
    for what, names in quick.items():
        work.say(
            f"{', '.join(names)}: logged {what} between the {rate:.3g} rows a second are left out"
        )


def _say_what_was_held(work: _Work, rows: Array) -> None:
    for name, c in work.columns.items():
        if c.held and (longest := longest_hold(rows, c.given)):
            work.say(
                f"{name} is held for up to {longest:.3g} s without a new value; was it still in force?"
            )


def _whole(work: _Work, rows: Array, signals: dict[str, Array]) -> tuple[Array, dict[str, Array]]:
    """Without rows in which a command is unknown, and those few in which a pose is missing that others have.

    A column that is empty in many rows is a slow one, and its reader knows it; one that is empty in a few has lost
    samples.
    """
    kept = np.ones(len(rows), dtype=np.bool_)
    for name, values in signals.items():
        if work.columns[name].held and not name.startswith(HELD):
            kept &= np.isfinite(values)
    for _ in range(ROUNDS):  # rows that are left out may make a slow column of one that was not
        fair = allowed_gaps({n: v[kept] for n, v in signals.items()})
        unfair = [
            np.isnan(v[kept]) & ~fair.get(n, False)
            for n, v in signals.items()
            if n in (*POSE, *RATES)
        ]
        lost = np.flatnonzero(kept)[np.any(unfair, axis=0)]
        if not len(lost):
            break
        work.say(
            f"{len(lost)} rows in which a pose or rate is missing that the others have are left out"
        )
        kept[lost] = False
    if kept.sum() < FEWEST_ROWS:
        raise file_error(
            work.log.path,
            f"{int(kept.sum())} rows have all that is needed; at least {FEWEST_ROWS} must",
        )
    for name in [n for n in signals if n in (*POSE, *RATES)]:
        if np.isfinite(signals[name][kept]).sum() < FEWEST_ROWS:
            raise file_error(
                work.log.path,
                f"{name} has fewer than {FEWEST_ROWS} samples in the rows",
                column=name,
            )
    return rows[kept], {name: values[kept] for name, values in signals.items()}


def _say_times(work: _Work, rows: Array) -> None:
    if YEAR_2000 < rows[0] < YEAR_2100:
        work.say(
            f"t_s = 0 is {datetime.fromtimestamp(float(rows[0]), UTC).isoformat(timespec='milliseconds')}"
        )
    elif isfinite(work.begin):
        work.say(f"t_s = 0 is {rows[0] - work.begin:.3f} s after the log begins")
    steps = np.diff(rows)
    if (longest := float(steps.max())) > max(LEAST_LOST, 5.0 * float(np.median(steps))):
        where = float(rows[int(np.argmax(steps))] - rows[0])
        more = (
            "; no diagnosis reads over that: cut the log with use = [from_s, to_s]"
            if longest > MAX_GAP
            else ""
        )
        work.say(f"there is a gap of {longest:.3g} s at t = {where:.3f} s{more}")


def position_fix(map: Map) -> str | None:
    """The fact `position_fix` that a map tells: satellites, where positions are latitudes."""
    return "gnss" if map.position else None


def notes_of(path: Path, vessel: str, fix: str | None) -> str:
    """What a recording.toml should say of the recording in `path`."""
    key = (
        path.stem
        if path.stem.replace("_", "").replace("-", "").isalnum() and path.stem.isascii()
        else f'"{_quoted(path.stem)}"'
    )
    lines = [f"[runs.{key}]", f'vessel = "{_quoted(vessel)}"']
    return "\n".join([*lines, *([f'facts.position_fix = "{fix}"'] if fix else [])]) + "\n"


def _quoted(text: str) -> str:
    return "".join(
        c if c.isprintable() and c not in '"\\' else f"\\u{ord(c):04x}"
        for c in text
        if ord(c) < 0x10000
    )
