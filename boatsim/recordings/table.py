"""Recordings of a boat: time, named signals with units, notes; CSV, Parquet and the `.rrd` of our own runs in."""

import math
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from difflib import get_close_matches
from pathlib import Path

import numpy as np

from boatsim.errors import BadInput, unknown_name
from boatsim.files import replacing
from boatsim.physics.content import module_of, names
from boatsim.physics.signals import POSE, RATES, Array
from boatsim.recordings import limits, units
from boatsim.recordings.expression import Expression, parse
from boatsim.recordings.notes import Notes, notes_for, unit_of
from boatsim.recordings.raw_table import Raw, refuse

__all__ = ["POSE", "RATES", "Notes", "Recording", "read", "write_csv"]

FEWEST_ROWS = 20
# columns of our own runs beside pose, rates and commands; a sensor the boat has not got is nan
OWN = re.compile(r"(sent|stick|actual|sensed|camera|estimate|reference|goal|force|wind)_|contacts$")
# what command channels of boats are called; others are known by the vessel
COMMAND = re.compile(
    r"(thrust|steer|pwm|delta|rudder|throttle|nozzle|jet|elevator|azimuth|n)(_|$)(?!.*(sd|rate))"
)
HUGE = 1e12  # no time, place, speed or command here is anywhere near
GAP = 60.0  # [s] between two rows; over a longer one no boat here can be followed
NEAR = 0.8  # likeness from which a name that is not there is a misspelt one
# share of empty rows from which a pose or rate is one that is measured less often than rows are
# written
SLOW = 0.1
# share of a channel's range by which a command rounded for the file may pass its limit
ROUNDING = 1e-3


class NoSignal(BadInput):
    """A recording lacks a signal that somebody asks for."""


@dataclass(frozen=True)
class Orders:
    """Commands at their own times, each held until the next."""

    t: Array  # (K,) s
    signals: Mapping[str, Array]  # each (K,)

    def between(self, from_s: float, to_s: float) -> "Orders":
        """Those in force from one time to another."""
        begin = max(int(np.searchsorted(self.t, from_s + 1e-9, side="right")) - 1, 0)
        end = int(np.searchsorted(self.t, to_s + 1e-9, side="right"))
        return Orders(self.t[begin:end], {k: v[begin:end] for k, v in self.signals.items()})


@dataclass(frozen=True)
class Recording:
    """One run of a boat, SI units, SNAME axes. Commands are held from their row to the next; headings unwrapped."""

    name: str
    t: Array  # (N,) s, strictly increasing
    signals: dict[str, Array]  # each (N,), named with the unit at the end: psi_rad
    notes: Notes = field(default_factory=Notes)
    path: Path | None = None
    remarks: tuple[str, ...] = ()  # what was found in the files and not used, one line each
    orders: Orders | None = None  # commands more often than in its rows; None: those of its rows

    def __len__(self) -> int:
        return len(self.t)

    def __getitem__(self, name: str) -> Array:
        """The signal (N,) of this name. Raises NoSignal."""
        if name not in self.signals:
            raise NoSignal(unknown_name(f"{self.name}: signal", name, self.signals))
        return self.signals[name]

    def unit(self, name: str) -> str:
        """Unit of a signal, from the end of its name; "" for a plain number."""
        return unit_of(name)

    def between(self, from_s: float, to_s: float) -> "Recording":
        """The rows with from_s <= t <= to_s; times stay as they are."""
        inside = (self.t >= from_s - 1e-9) & (self.t <= to_s + 1e-9)
        if not inside.any():
            message = (
                f"no rows from {from_s:g} to {to_s:g} s; it has {self.t[0]:g} to {self.t[-1]:g} s"
            )
            raise refuse(self.path or Path(self.name), message, column="t_s")
        signals = {k: v[inside] for k, v in self.signals.items()}
        orders = self.orders.between(from_s, to_s) if self.orders else None
        return replace(self, t=self.t[inside], signals=signals, orders=orders)

    def thinned(self, rate: float) -> "Recording":
        """Every n-th row, so that about `rate` rows a second are left, each with the mean command until the next.

        Of poses and rates that are not measured in every row, each keeps every n-th of its own samples. The commands
        themselves stay at their own times, as its `orders`.
        """
        measured = {k: v for k, v in self.signals.items() if k in (*POSE, *RATES)}
        if any(np.isnan(v).any() for v in measured.values()):
            return self._thinned_each(rate, measured)
        n = max(1, round(1.0 / (rate * float(np.median(np.diff(self.t))))))
        if n == 1:
            return self
        commands = {
            k: v for k, v in self.signals.items() if k not in (*POSE, *RATES)
        }  # whatever the vessel calls them
        ends = np.append(np.arange(0, len(self.t), n), len(self.t))
        signals = {k: v[::n] for k, v in self.signals.items()}
        signals |= {k: np.add.reduceat(v, ends[:-1]) / np.diff(ends) for k, v in commands.items()}
        return replace(
            self, t=self.t[::n], signals=signals, orders=self.orders or Orders(self.t, commands)
        )

    def _thinned_each(self, rate: float, measured: Mapping[str, Array]) -> "Recording":
        """The rows in which some signal has a sample that it keeps."""
        kept = {}
        for name, values in measured.items():
            there = np.flatnonzero(np.isfinite(values))
            steps = np.diff(self.t[there])
            kept[name] = there[
                :: max(1, round(1.0 / (rate * float(np.median(steps))))) if len(steps) else 1
            ]
        rows = np.unique(np.concatenate(list(kept.values())))
        if len(rows) < 2:
            return self
        signals = {}
        for name, values in self.signals.items():
            if name in kept:
                full = np.full(len(self.t), np.nan)
                full[kept[name]] = values[kept[name]]
                signals[name] = full[rows]
            else:  # the mean until the next row, by time
                lasts = np.append(np.diff(self.t), np.median(np.diff(self.t)))
                signals[name] = np.add.reduceat(values * lasts, rows) / np.add.reduceat(lasts, rows)
        commands = {k: v for k, v in self.signals.items() if k not in measured}
        return replace(
            self, t=self.t[rows], signals=signals, orders=self.orders or Orders(self.t, commands)
        )

    def used(self) -> "Recording":
        """The part its notes name in `use`, or all of it."""
        return self.between(*self.notes.use) if self.notes.use else self


