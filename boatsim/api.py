"""Python interface: vessels, scenarios, runs, recordings, diagnoses, replays and sweeps.

Everything is available as `boatsim.NAME` and imported at first use. Units are SI and radians, axes
are SNAME, as in files. Input that cannot be used raises `boatsim.errors.BadInput` with a message
of one line, an argument of a wrong type a `TypeError` with its name.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple, get_args

from boatsim.arguments import (
    check_instance,
    checked_choice,
    checked_integer,
    checked_mapping,
    checked_name,
    checked_names,
    checked_number,
    optional_name,
    type_error,
)
from boatsim.control.linear_model import LinearModel as LinearModel
from boatsim.diagnosis import pipeline
from boatsim.diagnosis.answer.schema import Answer
from boatsim.diagnosis.checks.data_cleaning import drop_faulty_values
from boatsim.diagnosis.config import Given, from_settings
from boatsim.diagnosis.free_runs import FreeRun
from boatsim.diagnosis.loading import open_recording, open_recording_parts
from boatsim.diagnosis.output.files import write_diagnosis
from boatsim.diagnosis.output.what_if import collect_what_if
from boatsim.diagnosis.replay import join_free_runs, replay_recording
from boatsim.diagnosis.report.notebook_views import (
    diagnosis_figure,
    diagnosis_html,
    parameter_table,
)
from boatsim.errors import BadInput
from boatsim.physics import vessel as vessels
from boatsim.physics.vessel import Body as Body
from boatsim.physics.vessel import CommandChannel as CommandChannel
from boatsim.physics.vessel import Vessel as Vessel
from boatsim.physics.vessel.wave_field import wave_field as effects_wave_field
from boatsim.physics.waves.field import WaveField as WaveField
from boatsim.progress import Report, ignore_progress
from boatsim.recordings import table
from boatsim.recordings.exporting.mcap import write_mcap
from boatsim.recordings.notebook.data_frame import data_frame
from boatsim.recordings.notes import notes_for
from boatsim.recordings.run_folder import recording_file
from boatsim.recordings.table import Recording as Recording
from boatsim.simulate.batch import Batch as Batch
from boatsim.simulate.controllers import load_with_controller
from boatsim.simulate.evaluation import Metric, all_metrics
from boatsim.simulate.fleet import Fleet as Fleet
from boatsim.simulate.linearisation import linear_model
from boatsim.simulate.run import run as simulate
from boatsim.simulate.run_files import run_into_folder
from boatsim.simulate.run_options import RunOptions
from boatsim.simulate.run_summary import run_html
from boatsim.simulate.scenario import Scenario as Scenario
from boatsim.simulate.steady_motion import find_steady_motion
from boatsim.sweeps.axes import make_axis
from boatsim.sweeps.designs import Design
from boatsim.sweeps.execute import run_plan
from boatsim.sweeps.indices import Index, sensitivity_indices
from boatsim.sweeps.keys import Value
from boatsim.sweeps.plan import MOST_RUNS, make_plan
from boatsim.sweeps.results import Results
from boatsim.sweeps.sampled_keys import make_sampled_key
from boatsim.sweeps.summary import Pair, Spread, compare_controllers, metric_statistics
from boatsim.webassembly.compiler import find_compiler

if TYPE_CHECKING:
    import pandas as pd
    import pyarrow as pa
    from matplotlib.figure import Figure

LONGEST_HORIZON = 86400.0  # [s] of a free run, as of a scenario
LONGEST_SAMPLE_TIME = 3600.0  # [s] of a discrete model
FASTEST = 300.0  # [m/s] speed of a steady motion; more is a mistake
MOST_JOBS = 10_000  # processes of a sweep; more is a mistake
# Name of shipped content, or path of a file or folder
Name = str | Path
Names = Name | Sequence[Name]


@dataclass(frozen=True)
class Run:
    """The results of a run of a scenario.

    Attributes:
        scenario: Name of the scenario.
        seed: Seed of sensor noise and random effects.
        complete: Whether the run reached its end.
        recording: True signals at every step; `recording["psi_rad"]` is a signal.
        camera: Poses measured by an overhead camera; None for a vessel that does not yaw.
        metrics: Name -> metric with value, unit and regression band.
        folder: Folder of the files; None where none were written.
    """

    scenario: str
    seed: int
    complete: bool
    recording: Recording
    camera: Recording | None
    metrics: Mapping[str, Metric]
    folder: Path | None = None

    @property
    def ok(self) -> bool:
        """Whether every metric of the run lies within its regression band."""
        return all(metric.ok is not False for metric in self.metrics.values())

    def __repr__(self) -> str:
        """Scenario, seed and size; the values would fill pages."""
        size = f"{len(self.recording)} rows, {len(self.metrics)} metrics"
        return f"<Run of {self.scenario}, seed {self.seed}: {size}>"

    def to_arrow(self) -> "pa.Table":
        """Return the true signals as a table of Arrow, `t_s` first, in SI units and radians.

        The metadata has scenario and seed; that of each column has its `unit`.
        """
        signals = self.recording.to_arrow()
        about = {"scenario": self.scenario, "seed": str(self.seed)}
        return signals.replace_schema_metadata({**signals.schema.metadata, **about})

    def __arrow_c_stream__(self, requested_schema: object = None) -> object:
        """Return the true signals as a stream of Arrow, so that `pyarrow.table(run)` works.

        Args:
            requested_schema: Capsule of the schema that the reader prefers.
        """
        return self.to_arrow().__arrow_c_stream__(requested_schema)

    def to_pandas(self) -> "pd.DataFrame":
        """Return the true signals as a data frame of pandas, in SI units and radians.

        `attrs` has scenario and seed, and in `attrs["units"]` the unit of each column.

        Raises:
            BadInput: If pandas is not installed.
        """
        return data_frame(self.to_arrow())

    def plot(self, signals: str | Sequence[str] = ()) -> "Figure":
        """Draw the track seen from above, and signals over time, with angles in degrees.

        Args:
            signals: One or several signals to draw over time; by default attitude, rates and
                commands.

        Returns:
            A figure of matplotlib.

        Raises:
            BadInput: If a signal does not exist, or matplotlib is not installed.
        """
        return self.recording.plot(signals)

    def _repr_html_(self) -> str:
        """Return a replay seen from above and the metrics, for a notebook."""
        summary = run_html(self.scenario, self.seed, self.complete, self.metrics)
        return self.recording._repr_html_() + summary


class Parameter(NamedTuple):
    """A parameter of an effect, identified from recordings by a diagnosis.

    Attributes:
        value: Estimate, in the parameter's unit.
        sd: Standard deviation of the estimate.
    """

    value: float
    sd: float


@dataclass(frozen=True)
class Diagnosis:
    """Result of a diagnosis: the physics that a vessel's model lacks, identified from recordings.

    Attributes:
        result: All results of the stages of the diagnosis, with the curves of the report.
    """

    result: pipeline.Diagnosis

    @property
    def answer(self) -> Answer:
        """Content of diagnosis.json, the result of the diagnosis."""
        return self.result.findings.answer

    @property
    def verdict(self) -> str:
        """Verdict of the diagnosis.

        It is "named", "ambiguous", "described", "unknown" or "nothing_missing".
        """
        return self.answer["verdict"]

    @property
    def sentence(self) -> str:
        """Verdict of the diagnosis in words, with its numbers."""
        return self.answer["sentence"]

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the effects that the diagnosis identified, the most certain first."""
        return tuple(effect["name"] for effect in self.answer["effects"])

    @property
    def parameters(self) -> dict[str, dict[str, Parameter]]:
        """Parameters of the effects that the diagnosis identified.

        They are nested: effect -> parameter -> value and standard deviation.
        """
        found: dict[str, dict[str, Parameter]] = {}
        for effect in self.answer["effects"]:
            parameters: dict[str, Parameter] = {}
            for name, entry in effect["parameters"].items():
                parameters[name] = Parameter(entry["value"], entry["sd"])
            found[effect["name"]] = parameters
        return found

    @property
    def skill(self) -> dict[str, float]:
        """Reduction of the simulation error on held-out data by the diagnosis.

        The keys are "position", "heading", "roll" and "heave". It is 1 - rms of the corrected
        vessel / rms of the retuned one: 0 is no improvement, 1 a perfect model.
        """
        fit = self.answer["fit"]
        errors = {
            "position": fit.get("position_rms_m"),
            "heading": fit.get("heading_rms_rad"),
            "roll": fit.get("roll_rms_rad"),
            "heave": fit.get("heave_rms_m"),
        }
        skill: dict[str, float] = {}
        for name, rms in errors.items():
            if rms:
                skill[name] = 1.0 - rms["patched"] / rms["recalibrated"]
        return skill

    def write(self, folder: Name, what_if: bool = False) -> None:
        """Write the results of the diagnosis to files in a folder.

        They are report.html, report.md, diagnosis.json, patched.toml and diagnosis.rrd.

        Args:
            folder: Folder of the files; it is created if needed.
            what_if: Whether report.html repeats free runs in the browser while sliders move, which
                needs a compiler for WebAssembly, such as that of `boatsim[wasm]`.

        Raises:
            BadInput: There is no such compiler, or a law has no C form; nothing is written.
        """
        section = None
        if what_if:
            section = collect_what_if(self.result, find_compiler())
        write_diagnosis(self.result, Path(checked_name("folder", folder)), section)

    def __repr__(self) -> str:
        """Verdict and sentence; all results would fill pages."""
        return f"<Diagnosis, {self.verdict}: {self.sentence}>"

    def to_arrow(self) -> "pa.Table":
        """Return the parameters of the identified effects as a table of Arrow, one row for each.

        The columns are effect, parameter, value, sd, unit, at_bound, probability,
        log_bayes_factor_nats and confirmed. The metadata has verdict and sentence.
        """
        return parameter_table(self.answer)

    def __arrow_c_stream__(self, requested_schema: object = None) -> object:
        """Return the parameters as a stream of Arrow, so that `pyarrow.table(diagnosis)` works.

        Args:
            requested_schema: Capsule of the schema that the reader prefers.
        """
        return self.to_arrow().__arrow_c_stream__(requested_schema)

    def to_pandas(self) -> "pd.DataFrame":
        """Return the parameters of the identified effects as a data frame of pandas.

        `attrs` has the verdict and the sentence.

        Raises:
            BadInput: If pandas is not installed.
        """
        return data_frame(self.to_arrow())

    def plot(self) -> "Figure":
        """Draw a held-out recording with the simulations of the vessel before, retuned, corrected.

        Returns:
            A figure of matplotlib.

        Raises:
            BadInput: If no recording was held out, or matplotlib is not installed.
        """
        return diagnosis_figure(self.result.findings)

    def _repr_html_(self) -> str:
        """Return the sentence, the parameters and a replay of held-out data, for a notebook."""
        return diagnosis_html(self.result.findings)


