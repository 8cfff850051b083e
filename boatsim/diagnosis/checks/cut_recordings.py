"""Cuts intervals out of the recordings of a diagnosis, which become several recordings."""

import re
from collections.abc import Callable, Sequence
from dataclasses import replace

from boatsim.diagnosis.checks.finding import Finding
from boatsim.diagnosis.loading import LoadedRecordings
from boatsim.recordings.table import FEWEST_ROWS, Recording

Interval = tuple[float, float]  # first and last time [s]
NAME_DIGITS, TEXT_DIGITS = 3, 4  # least significant digits of times in names and in findings
MOST_DIGITS = 17  # that tell any two numbers of double precision apart
SPAN = re.compile(r" \(\S+ to \S+ s\)$")  # at the end of the name of a piece


def format_interval(begin: float, end: float, digits: int) -> str:
    """Return the text of two times, such as "40 to 60 s", without powers of ten.

    Args:
        begin: First time [s].
        end: Last time [s].
        digits: Least number of significant digits; there are more where both times look alike.
    """
    first, last = "", ""
    for more in range(digits, MOST_DIGITS + 1):
        first, last = _format_time(begin, more), _format_time(end, more)
        if first != last:
            break
    return f"{first} to {last} s"


def _format_time(seconds: float, digits: int) -> str:
    """A time with a number of significant digits, but at least to whole seconds."""
    text = f"{seconds:.{digits}g}"
    if "e" in text:
        return f"{seconds:.0f}"
    return text


def parts_outside_intervals(recording: Recording, intervals: Sequence[Interval]) -> list[Recording]:
    """Return the parts of a recording outside some intervals that are long enough for a filter.

    Args:
        recording: The recording.
        intervals: Intervals in order of time, which do not overlap.

    Returns:
        The parts, each named by its span; the recording itself if there are no intervals.
    """
    if not intervals:
        return [recording]
    begins = [float(recording.t[0]) - 1e-6, *(end for _, end in intervals)]
    ends = [*(begin for begin, _ in intervals), float(recording.t[-1]) + 1e-6]
    whole = SPAN.sub("", recording.name)
    pieces = []
    for a, b in zip(begins, ends, strict=True):
        inside = (recording.t > a) & (recording.t < b)
        if int(inside.sum()) >= FEWEST_ROWS:
            t = recording.t[inside]
            piece = recording.between(float(t[0]), float(t[-1]))
            span = format_interval(float(t[0]), float(t[-1]), NAME_DIGITS)
            pieces.append(replace(piece, name=f"{whole} ({span})"))
    return pieces


def cut_intervals(
    loaded: LoadedRecordings,
    intervals_of: Callable[[Recording], Sequence[Interval]],
    finding_of: Callable[[Recording, Sequence[Interval]], Finding],
) -> LoadedRecordings:
    """Return the recordings of a diagnosis without some intervals, with a finding for each.

    A recording of which no part would be long enough for a filter is returned as it is.

    Args:
        loaded: The recordings.
        intervals_of: Function that returns the intervals of a recording.
        finding_of: Function that returns the finding about a recording and its intervals.
    """
    findings = list(loaded.findings)
    parts: list[list[Recording]] = []
    for recordings in (loaded.fitted, loaded.held_out):
        kept: list[Recording] = []
        for recording in recordings:
            intervals = intervals_of(recording)
            pieces = parts_outside_intervals(recording, intervals)
            kept += pieces or [recording]
            if intervals and pieces:
                findings.append(finding_of(recording, intervals))
        parts.append(kept)
    return replace(loaded, fitted=parts[0], held_out=parts[1], findings=findings)
