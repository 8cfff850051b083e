"""The `Recording` of a vessel: time, named signals with units and notes.

Read with checks, written as CSV.
"""

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from difflib import get_close_matches
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from boatsim.arguments import check_instance, checked_names, checked_number, float_array
from boatsim.errors import BadInput, unknown_name_message
from boatsim.files import replace_file
from boatsim.physics.content import import_library_module, shipped_content_names
from boatsim.physics.signals import POSE, RATES, Array
from boatsim.recordings import limits, units
from boatsim.recordings.conversion import Curve, Range
from boatsim.recordings.expression import Expression, parse
from boatsim.recordings.interpolated_wraps import (
    ACROSS_WRAP,
    empty_across_wrap,
    without_interpolated_wraps,
)
from boatsim.recordings.latency import shifted_columns, shifted_commands
from boatsim.recordings.motion_clock import times_by_motion
from boatsim.recordings.notebook.arrow import signal_table
from boatsim.recordings.notebook.data_frame import data_frame
from boatsim.recordings.notebook.views import recording_figure, recording_html, table_metadata
from boatsim.recordings.notes import Notes, join_mistakes, notes_for, unit_of
from boatsim.recordings.raw_table import Raw, file_error, select_rows
from boatsim.recordings.run_folder import recording_file

if TYPE_CHECKING:
    import pandas as pd
    import pyarrow as pa
    from matplotlib.figure import Figure

__all__ = ["POSE", "RATES", "Notes", "Recording", "read", "write_csv"]

FEWEST_ROWS = 20
MOTION = (*POSE, *RATES)
# Columns of runs of boatsim other than pose, rates and commands; missing sensors are nan
RUN_COLUMN = re.compile(
    r"(sent|stick|actual|sensed|camera|estimate|reference|goal|force|wind)_"
    r"|(contacts|wave_elevation_m|water_north_mps|water_east_mps)$"
)
# Usual names of command channels; others are known from the vessel
COMMAND = re.compile(
    r"(thrust|steer|pwm|delta|rudder|throttle|nozzle|jet|elevator|azimuth|n)(_|$)(?!.*(sd|rate))"
)
HUGE = 1e12  # larger times, positions, speeds and commands are mistakes
# A command is refused if it exceeds its limit by this factor. Units that are mistaken for another
# differ by more: degrees by 57, revolutions a minute by 9.5, thousandths by 1,000. A real drive may
# exceed the limit of a vessel file by 30 %, as files are written for another load or voltage
MAX_EXCESS = 3.0
BEYOND_RANGE = "beyond the range of the vessel file,"
MAX_GAP = 60.0  # [s] between rows; no filter follows a vessel over a longer gap
MISSPELT = 0.8  # similarity from which an unknown column is a misspelt name
MAX_PARTS = 5  # of a recording with gaps that a message proposes to use
# Share of empty rows from which a pose or rate is measured less often than rows are written
SPARSE_SHARE = 0.1
# Share of a channel's range by which a rounded command may exceed its limit
ROUNDING = 1e-3


class SignalMissing(BadInput):
    """Raised if a requested signal is not in a recording."""


@dataclass(frozen=True)
class Converted:
    """A column by a conversion of an expression of another column."""

    how: Expression
    conversion: Range | Curve

    @property
    def signal(self) -> str:
        """Name of the column from which this one follows."""
        return self.how.signal

    def convert(self, values: Array) -> Array:
        """Convert the values (N,) of the recorded column to those of this column."""
        return self.conversion.convert(self.how.convert(values))


@dataclass(frozen=True)
class TimedCommands:
    """Recorded commands at their own times; each command is in force until the next.

    Attributes:
        t: Times (K,) [s].
        signals: Command channel -> values (K,).
    """

    t: Array
    signals: Mapping[str, Array]

    def between(self, from_s: float, to_s: float) -> "TimedCommands":
        """Return the recorded commands that are in force between two times [s]."""
        begin = max(int(np.searchsorted(self.t, from_s + 1e-9, side="right")) - 1, 0)
        end = int(np.searchsorted(self.t, to_s + 1e-9, side="right"))
        return TimedCommands(self.t[begin:end], select_rows(self.signals, slice(begin, end)))