@dataclass(frozen=True)
class Sweep:
    """The results of a sweep: runs over a parameter grid and random samples.

    Attributes:
        results: All runs, with their plan.
        complete: Whether all runs of the plan are done.
        folder: Folder of sweep.parquet and report.html.
    """

    results: Results
    complete: bool
    folder: Path

    @property
    def columns(self) -> dict[str, Sequence[Any]]:
        """Columns of the sweep's table, sweep.parquet, with one row per run.

        They are varied and sampled keys, and metrics; None where a value is missing.
        """
        return self.results.columns()

    @property
    def spreads(self) -> list[Spread]:
        """Mean and quantiles of each metric at each point of the sweep's parameter grid."""
        return metric_statistics(self.results)

    @property
    def pairs(self) -> list[Pair]:
        """Comparison of controllers on the same samples, where `controller.use` was varied."""
        return compare_controllers(self.results)

    @property
    def indices(self) -> list[Index]:
        """Sobol sensitivity indices of the metrics, where the design of the sweep was "sobol"."""
        return sensitivity_indices(self.results)

    @property
    def failures(self) -> dict[str, int]:
        """Reasons for which runs of the sweep failed -> number of runs."""
        return self.results.failure_counts


def load_vessel(name: Name, load: Names = ()) -> Vessel:
    """Load a vessel by its name or from its file.

    Args:
        name: Name of a shipped vessel, its folder or its file.
        load: Load conditions in force.

    Returns:
        The vessel with its effects.

    Raises:
        BadInput: If the vessel or a load condition does not exist, or the file has a mistake.

    >>> import boatsim
    >>> vessel = boatsim.load_vessel("joystick_boat", ["heavy"])
    >>> vessel.dof, vessel.length
    (('surge', 'sway', 'yaw'), 1.25)
    """
    return vessels.load_vessel(checked_name("name", name), checked_names("load", load))


