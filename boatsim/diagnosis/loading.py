"""The load stage: reads recordings with their vessel, cleans them, and holds some of them out."""

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from boatsim.diagnosis.checks import data_cleaning, run_checks
from boatsim.diagnosis.checks.accelerometer_clock import correct_pose_clock
from boatsim.diagnosis.checks.channel_ranges import widen_channel_ranges
from boatsim.diagnosis.checks.clock_rate import check_clock_rate
from boatsim.diagnosis.checks.finding import Finding
from boatsim.diagnosis.checks.order_signs import restore_order_signs
from boatsim.diagnosis.checks.silent_poses import without_silent_recordings
from boatsim.diagnosis.config import DEFAULT, DiagnosisConfig
from boatsim.errors import BadInput
from boatsim.files import Value
from boatsim.physics import vessel as vessels
from boatsim.physics.vessel import Vessel
from boatsim.progress import Report, ignore_progress
from boatsim.recordings.notes import NotesFile, notes_for
from boatsim.recordings.run_folder import is_in_run_folder, recording_file
from boatsim.recordings.table import Recording, read

THIRDS = ("first", "middle", "last")
MOST_FOLDERS = 8  # in front of a file's name that may distinguish it from others


@dataclass(frozen=True)
class Request:
    """Files and options that the user gives to one diagnosis."""

    runs: Sequence[Path]  # recordings to fit
    hold_out: Sequence[Path] = ()  # recordings for validation
    vessel: str | None = None  # None: that of the recordings' notes
    load: Sequence[str] = ()  # load conditions
    library: Sequence[str] = ()  # further candidate effects, by name or file
    without: Sequence[str] = ()  # candidate effects that are excluded
    horizon: float | None = None  # [s] length of free runs; None: the usual one
    facts: Mapping[str, Value] = field(default_factory=dict)  # where the notes do not state them


@dataclass(frozen=True)
class LoadedRecordings:
    """Cleaned recordings, divided into fitted and held-out ones, with vessels and findings."""

    fitted: Sequence[Recording]
    held_out: Sequence[Recording]
    vessels: Mapping[Path | None, Vessel]  # by the file of a recording
    note: str  # which recordings are held out, in words
    library: Sequence[str] = ()
    without: Sequence[str] = ()
    horizon: float | None = None
    findings: Sequence[Finding] = ()  # of the checks of single recordings
    remarks: tuple[str, ...] = ()  # what was read and not used

    @property
    def vessel(self) -> Vessel:
        """Vessel of the first recording."""
        return self.vessels[self.fitted[0].path]


def load_recordings(
    request: Request, report: Report = ignore_progress, config: DiagnosisConfig = DEFAULT
) -> LoadedRecordings:
    """Read, check and clean the recordings of a diagnosis, and hold some of them out.

    Args:
        request: Files and options.
        report: Receives the progress.
        config: Settings of the diagnosis.

    Returns:
        The fitted and the held-out recordings, with their vessels and the findings of the checks.

    Raises:
        BadInput: A file cannot be used.
    """
    if not request.runs:
        raise BadInput("runs: no recording is given; a diagnosis needs one or more")
    paths = list(map(recording_file, (*request.runs, *request.hold_out)))
    _check_distinct(paths)
    opened, own_vessels, names = list[Recording](), list[Vessel](), list[str]()
    first = 0  # number of parts of the recordings to fit
    count = "1 recording"
    if len(paths) > 1:
        count = f"{len(paths)} recordings"
    for i, (path, name) in enumerate(zip(paths, _distinct_names(paths), strict=True)):
        report(f"reading {count}", i / len(paths))
        parts, vessel = open_recording_parts(path, request.vessel, request.load, config)
        for number, recording in enumerate(parts, 1):
            facts = {**request.facts, **recording.notes.facts}
            notes = replace(recording.notes, facts=facts)
            opened.append(replace(recording, notes=notes))
            own_vessels.append(vessel)
            if len(parts) > 1:
                names.append(f"{name} (part {number})")
            else:
                names.append(name)
        if i < len(request.runs):
            first = len(opened)
    report("checking the log", 1.0)
    check_same_vessel(own_vessels)
    kept, silent = without_silent_recordings(opened, own_vessels, names, first, config.checks)
    opened, own_vessels = [opened[i] for i in kept], [own_vessels[i] for i in kept]
    names = [names[i] for i in kept]
    first = sum(i < first for i in kept)
    opened = restore_order_signs(opened, own_vessels[0], first)
    duration = data_cleaning.total_duration(opened)
    findings, cleaned, remarks = list(silent), list[Recording](), list[str]()
    by_path: dict[Path | None, Vessel] = {}
    for recording, own, name in zip(opened, own_vessels, names, strict=True):
        vessel = widen_channel_ranges(own, opened)
        by_path[recording.path] = vessel
        clean = data_cleaning.clean_recording(recording, vessel, duration, config)
        findings += run_checks.check_recording(recording, clean, vessel, config.checks)
        cleaned.append(replace(clean, name=name))
        remarks += clean.remarks
    findings += check_clock_rate(opened, config.checks)
    fitted, held_out, note = split_recordings(cleaned[:first], cleaned[first:])
    return LoadedRecordings(
        fitted,
        held_out,
        by_path,
        note,
        request.library,
        request.without,
        request.horizon,
        findings,
        tuple(dict.fromkeys(remarks)),
    )