@dataclass(frozen=True)
class Recording:
    """Recording of one run of a vessel, simulated or real, in SI units and SNAME axes.

    A command is in force until the next row. Headings are unwrapped. `boatsim.read` returns the
    recording of a file; `recording["psi_rad"]` is a signal.

    Attributes:
        name: Name of the recording.
        t: Times (N,) [s], strictly increasing.
        signals: Name with the unit as suffix ("psi_rad") -> values (N,).
        notes: Vessel, load conditions, noise and facts.
        path: File of the recording, None for one in memory.
        remarks: Messages about content of the files that is not used.
        orders: Commands at a higher rate than the rows; None where the rows have all commands.
    """

    name: str
    t: Array
    signals: dict[str, Array]
    notes: Notes = field(default_factory=Notes)
    path: Path | None = None
    remarks: tuple[str, ...] = ()
    orders: TimedCommands | None = None

    def __post_init__(self) -> None:
        check_instance("name", self.name, str, "a text")
        check_instance("notes", self.notes, Notes, "Notes")
        check_instance("signals", self.signals, Mapping, "a mapping")
        if not isinstance(self.t, np.ndarray):
            object.__setattr__(self, "t", float_array("t", self.t))
        if self.t.ndim != 1:
            raise BadInput(f"t of shape {self.t.shape}; allowed are times (N,)")
        for name, values in self.signals.items():
            if not isinstance(values, np.ndarray):
                values = float_array(f"signals[{name!r}]", values)
                object.__setattr__(self, "signals", {**self.signals, name: values})
            if values.shape != self.t.shape:
                raise BadInput(
                    f"signals[{name!r}] of shape {values.shape}; allowed is {self.t.shape}, as t"
                )

    def __len__(self) -> int:
        return len(self.t)

    def __repr__(self) -> str:
        """Name, number of rows and signals; the values would fill pages."""
        return f"<Recording {self.name}: {len(self)} rows of {len(self.signals)} signals>"

    @property
    def origin(self) -> str:
        """File that it was read from, or its name if it is one in memory."""
        return str(self.path or self.name)

    def __getitem__(self, name: str) -> Array:
        """Return the values (N,) of a signal. Raises SignalMissing."""
        check_instance("name", name, str, "a text")
        if name not in self.signals:
            raise SignalMissing(unknown_name_message(f"{self.name}: signal", name, self.signals))
        return self.signals[name]

    def unit(self, name: str) -> str:
        """Return the unit of a signal by its name's suffix.

        Args:
            name: Name of the signal, such as "u_mps".

        Returns:
            The unit, such as "m/s"; "" for a number without a unit.
        """
        check_instance("name", name, str, "a text")
        return unit_of(name)

    def between(self, from_s: float, to_s: float) -> "Recording":
        """Return the part of a recording between two times; times are not shifted.

        Args:
            from_s: First time [s].
            to_s: Last time [s].

        Returns:
            The rows with from_s <= t <= to_s.

        Raises:
            BadInput: If there are no such rows.
        """
        for argument, value in (("from_s", from_s), ("to_s", to_s)):
            check_instance(argument, value, int | float | np.number, "a number")
        inside = (self.t >= from_s - 1e-9) & (self.t <= to_s + 1e-9)
        if not inside.any():
            message = (
                f"no rows from {from_s:g} to {to_s:g} s; it has {self.t[0]:g} to {self.t[-1]:g} s"
            )
            raise file_error(self.path or Path(self.name), message, column="t_s")
        orders = self.orders
        if orders:
            orders = orders.between(from_s, to_s)
        signals = select_rows(self.signals, inside)
        return replace(self, t=self.t[inside], signals=signals, orders=orders)

    def thinned(self, rate: float) -> "Recording":
        """Return a recording with fewer rows: every n-th row, with mean commands in between.

        Poses and rates that are not measured in every row keep every n-th of their own samples.
        `orders` of the result are all commands.

        Args:
            rate: Rows per second of the result, approximately [Hz].

        Returns:
            The recording with fewer rows; the same recording if it has so few already.
        """
        rate = checked_number("rate", rate, 1e-9, 1e9, "Hz")
        if len(self.t) < 2:
            return self
        measured, commands = _motion_and_others(self.signals)
        if any(np.isnan(values).any() for values in measured.values()):
            return self._thinned_each(rate, measured, commands)
        n = max(1, round(1.0 / (rate * float(np.median(np.diff(self.t))))))
        if n == 1:
            return self
        ends = np.append(np.arange(0, len(self.t), n), len(self.t))
        signals = select_rows(self.signals, slice(None, None, n))
        for name, values in commands.items():
            signals[name] = np.add.reduceat(values, ends[:-1]) / np.diff(ends)
        return replace(
            self,
            t=self.t[::n],
            signals=signals,
            orders=self.orders or TimedCommands(self.t, commands),
        )

    def _thinned_each(
        self, rate: float, measured: Mapping[str, Array], commands: dict[str, Array]
    ) -> "Recording":
        """Return the rows in which at least one signal keeps a sample."""
        kept = {}
        for name, values in measured.items():
            samples = np.flatnonzero(np.isfinite(values))
            steps = np.diff(self.t[samples])
            n = 1
            if len(steps):
                n = max(1, round(1.0 / (rate * float(np.median(steps)))))
            kept[name] = samples[::n]
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
        return replace(
            self,
            t=self.t[rows],
            signals=signals,
            orders=self.orders or TimedCommands(self.t, commands),
        )

    def without_latency(self, latency: Mapping[str, float]) -> "Recording":
        """Return a recording whose late columns are moved to the times at which they were true.

        Args:
            latency: Column -> delay of its values [s].

        Raises:
            BadInput: A column does not exist, or x_m and y_m have different delays.
        """
        place = self.origin
        t, signals = shifted_columns(self.t, self.signals, latency, place)
        orders = self.orders
        if orders is not None:
            orders = TimedCommands(*shifted_commands(orders.t, orders.signals, latency))
        return replace(self, t=t, signals=signals, orders=orders)

    def parts(self) -> list["Recording"]:
        """Return the parts of a recording that its notes select by `use`, or the whole recording.

        The notes of each part select this part alone.
        """
        if not self.notes.use:
            return [self]
        found = []
        for part in self.notes.use:
            found.append(replace(self.between(*part), notes=replace(self.notes, use=(part,))))
        return found

    def used(self) -> "Recording":
        """Return the part of a recording that its notes select by `use`, or the whole recording.

        Of several parts it is the longest one, and a remark states it.
        """
        parts = self.parts()
        if len(parts) == 1:
            return parts[0]
        longest = max(parts, key=lambda part: float(np.ptp(part.t)))
        begin, end = longest.notes.use[0]
        note = (
            f"{self.origin}: of {len(parts)} parts to use the longest one is used here, "
            f"{begin:g} to {end:g} s"
        )
        return replace(longest, remarks=(*longest.remarks, note))

    def to_arrow(self) -> "pa.Table":
        """Return the columns of the recording as a table of Arrow, `t_s` first.

        Units are SI and radians; the metadata of each column has its `unit`. Missing values are
        null.
        """
        return signal_table(self.t, self.signals, table_metadata(self.name, self.notes))

    def __arrow_c_stream__(self, requested_schema: object = None) -> object:
        """Return the columns as a stream of Arrow, so that `pyarrow.table(recording)` works.

        This is the PyCapsule interface of Arrow, which pandas, polars and DuckDB read too.

        Args:
            requested_schema: Capsule of the schema that the reader prefers.
        """
        return self.to_arrow().__arrow_c_stream__(requested_schema)

    def to_pandas(self) -> "pd.DataFrame":
        """Return the columns of the recording as a data frame of pandas, `t_s` first.

        Units are SI and radians; `attrs["units"]` has the unit of each column.

        Raises:
            BadInput: If pandas is not installed.
        """
        return data_frame(self.to_arrow())

    def plot(self, signals: str | Sequence[str] = ()) -> "Figure":
        """Draw the track seen from above, and signals over time, with angles in degrees.

        Args:
            signals: One or several signals to draw over time; by default attitude, rates and
                commands.

        Returns:
            A figure of matplotlib.

        Raises:
            BadInput: If a signal does not exist, or matplotlib is not installed.
        """
        given = checked_names("signals", signals)
        for name in given:
            self[name]  # raises for a name that does not exist
        selected = given or _motion_and_commands(self.signals)
        return recording_figure(self.name, self.t, self.signals, selected)

    def _repr_html_(self) -> str:
        """Return the summary of the recording for a notebook, with a replay seen from above."""
        return recording_html(self.name, self.t, self.signals, self.notes)


