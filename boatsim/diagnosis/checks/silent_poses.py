"""Check for recordings in which the sensor of the poses recorded nothing."""

import numpy as np

from boatsim.diagnosis.checks.finding import Finding
from boatsim.diagnosis.config import ChecksConfig
from boatsim.errors import BadInput
from boatsim.physics.signals import motion_signals
from boatsim.physics.vessel import Vessel
from boatsim.recordings.table import Recording
from boatsim.view.formatting import join_words


def check_silent_poses(recording: Recording, vessel: Vessel, _: ChecksConfig) -> list[Finding]:
    """Find out whether no pose of a recording was measured.

    Args:
        recording: A prepared recording.
        vessel: The vessel with its degrees of freedom.

    Returns:
        One finding, or none.
    """
    evidence = reason_without_poses(recording, vessel)
    if not evidence:
        return []
    return [Finding("poses_silent", evidence, remedy="leave this recording out")]


def refuse_silent_poses(recording: Recording, vessel: Vessel) -> None:
    """Refuse a recording without any information on the motion of its vessel.

    Args:
        recording: A prepared recording.
        vessel: The vessel with its degrees of freedom.

    Raises:
        BadInput: No pose was measured.
    """
    evidence = reason_without_poses(recording, vessel)
    if evidence:
        raise BadInput(f"{recording.origin}: {evidence}; leave this recording out")


def reason_without_poses(recording: Recording, vessel: Vessel) -> str:
    """Return the reason why the poses of a recording show no motion, "" if they show some.

    Poses are not measured if they and the velocities are empty in all rows. If all have one value
    in all rows, to the last digit, although a command or a measured input moves, the sensor failed
    or the vessel was held; neither shows how it answers.

    Args:
        recording: A prepared recording.
        vessel: The vessel with its degrees of freedom.
    """
    columns = [s.column for s in motion_signals(vessel.dof) if s.column in recording.signals]
    measured = [name for name in columns if np.isfinite(recording[name]).any()]
    rows = f"in all {len(recording.t)} rows"
    if columns and not measured:
        return f"no pose is measured: {join_words(columns)} without a value {rows}"
    moving = [name for name in (*vessel.commands, *vessel.measured) if _moves(recording, name)]
    if not moving or any(_moves(recording, name) for name in measured):
        return ""
    return (
        f"no motion is measured: {join_words(measured)} with one value {rows}, although "
        f"{moving[0]} moves; the sensor recorded nothing, or the vessel was held"
    )


def _moves(recording: Recording, name: str) -> bool:
    """Whether a signal is recorded and has more than one value."""
    if name not in recording.signals:
        return False
    known = recording[name][np.isfinite(recording[name])]
    return len(known) > 1 and float(np.ptp(known)) > 0.0