def load_scenario(
    name: Name,
    vessel: Vessel | None = None,
    controller: Name | None = None,
    **changes: object,
) -> Scenario:
    """Load a scenario, as `run`, `Fleet` and the environments of `boatsim.simulate.env` use it.

    Args:
        name: Name or file of a scenario, as for `boatsim run`.
        vessel: Vessel in place of the scenario's.
        controller: Name or file of a controller in place of the scenario's.
        changes: Top-level keys of the file that are replaced, such as `duration`.

    Returns:
        The scenario with its vessel and controller.

    Raises:
        BadInput: If scenario, controller and vessel do not fit each other.

    >>> import boatsim
    >>> vessel = boatsim.load_vessel("joystick_boat").with_parameters({"body": {"mass": 6.0}})
    >>> scenario = boatsim.load_scenario("joystick_boat/sway_1", vessel=vessel, duration=5.0)
    >>> scenario.vessel.body.mass, len(boatsim.run(scenario).recording.t)
    (6.0, 251)
    """
    _check_vessel(vessel)
    own = optional_name("controller", controller)
    return load_with_controller(checked_name("name", name), own, vessel, changes)


def run(
    scenario: Name | Scenario,
    seed: int | None = None,
    controller: Name | None = None,
    out: Name | None = None,
    vessel: Vessel | None = None,
) -> Run:
    """Run a scenario: simulate its vessel under its controller, and return recording and metrics.

    An interruption ends the run and keeps what was reached.

    Args:
        scenario: Name or file of a scenario, or a `Scenario`.
        seed: Seed of sensor noise and random effects; the scenario's by default.
        controller: Name or file of a controller in place of the scenario's; not for a `Scenario`.
        out: Folder for the files of the run; none are written by default.
        vessel: Vessel in place of the scenario's; not for a `Scenario`. With `out`, a vessel that
            differs from its file is saved in the folder `<out>_vessel`, which the recording names.

    Returns:
        The recording, the camera's recording and the metrics of the run.

    Raises:
        BadInput: If scenario, controller and vessel do not fit each other.
        BadPhysics: If the vessel cannot be simulated.

    >>> import boatsim
    >>> done = boatsim.run("joystick_boat/sway_1", out="out/sway_1")
    >>> rms = done.metrics["yaw_rate_rms"]
    >>> f"{rms.value:.2f} {rms.unit}", done.ok
    ('0.20 deg/s', True)
    >>> float(done.recording["y_m"][-1]) > 0.9  # [m] to starboard
    True
    """
    _check_vessel(vessel)
    out = optional_name("out", out)
    if seed is not None:
        seed = checked_integer("seed", seed)
    if out is not None and vessel is not None and not _matches_its_file(vessel):
        vessel = vessel.save(f"{out}_vessel")
    loaded = _resolve_scenario(scenario, controller, vessel)
    folder = None
    if out is None:
        done = simulate(loaded, seed)
        metrics: Mapping[str, Metric] = all_metrics(done)
    else:
        from boatsim.view.run_observers import (  # rerun takes half a second
            page_observer,
            rerun_observers,
        )
        from boatsim.view.run_page import run_command

        folder = Path(out)
        options = RunOptions(seed=seed)
        command = ""
        if vessel is None and loaded.address:
            chosen = None if controller is None else str(controller)
            command = run_command(loaded.address, chosen, seed)
        observers = [*rerun_observers(), page_observer(loaded, command)]
        done, metrics = run_into_folder(folder, loaded, options, observers, in_memory=True)
    camera = None
    if "yaw" in loaded.vessel.dof:
        camera = done.camera
    return Run(loaded.name, done.seed, done.complete, done.recording, camera, metrics, folder)


