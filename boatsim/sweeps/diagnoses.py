"""Separate diagnoses of many recordings: a folder of results for each, and one table of all."""

import os
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from hashlib import sha256
from itertools import chain
from json import dumps
from operator import itemgetter
from pathlib import Path
from typing import Any, NamedTuple

from boatsim.diagnosis import pipeline
from boatsim.diagnosis.config import from_settings
from boatsim.diagnosis.output.files import write_diagnosis
from boatsim.errors import BadInput, BoatsimError
from boatsim.progress import Report, ignore_progress
from boatsim.sweeps import table
from boatsim.sweeps.campaign import Campaign, Outcome, run_campaign
from boatsim.sweeps.entries import DiagnosisEntry
from boatsim.sweeps.journal import Entry
from boatsim.sweeps.runs import failure_entry
from boatsim.sweeps.workers.base import Backend
from boatsim.version import version

NAME = "diagnoses.parquet"
PATTERNS = ("*.csv", "*.parquet", "*.rrd")  # files that may be recordings
OF_A_RUN = "camera.csv"  # the file of a boatsim run that holds only what a sensor can see
LABEL = "diagnoses"
FAMILIES = ("position_rms_m", "heading_rms_rad", "roll_rms_rad", "heave_rms_m")


@dataclass(frozen=True)
class DiagnosisOptions:
    """Options of a diagnosis of recordings, as in the command `boatsim diagnose`.

    Attributes:
        hold_out: Recordings used only for validation.
        vessel: Nominal vessel; None for the one that recording.toml names.
        load: Load conditions.
        library: Further candidate effects.
        without: Candidate effects that are not tested.
        horizon: Length of each free run [s]; None for the default of the vessel.
        settings: Changed settings of the method, by dotted name.
    """

    hold_out: tuple[str, ...] = ()
    vessel: str | None = None
    load: tuple[str, ...] = ()
    library: tuple[str, ...] = ()
    without: tuple[str, ...] = ()
    horizon: float | None = None
    settings: tuple[tuple[str, str], ...] = ()


class DiagnosisTask(NamedTuple):
    """Task to diagnose one recording.

    It holds plain values, so that it can be sent to a process or a node.
    """

    recording: str
    options: DiagnosisOptions
    folder: str  # for its output files


def find_recordings(inputs: Sequence[Path]) -> list[Path]:
    """Return the paths of recordings: given files, and the recordings in given folders.

    Args:
        inputs: Files, and folders with boatsim runs (camera.csv) or other recordings.

    Raises:
        BadInput: A folder holds no recording, a file is missing or given twice.
    """
    paths: list[Path] = []
    for path in inputs:
        if path.is_dir():
            inside = sorted(path.rglob(OF_A_RUN))
            if not inside:
                inside = sorted(chain.from_iterable(map(path.glob, PATTERNS)))
            if not inside:
                raise BadInput(f"{path}: no recording in this folder ({', '.join(PATTERNS)})")
            paths += inside
        else:
            paths.append(path)
    for path in paths:
        if paths.count(path) > 1:
            raise BadInput(f"{path} is given twice")
    for path in paths:
        if not path.is_file():
            raise BadInput(f"{path}: there is no such file")
    return paths


def diagnose_all(
    paths: Sequence[Path],
    options: DiagnosisOptions,
    folder: Path,
    backend: Backend,
    report: Report = ignore_progress,
) -> Outcome:
    """Diagnose many recordings separately, or continue to do so; write diagnoses.parquet.

    Args:
        paths: Recordings.
        options: Options of each diagnosis.
        folder: Output folder.
        backend: Performs the diagnoses.
        report: Function to call with the progress.

    Raises:
        BadInput: The folder belongs to another campaign.
        OSError: A file cannot be written.
    """
    about = {
        "boatsim": version(),
        "recordings": {str(p): sha256(p.read_bytes()).hexdigest()[:12] for p in paths},
        "asked": asdict(options),
    }
    tasks = []
    for path, name in zip(paths, output_folders(paths), strict=True):
        tasks.append(DiagnosisTask(str(path), options, str(folder / name)))
    report(LABEL, 0.0, "starting")
    numbered = enumerate(tasks)
    campaign = Campaign(folder, about, len(paths), numbered, diagnose_task, LABEL, DiagnosisEntry)
    done = run_campaign(campaign, backend, report)
    units: dict[str, str] = {}
    for entry in done.entries.values():
        for name, (_, unit) in entry.get("values", {}).items():
            units[name] = unit
    columns = table_columns(done, list(map(str, paths)))
    table.write_parquet(columns, units, dumps(about, ensure_ascii=False), folder / NAME)
    return done