def _motion_and_commands(signals: Mapping[str, Array]) -> list[str]:
    """Names of attitude, rates and commands; the position is drawn as a track if it is complete."""
    found = []
    has_track = {"x_m", "y_m"} <= signals.keys()
    for name in signals:
        if not RUN_COLUMN.match(name) and not (has_track and name in ("x_m", "y_m")):
            found.append(name)
    return found


def _motion_and_others(signals: Mapping[str, Array]) -> tuple[dict[str, Array], dict[str, Array]]:
    """Poses and rates, and the other signals."""
    motion, others = {}, {}
    for name, values in signals.items():
        if name in MOTION:
            motion[name] = values
        else:
            others[name] = values
    return motion, others


def read(
    path: Path | str,
    channels: Mapping[str, tuple[float, float]] | None = None,
    columns: Mapping[str, str] | None = None,
    turns_over: bool = False,
) -> Recording:
    """Read a recording from a file, with checks and the notes of the nearest `recording.toml`.

    Args:
        path: File of the recording, or the output folder of a run.
        channels: Allowed range (low, high) of the vessel's inputs; inputs without a column are
            absent.
        columns: Signal -> column of the vessel's recordings; those of the notes replace them.
        turns_over: Whether the vessel may roll to any angle, so that its roll runs on.

    Raises:
        BadInput: One line with file, row and column of what cannot be used.
    """
    path, channels = recording_file(path), channels or {}
    found = notes_for(path)
    raw, _, absent = _rename_columns(_read_raw(path), columns or {}, found.columns)
    needed = []
    for name in raw.columns:
        if name in ("t_s", *MOTION, *channels) or is_command(name):
            needed.append(name)
    _check_columns(raw, needed)
    used = _used_rows(raw, found.notes.use)  # rows outside may have faults
    _check_cells(used, needed)
    mistakes: list[str] = []
    check_time = partial(_check_time, use=found.notes.use)
    check_units = partial(_check_units, turns_over=turns_over)
    for check in (check_time, check_units, partial(_check_limits, channels=channels)):
        try:
            check(used)
        except BadInput as error:
            mistakes.append(str(error))
    if mistakes:
        raise BadInput(join_mistakes(mistakes, path))
    signals, ignored, across = _signals(raw, needed, turns_over)
    remarks = [*found.remarks, *absent, *across]
    if ignored:
        remarks.append(f"{path}: columns not used: {', '.join(ignored)}")
    remarks += _range_remarks(used, channels)
    recording = Recording(path.stem, raw.columns["t_s"], signals, found.notes, path, tuple(remarks))
    recording = recording.without_latency(found.notes.latency)
    if found.notes.clock:
        recording = _with_clock_of_motion(recording, path)
    for part in recording.parts():
        if len(part) < FEWEST_ROWS:
            [interval] = part.notes.use or [(part.t[0], part.t[-1])]
            raise file_error(
                path,
                f"has {len(part)} rows in its part to use {list(interval)}; at least {FEWEST_ROWS} "
                "needed",
            )
    return recording


