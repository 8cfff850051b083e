"""What a run leaves in its folder: recording.csv, camera.csv with recording.toml, norms.json, run.rrd, all or none."""

import json
import os
import shutil
import signal
import tempfile
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from boatsim.errors import BadInput
from boatsim.physics.content import vessel_address
from boatsim.recordings.table import write_csv
from boatsim.simulate import norms as judged
from boatsim.simulate.norms import RunEntry
from boatsim.simulate.run import Run, Runner
from boatsim.simulate.scenario import Scenario

if TYPE_CHECKING:
    from boatsim.view.rerun_log import RunLog

CAMERA = "camera"  # stem of the file a diagnosis reads


def run_into(
    folder: Path,
    scenario: Scenario,
    seed: int | None = None,
    live: bool = False,
    progress: Callable[[float], None] | None = None,
) -> RunEntry:
    """Run a scenario, logging to rerun as it goes, and put its files into `folder`; returns what norms.json says.

    An interruption ends the run, and what was logged is kept. Raises BadInput, BadPhysics or OSError, and then
    `folder` is as it was.
    """
    runner = Runner(scenario, seed)
    with _interrupts() as ignore, filling(folder) as new, _log(new / "run.rrd", runner, live) as log:
        runner.listen = log.chunk
        run = runner.run(progress)
        ignore()  # a second Ctrl-C must not cost the files of a run that the first one ended
        found = judged.norms(run)
        log.finish({name: norm.to_json() for name, norm in found.items()})
        content = judged.to_json(run, found)
        write(run, content, new)
    return content


def write(run: Run, content: RunEntry, folder: Path) -> None:
    """The files of a run but its rerun log; `content` is that of norms.json."""
    write_csv(run.recording, folder / "recording.csv")
    if "yaw" in run.scenario.vessel.freedoms:  # the camera looks from above: it does not see a hull roll
        write_csv(run.camera, folder / f"{CAMERA}.csv")
    (folder / "recording.toml").write_text(notes_toml(run), encoding="utf-8")
    (folder / "norms.json").write_text(json.dumps(content, indent=1) + "\n", encoding="utf-8")


def notes_toml(run: Run) -> str:
    """recording.toml: what a diagnosis of the run may know. Effects the scenario adds are what it has to find."""
    vessel, notes = run.scenario.vessel, run.recording.notes
    lines = [f"vessel = {_value(vessel_address(vessel.file))}", f"load = {_value(list(notes.load))}"]
    for effect, values in notes.settings.items():
        lines += _table(f"set.{_key(effect)}", values)
    lines += _table(f"runs.{CAMERA}.noise", notes.noise)  # recording.csv has none: it is the truth
    facts = {"scenario": run.scenario.name, "seed": run.seed, "complete": run.complete}
    return "\n".join(lines + _table("facts", facts)) + "\n"


def _table(name: str, values: Mapping[str, object]) -> list[str]:
    return ["", f"[{name}]", *(f"{_key(k)} = {_value(v)}" for k, v in values.items())]


def _key(name: str) -> str:
    return name if name.replace("_", "a").replace("-", "a").isalnum() and name.isascii() else _value(name)


def _value(value: object) -> str:
    """A text, number, truth value or list of them, which TOML writes as JSON does."""
    return json.dumps(value, ensure_ascii=False)


def _log(path: Path, runner: Runner, live: bool) -> "RunLog":
    """The rerun log of a run about to start."""
    from boatsim.view.rerun_log import RunLog
    from boatsim.view.scene import scene_from

    return RunLog(path, live, scene_from(runner.engine.model, runner.scenario.vessel, runner.engine.tank))


@contextmanager
def filling(folder: Path) -> Iterator[Path]:
    """A new folder beside `folder`, whose files move into it once all of them are whole."""
    if folder.exists() and not folder.is_dir():
        raise BadInput(f"{folder}: is a file; what is written needs a folder")
    folder.parent.mkdir(parents=True, exist_ok=True)
    new = Path(tempfile.mkdtemp(prefix=f".{folder.name}.", dir=folder.parent))
    try:
        yield new
        folder.mkdir(exist_ok=True)
        for file in sorted(new.iterdir()):
            os.replace(file, folder / file.name)
    finally:
        shutil.rmtree(new, ignore_errors=True)


@contextmanager
def _interrupts() -> Iterator[Callable[[], object]]:
    """A switch that makes Ctrl-C do nothing until the block is left."""
    before = signal.getsignal(signal.SIGINT)
    try:
        yield lambda: signal.signal(signal.SIGINT, signal.SIG_IGN)
    finally:
        signal.signal(signal.SIGINT, before)