def output_folders(paths: Sequence[Path]) -> list[str]:
    """Return an output folder for the diagnosis of each recording, named after the recording.

    Args:
        paths: Recordings; the folders repeat their structure below their common folder.
    """
    real = [path.resolve() for path in paths]
    root = os.path.commonpath([path.parent for path in real])
    full = [Path(os.path.relpath(path, root)) for path in real]
    short = list(map(_without_suffix, full))
    names = []
    for name, path in zip(short, full, strict=True):
        if short.count(name) > 1:
            name = str(path)
        names.append(name)
    return names


def _without_suffix(path: Path) -> str:
    """The folder of a boatsim run, or a file without its ending."""
    if path.name == OF_A_RUN and len(path.parts) > 1:
        return str(path.parent)
    return str(path.with_suffix(""))


def diagnose_task(task: DiagnosisTask) -> Entry:
    """Diagnose one recording of a campaign and write the files of the diagnosis.

    Args:
        task: Recording, options and output folder.

    Returns:
        Verdict, identified effects with their values, and rms errors on held-out data; or only the
        reason of a failure.
    """
    options = task.options
    try:
        found = pipeline.diagnose(
            [Path(task.recording)],
            list(map(Path, options.hold_out)),
            options.vessel,
            options.load,
            options.library,
            options.without,
            options.horizon,
            config=from_settings(dict(options.settings)),
        )
        write_diagnosis(found, Path(task.folder))
    except BoatsimError as error:
        return failure_entry(str(error))
    except Exception as error:
        return failure_entry(f"{type(error).__name__}: {error}")
    answer = found.findings.answer
    values: dict[str, list[Any]] = {}
    for effect in answer["effects"]:
        for name, parameter in effect["parameters"].items():
            key = f"{effect['name']}.{name}"
            values[key] = [parameter["value"], parameter["unit"]]
            values[f"{key} sd"] = [parameter["sd"], parameter["unit"]]
    rms = {}
    fit: dict[str, Any] = dict(answer["fit"])
    for family in FAMILIES:
        for model, value in (fit.get(family) or {}).items():
            rms[f"{family}.{model}"] = value
    return {
        "failure": None,
        "verdict": answer["verdict"],
        "causes": list(map(itemgetter("name"), answer["effects"])),
        "values": values,
        "rms": rms,
    }


def _joined_causes(entry: Entry) -> str | None:
    if "causes" not in entry:
        return None
    return ", ".join(entry["causes"])


def table_columns(done: Outcome, paths: Sequence[str]) -> dict[str, list[Any]]:
    """Return the columns of diagnoses.parquet, which has a row for each finished diagnosis.

    Args:
        done: Result of the campaign.
        paths: Recordings by the number of their task.
    """
    entries = list(done.entries.values())
    columns: dict[str, list[Any]] = {
        "recording": [paths[number] for number in done.entries],
        "verdict": [entry.get("verdict") for entry in entries],
        "causes": list(map(_joined_causes, entries)),
    }
    parameters: dict[str, None] = {}
    errors: dict[str, None] = {}
    for entry in entries:
        parameters |= dict.fromkeys(entry.get("values", ()))
        errors |= dict.fromkeys(entry.get("rms", ()))
    for name in parameters:
        columns[name] = [entry.get("values", {}).get(name, (None,))[0] for entry in entries]
    for name in errors:
        columns[name] = [entry.get("rms", {}).get(name) for entry in entries]
    columns["failure"] = list(map(itemgetter("failure"), entries))
    return columns