def read_unchecked(
    path: Path, columns: Mapping[str, str] | None = None
) -> tuple[Recording, Mapping[str, Expression]]:
    """Read a recording from a file without checks of its values; angles may be in degrees.

    Args:
        path: File of the recording.
        columns: Signal -> column of the vessel's recordings.

    Returns:
        The recording, and the expression of each column that the vessel or the notes define.

    Raises:
        BadInput: If the file is no table, or one without time.
    """
    found = notes_for(path)
    raw, made, _ = _rename_columns(_read_raw(path), columns or {}, found.columns)
    if "t_s" not in raw.columns or not len(raw.rows):
        _check_columns(raw, list(raw.columns))
    if len(raw.rows) < FEWEST_ROWS:
        raise _too_few_rows(raw)
    signals = dict(raw.columns)
    t = signals.pop("t_s")
    linear: dict[str, Expression] = {}
    for name, how in made.items():
        if isinstance(how, Expression):
            linear[name] = how
    return Recording(path.stem, t, signals, found.notes, path), linear


def write_csv(recording: Recording, path: Path | str) -> None:
    """Write all signals of a recording to a CSV file, with time first and 12 digits.

    Equal recordings give equal files. Raises OSError.
    """
    with replace_file(path) as temporary, temporary.open("w", encoding="utf-8", newline="") as file:
        file.write(csv_header(recording))
        for start in range(0, len(recording), 10_000):  # limits the memory of the text
            file.write(csv_rows(recording, start, start + 10_000))