def _matches_its_file(vessel: Vessel) -> bool:
    """Whether loading the vessel's file again gives the same vessel."""
    if not vessel.file.is_file():
        return False
    return vessels.load_vessel(str(vessel.file), vessel.load) == vessel


def _resolve_scenario(
    given: Name | Scenario, controller: Name | None, vessel: Vessel | None
) -> Scenario:
    """The scenario of a name with another controller or vessel, or the given `Scenario`."""
    if not isinstance(given, Scenario):
        if not isinstance(given, Name):
            raise type_error("scenario", given, "a name, a path or a Scenario")
        name, own = checked_name("scenario", given), optional_name("controller", controller)
        return load_with_controller(name, own, vessel)
    if controller is not None or vessel is not None:
        raise BadInput(
            f"{given.name}: controller and vessel are allowed with the name of a scenario only; "
            "a Scenario has its own"
        )
    return given


def read(path: Name, vessel: Name | None = None, load: Names = ()) -> Recording:
    """Read and check a recording from a file, with the notes of its recording.toml.

    Args:
        path: A .csv, .parquet or .rrd file.
        vessel: Name or file of the vessel; that of the recording.toml by default.
        load: Load conditions of the vessel.

    Returns:
        The recording in SI units, with the names of boatsim's columns.

    Raises:
        BadInput: One line with file, row and column of what cannot be used.

    >>> import boatsim
    >>> done = boatsim.run("joystick_boat/sway_1", out="out/sway_1")
    >>> log = boatsim.read("out/sway_1/camera.csv")
    >>> log.notes.vessel, log.unit("psi_rad")
    ('joystick_boat', 'rad')
    """
    file = Path(checked_name("path", path))
    own, loads = optional_name("vessel", vessel), checked_names("load", load)
    if vessel is None and not notes_for(file).notes.vessel:
        return table.read(file)
    recording, _ = open_recording(file, own, loads)
    return recording


