"""Logs: many signals, each with its own times and the unit that the format gives."""

import os
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, redirect_stderr, redirect_stdout
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from boatsim.errors import BadInput
from boatsim.physics.base import Array
from boatsim.physics.content import import_library_module, shipped_content_names
from boatsim.recordings.raw_table import file_error

MAX_BYTES = 2_000_000_000  # of a file
# [bytes] of a text that is read line by line, which needs 20 times as much memory
MAX_TEXT_BYTES = 50_000_000
MAX_VALUES = 25_000_000  # of all signals together; 200 MB
MAX_SIGNALS = 5_000
HUGE = 1e20  # no measurement is as large; times in ns since 1970 are 2e18
BAG = "metadata.yaml"  # file in the folder of a bag


@dataclass(frozen=True)
class Signal:
    """One field of one stream.

    Attributes:
        t: Times (N,) as logged [s]; they may be unsorted and have gaps.
        values: Values (N,).
        unit: Unit by the format; "" where it has none.
        about: Description by the format, such as "throttle left".
        pulse: Low, neutral and high value of an output, in the unit of the signal.
        source: Name of the file, if the log has several.
    """

    t: Array
    values: Array
    unit: str = ""
    about: str = ""
    pulse: tuple[float, float, float] | None = None
    source: str = ""


@dataclass(frozen=True)
class Log:
    """All signals of a log.

    Attributes:
        path: The file.
        signals: Name, `STREAM.FIELD` or the column of a table -> signal.
        frame: Axes of the format: "NED", or "ENU" with body axes x forward, y port, z up; "" where
            unknown.
        remarks: Messages about content that was not read.
    """

    path: Path
    signals: Mapping[str, Signal]
    frame: str = ""
    remarks: tuple[str, ...] = ()


class MemoryBudget:
    """Counter of the values that a reader keeps, which limits its memory."""

    def __init__(self, path: Path) -> None:
        self.path, self.values = path, 0

    def count_values(self, values: int, signals: int = 0) -> None:
        """Count values and signals that a log reader keeps. Raises BadInput for too many."""
        self.values += values
        if self.values > MAX_VALUES:
            raise file_error(
                self.path, f"holds more than {MAX_VALUES:,} values; cut the log into shorter ones"
            )
        if signals > MAX_SIGNALS:
            raise file_error(
                self.path, f"has more than {MAX_SIGNALS:,} signals; no log of a boat has as many"
            )


def missing_library_error(path: Path, library: str, extra: str) -> BadInput:
    """Return the error of a reader whose library is not installed."""
    return file_error(
        path, f"reading it needs {library}; install it with: pip install 'boatsim[{extra}]'"
    )


def damaged_log_error(path: Path, what: str, error: BaseException) -> BadInput:
    """Return the error of a log that the library of its format cannot read."""
    reason = " ".join(str(error).split())[:150] or type(error).__name__
    return file_error(path, f"cannot be read as {what} ({reason})")


@contextmanager
def suppress_output() -> Iterator[None]:
    """Suppress the output of a library, also of its native code."""
    for stream in (sys.stdout, sys.stderr):
        stream.flush()
    kept = list(map(os.dup, (1, 2)))
    null = os.open(os.devnull, os.O_WRONLY)
    try:
        for number in (1, 2):
            os.dup2(null, number)
        with open(os.devnull, "w") as file, redirect_stdout(file), redirect_stderr(file):
            yield
    finally:
        for number, was in zip((1, 2), kept, strict=True):
            os.dup2(was, number)
        for number in (*kept, null):
            os.close(number)


def open_log(path: Path) -> Log:
    """Return a log, read by the reader of its suffix; implausible numbers are nan.

    Raises BadInput.
    """
    found = reader_for(path)(path)
    if not found.signals:
        raise file_error(path, "has no signals: nothing in it has numbers and times")
    # Signals of one stream share their times
    times = {id(signal.t): _without_implausible(signal.t) for signal in found.signals.values()}
    signals: dict[str, Signal] = {}
    for name, signal in found.signals.items():
        signals[name] = replace(
            signal, t=times[id(signal.t)], values=_without_implausible(signal.values)
        )
    return replace(found, signals=signals)


def _without_implausible(values: Array) -> Array:
    beyond = np.abs(values) >= HUGE
    if beyond.any():
        return np.where(beyond, np.nan, values)
    return values


def reader_for(path: Path) -> Callable[[Path], Log]:
    """Return the `read` of the format of a log by its suffix. Raises BadInput."""
    if not path.exists():
        raise file_error(path, "there is no such file")
    suffixes = known_suffixes()
    if path.is_dir() and not (path / BAG).is_file():
        raise file_error(
            path, f"is a folder; a log is a file, or the folder of a ROS 2 bag with its {BAG}"
        )
    if not path.is_dir() and not path.is_file():
        raise file_error(path, "is a device or a pipe; a log is a file")
    suffix = path.suffix.lower()
    if path.is_dir():
        suffix = "/"
    if suffix not in suffixes:
        allowed = ", ".join(sorted(set(suffixes) - {"/"}))
        raise file_error(
            path, f"its suffix {suffix or '(none)'!r} is of no known format; there are: {allowed}"
        )
    if path.is_file() and path.stat().st_size > MAX_BYTES:
        raise file_error(
            path, f"has {path.stat().st_size:,} bytes; at most {MAX_BYTES:,} are read: cut the log"
        )
    read: Callable[[Path], Log] = import_library_module("log", suffixes[suffix]).read
    return read


def known_suffixes() -> dict[str, str]:
    """Return the suffix -> name of the module of each format; the suffix of a folder is "/"."""
    found: dict[str, str] = {}
    for name in shipped_content_names("log"):
        found |= dict.fromkeys(import_library_module("log", name).SUFFIXES, name)
    return found


def stream_signals(
    stream: str, t: Array, fields: Mapping[str, Array], units: Mapping[str, str] | None = None
) -> dict[str, Signal]:
    """Return the signals of one stream by name.

    Args:
        stream: Name of the stream.
        t: Times (N,) [s].
        fields: Name -> values (N,).
        units: Name -> unit.
    """
    prefix = ""
    if stream:
        prefix = f"{stream}."
    signals: dict[str, Signal] = {}
    for name, values in fields.items():
        unit = (units or {}).get(name, "")
        signals[f"{prefix}{name}"] = Signal(t, np.asarray(values, dtype=float), unit)
    return signals


def median_sampling_rate(t: Array) -> float:
    """Return the rate [Hz] by the median step of times (N,) [s]; 0 for fewer than two."""
    steps = np.diff(t)
    steps = steps[steps > 0.0]
    if not len(steps):
        return 0.0
    return float(1.0 / np.median(steps))


def names_of_streams(names: Sequence[tuple[str, int]]) -> dict[tuple[str, int], str]:
    """Return the name of each (name, instance) of streams: GPS, GPS[1] and so on."""
    first: dict[str, int] = {}
    for name, instance in names:
        first[name] = min(instance, first.get(name, instance))
    found: dict[tuple[str, int], str] = {}
    for name, instance in names:
        found[name, instance] = name
        if instance != first[name]:
            found[name, instance] = f"{name}[{instance}]"
    return found
