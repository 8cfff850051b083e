"""All looks at a log, in order: at the table as written, at the recording as it is opened, and laid on its vessel."""

from dataclasses import replace
from pathlib import Path

from boatsim.diagnosis.checks import (
    angle_unit,
    clock,
    column_names,
    command_unit,
    data_cleaning,
    excitation,
    interpolated_positions,
    position_jumps,
    position_unit,
    recorded_rates,
    saturation,
    time_unit,
)
from boatsim.diagnosis.checks.finding import Finding, applied
from boatsim.physics.vessel import Vessel
from boatsim.recordings.table import Recording, as_written

AS_WRITTEN = (column_names, time_unit, clock, position_unit, angle_unit, command_unit)
OPENED = (interpolated_positions, position_jumps, recorded_rates)
LIMITS = (saturation, excitation)


def at_the_table(path: Path, vessel: Vessel) -> list[Finding]:
    """Faults of units and of the clock, of a file that may be refused for them. Raises BadInput if it is no table."""
    recording, _ = as_written(path, vessel.columns)
    if (part := recording.notes.use) and (
        (recording.t >= part[0]) & (recording.t <= part[1])
    ).any():
        recording = recording.used()
    found: list[Finding] = []
    for look in AS_WRITTEN:
        new = look.look(recording, vessel)
        for finding in new:
            recording = applied(recording, finding.changes)
        found += new
    return [replace(f, run=str(path)) for f in found]


def at_the_recording(recording: Recording, thinned: Recording, vessel: Vessel) -> list[Finding]:
    """Faults of an opened recording, and what a diagnosis leaves out of it (`thinned`)."""
    found = data_cleaning.findings(thinned)
    for look in OPENED:
        found += look.look(recording, vessel)
    return [replace(f, run=str(recording.path or recording.name)) for f in found]


def at_the_limits(recording: Recording, vessel: Vessel) -> list[Finding]:
    """What can not be told from a recording."""
    found = [f for look in LIMITS for f in look.look(recording, vessel)]
    return [replace(f, run=str(recording.path or recording.name)) for f in found]
