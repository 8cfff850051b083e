"""Files of a run: recording.csv, camera.csv, recording.toml, norms.json and those of observers.

They are written during the run into a folder named `.part-...` next to the final one, which remains
if the process is killed.
"""

import json
from collections.abc import Callable, Mapping, Sequence
from contextlib import AbstractContextManager, ExitStack, nullcontext, suppress
from dataclasses import replace
from pathlib import Path
from time import monotonic
from typing import NamedTuple, Protocol, Self, TypeAlias
from warnings import catch_warnings, simplefilter

import numpy as np

from boatsim.atomic_folder import atomic_folder
from boatsim.errors import BadInput
from boatsim.files import AppendedFile, replace_file, toml_key, toml_value
from boatsim.interruption import deferred_signals
from boatsim.physics.content import vessel_reference
from boatsim.recordings.run_folder import METRICS
from boatsim.recordings.table import Recording, csv_header, csv_rows
from boatsim.simulate import evaluation
from boatsim.simulate.engine import Engine
from boatsim.simulate.evaluation import Metric, RunEntry
from boatsim.simulate.open_water import OpenWater
from boatsim.simulate.real_time_pace import Pace
from boatsim.simulate.run import Run, Simulation, build_engine, recording_notes, seed_or_default
from boatsim.simulate.run_options import Listener, RunOptions
from boatsim.simulate.scenario import Scenario

CAMERA = "camera"  # stem of the file that a diagnosis reads
METRICS_INTERVAL = 1.0  # [s] of wall time at least between two updates of norms.json
METRICS_SHARE = 0.03  # largest share of the time of a run that these updates may take


class RunObserver(Protocol):
    """Interface of objects that follow a run in progress, such as a 3D log."""

    def add_rows(self, rows: Recording) -> None:
        """Receive the new rows of the log of a run in progress."""

    def finish(self, result: RunEntry) -> None:
        """Receive the content of norms.json at the end of a run."""


# starts to observe a run of an engine; files of the observer go into the folder
StartObserver: TypeAlias = Callable[[Path, Engine | OpenWater], AbstractContextManager[RunObserver]]


class Steering(Protocol):
    """Interface of objects that steer a run in place of its scenario's goals, as a driver does."""

    @property
    def pace(self) -> Pace | None:
        """Object that slows the run down to a clock; None for none."""

    @property
    def refresh(self) -> float:
        """Wall time between two deliveries of log rows to listeners [s]."""

    def goal_at(self, t: float, /) -> Mapping[str, float]:
        """Return the goals of the controller at a simulated time [s]."""

    def is_finished(self) -> bool:
        """Return whether the driver has ended the run."""

    def prepare_run(self, engine: Engine | OpenWater, stop: Callable[[], bool]) -> None:
        """Prepare the steering of a run before the run starts.

        Raises:
            KeyboardInterrupt: If `stop` returns True before the run begins.
        """

    def wrap_listener(self, listener: Listener) -> AbstractContextManager[Listener]:
        """Yield a listener of log rows that passes the rows of a run on to the given listener."""

    def recording_facts(self) -> Mapping[str, object]:
        """Return the entries that the driver adds to the table [facts] of recording.toml."""

    def extra_files(self) -> Mapping[str, str]:
        """Return further files of the run up to the present: file name -> text."""


class RecordedRun(NamedTuple):
    """Result of a run, with its metrics."""

    run: Run
    metrics: Mapping[str, Metric]

    def to_json(self) -> RunEntry:
        """Return the content of norms.json for the run."""
        return evaluation.to_json(self.run, self.metrics)


def run_into_folder(
    folder: Path,
    scenario: Scenario,
    options: RunOptions | None = None,
    observers: Sequence[StartObserver] = (),
    steering: Steering | None = None,
    *,
    in_memory: bool = False,
) -> RecordedRun:
    """Run a scenario and write recordings, notes and metrics into a folder, all files or none.

    An interruption ends the run; what was logged is kept, with its metrics so far. With `steering`,
    files are written in a separate thread and norms.json only at the end, so that neither delays
    the run.

    Args:
        folder: Folder of the files.
        scenario: The scenario.
        options: How it is run; listeners, folder and stop condition are set here.
        observers: Follow the run.
        steering: Steers the run in place of the scenario's goals.
        in_memory: Keep the log in memory too. Otherwise the recordings of the result are views of
            a temporary file, so that a run of any length fits.

    Returns:
        The run with its metrics.

    Raises:
        BadInput: If the scenario cannot be run.
        BadPhysics: If the motion diverges.
        BoatsimError: If the disk is full; the message names the folder with the data until then.
        OSError: If a file cannot be written.
    """
    options = options or RunOptions()
    seed = seed_or_default(scenario, options.seed)
    engine = build_engine(scenario, seed)
    with deferred_signals() as stop, atomic_folder(folder, keep="recording.csv") as new:
        _write_description(new, scenario, seed, False, steering)
        options = replace(options, folder=None if in_memory else new, stop=stop)
        if steering:
            options = _apply_steering(options, steering, engine)
        with ExitStack() as open_files:
            started = [open_files.enter_context(start(new, engine)) for start in observers]
            table = open_files.enter_context(CsvFile(new / "recording.csv"))
            so_far = None if steering else MetricsSoFar(new / METRICS)
            if "yaw" in scenario.vessel.dof:  # a camera above the water does not see a hull roll
                camera = open_files.enter_context(CsvFile(new / f"{CAMERA}.csv"))
                options = replace(options, camera_listener=camera.append_rows)

            def pass_rows_to_observers(rows: Recording) -> None:
                table.append_rows(rows)
                for observer in started:
                    observer.add_rows(rows)
                if so_far:
                    so_far.update(simulation.partial_result)

            with (
                steering.wrap_listener(pass_rows_to_observers)
                if steering
                else nullcontext(pass_rows_to_observers) as listener
            ):
                simulation = Simulation(scenario, replace(options, listener=listener), engine)
                run = simulation.run()
            stop.finish()  # signals must not cost the files now
            result = RecordedRun(run, evaluation.all_metrics(run))
            content = result.to_json()
            for observer in started:
                observer.finish(content)
        _write_description(new, scenario, seed, run.complete, steering)
        write_metrics(new / METRICS, content)
    return result


