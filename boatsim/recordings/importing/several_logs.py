"""One run in several logs, such as instruments and engine: one set of signals on one clock."""

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from itertools import pairwise
from pathlib import Path

import numpy as np

from boatsim.errors import BadInput, unknown_name_message
from boatsim.physics.base import Array
from boatsim.recordings.importing.clocks import YEAR_2000, YEAR_2100
from boatsim.recordings.importing.log import BAG, Log, Signal, known_suffixes, open_log
from boatsim.recordings.raw_table import file_error

# Loggers of one clock are started and stopped together: each file overlaps the first one for at
# least this share of the shorter of both
MIN_OVERLAP = 0.5
ZERO = 1e-6  # [s] a file that begins nearer to 0 counts from its own begin


@dataclass(frozen=True)
class Span:
    """First and last time of a log [s], and whether its times are UTC, since 1970."""

    begin: float
    end: float

    @property
    def is_utc(self) -> bool:
        """Whether the times are seconds since 1970."""
        return YEAR_2000 < self.begin < YEAR_2100

    @property
    def duration(self) -> float:
        """Time from the first to the last sample [s]."""
        return self.end - self.begin

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

    Logs with the same signals that follow each other in time are one log. Otherwise a signal whose
    name occurs in several logs is called FILE.SIGNAL, FILE without its suffix.

    Args:
        paths: The logs, or folders with logs; the first gives the name and the clock.

    Raises:
        BadInput: A log cannot be read, two have one name, or their axes differ.
    """
    logs, remarks = _opened(paths)
    if len(logs) == 1:
        return replace(logs[0], remarks=(*remarks, *logs[0].remarks))
    if _follow_each_other(logs):
        return _joined(logs, remarks)
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
    for log in logs:
        remarks += log.remarks
        for name, signal in log.signals.items():
            if owners[name] > 1:
                name = f"{log.path.stem}.{name}"
            signals[name] = replace(signal, source=log.path.name)
    return Log(logs[0].path, signals, "".join(frames), tuple(remarks))


def _opened(paths: Sequence[Path]) -> tuple[list[Log], list[str]]:
    """The logs of some paths, and remarks on files of folders that are none. Raises BadInput."""
    logs, remarks = list[Log](), list[str]()
    for path in paths:
        if not path.is_dir() or (path / BAG).is_file():
            logs.append(open_log(path))
            continue
        reasons = []
        found = []
        for file in _files_of_folder(path):
            try:
                found.append(open_log(file))
            except BadInput as error:
                reasons.append(str(error))
        if not found:
            reason = reasons[0] if reasons else f"allowed are {', '.join(_suffixes_of_files())}"
            raise file_error(path, f"the folder has no log that can be read ({reason})")
        logs += found
        remarks += [f"left out: {reason}" for reason in reasons]
    return logs, remarks


def _files_of_folder(folder: Path) -> list[Path]:
    """The files of a folder with the suffix of a log, in the order of their names."""
    suffixes = _suffixes_of_files()
    files = []
    for file in sorted(folder.iterdir()):
        if file.is_file() and file.suffix.lower() in suffixes:
            files.append(file)
    return files


def _suffixes_of_files() -> list[str]:
    return sorted(set(known_suffixes()) - {"/"})


def _span(log: Log) -> Span:
    """The time span of a log."""
    begin, end = np.inf, -np.inf
    for signal in log.signals.values():
        finite = signal.t[np.isfinite(signal.t)]
        if len(finite):
            begin, end = min(begin, float(finite.min())), max(end, float(finite.max()))
    return Span(begin, end)


def _follow_each_other(logs: Sequence[Log]) -> bool:
    """Whether logs have the same signals, and each begins after another ends."""
    names = set(logs[0].signals)
    if any(set(log.signals) != names or log.frame != logs[0].frame for log in logs):
        return False
    spans = sorted((_span(log) for log in logs), key=lambda span: span.begin)
    for first, second in pairwise(spans):
        if not second.begin > first.end or first.is_utc != second.is_utc:
            return False
    return True


def _joined(logs: Sequence[Log], remarks: Sequence[str]) -> Log:
    """One log of logs that follow each other, in the order of time."""
    ordered = sorted(logs, key=lambda log: _span(log).begin)
    signals: dict[str, Signal] = {}
    for name, first in ordered[0].signals.items():
        parts = [log.signals[name] for log in ordered]
        t = np.concatenate([part.t for part in parts])
        values = np.concatenate([part.values for part in parts])
        signals[name] = replace(first, t=t, values=values)
    names = ", ".join(log.path.name for log in ordered)
    of_logs = [remark for log in ordered for remark in log.remarks]
    joined = f"{names} have the same signals and follow each other: they are read as one log"
    return Log(ordered[0].path, signals, ordered[0].frame, (*remarks, *of_logs, joined))


def begins_by_shared_clock(spans: Mapping[str, Span]) -> dict[str, float]:
    """Return when each further file begins after the first [s], if all share one clock without UTC.

    Two signs are needed: at most one file begins at zero, as each file with a clock of its own
    does, and each file overlaps the first one for most of its time.

    Args:
        spans: Name of a file -> its time span; the first file is first.

    Returns:
        Name of a further file -> begin after that of the first file [s]; empty without both signs.
    """
    if len(spans) < 2 or any(span.is_utc for span in spans.values()):
        return {}
    zeros = [name for name, span in spans.items() if abs(span.begin) < ZERO]
    if len(zeros) > 1:
        return {}
    first, *others = spans
    found = {}
    for name in others:
        overlap = min(spans[name].end, spans[first].end) - max(
            spans[name].begin, spans[first].begin
        )
        shorter = min(spans[name].duration, spans[first].duration)
        if not overlap >= MIN_OVERLAP * shorter:
            return {}
        found[name] = round(spans[name].begin - spans[first].begin, 6)
    return found


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


def files_without_common_time(spans: Mapping[str, Span]) -> list[str]:
    """Return the files whose times are UTC like those of the first file, but never at its times."""
    first, *others = spans
    found = []
    for name in others:
        is_apart = spans[name].end < spans[first].begin or spans[name].begin > spans[first].end
        if is_apart and spans[first].is_utc and spans[name].is_utc:
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
        shared = begins_by_shared_clock(spans).get(name)
        raise BadInput(
            f"{name}: its times ({spans[name].in_words()}) and those of {first} "
            f"({spans[first].in_words()}) are not both UTC; write into {file}: "
            f"{file_begin_line(name, shared)}"
        )
    shifts: dict[str, float] = {}
    for name, begin in begins.items():
        shifts[name] = spans[first].begin + begin - spans[name].begin
    return _shifted(log, lambda signal: signal.t + shifts.get(signal.source, 0.0))


def file_begin_line(
    name: str, seconds: float | None = None, why: str = "if both have one clock"
) -> str:
    """Return the line of a map that states when a file begins.

    Args:
        name: Name of the file.
        seconds: Begin after that of the first file [s]; None leaves a place for the number.
        why: Condition or reason of the number.
    """
    if seconds is not None:
        return f'[begins] / "{name}" = {seconds:g} ({why})'
    return f'[begins] / "{name}" = SECONDS (after the first file begins)'


def _shifted(log: Log, times: Callable[[Signal], Array]) -> Log:
    signals: dict[str, Signal] = {}
    for name, signal in log.signals.items():
        signals[name] = replace(signal, t=times(signal))
    return replace(log, signals=signals)