def read(
    path: Path | str,
    channels: Mapping[str, tuple[float, float]] | None = None,
    columns: Mapping[str, str] | None = None,
) -> Recording:
    """A recording with the notes of the nearest `recording.toml`.

    `channels` are the vessel's command channels with their lowest and highest value; those not among the columns are
    simply absent. `columns` says what the vessel's recordings call our names; the notes' own word wins. Raises
    BadInput, one line with file, row and column, for anything that can not be used.
    """
    path, channels = Path(path), channels or {}
    found = notes_for(path)
    raw, _, absent = _renamed(_raw(path), columns or {}, found.columns)
    needed = [
        n for n in raw.columns if n == "t_s" or n in (*POSE, *RATES, *channels) or is_command(n)
    ]
    _check_columns(raw, needed)
    _check_cells(raw, needed)
    wrong = [*_wrong(lambda: _check_time(raw)), *_wrong(lambda: _check_units(raw))]
    if wrong := [*wrong, *_wrong(lambda: _check_limits(raw, channels))]:
        raise BadInput("; ".join([wrong[0], *(w.removeprefix(f"{path}: ") for w in wrong[1:])]))
    signals, ignored = _signals(raw, needed)
    remarks = (
        *found.remarks,
        *absent,
        *((f"{path}: columns not used: {', '.join(ignored)}",) if ignored else ()),
    )
    recording = Recording(path.stem, raw.columns["t_s"], signals, found.notes, path, remarks)
    if len(part := recording.used()) < FEWEST_ROWS:
        raise refuse(
            path,
            f"has {len(part)} rows in its part to use {found.notes.use}; at least {FEWEST_ROWS} needed",
        )
    return recording


def as_written(
    path: Path, columns: Mapping[str, str] | None = None
) -> tuple[Recording, Mapping[str, Expression]]:
    """What a file holds under our names, unchecked: times may stand still, angles be in degrees, cells be empty.

    With it what each column is made of, where the vessel or the notes say so. Raises BadInput where it is no table, or
    one without time.
    """
    found = notes_for(path)
    raw, made, _ = _renamed(_raw(path), columns or {}, found.columns)
    if "t_s" not in raw.columns or len(raw.rows) < 2:
        _check_columns(raw, list(raw.columns))
        raise refuse(path, f"has {len(raw.rows)} rows; at least {FEWEST_ROWS} are needed")
    signals = {n: v for n, v in raw.columns.items() if n != "t_s"}
    return Recording(path.stem, raw.columns["t_s"], signals, found.notes, path), made


def write_csv(recording: Recording, path: Path | str) -> None:
    """Write all signals, t_s first, to 12 digits: the same recording gives the same bytes. Raises OSError."""
    with replacing(path) as temporary, temporary.open("w", encoding="utf-8", newline="") as file:
        file.write(csv_header(recording))
        for start in range(
            0, len(recording), 10_000
        ):  # an hour of rows is not formatted in one piece of memory
            file.write(csv_rows(recording, start, start + 10_000))


def joined(pieces: Sequence[Recording]) -> Recording:
    """Pieces of one log, whose rows follow each other, as one."""
    first = pieces[0]
    if len(pieces) == 1:
        return first
    signals = {name: np.concatenate([piece[name] for piece in pieces]) for name in first.signals}
    return replace(first, t=np.concatenate([piece.t for piece in pieces]), signals=signals)