def export(recording: Name | Recording | Run, path: Name) -> int:
    """Write a recording to an MCAP file, which Foxglove, PlotJuggler and ROS 2 open.

    Pose, twist and transform are standard messages in the axes of ROS (x east, y north, z up; hull
    x forward, y port); commands and all other signals are numbers in SI units and SNAME axes.

    Args:
        recording: A recording, its file, the folder of a run, or a `Run`, of which the true motion
            is written.
        path: The .mcap file.

    Returns:
        Number of messages.

    Raises:
        BadInput: If the recording cannot be read, or `mcap` and `rosbags` are not installed.

    >>> import boatsim
    >>> done = boatsim.run("joystick_boat/sway_1")
    >>> boatsim.export(done, "out/sway_1.mcap") > 10 * len(done.recording)
    True
    """
    if isinstance(recording, Run):
        recording = recording.recording
    file = Path(checked_name("path", path))
    if not isinstance(recording, Recording):
        recording = read(recording_file(Path(checked_name("recording", recording))))
    return write_mcap(recording, file)


def diagnose(
    runs: Names,
    hold_out: Names = (),
    vessel: Name | None = None,
    load: Names = (),
    library: Names = (),
    without: Names = (),
    horizon: float | None = None,
    settings: Mapping[str, Given] | None = None,
) -> Diagnosis:
    """Identify the physical effects that the model of a vessel lacks, from recordings.

    Args:
        runs: Recordings that are fitted.
        hold_out: Recordings that are held out to judge the result; by default a part of `runs`.
        vessel: Name or file of the vessel; that of the recordings' recording.toml by default.
        load: Load conditions of the vessel.
        library: Candidate effects to test in addition to the usual ones.
        without: Candidate effects not to test.
        horizon: Length of the free runs by which the result is judged [s].
        settings: Dotted name of a setting of `boatsim.diagnosis.config`, such as "select.odds" ->
            value.

    Returns:
        The identified effects, their parameters and the errors on held-out data.

    Raises:
        BadInput: If a recording, name or setting cannot be used.

    >>> import boatsim
    >>> done = boatsim.run("joystick_boat/sway_1_as_published", out="out/published")
    >>> found = boatsim.diagnose("out/published/camera.csv")
    >>> found.verdict, found.names
    ('named', ('weak_reverse',))
    >>> value, sd = found.parameters["weak_reverse"]["astern_factor"]
    >>> abs(value - 0.694) < 2 * sd  # the value in the scenario
    True
    >>> found.skill["position"] > 0.9
    True
    >>> found.write("out/diagnosis")
    """
    if horizon is not None:
        horizon = _checked_horizon(horizon)
    changed: Mapping[str, Any] = {}
    if settings is not None:
        changed = checked_mapping("settings", settings)
    return Diagnosis(
        pipeline.diagnose(
            runs=_path_list("runs", runs),
            hold_out=_path_list("hold_out", hold_out),
            vessel=optional_name("vessel", vessel),
            load=checked_names("load", load),
            library=checked_names("library", library),
            without=checked_names("without", without),
            horizon=horizon,
            config=from_settings(changed),
        )
    )


