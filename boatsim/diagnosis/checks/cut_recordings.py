"""Cuts intervals out of the recordings of a diagnosis, which become several recordings."""

import re
from collections.abc import Sequence
from dataclasses import replace

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