def join_recordings(pieces: Sequence[Recording]) -> Recording:
    """Join consecutive pieces of a log into one recording."""
    first = pieces[0]
    if len(pieces) == 1:
        return first
    signals: dict[str, Array] = {}
    for name in first.signals:
        signals[name] = np.concatenate([piece[name] for piece in pieces])
    return replace(first, t=np.concatenate([piece.t for piece in pieces]), signals=signals)


def csv_header(recording: Recording) -> str:
    """Return the header line of a recording's CSV file."""
    return ",".join(["t_s", *recording.signals]) + "\n"


def csv_rows(recording: Recording, start: int = 0, end: int | None = None) -> str:
    """Return the rows `start` to `end` of a recording as lines of CSV; nan is an empty cell."""
    columns = [recording.t, *recording.signals.values()]
    line = ",".join(["%.12g"] * len(columns)) + "\n"
    part = np.column_stack([c[start:end] for c in columns]) + 0.0  # -0 becomes 0
    return "".join(map(line.__mod__, map(tuple, part.tolist()))).replace("nan", "")


def _read_raw(path: Path) -> Raw:
    if path.is_dir():
        raise file_error(path, "is a folder; a recording is a CSV, Parquet or .rrd file")
    if not path.is_file():
        raise file_error(path, "there is no such file")
    try:
        limits.check_file_size(path)
        suffix = path.suffix.removeprefix(".").lower()
        format = "csv"
        if suffix in shipped_content_names("reader"):
            format = suffix
        found = import_library_module("reader", format).read(path)
        if not isinstance(found, Raw):
            raise file_error(
                path,
                f"read of the reader {format}.py returns {type(found).__name__}; allowed is Raw",
            )
        limits.check_table_size(path, len(found.columns))
        return found
    except OSError as error:
        raise file_error(path, f"cannot be read ({error.strerror})") from error