def replay(
    recording: Name, vessel: Name | None = None, load: Names = (), horizon: float = 6.0
) -> Recording:
    """Simulate free runs of a vessel, each from a recorded state with the recorded commands.

    Args:
        recording: File of the recording.
        vessel: Name or file of the vessel, such as a patched.toml; that of the recording.toml by
            default.
        load: Load conditions of the vessel.
        horizon: Length of a free run [s].

    Returns:
        The simulated pose at the times of the recording; the signal `segment` is the number of the
        free run.

    Raises:
        BadInput: If the recording or the vessel cannot be used.

    >>> import boatsim
    >>> done = boatsim.run("joystick_boat/sway_1_as_published", out="out/published")
    >>> simulated = boatsim.replay("out/published/camera.csv")
    >>> sorted(simulated.signals)
    ['psi_rad', 'segment', 'x_m', 'y_m']
    """
    horizon = _checked_horizon(horizon)
    file, own = Path(checked_name("recording", recording)), optional_name("vessel", vessel)
    parts, replayed_vessel = open_recording_parts(file, own, checked_names("load", load))
    stretches: list[FreeRun] = []
    for part in parts:
        cleaned = drop_faulty_values(part, replayed_vessel)
        stretches += replay_recording(cleaned, replayed_vessel, horizon)
    return join_free_runs(stretches)


def sweep(
    scenarios: Names,
    vary: Mapping[str, str | Sequence[Value]] | None = None,
    draw: Mapping[str, str] | None = None,
    runs: int = 1,
    design: Design = "random",
    seed: int = 0,
    out: Name = "out/sweep",
    jobs: int | None = None,
    ray: str | None = None,
    norms: Names = (),
    report: Report = ignore_progress,
) -> Sweep:
    """Run scenarios at every point of a parameter grid, with equal random samples at each point.

    A sweep that was interrupted is continued in its folder.

    Args:
        scenarios: Names or files of scenarios.
        vary: Key -> its values, or "LOW:HIGH:COUNT".
        draw: Key -> its distribution, such as "normal(0.7, 0.05)".
        runs: Number of samples at each point.
        design: "random", "latin" (Latin hypercube) or "sobol" (for Sobol indices).
        seed: Seed of the samples.
        out: Folder of sweep.parquet and report.html.
        jobs: Number of processes; with more than one a script needs `if __name__ == "__main__":`.
        ray: Address of a Ray cluster on which to run.
        norms: Metrics in the report; all by default.
        report: Called with the progress.

    Returns:
        The results of all runs, with statistics of their metrics.

    Raises:
        BadInput: If a scenario, key, distribution or metric cannot be used.

    >>> import boatsim
    >>> done = boatsim.sweep(
    ...     "joystick_boat/sway_1",
    ...     vary={"controller.use": ["pid_autopilot", "l1_joystick"]},
    ...     draw={"weak_reverse.astern_factor": "normal(0.7, 0.05)"},
    ...     runs=4, out="out/sweep", jobs=1, norms="heading_at_end",
    ... )
    >>> len(done.columns["heading_at_end"]), done.failures
    (8, {})
    >>> (pair,) = done.pairs
    >>> pair.norm, pair.second, pair.pairs
    ('|heading_at_end|', 'l1_joystick', 4)
    """
    axes = []
    for key, values in checked_mapping("vary", vary or {}).items():
        axes.append(make_axis(key, _checked_values(f"vary[{key!r}]", values)))
    sampled = []
    for key, law in checked_mapping("draw", draw or {}).items():
        if not isinstance(law, str):
            raise type_error(f"draw[{key!r}]", law, 'a distribution such as "normal(0.7, 0.05)"')
        sampled.append(make_sampled_key(key, law))
    runs, seed = checked_integer("runs", runs, 1, MOST_RUNS), checked_integer("seed", seed)
    checked_choice("design", design, get_args(Design))
    if jobs is not None:
        jobs = checked_integer("jobs", jobs, 1, MOST_JOBS)
    if ray is not None:
        check_instance("ray", ray, str, "an address")
    if not callable(report):
        raise type_error("report", report, "a function")
    folder, metrics = Path(checked_name("out", out)), checked_names("norms", norms)
    plan = make_plan(checked_names("scenarios", scenarios), axes, sampled, runs, seed, design)
    return Sweep(*run_plan(plan, folder, jobs, ray, metrics, report), folder)


