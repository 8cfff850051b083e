"""Check for recordings in which the sensor of the poses recorded nothing."""

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from boatsim.diagnosis.checks.finding import Finding
from boatsim.diagnosis.config import ChecksConfig
from boatsim.errors import BadInput
from boatsim.physics.signals import motion_signals
from boatsim.physics.vessel import Vessel
from boatsim.recordings.table import Recording
from boatsim.view.formatting import join_words


def check_silent_poses(recording: Recording, vessel: Vessel, config: ChecksConfig) -> list[Finding]:
    """Find out whether a recording shows no motion at all.

    Poses are not measured if they and the velocities are empty in all rows. If each has one value
    in all rows, to the last digit, although a command or a measured input moves, the sensor failed
    or the vessel was held; neither shows how the vessel answers.

    Args:
        recording: A prepared recording.
        vessel: The vessel with its degrees of freedom and commands.
        config: Thresholds of the quality checks.

    Returns:
        One finding, or none.
    """
    columns = [s.column for s in motion_signals(vessel.dof) if s.column in recording.signals]
    measured = [name for name in columns if np.isfinite(recording[name]).any()]
    rows = f"in all {len(recording.t)} rows"
    if not columns:
        return []
    if not measured:
        return [_finding(recording, f"no pose is measured: {join_words(columns)} empty {rows}")]
    inputs = (*vessel.commands, *vessel.measured)
    moving = [name for name in inputs if _moves(recording, vessel, name, config)]
    if not moving or any(_range(recording, name) > 0.0 for name in measured):
        return []
    evidence = (
        f"no motion is measured: {join_words(measured)} with one value {rows}, although "
        f"{moving[0]} moves; the sensor recorded nothing, or the vessel was held"
    )
    return [_finding(recording, evidence)]


def without_silent_recordings(
    recordings: Sequence[Recording],
    vessels: Sequence[Vessel],
    names: Sequence[str],
    fitted: int,
    config: ChecksConfig,
) -> tuple[list[int], list[Finding]]:
    """Leave out recordings that show no motion.

    Args:
        recordings: Prepared recordings, those to fit first.
        vessels: Vessel of each.
        names: Name of each.
        fitted: Number of recordings to fit; the others are held out.
        config: Thresholds of the quality checks.

    Returns:
        Places of the other recordings, and findings of kind "mended" about those left out.

    Raises:
        BadInput: No recording to fit is left, or none of those that were to be held out.
    """
    kept, found = list[int](), list[Finding]()
    first: Finding | None = None
    for place, (recording, vessel) in enumerate(zip(recordings, vessels, strict=True)):
        silent = check_silent_poses(recording, vessel, config)
        if not silent:
            kept.append(place)
        for one in silent:
            evidence = f"{one.evidence}; the diagnosis leaves {names[place]} out"
            found.append(replace(one, evidence=evidence, kind="mended", remedy=""))
            first = one if first is None else first
    has_fitted = any(place < fitted for place in kept)
    has_held_out = fitted == len(recordings) or any(place >= fitted for place in kept)
    if first is not None and not (has_fitted and has_held_out):
        raise BadInput(f"{first.run}: {first.evidence}; {first.remedy}")
    return kept, found


def _finding(recording: Recording, evidence: str) -> Finding:
    return Finding(
        "poses_silent", evidence, remedy="leave this recording out", run=recording.origin
    )


def _range(recording: Recording, name: str) -> float:
    known = recording[name][np.isfinite(recording[name])]
    return float(np.ptp(known)) if len(known) else 0.0


def _moves(recording: Recording, vessel: Vessel, name: str, config: ChecksConfig) -> bool:
    """Whether a command or a measured input has clearly more than one value."""
    if name not in recording.signals:
        return False
    moved = _range(recording, name)
    full = 0.0
    if name in vessel.commands:
        command = vessel.commands[name]
        full = command.high - command.low
    return moved > (config.silent_input * full if math.isfinite(full) else 0.0)