def _rename_columns(
    raw: Raw, of_vessel: Mapping[str, str], of_notes: Mapping[str, str | Range | Curve]
) -> tuple[Raw, Mapping[str, Expression | Converted], tuple[str, ...]]:
    """The table with names of signals, their expressions, and a remark on unknown columns.

    A mapping of the vessel whose column does not exist is ignored; one of the notes with a misspelt
    column is an error.
    """
    made: dict[str, Expression | Converted] = {}
    absent: list[str] = []
    for ours, given in {**of_vessel, **of_notes}.items():
        words = given if isinstance(given, str) else given.signal
        try:
            found: Expression | Converted = parse(words, raw.columns)
            if isinstance(found, Expression) and not isinstance(given, str):
                found = Converted(found, given)
        except BadInput as error:
            raise BadInput(
                f"{raw.path} by its recording.toml: columns.{ours} = {words!r}: {error}"
            ) from None
        if found.signal in raw.columns:
            made[ours] = found
        elif ours in of_notes and ours not in raw.columns:
            absent.append(f"{ours} = {words!r}")
            if near := get_close_matches(found.signal, list(raw.columns), n=1, cutoff=MISSPELT):
                raise BadInput(
                    f"{raw.path} by its recording.toml: columns.{ours} = {words!r}, but there is "
                    "no column "
                    f"{found.signal!r}; did you mean {near[0]!r}? (there are: "
                    f"{', '.join(raw.columns)[:200]})"
                )
    used = {expression.signal for expression in made.values()}
    kept: dict[str, Array] = {}
    text: dict[str, tuple[int, str]] = {}
    for name, values in raw.columns.items():
        if name not in used and name not in made:
            kept[name] = values
            if name in raw.text:
                text[name] = raw.text[name]
    for ours, expression in made.items():
        kept[ours] = expression.convert(raw.columns[expression.signal])
        if expression.signal in raw.text:
            text[ours] = raw.text[expression.signal]
    remarks: tuple[str, ...] = ()
    if absent:
        remarks = (
            f"{raw.path}: recording.toml names columns that do not exist: {', '.join(absent)}",
        )
    return replace(raw, columns=kept, text=text), made, remarks


def is_command(name: str) -> bool:
    """Return whether the name of a column is usual for a command channel, such as a thrust."""
    return COMMAND.match(name) is not None


def _used_rows(raw: Raw, use: Sequence[tuple[float, float]]) -> Raw:
    """The rows of a table that the notes select; all rows if they select too few."""
    if not use:
        return raw
    t = raw.columns["t_s"]
    inside = np.zeros(len(t), dtype=np.bool_)
    for begin, end in use:
        inside |= (t >= begin - 1e-9) & (t <= end + 1e-9)
    if inside.sum() < FEWEST_ROWS:
        return raw
    rows = np.asarray(raw.rows)[inside].tolist()
    return replace(raw, columns=select_rows(raw.columns, inside), rows=rows)


def _check_columns(raw: Raw, needed: list[str]) -> None:
    if "t_s" not in raw.columns:
        raise file_error(
            raw.path, f"is missing (there are: {', '.join(raw.columns)[:200]})", 1, "t_s"
        )
    if set(MOTION).isdisjoint(needed):
        raise file_error(
            raw.path, f"no pose or rate; at least one is needed of {', '.join(MOTION)}", 1
        )
    if not len(raw.rows):
        raise file_error(raw.path, f"has a header and no rows; at least {FEWEST_ROWS} are needed")


def _too_few_rows(raw: Raw) -> BadInput:
    return file_error(raw.path, f"has {len(raw.rows)} rows; at least {FEWEST_ROWS} are needed")


def _check_cells(raw: Raw, needed: list[str]) -> None:
    for name in needed:
        if name in raw.text:
            row, cell = raw.text[name]
            raise file_error(raw.path, f"{cell!r} is not a number", row, name)
    columns = dict(zip(needed, map(raw.columns.__getitem__, needed), strict=True))
    _check_overlap(raw, columns)
    allowed = allowed_empty_rows(columns)
    first: list[tuple[int, str]] = []
    for name, values in columns.items():
        unusable = ~(np.abs(values) < HUGE)
        if name in allowed:
            unusable &= ~allowed[name]
        if unusable.any():
            first.append((int(np.argmax(unusable)), name))
    if first:
        index, name = min(first, key=lambda found: found[0])
        found = columns[name][index]
        what = f"{found:g} is too large"
        if np.isnan(found):
            what = "the cell is empty or not a number (NaN)"
        raise file_error(raw.path, f"{what}; every row needs a number here", raw.rows[index], name)
    if len(raw.rows) < FEWEST_ROWS:
        raise _too_few_rows(raw)