def _apply_steering(
    options: RunOptions, steering: Steering, engine: Engine | OpenWater
) -> RunOptions:
    """Options under a driver, who is ready when this returns."""
    steering.prepare_run(engine, options.stop)
    return replace(
        options,
        goal_source=steering.goal_at,
        finish=steering.is_finished,
        pace=steering.pace,
        refresh=steering.refresh,
    )


def _write_description(
    folder: Path, scenario: Scenario, seed: int, complete: bool, steering: Steering | None
) -> None:
    """Write recording.toml and the further files of a driver."""
    facts: Mapping[str, object] = {}
    files: dict[str, str] = {}
    if steering:
        facts = steering.recording_facts()
        files.update(steering.extra_files())
    texts = {"recording.toml": notes_toml(scenario, seed, complete, facts), **files}
    for name, text in texts.items():
        (folder / name).write_text(text, "utf-8")


def write_metrics(path: Path, content: RunEntry) -> None:
    """Write the metrics of a run to norms.json, replacing an existing file.

    Args:
        path: The file.
        content: Its content.

    Raises:
        OSError: If it cannot be written.
    """
    with replace_file(path) as temporary:
        temporary.write_text(json.dumps(content, indent=1) + "\n", encoding="utf-8")


class MetricsSoFar:
    """Writes preliminary metrics to norms.json during a run, in case the run is killed."""

    def __init__(self, path: Path) -> None:
        """Prepare the first update.

        Args:
            path: The norms.json.
        """
        self._path = path
        self._due = monotonic() + METRICS_INTERVAL

    def update(self, so_far: Callable[[], Run]) -> None:
        """Write the metrics of the run so far to norms.json if an update is due.

        Args:
            so_far: Returns the run up to the present.

        Raises:
            OSError: If the file cannot be written.
        """
        begin = monotonic()
        if begin < self._due:
            return
        run = so_far()
        # an incomplete log causes warnings; what cannot be evaluated at all is reported at the end
        with suppress(BadInput), np.errstate(all="ignore"), catch_warnings():
            simplefilter("ignore")
            write_metrics(self._path, evaluation.to_json(run, evaluation.all_metrics(run)))
        duration = monotonic() - begin
        self._due = begin + duration + max(METRICS_INTERVAL, duration / METRICS_SHARE)


class CsvFile:
    """CSV file of a recording in progress, to which rows are appended.

    The file contains whole rows at any time.
    """

    def __init__(self, path: Path) -> None:
        """Create the file.

        Args:
            path: Its path.

        Raises:
            OSError: If it cannot be written.
        """
        self._file = AppendedFile(path.open("wb", buffering=0), path)
        self._has_header = False

    def append_rows(self, rows: Recording) -> None:
        """Append the next rows of a recording to its CSV file.

        Args:
            rows: The rows that follow.

        Raises:
            OSError: If the disk is full; then none of the rows is in the file.
        """
        header = "" if self._has_header else csv_header(rows)
        self._file.append((header + csv_rows(rows)).encode())
        self._has_header = True

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._file.close()


def notes_toml(scenario: Scenario, seed: int, complete: bool, facts: Mapping[str, object]) -> str:
    """Return the text of a simulated run's recording.toml: all that a later diagnosis may know.

    Effects that the scenario adds are not part of it, since a diagnosis has to find them.

    Args:
        scenario: The scenario.
        seed: Seed of the run.
        complete: Whether the run reached its end.
        facts: Further entries for the table [facts].
    """
    notes = recording_notes(scenario)
    address = vessel_reference(scenario.vessel.file)
    lines = [f"vessel = {toml_value(address)}", f"load = {toml_value(list(notes.load))}"]
    for effect, values in notes.settings.items():
        lines += _toml_table(f"set.{toml_key(effect)}", values)
    # recording.csv has no noise: it holds the true motion
    lines += _toml_table(f"runs.{CAMERA}.noise", notes.noise)
    place = scenario.address or scenario.name
    lines += _toml_table("facts", {"scenario": place, "seed": seed, "complete": complete, **facts})
    return "\n".join(lines) + "\n"


def _toml_table(name: str, values: Mapping[str, object]) -> list[str]:
    lines = ["", f"[{name}]"]
    for key, value in values.items():
        lines.append(f"{toml_key(key)} = {toml_value(value)}")
    return lines
