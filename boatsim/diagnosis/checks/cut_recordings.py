"""Cuts intervals out of the recordings of a diagnosis, which become several recordings."""

import re
from collections.abc import Callable, Sequence
from dataclasses import replace

from boatsim.diagnosis.checks.finding import Finding
from boatsim.diagnosis.loading import LoadedRecordings
from boatsim.recordings.table import FEWEST_ROWS, Recording

Interval = tuple[float, float]  # first and last time [s]
SPAN = re.compile(r" \(\S+ to \S+ s\)$")  # at the end of the name of a piece


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
            pieces.append(replace(piece, name=f"{whole} ({t[0]:.3g} to {t[-1]:.3g} s)"))
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