def allowed_empty_rows(
    columns: Mapping[str, Array],
) -> dict[str, "np.ndarray[tuple[int], np.dtype[np.bool_]]"]:
    """Return the rows (N,) in which each pose and rate of a table may be empty.

    A signal that is empty in many rows is measured less often than rows are written. Other signals
    may be empty in the rows that exist for such a signal. In a row with nothing but commands all of
    them may be empty. A heading may be empty where it jumps by a full turn, because an import left
    out what was interpolated across the jump. Any other empty cell is a mistake in the file.
    """
    slow, others = {}, {}
    for name, values in columns.items():
        if name not in MOTION:
            continue
        empty = np.isnan(values)
        if empty.mean() >= SPARSE_SHARE and len(empty) - int(empty.sum()) >= FEWEST_ROWS:
            slow[name] = empty
        else:
            others[name] = empty
    if not slow and not others:
        return {}
    allowed = np.all([*slow.values(), *others.values()], axis=0)
    if slow:
        allowed |= ~np.all(list(slow.values()), axis=0)
    for name, empty in others.items():
        others[name] = empty & allowed
        if name == "psi_rad":
            others[name] |= empty_across_wrap(columns[name])
    return slow | others


def _check_overlap(raw: Raw, columns: Mapping[str, Array]) -> None:
    """Refuse logs merged by time that have poses in some rows and commands in others only."""
    motion, commands = _motion_and_others(columns)
    commands.pop("t_s")
    if not motion or not commands:
        return
    posed = ~np.any(list(map(np.isnan, motion.values())), axis=0)
    commanded = ~np.any(list(map(np.isnan, commands.values())), axis=0)
    if posed.any() and commanded.any() and not (posed & commanded).any():
        t = raw.columns["t_s"]
        spans = (_span(t[posed]), _span(t[commanded]))
        message = (
            f"poses ({spans[0]}) and commands ({spans[1]}) have no row in common; every "
            "row needs both"
        )
        raise file_error(raw.path, message, raw.rows[int(np.argmax(commanded))], "t_s")


def _span(t: Array) -> str:
    return f"{t[0]:g} to {t[-1]:g} s"


def _check_time(raw: Raw, use: Sequence[tuple[float, float]]) -> None:
    t = raw.columns["t_s"]
    stuck = np.diff(t) <= 0.0
    if stuck.any():
        index = int(np.argmax(stuck)) + 1
        message = f"time {t[index]:g} s after {t[index - 1]:g} s; it must increase from row to row"
        raise file_error(raw.path, message, raw.rows[index], "t_s")
    apart = np.diff(t) > MAX_GAP
    for begin, _ in use:  # between two parts to use
        apart &= (t[:-1] >= begin - 1e-9) | (t[1:] < begin - 1e-9)
    if apart.any():
        index = int(np.argmax(apart)) + 1
        advice = "is it in seconds?"
        if 2 * int(apart.sum()) < len(apart):
            advice = f"use = {_parts_between(t, apart)} in recording.toml selects what is between"
        message = (
            f"{t[index] - t[index - 1]:g} s after the row before, at most {MAX_GAP:g} s "
            f"are allowed; {advice}"
        )
        raise file_error(raw.path, message, raw.rows[index], "t_s")


def _parts_between(t: Array, apart: NDArray[np.bool_]) -> list[list[float]]:
    """First and last time [s] of the longest parts between gaps, in order of time."""
    parts = np.split(t, np.flatnonzero(apart) + 1)
    parts.sort(key=np.ptp, reverse=True)
    kept = [part for part in parts[:MAX_PARTS] if len(part) >= FEWEST_ROWS] or parts[:1]
    return sorted([float(part[0]), float(part[-1])] for part in kept)


def _check_units(raw: Raw, turns_over: bool = False) -> None:
    for name, index in units.find_columns_in_degrees(raw.columns, turns_over).items():
        message = (
            f"{raw.columns[name][index]:g} looks like degrees; allowed are radians "
            f"({unit_of(name)})"
        )
        raise file_error(raw.path, message, raw.rows[index], name)


