"""One run in several logs, such as instruments and engine: one set of signals on one clock."""

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from pathlib import Path

import numpy as np

from boatsim.errors import BadInput, unknown_name_message
from boatsim.physics.base import Array
from boatsim.recordings.importing.clocks import YEAR_2000, YEAR_2100
from boatsim.recordings.importing.log import Log, Signal, open_log


@dataclass(frozen=True)
class Span:
    """First and last time of a log [s], and whether its times are UTC, since 1970."""

    begin: float
    end: float

    @property
    def is_utc(self) -> bool:
        """Whether the times are seconds since 1970."""
        return YEAR_2000 < self.begin < YEAR_2100

    def in_words(self) -> str:
        """Return the span in words: UTC to the second, or seconds."""
        if not self.is_utc:
            return f"{self.begin:.6g} to {self.end:.6g} s"
        ends = []
        for t in (self.begin, self.end):
            ends.append(datetime.fromtimestamp(t, UTC).strftime("%Y-%m-%d %H:%M:%S"))
        return f"{ends[0]} to {ends[1]} UTC"


def open_logs(paths: Sequence[Path]) -> Log:
    """Return the signals of one or several logs of one run.

    A signal whose name occurs in several logs is called FILE.SIGNAL, FILE without its suffix.

    Args:
        paths: The logs; the first gives the name and the clock.

    Raises:
        BadInput: A log cannot be read, two have one name, or their axes differ.
    """
    logs = list(map(open_log, paths))
    if len(logs) == 1:
        return logs[0]
    count = Counter(log.path.name for log in logs)
    for name, times in count.items():
        if times > 1:
            raise BadInput(f"{name}: {times} logs have this name; allowed is one of each name")
    frames = {log.frame for log in logs if log.frame}
    if len(frames) > 1:
        raise BadInput(
            f"{', '.join(log.path.name for log in logs)}: their axes differ "
            f"({', '.join(sorted(frames))}); allowed are logs with the same axes"
        )
    owners = Counter(name for log in logs for name in log.signals)
    signals: dict[str, Signal] = {}
    remarks: list[str] = []
    for log in logs:
        remarks += log.remarks
        for name, signal in log.signals.items():
            if owners[name] > 1:
                name = f"{log.path.stem}.{name}"
            signals[name] = replace(signal, source=log.path.name)
    return Log(logs[0].path, signals, "".join(frames), tuple(remarks))


def file_spans(log: Log) -> dict[str, Span]:
    """Return the time span of each file of a log, by the file's name; the first file is first."""
    ends: dict[str, Span] = {}
    for signal in log.signals.values():
        finite = signal.t[np.isfinite(signal.t)]
        if not len(finite):
            continue
        begin, end = float(finite.min()), float(finite.max())
        if signal.source in ends:
            begin = min(begin, ends[signal.source].begin)
            end = max(end, ends[signal.source].end)
        ends[signal.source] = Span(begin, end)
    return ends


def files_with_unrelated_clocks(
    spans: Mapping[str, Span], begins: Mapping[str, float]
) -> list[str]:
    """Return the files whose clock has no known relation to that of the first file."""
    first, *others = spans
    found = []
    for name in others:
        if name not in begins and not (spans[first].is_utc and spans[name].is_utc):
            found.append(name)
    return found


def align_clocks(log: Log, begins: Mapping[str, float], file: str) -> Log:
    """Return a log of several files with all times on the clock of the first file.

    Args:
        log: The log.
        begins: Name of a file -> begin of this file after that of the first one [s].
        file: Name of the map in messages.

    Raises:
        BadInput: A file has neither UTC nor a begin, or the map names a file that is not there.
    """
    spans = file_spans(log)
    for name in begins:
        if name not in spans or name == next(iter(spans)):
            others = list(spans)[1:]
            raise BadInput(f"{file}: {unknown_name_message('begins: file', name, others)}")
    first = next(iter(spans), "")
    for name in files_with_unrelated_clocks(spans, begins) if spans else ():
        raise BadInput(
            f"{name}: its times ({spans[name].in_words()}) and those of {first} "
            f"({spans[first].in_words()}) are not both UTC; write into {file}: "
            f"{file_begin_line(name)}"
        )
    shifts: dict[str, float] = {}
    for name, begin in begins.items():
        shifts[name] = spans[first].begin + begin - spans[name].begin
    return _shifted(log, lambda signal: signal.t + shifts.get(signal.source, 0.0))


def file_begin_line(name: str) -> str:
    """Return the line of a map that states when a file begins, with a place for the number."""
    return f'[begins] / "{name}" = SECONDS (after the first file begins)'


def _shifted(log: Log, times: Callable[[Signal], Array]) -> Log:
    signals: dict[str, Signal] = {}
    for name, signal in log.signals.items():
        signals[name] = replace(signal, t=times(signal))
    return replace(log, signals=signals)
