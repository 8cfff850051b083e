"""Checks recordings without diagnosing them: what is wrong with each file."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import islice
from pathlib import Path

from boatsim.diagnosis.answer.log_entry import column_sources, finding_entry, join_toml_lines
from boatsim.diagnosis.answer.schema import LogEntry
from boatsim.diagnosis.checks import data_cleaning, run_checks
from boatsim.diagnosis.checks.channel_ranges import widen_channel_ranges
from boatsim.diagnosis.checks.clock_rate import check_clock_rate
from boatsim.diagnosis.checks.command_clock import find_command_clocks
from boatsim.diagnosis.checks.finding import LOG_NOT_BOAT, Finding, has_result
from boatsim.diagnosis.checks.hypothesis_test import compare_reinterpretations
from boatsim.diagnosis.checks.late_sensors import check_late_sensors
from boatsim.diagnosis.checks.order_signs import restore_order_signs
from boatsim.diagnosis.checks.per_cent_commands import check_per_cent_commands
from boatsim.diagnosis.checks.silent_poses import check_silent_poses
from boatsim.diagnosis.config import DEFAULT
from boatsim.diagnosis.loading import LoadedRecordings, check_same_vessel, vessel_of_recording_file
from boatsim.diagnosis.question import set_up_estimation_problem
from boatsim.errors import BadInput
from boatsim.physics.vessel import Vessel
from boatsim.recordings.table import Recording, read


@dataclass(frozen=True)
class _Opened:
    """A file with the findings about its table, and its prepared parts."""

    path: Path
    table: tuple[Finding, ...]
    parts: tuple[Recording, ...] = ()
    refused: BadInput | None = None


@dataclass(frozen=True)
class _Checked:
    """Findings of one file, and its cleaned parts if these may be mapped to the vessel."""

    findings: tuple[Finding, ...]
    parts: tuple[Recording, ...] = ()


def check_files(
    runs: Sequence[Path],
    vessel: str | None = None,
    load_conditions: Sequence[str] = (),
) -> tuple[dict[Path, list[LogEntry]], list[BadInput]]:
    """Check files of recordings for faults, without a diagnosis of the vessel.

    If the table of a file is at fault, the file is not compared with the vessel model.

    Args:
        runs: Files of recordings.
        vessel: Name of the vessel; None: that of the recordings' notes.
        load_conditions: Names of load conditions.

    Returns:
        Findings by file, and the errors of files that cannot be read.

    Raises:
        BadInput: No vessel is named, or several.
    """
    vessels: dict[Path | None, Vessel] = {}
    for path in runs:
        vessels[path] = vessel_of_recording_file(path, vessel, load_conditions)
    check_same_vessel(list(vessels.values()))
    findings, refused, usable = list[Finding](), list[BadInput](), list[Recording]()
    prepared = list[Recording]()
    for file in _with_order_signs([_open_file(path, vessels[path]) for path in runs], vessels):
        if file.refused:
            refused.append(file.refused)
        checked = _check_file(file, vessels[file.path])
        findings += checked.findings
        usable += checked.parts
        if checked.parts:
            prepared += [part for part in file.parts if not _is_silent(part, vessels[file.path])]
    findings += check_clock_rate(prepared, DEFAULT.checks)
    if usable:
        try:
            widened = {path: widen_channel_ranges(own, usable) for path, own in vessels.items()}
            loaded = LoadedRecordings(usable, (), widened, "")
            question = set_up_estimation_problem(loaded, with_candidates=False)
            compared = compare_reinterpretations(usable, question.map_recording, question.problem)
            if not has_result(compared):
                compared += check_per_cent_commands(usable, question.problem)
            velocity_is_late = any(f.name == "velocity_late" for f in findings)
            if not has_result(compared) and not velocity_is_late:
                compared += check_late_sensors(usable, question.problem)
            if not has_result(compared) and not velocity_is_late:
                compared += find_command_clocks(question.problem, usable)
            for finding in compared:
                findings.append(replace(finding, run=finding.run or str(usable[0].path)))
        except BadInput as error:
            refused.append(error)
    entries: dict[Path, list[LogEntry]] = {path: [] for path in runs}
    for path in runs:
        for finding in findings:
            if finding.run == str(path):
                sources = column_sources(finding.run, vessels[path])
                entries[path].append(finding_entry(finding, sources))
    return entries, refused


def _open_file(path: Path, vessel: Vessel) -> _Opened:
    """Check the table of a file, and prepare its parts."""
    table: tuple[Finding, ...] = ()
    try:
        table = tuple(run_checks.check_table(path, vessel, DEFAULT.checks))
        parts = []
        for part in read(path, vessel.recorded_limits(), vessel.columns, vessel.turns_over).parts():
            parts.append(data_cleaning.prepare_recording(part, vessel, DEFAULT.checks))
    except BadInput as error:
        return _Opened(path, table, refused=None if table else error)
    return _Opened(path, table, tuple(parts))


def _with_order_signs(
    files: Sequence[_Opened], vessels: Mapping[Path | None, Vessel]
) -> list[_Opened]:
    """The files, with the signs that orders of their parts have lost."""
    every = [part for file in files for part in file.parts]
    if not every:
        return list(files)
    restored = iter(restore_order_signs(every, vessels[files[0].path], len(every)))
    return [replace(file, parts=tuple(islice(restored, len(file.parts)))) for file in files]


def _check_file(file: _Opened, vessel: Vessel) -> _Checked:
    """Check the parts of one file."""
    duration = data_cleaning.total_duration(file.parts)
    findings, cleaned_parts = list(file.table), list[Recording]()
    for number, part in enumerate(file.parts, 1):
        silent = check_silent_poses(part, vessel, DEFAULT.checks)
        if silent:  # the other checks need poses
            findings += silent
            continue
        cleaned = data_cleaning.clean_recording(part, vessel, duration)
        findings += run_checks.check_recording(part, cleaned, vessel, DEFAULT.checks)
        findings += run_checks.check_identifiability(part, vessel, DEFAULT.checks)
        name = str(file.path)
        if len(file.parts) > 1:
            name = f"{file.path} (part {number})"
        cleaned_parts.append(replace(cleaned, name=name))
    if file.table:
        return _Checked(tuple(findings))
    return _Checked(tuple(findings), tuple(cleaned_parts))


def _is_silent(part: Recording, vessel: Vessel) -> bool:
    """Whether a part of a file shows no motion."""
    return bool(check_silent_poses(part, vessel, DEFAULT.checks))


def correction_hint(
    runs: Sequence[Path],
    hold_out: Sequence[Path],
    vessel: str | None,
    load_conditions: Sequence[str],
) -> str:
    """Return lines that correct the first recording that cannot be read, for an error message.

    Args:
        runs: Files of recordings.
        hold_out: Files of held-out recordings.
        vessel: Name of the vessel; None: that of the recordings' notes.
        load_conditions: Names of load conditions.

    Returns:
        Lines for its recording.toml; "" if no correction is known.
    """
    for path in (*runs, *hold_out):
        try:
            own = vessel_of_recording_file(path, vessel, load_conditions)
            findings = run_checks.check_table(path, own, DEFAULT.checks)
        except BadInput:
            return ""
        for finding in findings:
            entry = finding_entry(finding, column_sources(finding.run, own))
            if entry["lines"]:
                name, lines = entry["name"].replace("_", " "), join_toml_lines(entry["lines"])
                return f"; {LOG_NOT_BOAT}: {name}, write into recording.toml {lines}"
    return ""
