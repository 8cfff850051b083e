"""What a run leaves in its folder: recording.csv, camera.csv with recording.toml, norms.json, run.rrd, all or none.

They are written as the run goes, in a folder beside it that is called `.part-...`: one that is killed leaves that.
"""

import json
import os
import shutil
import tempfile
from collections.abc import Callable, Iterator, Mapping
from contextlib import AbstractContextManager, ExitStack, contextmanager, nullcontext, suppress
from pathlib import Path
from time import monotonic
from typing import TYPE_CHECKING, Protocol, Self
from warnings import catch_warnings, simplefilter

import numpy as np

from boatsim.errors import BadInput, BoatsimError
from boatsim.files import AppendedFile, replacing
from boatsim.interruption import deferred_signals
from boatsim.physics.content import vessel_address
from boatsim.recordings.table import Notes, Recording, csv_header, csv_rows
from boatsim.simulate import evaluation as judged
from boatsim.simulate.evaluation import RunEntry
from boatsim.simulate.real_time_pace import Pace
from boatsim.simulate.run import Listener, Runner
from boatsim.simulate.scenario import Scenario

if TYPE_CHECKING:
    from boatsim.view.rerun_log import RunLog

PART = ".part-"  # of the name of a folder that is being filled
CAMERA = "camera"  # stem of the file a diagnosis reads
NORMS = "norms.json"
SELDOM = 1.0  # [s] at least between two writings of the norms so far
SHARE = 0.03  # of the time of a run that these may take


class Steering(Protocol):
    """Somebody who steers a run while it goes, in place of its scenario's goals."""

    def take(self, runner: Runner, stop: Callable[[], bool]) -> None:
        """Take a run over that is about to start, or give up where somebody wants to `stop`."""

    def beside(self, listen: Listener) -> AbstractContextManager[Listener]:
        """A listener for the time of the run that looks at the rows and hands them on."""

    def facts(self) -> Mapping[str, object]:
        """What recording.toml is to say of it."""

    def files(self) -> Mapping[str, str]:
        """Further files of the run, name -> text, as they are by now."""


def run_into(
    folder: Path,
    scenario: Scenario,
    seed: int | None = None,
    viewer: str | None = None,
    progress: Callable[[float], None] | None = None,
    pace: Pace | None = None,
    steering: Steering | None = None,
) -> RunEntry:
    """Run a scenario, writing its log as it goes, and put its files into `folder`; returns what norms.json says.

    `viewer` is the address of one that shows it meanwhile, and `pace` holds it back for that. Under `steering` files
    are written beside the run, in a thread, and norms.json at its end alone: neither may hold it up.

    An interruption ends the run, and what was logged is kept with its norms so far. Raises BadInput, BadPhysics or
    OSError, and then `folder` is as it was; of a disk that is full the line says where the whole part of the log lies.
    """
    runner = Runner(scenario, seed)
    runner.pace = pace
    with deferred_signals() as stop, filling(folder, keep="recording.csv") as new:
        runner.folder = new
        _describe(new, runner, runner.notes(), False, steering)
        if steering:
            steering.take(runner, stop)
        with ExitStack() as open_files:
            logs = [open_files.enter_context(_log(new / "run.rrd", runner))]
            if viewer:  # apart from the file, which many small pieces would make ten times as large
                logs.append(open_files.enter_context(_log(None, runner, viewer)))
            table = open_files.enter_context(CsvFile(new / "recording.csv"))
            so_far = None if steering else NormsSoFar(new / NORMS, runner)

            def listen(rows: Recording) -> None:
                table.add(rows)
                for log in logs:
                    log.chunk(rows)
                if so_far:
                    so_far.look()

            if (
                "yaw" in scenario.vessel.dof
            ):  # the camera looks from above: it does not see a hull roll
                runner.watch = open_files.enter_context(CsvFile(new / f"{CAMERA}.csv")).add
            with steering.beside(listen) if steering else nullcontext(listen) as runner.listen:
                run = runner.run(progress, stop)
            stop.finishing = True  # nothing that comes now may cost the files
            found = judged.all_norms(run)
            for log in logs:
                log.finish({name: norm.to_json() for name, norm in found.items()})
        content = judged.to_json(run, found)
        _describe(new, runner, run.recording.notes, run.complete, steering)
        write_norms(new / NORMS, content)
    return content


def _describe(
    folder: Path, runner: Runner, notes: Notes, complete: bool, steering: Steering | None
) -> None:
    """recording.toml, and what somebody who steers adds to it."""
    more = steering.facts() if steering else {}
    text = notes_toml(runner.scenario, notes, runner.seed, complete, more)
    for name, content in {"recording.toml": text, **(steering.files() if steering else {})}.items():
        (folder / name).write_text(content, "utf-8")


def write_norms(path: Path, content: RunEntry) -> None:
    """norms.json, in place of one that is there."""
    with replacing(path) as temporary:
        temporary.write_text(json.dumps(content, indent=1) + "\n", encoding="utf-8")