def csv_header(recording: Recording) -> str:
    """First line of its CSV."""
    return ",".join(["t_s", *recording.signals]) + "\n"


def csv_rows(recording: Recording, start: int = 0, end: int | None = None) -> str:
    """Lines of its CSV from row `start` to row `end`; nan is an empty cell."""
    columns = [recording.t, *recording.signals.values()]
    line = ",".join(["%.12g"] * len(columns)) + "\n"
    part = np.column_stack([c[start:end] for c in columns]) + 0.0  # -0 becomes 0
    return "".join([line % tuple(row) for row in part.tolist()]).replace("nan", "")


def _raw(path: Path) -> Raw:
    if path.is_dir():
        raise refuse(path, "is a folder; a recording is a CSV, Parquet or .rrd file")
    if not path.is_file():
        raise refuse(path, "there is no such file")
    try:
        limits.check_file(path)
        suffix = path.suffix.removeprefix(".").lower()
        format = suffix if suffix in names("reader") else "csv"
        found = module_of("reader", format).read(path)
        if not isinstance(found, Raw):
            raise refuse(
                path,
                f"read of the reader {format}.py gives {type(found).__name__}; a Raw is wanted",
            )
        limits.check_shape(path, len(found.columns))
        return found
    except OSError as error:
        raise refuse(path, f"can not be read ({error.strerror})") from error


def _renamed(
    raw: Raw, of_vessel: Mapping[str, str], stated: Mapping[str, str]
) -> tuple[Raw, Mapping[str, Expression], tuple[str, ...]]:
    """The table under our names, what these are made of, and a remark on what of the notes' own `[columns]` it lacks.

    A vessel's mapping that does not fit this file's columns is left alone; one that the notes state and that is a
    letter off a column is refused.
    """
    made: dict[str, Expression] = {}
    absent: list[str] = []
    for ours, words in {**of_vessel, **stated}.items():
        try:
            found = parse(words, raw.columns)
        except BadInput as error:
            raise BadInput(
                f"{raw.path} by its recording.toml: columns.{ours} = {words!r}: {error}"
            ) from None
        if found.signal in raw.columns:
            made[ours] = found
        elif ours in stated and ours not in raw.columns:
            absent.append(f"{ours} = {words!r}")
            if near := get_close_matches(found.signal, list(raw.columns), n=1, cutoff=NEAR):
                raise BadInput(
                    f"{raw.path} by its recording.toml: columns.{ours} = {words!r}, but there is no column "
                    f"{found.signal!r}; did you mean {near[0]!r}? (there are: {', '.join(raw.columns)[:200]})"
                )
    used = {e.signal for e in made.values()}
    kept = {n: v for n, v in raw.columns.items() if n not in used and n not in made}
    text = {n: raw.text[n] for n in kept if n in raw.text}
    for ours, e in made.items():
        kept[ours] = e.of(raw.columns[e.signal])
        if e.signal in raw.text:
            text[ours] = raw.text[e.signal]
    said = (
        (f"{raw.path}: recording.toml names columns that it has not: {', '.join(absent)}",)
        if absent
        else ()
    )
    return replace(raw, columns=kept, text=text), made, said


def is_command(name: str) -> bool:
    """Whether command channels of boats are called so."""
    return COMMAND.match(name) is not None


def _check_columns(raw: Raw, needed: list[str]) -> None:
    if "t_s" not in raw.columns:
        raise refuse(raw.path, f"is missing (there are: {', '.join(raw.columns)[:200]})", 1, "t_s")
    if not any(name in (*POSE, *RATES) for name in needed):
        raise refuse(
            raw.path, f"no pose or rate; at least one is needed of {', '.join((*POSE, *RATES))}", 1
        )
    if not len(raw.rows):
        raise refuse(raw.path, f"has a header and no rows; at least {FEWEST_ROWS} are needed")


def _check_cells(raw: Raw, needed: list[str]) -> None:
    for name in needed:
        if name in raw.text:
            row, cell = raw.text[name]
            raise refuse(raw.path, f"{cell!r} is not a number", row, name)
    _check_overlap(raw, {name: np.isnan(raw.columns[name]) for name in needed})
    fair = fair_gaps({n: raw.columns[n] for n in needed})
    unusable = {n: ~(np.abs(raw.columns[n]) < HUGE) & ~fair.get(n, False) for n in needed}
    first = [(int(np.argmax(where)), name) for name, where in unusable.items() if where.any()]
    if first:
        index, name = min(first, key=lambda found: found[0])
        found = raw.columns[name][index]
        what = (
            "the cell is empty or not a number (NaN)"
            if np.isnan(found)
            else f"{found:g} can not be right"
        )
        raise refuse(raw.path, f"{what}; every row needs a number here", raw.rows[index], name)
    if len(raw.rows) < FEWEST_ROWS:
        raise refuse(
            raw.path, f"has {len(raw.rows)} rows; at least {FEWEST_ROWS} are needed", raw.rows[-1]
        )


