"""Many recordings, each diagnosed by itself: a folder of answers for each, and one table of all."""

import os
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass
from hashlib import sha256
from json import dumps
from pathlib import Path
from typing import Any, NamedTuple

from boatsim.diagnosis import pipeline
from boatsim.diagnosis.config import from_settings
from boatsim.diagnosis.report import output_files
from boatsim.errors import BadInput, BoatsimError
from boatsim.progress import Report, silent
from boatsim.sweeps import table
from boatsim.sweeps.campaign import Outcome, carry_out
from boatsim.sweeps.journal import Entry
from boatsim.sweeps.runs import reason
from boatsim.sweeps.workers.base import Backend
from boatsim.version import version

NAME = "diagnoses.parquet"
FILES = ("*.csv", "*.parquet", "*.rrd")
OF_A_RUN = "camera.csv"  # what a diagnosis may see of a run of ours
WHAT = "diagnoses"
FAMILIES = ("position_rms_m", "heading_rms_rad", "roll_rms_rad")


@dataclass(frozen=True)
class Asked:
    """What each recording is asked, as `boatsim diagnose` has it."""

    hold_out: tuple[str, ...] = ()
    vessel: str | None = None
    load: tuple[str, ...] = ()
    library: tuple[str, ...] = ()
    without: tuple[str, ...] = ()
    horizon: float | None = None  # [s]
    settings: tuple[tuple[str, str], ...] = ()  # changed, by dotted name


class Told(NamedTuple):
    """One diagnosis: plain values, so that it can be sent to a process or a node."""

    recording: str
    asked: Asked
    folder: str  # of its files


def recordings(given: Sequence[Path]) -> list[Path]:
    """Files as they are, folders as the recordings in them: camera.csv of our own runs, else all of a known kind.

    Raises BadInput.
    """
    found: list[Path] = []
    for path in given:
        inside = sorted(path.rglob(OF_A_RUN)) or sorted(
            p for like in FILES for p in path.glob(like)
        )
        if path.is_dir() and not inside:
            raise BadInput(f"{path}: there is no recording in this folder ({', '.join(FILES)})")
        found += inside if path.is_dir() else [path]
    if twice := next((path for path in found if found.count(path) > 1), None):
        raise BadInput(f"{twice} is given twice")
    if missing := next((path for path in found if not path.is_file()), None):
        raise BadInput(f"{missing}: there is no such file")
    return found


def diagnosed(
    paths: Sequence[Path], asked: Asked, folder: Path, backend: Backend, report: Report = silent
) -> Outcome:
    """Diagnose each of the recordings, or go on with it; writes diagnoses.parquet into the folder.

    Raises BadInput and OSError.
    """
    names = folders_of(paths)
    about = {
        "boatsim": version(),
        "recordings": {str(p): sha256(p.read_bytes()).hexdigest()[:12] for p in paths},
        "asked": asdict(asked),
    }

    def tasks() -> Iterator[tuple[int, Told]]:
        for number, (path, name) in enumerate(zip(paths, names, strict=True)):
            yield number, Told(str(path), asked, str(folder / name))

    report(WHAT, 0.0, "beginning")
    done = carry_out(folder, about, len(paths), tasks(), carried_out, backend, WHAT, report)
    columns = columns_of(done, [str(path) for path in paths])
    units = {
        name: unit
        for entry in done.entries.values()
        for name, (_, unit) in entry.get("values", {}).items()
    }
    table.write(columns, units, dumps(about, ensure_ascii=False), folder / NAME)
    return done


def folders_of(paths: Sequence[Path]) -> list[str]:
    """A folder for each recording's files, called as the recording is, from where all of them lie."""
    real = [path.resolve() for path in paths]
    home = os.path.commonpath([path.parent for path in real])
    names = [Path(os.path.relpath(p, home)) for p in real]
    short = [
        str(n.parent if n.name == OF_A_RUN and len(n.parts) > 1 else n.with_suffix(""))
        for n in names
    ]
    return [s if short.count(s) == 1 else str(n) for s, n in zip(short, names, strict=True)]


def carried_out(told: Told) -> Entry:
    """Verdict, causes with their values, errors on unseen data; or why it failed."""
    asked = told.asked
    try:
        found = pipeline.diagnose(
            [Path(told.recording)],
            [Path(path) for path in asked.hold_out],
            asked.vessel,
            asked.load,
            asked.library,
            asked.without,
            asked.horizon,
            config=from_settings(dict(asked.settings)),
        )
        output_files.write(found, Path(told.folder))
    except BoatsimError as error:
        return {"failure": reason(str(error))}
    except Exception as error:
        return {"failure": reason(f"{type(error).__name__}: {error}")}
    answer = found.findings.answer
    values: dict[str, list[Any]] = {}
    for effect in answer["effects"]:
        for name, p in effect["parameters"].items():
            values[f"{effect['name']}.{name}"] = [p["value"], p["unit"]]
            values[f"{effect['name']}.{name} sd"] = [p["sd"], p["unit"]]
    fit: Mapping[str, Any] = answer["fit"]
    rms = {
        f"{family}.{model}": value
        for family in FAMILIES
        for model, value in (fit.get(family) or {}).items()
    }
    causes = [effect["name"] for effect in answer["effects"]]
    return {
        "failure": None,
        "verdict": answer["verdict"],
        "causes": causes,
        "values": values,
        "rms": rms,
    }


def columns_of(done: Outcome, paths: Sequence[str]) -> dict[str, list[Any]]:
    """All of the table, a row for each recording that is done."""
    entries = list(done.entries.values())
    values = dict.fromkeys(name for entry in entries for name in entry.get("values", {}))
    errors = dict.fromkeys(name for entry in entries for name in entry.get("rms", {}))
    return {
        "recording": [paths[number] for number in done.entries],
        "verdict": [entry.get("verdict") for entry in entries],
        "causes": [", ".join(entry["causes"]) if "causes" in entry else None for entry in entries],
        **{
            name: [entry.get("values", {}).get(name, (None,))[0] for entry in entries]
            for name in values
        },
        **{name: [entry.get("rms", {}).get(name) for entry in entries] for name in errors},
        "failure": [entry["failure"] for entry in entries],
    }