def _check_limits(raw: Raw, channels: Mapping[str, tuple[float, float]]) -> None:
    """Refuse commands that are too large to be commands of their channel."""
    for name, (low, high) in channels.items():
        excess = (MAX_EXCESS - 1.0) * max(abs(low), abs(high))
        beyond = _beyond(raw, name, low - excess, high + excess)
        if beyond.any():
            index = int(np.argmax(beyond))
            found = f"{raw.columns[name][index]:g} {unit_of(name)}".strip()
            message = (
                f"command {found} is far outside the vessel's limits {low:g} to {high:g}; in "
                "what unit is it?"
            )
            raise file_error(raw.path, message, raw.rows[index], name)


def _range_remarks(raw: Raw, channels: Mapping[str, tuple[float, float]]) -> list[str]:
    """Remarks on commands beyond the limits of the vessel file that may be true."""
    remarks = []
    for name, (low, high) in channels.items():
        margin = 0.0
        if math.isfinite(high - low):
            margin = ROUNDING * (high - low)
        beyond = _beyond(raw, name, low - margin, high + margin)
        if beyond.any():
            row = raw.rows[int(np.argmax(beyond))]
            ends = f"{np.nanmin(raw.columns[name]):.4g} to {np.nanmax(raw.columns[name]):.4g}"
            remarks.append(
                f"{raw.path}: {name} ranges from {ends} {unit_of(name)}".rstrip()
                + f", {BEYOND_RANGE} {low:g} to {high:g}, in {int(beyond.sum())} rows, first in "
                f"row {row}"
            )
    return remarks


def _beyond(raw: Raw, name: str, low: float, high: float) -> "NDArray[np.bool_]":
    """Rows (N,) in which a column is outside a range; none if there is no such column."""
    if name not in raw.columns:
        return np.zeros(len(raw.rows), dtype=np.bool_)
    return np.asarray((raw.columns[name] < low) | (raw.columns[name] > high))


def _with_clock_of_motion(recording: Recording, path: Path) -> Recording:
    """The recording with the times that its motion implies; parts to use keep their rows."""
    t = times_by_motion(recording.t, recording.signals, str(path))
    rates = np.diff(t) / np.diff(recording.t)
    lowest, highest = np.quantile(rates, [0.05, 0.95])
    remark = (
        f'{path}: clock = "motion": the times follow from the motion; a second of the log lasted '
        f"{lowest:.2f} to {highest:.2f} s, {np.mean(rates):.3f} s on average"
    )
    use = []
    for begin, end in recording.notes.use:
        moved = np.interp([begin, end], recording.t, t)
        use.append((float(moved[0]), float(moved[1])))
    notes = replace(recording.notes, use=tuple(use))
    return replace(recording, t=t, notes=notes, remarks=(*recording.remarks, remark))


def _signals(
    raw: Raw, needed: list[str], turns_over: bool
) -> tuple[dict[str, Array], list[str], list[str]]:
    """The signals with unwrapped angles, the names of columns that are not used, and remarks."""
    ignored = [n for n in raw.columns if n not in needed and not RUN_COLUMN.match(n)]
    signals: dict[str, Array] = {}
    remarks = list[str]()
    for name, values in raw.columns.items():
        if name == "t_s" or name in raw.text or (name in ignored and not unit_of(name)):
            continue
        is_heading = name == "psi_rad" or name.endswith("_psi_rad")
        if is_heading or (turns_over and name == "phi_rad"):
            values, lost = without_interpolated_wraps(values)
            values = _unwrap(values)
            if lost:
                remarks.append(f"{raw.path}: {name}: {lost} rows {ACROSS_WRAP}")
        signals[name] = values
    return signals, ignored, remarks


def _unwrap(angle: Array) -> Array:
    """The angle without jumps of 2 pi; nan stays nan."""
    known = np.isfinite(angle)
    full = angle.copy()
    full[known] = np.unwrap(angle[known])
    return full
