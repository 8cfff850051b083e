"""A log as it was written: many signals, each with its own times, units as far as the format knows them."""

import os
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, redirect_stderr, redirect_stdout
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from boatsim.errors import BadInput
from boatsim.physics.base import Array
from boatsim.physics.content import module_of, names
from boatsim.recordings.raw_table import file_error

MOST_BYTES = 2_000_000_000  # of a file
# [bytes] of a text that is read line by line, which takes 20 times as much memory
MOST_TEXT = 50_000_000
MOST_VALUES = 25_000_000  # of all signals together; 200 MB
MOST_SIGNALS = 5_000
HUGE = 1e20  # times in ns since 1970 are 2e18; nothing that is measured is so large
BAG = "metadata.yaml"  # a folder that holds one is a bag


@dataclass(frozen=True)
class Signal:
    """One field of one stream."""

    t: Array  # (N,) s, as logged: neither sorted nor free of gaps
    values: Array  # (N,)
    unit: str = ""  # as the format says; "" where it says nothing
    about: str = ""  # what the format says of it: "throttle left"
    # low, neutral, high of an output, in the signal's unit
    pulse: tuple[float, float, float] | None = None


@dataclass(frozen=True)
class Log:
    """All signals of a log by name, `STREAM.FIELD`, or the name of the column in a table."""

    path: Path
    signals: Mapping[str, Signal]
    # axes of the format's own conventions: "NED", or "ENU" with the hull's x forward, y port, z up
    frame: str = ""
    remarks: tuple[str, ...] = ()


class Room:
    """Counts what a reader keeps, so that no log takes more memory than is stated."""

    def __init__(self, path: Path) -> None:
        self.path, self.values = path, 0

    def take(self, values: int, signals: int = 0) -> None:
        """Note so many more values; raises BadInput where there are too many."""
        self.values += values
        if self.values > MOST_VALUES:
            raise file_error(
                self.path, f"holds more than {MOST_VALUES:,} values; cut the log into shorter ones"
            )
        if signals > MOST_SIGNALS:
            raise file_error(
                self.path, f"has more than {MOST_SIGNALS:,} signals; no log of a boat has as many"
            )


def needs(path: Path, library: str, extra: str) -> BadInput:
    """The error of a reader whose library is not installed."""
    return file_error(
        path, f"reading it needs {library}; install it with: pip install 'boatsim[{extra}]'"
    )


def damaged(path: Path, what: str, error: BaseException) -> BadInput:
    """The error of a log that its format's library can not read."""
    said = " ".join(str(error).split())[:150] or type(error).__name__
    return file_error(path, f"can not be read as {what} ({said})")


@contextmanager
def quiet() -> Iterator[None]:
    """What a library prints of a damaged log, in Python or below it, goes nowhere: its reader says it in one line."""
    for stream in (sys.stdout, sys.stderr):
        stream.flush()
    kept = [os.dup(number) for number in (1, 2)]
    nowhere = os.open(os.devnull, os.O_WRONLY)
    try:
        for number in (1, 2):
            os.dup2(nowhere, number)
        with open(os.devnull, "w") as file, redirect_stdout(file), redirect_stderr(file):
            yield
    finally:
        for number, was in zip((1, 2), kept, strict=True):
            os.dup2(was, number)
        for number in (*kept, nowhere):
            os.close(number)


def open_log(path: Path) -> Log:
    """A log read by the reader that its suffix asks for; numbers that measure nothing are nan. Raises BadInput."""
    found = reader_for(path)(path)
    if not found.signals:
        raise file_error(path, "has no signals: nothing in it has numbers and times")
    times = {
        id(s.t): _plausible(s.t) for s in found.signals.values()
    }  # which signals of one stream share
    signals = {
        n: replace(s, t=times[id(s.t)], values=_plausible(s.values))
        for n, s in found.signals.items()
    }
    return replace(found, signals=signals)


def _plausible(values: Array) -> Array:
    beyond = np.abs(values) >= HUGE
    return np.where(beyond, np.nan, values) if beyond.any() else values


def reader_for(path: Path) -> Callable[[Path], Log]:
    """The `read` of the format that a log has by its suffix. Raises BadInput."""
    if not path.exists():
        raise file_error(path, "there is no such file")
    suffixes = known_suffixes()
    if path.is_dir() and not (path / BAG).is_file():
        raise file_error(
            path, f"is a folder; a log is a file, or the folder of a ROS 2 bag with its {BAG}"
        )
    if not path.is_dir() and not path.is_file():
        raise file_error(path, "is a device or a pipe; a log is a file")
    suffix = "/" if path.is_dir() else path.suffix.lower()
    if suffix not in suffixes:
        allowed = ", ".join(sorted(s for s in suffixes if s != "/"))
        raise file_error(
            path, f"its suffix {suffix or '(none)'!r} is of no known format; there are: {allowed}"
        )
    if path.is_file() and path.stat().st_size > MOST_BYTES:
        raise file_error(
            path, f"has {path.stat().st_size:,} bytes; at most {MOST_BYTES:,} are read: cut the log"
        )
    read: Callable[[Path], Log] = module_of("log", suffixes[suffix]).read
    return read


def known_suffixes() -> dict[str, str]:
    """Suffix -> name of the format's file; "/" stands for a folder."""
    return {suffix: name for name in names("log") for suffix in module_of("log", name).SUFFIXES}


def signals_of(
    stream: str, t: Array, fields: Mapping[str, Array], units: Mapping[str, str] | None = None
) -> dict[str, Signal]:
    """Signals of one stream; `t` (N,) and every field (N,) are of the same rows."""
    prefix, units = f"{stream}." if stream else "", units or {}
    return {
        f"{prefix}{name}": Signal(t, np.asarray(v, dtype=float), units.get(name, ""))
        for name, v in fields.items()
    }


def rate_of(t: Array) -> float:
    """Samples a second, by the median step; 0 for fewer than two."""
    steps = np.diff(t)
    steps = steps[steps > 0.0]
    return float(1.0 / np.median(steps)) if len(steps) else 0.0


def numbered(names: Sequence[tuple[str, int]]) -> dict[tuple[str, int], str]:
    """Names of streams: the first instance plain, the others with their number: GPS, GPS[1]."""
    first: dict[str, int] = {}
    for name, instance in names:
        first[name] = min(instance, first.get(name, instance))
    return {(n, i): n if i == first[n] else f"{n}[{i}]" for n, i in names}