def _belong_to(vessel: str, file: NotesFile) -> bool:
    """Whether load and settings of a recording's notes are those of a vessel, or of its patch."""
    own = file.notes.vessel
    if not own or own == vessel or not (file.notes.load or file.notes.settings):
        return True
    try:
        noted = vessels.load_vessel(own, base_folder=file.folder)
    except BadInput:
        return False
    return vessels.load_vessel(vessel).path == noted.path


def vessel_of_recording_file(
    path: Path,
    vessel: str | None,
    load_conditions: Sequence[str],
    config: DiagnosisConfig = DEFAULT,
) -> Vessel:
    """Return the vessel model that belongs to the file of a recording.

    A load condition of the vessel with the name of one of the recording's groups applies to it.

    Args:
        path: File of the recording.
        vessel: Name on the command line; None: that of the recording's notes.
        load_conditions: Names of load conditions.
        config: Settings of the diagnosis.

    Raises:
        BadInput: No vessel is named, or it cannot be loaded, or its model scale is another one.
    """
    file = notes_for(path)
    notes, name, base_folder = file.notes, vessel, None
    if vessel is None:
        name, base_folder = notes.vessel, file.folder
    if not path.exists():
        raise BadInput(f"{path}: there is no such file")
    if not name:
        raise BadInput(
            f"{path}: no vessel given; name one with --vessel or in a recording.toml next to it"
        )
    conditions = load_conditions or notes.load
    try:
        if vessel and not _belong_to(vessel, file):
            notes = replace(notes, load=(), settings={})
            conditions = load_conditions
        found = vessels.load_vessel(name, conditions, notes.settings, base_folder=base_folder)
        own = [g for g in notes.groups if g in found.loads and g not in conditions]
        if own:
            conditions = (*conditions, *own)
            found = vessels.load_vessel(name, conditions, notes.settings, base_folder=base_folder)
    except BadInput as error:
        by_notes = not vessel or notes.settings or (notes.load and not load_conditions)
        where = f"{path} by its recording.toml: " if by_notes else ""
        raise BadInput(f"{where}{error}") from None
    wanted, tolerance = notes.scale, config.load.scale_tolerance
    if wanted is None or found.scale is None or abs(wanted / found.scale - 1.0) < tolerance:
        return found
    alike = [n for n, scale in found.scales.items() if abs(wanted / scale - 1.0) < tolerance]
    if vessel or not alike:
        hint = f"; the vessel at that scale is {alike[0]}" if alike else ""
        raise BadInput(
            f"{path}: scale = {wanted:g}, but {found.name} is at scale {found.scale:g}{hint}"
        )
    return vessels.load_vessel(alike[0], conditions, notes.settings)


def open_recording_parts(
    path: Path,
    vessel: str | None,
    load_conditions: Sequence[str],
    config: DiagnosisConfig = DEFAULT,
) -> tuple[list[Recording], Vessel]:
    """Read the parts of a recording that its notes select by `use`, each as a recording.

    Args:
        path: File of the recording.
        vessel: Name of the vessel; None: that of the recording's notes.
        load_conditions: Names of load conditions.
        config: Settings of the diagnosis.

    Returns:
        The parts and their vessel.

    Raises:
        BadInput: The file or its vessel cannot be used.
    """
    found = vessel_of_recording_file(path, vessel, load_conditions, config)
    recording = read(path, found.recorded_limits(), found.columns, found.turns_over)
    recording = correct_pose_clock(recording, found, config.checks)
    parts = []
    for part in recording.parts():
        parts.append(data_cleaning.prepare_recording(part, found, config.checks))
    return parts, found


