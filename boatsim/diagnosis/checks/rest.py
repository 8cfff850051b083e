"""Check for intervals in which a body that bearings or rails guide stands still.

At rest, dry friction takes any value below its limit, so that the rows tell nothing of the forces.
A law of friction that depends on the speed alone would have them explained by other forces.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from boatsim.diagnosis import priors
from boatsim.diagnosis.checks.cut_recordings import (
    TEXT_DIGITS,
    Interval,
    cut_intervals,
    format_interval,
)
from boatsim.diagnosis.checks.finding import Finding
from boatsim.diagnosis.config import DiagnosisConfig
from boatsim.diagnosis.loading import LoadedRecordings
from boatsim.physics.base import Array
from boatsim.physics.particulars import GRAVITY
from boatsim.physics.signals import motion_signals
from boatsim.physics.vessel import Vessel
from boatsim.recordings.table import Recording

ELEVATION = "_m"  # ends the name of a recorded elevation of the water


def cut_intervals_at_rest(loaded: LoadedRecordings, config: DiagnosisConfig) -> LoadedRecordings:
    """Return the recordings of a guided vessel without the rows at rest, with a finding for each.

    Recordings of other vessels are returned as they are, and so is one that never moves.

    Args:
        loaded: The recordings.
        config: Settings of the diagnosis.
    """

    def intervals_of(recording: Recording) -> list[Interval]:
        vessel = loaded.vessels[recording.path]
        if not is_guided(vessel, recording):
            return []
        return intervals_at_rest(recording, vessel, config)

    return cut_intervals(loaded, intervals_of, rest_finding)


def is_guided(vessel: Vessel, recording: Recording) -> bool:
    """Return whether bearings or rails guide the vessel, by its facts or those of the recording."""
    known: dict[str, object] = {**vessel.diagnosis.facts, **recording.notes.facts}
    return known.get("guided") is True


def intervals_at_rest(
    recording: Recording, vessel: Vessel, config: DiagnosisConfig
) -> list[Interval]:
    """Return the intervals in which no recorded coordinate of a vessel and no wave moves.

    A body that follows a small wave is not at rest, however small its motion.

    Args:
        recording: The recording.
        vessel: Its vessel, whose length sets the scales of time and speed.
        config: Settings of the diagnosis.
    """
    seconds = priors.assumed_correlation_time(vessel, config.load)
    least = config.checks.rest_min_window * seconds
    still = np.ones(len(recording.t), dtype=np.bool_)
    for signal in motion_signals(vessel.dof):
        if not signal.rate and signal.column in recording.signals:
            limit = config.checks.rest_speed * np.sqrt(GRAVITY / vessel.length) * seconds
            if not signal.column.endswith("_rad"):
                limit *= vessel.length
            still &= _is_still(recording.t, recording[signal.column], seconds, limit, least)
    for name in vessel.measured:
        if name.endswith(ELEVATION) and name in recording.signals:
            wave = recording[name]
            limit = config.checks.rest_wave * float(np.nanmax(wave) - np.nanmin(wave))
            if limit > 0.0:
                still &= _is_still(recording.t, wave, seconds, limit, least)
    changes = np.flatnonzero(np.diff(np.concatenate(([False], still, [False])).astype(int)))
    found = []
    for a, b in changes.reshape(-1, 2).tolist():
        found.append((float(recording.t[a]), float(recording.t[b - 1])))
    return found


def _is_still(t: Array, y: Array, seconds: float, limit: float, least: float) -> NDArray[np.bool_]:
    """Rows (N,) in a window of some seconds over which a coordinate stays within a limit.

    The window at the end has at least `least` seconds.
    """
    still = np.zeros(len(t), dtype=np.bool_)
    known = np.flatnonzero(np.isfinite(y))
    ends = np.searchsorted(t[known], t[known] + seconds, side="right")
    for i, end in enumerate(ends.tolist()):
        if end == len(known) and t[known[-1]] - t[known[i]] < least:
            break
        window = y[known[i:end]]
        if float(window.max() - window.min()) < limit:
            still[known[i] : known[end - 1] + 1] = True
    return still


def rest_finding(recording: Recording, intervals: Sequence[Interval]) -> Finding:
    """Return the finding that states when a recording is at rest."""
    spans = ", ".join(format_interval(a, b, TEXT_DIGITS) for a, b in intervals)
    return Finding(
        "at_rest",
        f"nothing moves from {spans}; friction can have any size below its limit there, and the "
        "diagnosis leaves these rows out",
        kind="mended",
        spans=tuple(intervals),
        words="stretches at rest",
        run=recording.origin,
    )
