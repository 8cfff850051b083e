"""Division of recordings at long times in which no pose or rate is measured.

A filter simulates the vessel over such a time. The error of a rough model then grows until the
linearised equations of the filter no longer hold, and the first measurements behind it distort the
fit of the whole recording.
"""

from collections.abc import Sequence

import numpy as np

from boatsim.diagnosis.checks.cut_recordings import (
    TEXT_DIGITS,
    Interval,
    cut_intervals,
    format_interval,
)
from boatsim.diagnosis.checks.finding import Finding
from boatsim.diagnosis.checks.holes import rows_before_holes
from boatsim.diagnosis.config import DiagnosisConfig
from boatsim.diagnosis.loading import LoadedRecordings
from boatsim.physics.signals import motion_signals
from boatsim.physics.vessel import Vessel
from boatsim.recordings.table import Recording

INSIDE = 1e-6  # [s] from a measured row, which stays


def cut_unmeasured_times(loaded: LoadedRecordings, config: DiagnosisConfig) -> LoadedRecordings:
    """Return recordings divided where nothing is measured for long, with a finding for each.

    Args:
        loaded: The recordings, cleaned.
        config: Settings of the diagnosis; `checks.hole_duration` is the longest time that stays.
    """

    def intervals_of(recording: Recording) -> list[Interval]:
        return unmeasured_times(recording, loaded.vessels[recording.path], config)

    return cut_intervals(loaded, intervals_of, _finding)


def unmeasured_times(
    recording: Recording, vessel: Vessel, config: DiagnosisConfig
) -> list[Interval]:
    """Return the times between measured rows that are as long as a hole of a log.

    Args:
        recording: The recording, cleaned.
        vessel: Its vessel, whose length scales the duration.
        config: Settings of the diagnosis.
    """
    measured = np.zeros(len(recording.t), dtype=np.bool_)
    for signal in motion_signals(vessel.dof):
        if signal.column in recording.signals:
            measured |= np.isfinite(recording.signals[signal.column])
    t = recording.t[measured]
    found = []
    for k in rows_before_holes(t, vessel, config.checks).tolist():
        found.append((float(t[k]) + INSIDE, float(t[k + 1]) - INSIDE))
    return found


def _finding(recording: Recording, intervals: Sequence[Interval]) -> Finding:
    """The finding that states when nothing is measured in a recording."""
    spans = ", ".join(format_interval(a, b, TEXT_DIGITS) for a, b in intervals)
    return Finding(
        "unmeasured",
        f"no pose or rate is measured from {spans}; the parts before and behind are fitted like "
        "recordings of their own",
        kind="mended",
        spans=tuple(intervals),
        words="times without any measurement",
        run=recording.origin,
    )