def open_recording(
    path: Path,
    vessel: str | None,
    load_conditions: Sequence[str],
    config: DiagnosisConfig = DEFAULT,
) -> tuple[Recording, Vessel]:
    """Read a recording from a file, with the column names and command limits of its vessel.

    Of several parts that its notes select it is the longest one.

    Args:
        path: File of the recording.
        vessel: Name of the vessel; None: that of the recording's notes.
        load_conditions: Names of load conditions.
        config: Settings of the diagnosis.

    Returns:
        The recording and its vessel.

    Raises:
        BadInput: The file or its vessel cannot be used.
    """
    found = vessel_of_recording_file(path, vessel, load_conditions, config)
    recording = read(path, found.recorded_limits(), found.columns, found.turns_over)
    recording = correct_pose_clock(recording, found, config.checks)
    found = widen_channel_ranges(found, [recording])
    return data_cleaning.prepare_recording(recording, found, config.checks), found


def split_recordings(
    recordings: Sequence[Recording], hold_out: Sequence[Recording]
) -> tuple[list[Recording], list[Recording], str]:
    """Divide recordings into those to fit and those held out for validation.

    If the user specifies none, the last recording is held out, or the middle third of a single one:
    the end of a decay would be nearly linear and test nothing.

    Args:
        recordings: Recordings to fit.
        hold_out: Recordings to hold out.

    Returns:
        Fitted recordings, held-out recordings, and a note that names the latter.
    """
    if hold_out:
        return list(recordings), list(hold_out), ", ".join(r.name for r in hold_out)
    if len(recordings) > 1:
        last = recordings[-1]
        note = f"the last recording, {last.name}, because none was specified"
        return list(recordings[:-1]), [last], note
    whole = recordings[0]
    begin, end = float(whole.t[0]), float(whole.t[-1])
    a = float(begin + 1 / 3 * (end - begin))
    b = float(begin + 2 / 3 * (end - begin))
    half = 0.5 * float(np.median(np.diff(whole.t)))
    parts = (whole.between(begin, a), whole.between(a + half, b), whole.between(b + half, end))
    thirds = []
    for part, which in zip(parts, THIRDS, strict=True):
        thirds.append(replace(part, name=_third_of_recording(whole.name, which)))
    first, middle, last = thirds
    note = f"the middle third of the only recording, {a:.1f} to {b:.1f} s"
    return [first, last], [middle], note


def recording_order(names: Sequence[str], starts: Sequence[float]) -> list[int]:
    """Return the indices that put recordings into the order in which they were given.

    A single recording that was split into thirds has its thirds in order of time.

    Args:
        names: Names of the recordings.
        starts: Time of the first row of each [s].
    """
    whole = names[0].removesuffix(_third_of_recording("", THIRDS[0]))
    if set(names) == {_third_of_recording(whole, which) for which in THIRDS}:
        return sorted(range(len(names)), key=lambda i: starts[i])
    return list(range(len(names)))


def _third_of_recording(name: str, which: str) -> str:
    return f"{name} ({which} third)"


def check_same_vessel(found: Sequence[Vessel]) -> None:
    """Check that all recordings are of one vessel.

    Raises:
        BadInput: They are of several ones.
    """
    if len({(vessel.file, vessel.dof) for vessel in found}) > 1:
        names = ", ".join(sorted({vessel.name for vessel in found}))
        raise BadInput(f"recordings of different vessels: {names}")


def _check_distinct(paths: Sequence[Path]) -> None:
    """Raise BadInput for a file that is given twice: a held-out recording must not be fitted."""
    seen: set[str] = set()
    for path in paths:
        real = os.path.realpath(path)
        if real in seen:
            raise BadInput(f"{path}: given twice; a recording is either fitted or held out, once")
        seen.add(real)


def _distinct_names(paths: Sequence[Path]) -> list[str]:
    """The stems of files, with as many folders in front as distinguish them.

    A file in the folder of a run has the name of that folder, if that distinguishes it.
    """
    whole = [path.resolve().with_suffix("") for path in paths]
    folders = [path.parent if is_in_run_folder(path) else path for path in whole]
    for names in (folders, whole):
        for depth in range(1, MOST_FOLDERS + 1):
            short = ["/".join(path.parts[-depth:]) for path in names]
            if len(set(short)) == len(short):
                return short
    return list(map(str, paths))