def fair_gaps(
    columns: Mapping[str, Array],
) -> dict[str, "np.ndarray[tuple[int], np.dtype[np.bool_]]"]:
    """Of each pose and rate the rows (N,) in which it may be empty: it is just not measured then.

    One that is empty in many rows is measured less often than they are written. Another may be empty in rows that are
    there for such a one. Elsewhere an empty cell is a fault of the file.
    """
    empty = {n: np.isnan(v) for n, v in columns.items() if n in (*POSE, *RATES)}
    slow = {
        n: e for n, e in empty.items() if e.mean() >= SLOW and len(e) - int(e.sum()) >= FEWEST_ROWS
    }
    if not slow:
        return {}
    theirs = np.any([~e for e in slow.values()], axis=0)
    return {n: e if n in slow else e & theirs for n, e in empty.items()}


def _check_overlap(
    raw: Raw, empty: Mapping[str, "np.ndarray[tuple[int], np.dtype[np.bool_]]"]
) -> None:
    """Two logs merged by time leave poses in some rows and commands in others."""
    motion = [where for name, where in empty.items() if name in (*POSE, *RATES)]
    commands = [where for name, where in empty.items() if name not in ("t_s", *POSE, *RATES)]
    if not motion or not commands:
        return
    posed, commanded = ~np.any(motion, axis=0), ~np.any(commands, axis=0)
    if posed.any() and commanded.any() and not (posed & commanded).any():
        t = raw.columns["t_s"]
        spans = [f"{t[rows][0]:g} to {t[rows][-1]:g} s" for rows in (posed, commanded)]
        message = f"poses ({spans[0]}) and commands ({spans[1]}) have no row in common; every row needs both"
        raise refuse(raw.path, message, raw.rows[int(np.argmax(commanded))], "t_s")


def _wrong(check: Callable[[], None]) -> list[str]:
    """What a check refuses, so that all is said at once."""
    try:
        check()
    except BadInput as error:
        return [str(error)]
    return []


def _check_time(raw: Raw) -> None:
    t = raw.columns["t_s"]
    stuck = np.diff(t) <= 0.0
    if stuck.any():
        index = int(np.argmax(stuck)) + 1
        message = f"time {t[index]:g} s after {t[index - 1]:g} s; it must increase from row to row"
        raise refuse(raw.path, message, raw.rows[index], "t_s")
    if (apart := np.diff(t) > GAP).any():
        index = int(np.argmax(apart)) + 1
        message = f"{t[index] - t[index - 1]:g} s after the row before, at most {GAP:g} s are allowed; is it in seconds?"
        raise refuse(raw.path, message, raw.rows[index], "t_s")


def _check_units(raw: Raw) -> None:
    for name, index in units.in_degrees(raw.columns).items():
        message = f"{raw.columns[name][index]:g} looks like degrees; allowed are radians ({unit_of(name)})"
        raise refuse(raw.path, message, raw.rows[index], name)


def _check_limits(raw: Raw, channels: Mapping[str, tuple[float, float]]) -> None:
    for name, (low, high) in channels.items():
        if name in raw.columns:
            margin = ROUNDING * (high - low) if math.isfinite(high - low) else 0.0
            beyond = (raw.columns[name] < low - margin) | (raw.columns[name] > high + margin)
            if beyond.any():
                index = int(np.argmax(beyond))
                found = f"{raw.columns[name][index]:g} {unit_of(name)}".strip()
                message = f"command {found} is outside the vessel's limits {low:g} to {high:g}"
                raise refuse(raw.path, message, raw.rows[index], name)


def _signals(raw: Raw, needed: list[str]) -> tuple[dict[str, Array], list[str]]:
    """The signals, headings unwrapped, and the names of columns a diagnosis has no use for."""
    ignored = [n for n in raw.columns if n not in needed and not OWN.match(n)]
    names = [
        n
        for n in raw.columns
        if n != "t_s" and n not in raw.text and (n not in ignored or unit_of(n))
    ]
    signals = {name: raw.columns[name] for name in names}
    for name in names:
        if name == "psi_rad" or name.endswith("_psi_rad"):
            signals[name] = _unwrapped(signals[name])
    return signals, ignored


def _unwrapped(angle: Array) -> Array:
    """Without jumps of 2 pi; rows that are nan stay so."""
    known = np.isfinite(angle)
    full = angle.copy()
    full[known] = np.unwrap(angle[known])
    return full