class NormsSoFar:
    """norms.json of a run that goes on, for whoever finds it cut off: by a kill, by a disk that is full."""

    def __init__(self, path: Path, runner: Runner) -> None:
        self._path, self._runner, self._due = path, runner, monotonic() + SELDOM

    def look(self) -> None:
        """Write it anew, if it is time: so seldom that a long log, which takes long to judge, is not held up by it."""
        if (begun := monotonic()) < self._due:
            return
        run = self._runner.so_far()
        # a log that is cut short gives a measure reason to warn; what it can not judge at all is
        # told at the end
        with suppress(BadInput), np.errstate(all="ignore"), catch_warnings():
            simplefilter("ignore")
            write_norms(self._path, judged.to_json(run, judged.all_norms(run)))
        took = monotonic() - begun
        self._due = begun + took + max(SELDOM, took / SHARE)


class CsvFile:
    """A CSV of a recording that comes in pieces; it is whole rows at any time."""

    def __init__(self, path: Path) -> None:
        self._file = AppendedFile(path.open("wb", buffering=0), path)
        self._begun = False

    def add(self, rows: Recording) -> None:
        """The rows that follow. Raises OSError, and then none of them is there."""
        head = "" if self._begun else csv_header(rows)
        self._file.add((head + csv_rows(rows)).encode())
        self._begun = True

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._file.close()


def notes_toml(
    scenario: Scenario,
    notes: Notes,
    seed: int,
    complete: bool,
    more: Mapping[str, object] | None = None,
) -> str:
    """recording.toml: what a diagnosis of the run may know. Effects the scenario adds are what it has to find."""
    lines = [
        f"vessel = {_value(vessel_address(scenario.vessel.file))}",
        f"load = {_value(list(notes.load))}",
    ]
    for effect, values in notes.settings.items():
        lines += _table(f"set.{_key(effect)}", values)
    lines += _table(f"runs.{CAMERA}.noise", notes.noise)  # recording.csv has none: it is the truth
    facts = {"scenario": scenario.address or scenario.name, "seed": seed, "complete": complete}
    return "\n".join(lines + _table("facts", {**facts, **(more or {})})) + "\n"


def _table(name: str, values: Mapping[str, object]) -> list[str]:
    return ["", f"[{name}]", *(f"{_key(k)} = {_value(v)}" for k, v in values.items())]


def _key(name: str) -> str:
    return (
        name
        if name.replace("_", "a").replace("-", "a").isalnum() and name.isascii()
        else _value(name)
    )


def _value(value: object) -> str:
    """A text, number, truth value or list of them, which TOML writes as JSON does, but in UTF-8 alone."""
    if isinstance(value, list):
        return f"[{', '.join(_value(each) for each in value)}]"
    text = (
        value.encode("utf-8", "backslashreplace").decode("utf-8")
        if isinstance(value, str)
        else value
    )
    return json.dumps(text, ensure_ascii=False)


def _log(path: Path | None, runner: Runner, viewer: str | None = None) -> "RunLog":
    """The rerun log of a run about to start."""
    from boatsim.view.rerun_log import RunLog
    from boatsim.view.scene import scene_from

    return RunLog(
        path, scene_from(runner.engine.model, runner.scenario.vessel, runner.engine.tank), viewer
    )


@contextmanager
def filling(folder: Path, keep: str | None = None) -> Iterator[Path]:
    """A new folder `folder.part-...` beside `folder`, whose files move into it once all of them are whole.

    It stays where the process is killed, and where the disk is full and it has the file `keep`; the error says so.
    """
    if folder.exists() and not folder.is_dir():
        raise BadInput(f"{folder}: is a file; what is written needs a folder")
    if folder.is_symlink() and not folder.exists():
        raise BadInput(f"{folder}: is a link that leads nowhere; what is written needs a folder")
    folder.parent.mkdir(parents=True, exist_ok=True)
    new = Path(tempfile.mkdtemp(prefix=f"{folder.name}{PART}", dir=folder.parent))
    kept = False
    try:
        with deferred_signals():  # of a folder just made, and of one that is half moved
            yield new
            _move(new, folder)
    except OSError as error:
        kept = keep is not None and (new / keep).is_file() and (new / keep).stat().st_size > 0
        if not kept:
            raise
        said = f"{error.filename}: {error.strerror}"
        raise BoatsimError(f"{said}; what was whole until then stays in {new}") from error
    finally:
        if not kept:
            shutil.rmtree(new, ignore_errors=True)


def _move(new: Path, folder: Path) -> None:
    """All files of one folder to another; at once where that is not there yet."""
    if not folder.exists():
        new.chmod(0o777 & ~_umask())  # it was private as all temporary folders are
        new.rename(folder)
        return
    files = sorted(new.iterdir())
    if taken := next((folder / f.name for f in files if (folder / f.name).is_dir()), None):
        raise BadInput(f"{taken}: is a folder; a file is to be written there")
    for file in files:
        os.replace(file, folder / file.name)


def _umask() -> int:
    """What new files of this process are not allowed; the only way to read it sets it."""
    mask = os.umask(0o077)
    os.umask(mask)
    return mask