def wave_field(scenario: Name | Scenario, seed: int | None = None) -> WaveField:
    """Return the waves of a scenario, whose elevation is known at any place and time.

    They are the waves that exert the forces in a run with this seed, and whose elevation at the
    vessel is the column `wave_elevation_m` of its recording. Waves of `irregular_sea`,
    `strip_wave_loads`, `panel_wave_loads` and `hull_buoyancy` have an elevation; `wave_forcing` and
    `filtered_sea` are forces alone.

    Args:
        scenario: Name or file of a scenario, or a `Scenario`.
        seed: Seed of the random waves; the scenario's by default.

    Returns:
        The waves, none in calm water.

    Raises:
        BadInput: If the scenario cannot be used.

    >>> import boatsim
    >>> sea = boatsim.wave_field("eastward_ho/seas_30", seed=1)
    >>> len(sea), round(sea.significant_height, 2)
    (160, 1.88)
    >>> float(sea.elevation(0.0, 0.0, t=10.0)) == float(sea.elevation([0.0], 0.0, t=10.0)[0])
    True
    """
    loaded = _resolve_scenario(scenario, None, None)
    number = loaded.file.seed
    if seed is not None:
        number = checked_integer("seed", seed)
    return effects_wave_field(effect.with_seed(number) for effect in loaded.vessel.effects)


def linearise(
    vessel: Name | Vessel,
    speed: float | None = None,
    commands: Mapping[str, float] | None = None,
    load: Names = (),
    outputs: Names = (),
    position: bool = False,
    discrete: float | None = None,
) -> LinearModel:
    """Return the linear state-space model x' = A x + B u, y = C x + D u about a steady motion.

    Without a speed, commands that are not given are neutral. With a speed, those that are not given
    follow from it. The heading of the steady motion is north.

    Args:
        vessel: Name or file of a vessel, or a `Vessel`.
        speed: Speed in surge of a straight course [m/s].
        commands: Commands of the steady motion by channel.
        load: Load conditions of the vessel; not for a `Vessel`.
        outputs: States that are outputs; by default heading, attitude and velocities.
        position: Whether the position is a state also where no force depends on it.
        discrete: Sample time of a discrete model with held inputs [s]; continuous by default.

    Returns:
        The matrices with the names, units and steady values of states, inputs and outputs.
        `modes` has the eigenvalues, `state_space()` makes a `scipy.signal.StateSpace`, and
        `write(path)` writes a .json or .npz file.

    Raises:
        BadInput: If a name or value cannot be used, or there is no steady motion.

    >>> import boatsim
    >>> model = boatsim.linearise("joystick_boat", speed=0.5)
    >>> [state.name for state in model.states][:4]
    ['psi', 'u', 'v', 'r']
    >>> surge = [mode for mode in model.modes if mode.name == "surge"][0]
    >>> f"{surge.time_constant:.3f} s"
    '1.917 s'
    """
    loads = checked_names("load", load)
    if isinstance(vessel, Vessel):
        if loads:
            raise BadInput("load is allowed with the name of a vessel only; a Vessel has its own")
        loaded = vessel
    else:
        loaded = vessels.load_vessel(checked_name("vessel", vessel), loads)
    if speed is not None:
        speed = checked_number("speed", speed, -FASTEST, FASTEST, "m/s")
    given = {}
    for name, value in checked_mapping("commands", commands or {}).items():
        given[name] = checked_number(f"commands[{name!r}]", value)
    check_instance("position", position, bool, "True or False")
    if discrete is not None:
        discrete = checked_number("discrete", discrete, 1e-6, LONGEST_SAMPLE_TIME, "s")
    steady = find_steady_motion(loaded, given, speed)
    model = linear_model(loaded, steady, checked_names("outputs", outputs), position)
    if discrete is None:
        return model
    return model.discretised(discrete)


def _checked_values(argument: str, values: object) -> str | list[Any]:
    """Values along an axis of a sweep."""
    if isinstance(values, str):
        return values
    if not isinstance(values, Iterable) or isinstance(values, bytes | Mapping):
        raise type_error(argument, values, 'a list of values or "LOW:HIGH:COUNT"')
    return list(values)


def _checked_horizon(horizon: object) -> float:
    return checked_number("horizon", horizon, 1e-3, LONGEST_HORIZON, "s")


def _check_vessel(vessel: object) -> None:
    if vessel is not None:
        check_instance("vessel", vessel, Vessel, "a Vessel, such as boatsim.load_vessel returns")


def _path_list(argument: str, names: object) -> list[Path]:
    return list(map(Path, checked_names(argument, names)))
