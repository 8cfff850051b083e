"""All checks of a log in order: of the file, of the prepared recording, of its identifiability."""

from dataclasses import replace
from pathlib import Path

from boatsim.diagnosis.checks.angle_unit import check_angle_unit
from boatsim.diagnosis.checks.clock import check_clock
from boatsim.diagnosis.checks.column_names import check_column_names
from boatsim.diagnosis.checks.command_unit import check_command_unit
from boatsim.diagnosis.checks.data_cleaning import cleaning_findings
from boatsim.diagnosis.checks.drive_response import check_drive_response
from boatsim.diagnosis.checks.excitation import check_excitation
from boatsim.diagnosis.checks.finding import Finding, apply_corrections
from boatsim.diagnosis.checks.held_commands import check_held_commands
from boatsim.diagnosis.checks.holes import check_holes
from boatsim.diagnosis.checks.interpolated_positions import check_interpolated_positions
from boatsim.diagnosis.checks.position_jumps import check_position_jumps
from boatsim.diagnosis.checks.position_unit import check_position_unit
from boatsim.diagnosis.checks.recorded_rates import check_recorded_rates
from boatsim.diagnosis.checks.saturation import check_saturation
from boatsim.diagnosis.checks.time_unit import check_time_unit
from boatsim.diagnosis.config import ChecksConfig
from boatsim.errors import BadInput
from boatsim.physics.vessel import Vessel
from boatsim.recordings.table import Recording, read_unchecked

TABLE_CHECKS = (
    check_column_names,
    check_time_unit,
    check_clock,
    check_position_unit,
    check_angle_unit,
    check_command_unit,
)
RECORDING_CHECKS = (
    check_interpolated_positions,
    check_position_jumps,
    check_recorded_rates,
    check_held_commands,
)
IDENTIFIABILITY_CHECKS = (check_holes, check_saturation, check_excitation, check_drive_response)


def check_table(path: Path, vessel: Vessel, config: ChecksConfig) -> list[Finding]:
    """Check the units and the clock of a recording's file before it is read as a recording.

    A file may be too faulty to be read as a recording, but still be a table of numbers.

    Args:
        path: The file.
        vessel: The vessel that it is a recording of.
        config: Thresholds of the quality checks.

    Returns:
        Findings about the file.

    Raises:
        BadInput: The file is not a table.
    """
    recording, _ = read_unchecked(path, vessel.columns)
    try:
        parts = recording.parts()
    except BadInput:  # no rows in a part to use
        parts = [recording]
    found: list[Finding] = []
    for part in parts:
        known = {(finding.name, finding.changes) for finding in found}
        for finding in _check_part(part, vessel, config):
            if (finding.name, finding.changes) not in known:
                found.append(finding)
    return _of_run(found, path)


def _check_part(recording: Recording, vessel: Vessel, config: ChecksConfig) -> list[Finding]:
    """Findings of a part of a file; each check sees the corrections of those before."""
    found: list[Finding] = []
    for check in TABLE_CHECKS:
        new = check(recording, vessel, config)
        for finding in new:
            recording = apply_corrections(recording, finding.changes)
        found += new
    return found


def check_recording(
    recording: Recording, cleaned: Recording, vessel: Vessel, config: ChecksConfig
) -> list[Finding]:
    """Check a prepared recording for faults, and report what cleaning has dropped from it.

    Args:
        recording: The prepared recording.
        cleaned: The same recording without repeated values and outliers.
        vessel: The vessel that it is a recording of.
        config: Thresholds of the quality checks.

    Returns:
        Findings about the recording.
    """
    found = cleaning_findings(cleaned)
    for check in RECORDING_CHECKS:
        found += check(recording, vessel, config)
    return _of_run(found, recording.origin)


def check_identifiability(
    recording: Recording, vessel: Vessel, config: ChecksConfig
) -> list[Finding]:
    """Find coefficients of a vessel that a recording cannot identify, because it varies too little.

    Args:
        recording: A prepared recording.
        vessel: The vessel that it is a recording of.
        config: Thresholds of the quality checks.

    Returns:
        Findings on saturated commands, on missing excitation and on the response of the drives.
    """
    found: list[Finding] = []
    for check in IDENTIFIABILITY_CHECKS:
        found += check(recording, vessel, config)
    return _of_run(found, recording.origin)


def _of_run(found: list[Finding], run: Path | str) -> list[Finding]:
    """Findings with the file of their recording."""
    return [replace(finding, run=str(run)) for finding in found]
