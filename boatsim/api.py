"""boatsim for Python: load a vessel, run a scenario or many, read a recording, diagnose it, replay it.

`import boatsim` offers these functions and imports what they need when they are called. SI units, radians and SNAME
axes throughout, as in files. What can not be used raises `boatsim.errors.BadInput`, one line that says what is right.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from math import inf
from pathlib import Path
from typing import Any, NamedTuple

from boatsim.diagnosis import pipeline
from boatsim.diagnosis.config import Given, from_settings
from boatsim.diagnosis.replay import joined, replayed
from boatsim.diagnosis.report import output_files
from boatsim.diagnosis.report.schema import Answer
from boatsim.physics import vessel as vessels
from boatsim.physics.vessel import Vessel
from boatsim.progress import Report, silent
from boatsim.recordings import table
from boatsim.recordings.notes import notes_for
from boatsim.recordings.table import Recording
from boatsim.simulate.batch import Batch as Batch
from boatsim.simulate.controllers import steered
from boatsim.simulate.evaluation import Norm, NormEntry, all_norms
from boatsim.simulate.fleet import Fleet as Fleet
from boatsim.simulate.run import run as simulate
from boatsim.sweeps.axes import axis_of
from boatsim.sweeps.designs import Kind as Design
from boatsim.sweeps.execute import swept
from boatsim.sweeps.indices import Index, indices
from boatsim.sweeps.keys import Value
from boatsim.sweeps.plan import plan
from boatsim.sweeps.results import Results
from boatsim.sweeps.sampled_keys import draw_of
from boatsim.sweeps.summary import Pair, Spread, pairs, spreads

Name = str | Path  # of something shipped, of a file, or of a folder
Names = Name | Sequence[Name]  # one or several


@dataclass(frozen=True)
class Run:
    """What a run left."""

    scenario: str
    seed: int
    complete: bool  # whether it ran to its end
    recording: Recording  # the truth at every step: t, signals by column, `recording["psi_rad"]`
    camera: Recording | None  # what a camera above saw; None of a hull that it does not see move
    norms: Mapping[str, Norm]  # by name: value, unit, guard, ok, lacking, ...
    folder: Path | None = None  # of its files, where they were asked for

    @property
    def ok(self) -> bool:
        """Whether every guard is met."""
        return all(norm.ok is not False for norm in self.norms.values())


class Parameter(NamedTuple):
    """A parameter that was found, with its standard deviation."""

    value: float
    sd: float


@dataclass(frozen=True)
class Diagnosis:
    """What a vessel leaves out of recordings; `found` is all of it, curves too."""

    found: pipeline.Diagnosis

    @property
    def answer(self) -> Answer:
        """Exactly what diagnosis.json holds."""
        return self.found.findings.answer

    @property
    def verdict(self) -> str:
        """One of named, ambiguous, described, unknown and nothing_missing."""
        return self.answer["verdict"]

    @property
    def sentence(self) -> str:
        """The verdict in words, with the figures."""
        return self.answer["sentence"]

    @property
    def names(self) -> tuple[str, ...]:
        """Entries of the library that were named, the surest first."""
        return tuple(effect["name"] for effect in self.answer["effects"])

    @property
    def parameters(self) -> dict[str, dict[str, Parameter]]:
        """Parameters of what was named: entry -> name -> value and standard deviation, in the parameter's unit."""
        return {
            effect["name"]: {
                k: Parameter(p["value"], p["sd"]) for k, p in effect["parameters"].items()
            }
            for effect in self.answer["effects"]
        }

    @property
    def skill(self) -> dict[str, float]:
        """How much of the error on unseen data the patch takes away, of "position", "heading", "roll" what there is.

        1 - rms of the patched boat / rms of the same boat with but its own coefficients refitted: 0 gains nothing.
        """
        fit = self.answer["fit"]
        position, heading, roll = (
            fit.get("position_rms_m"),
            fit.get("heading_rms_rad"),
            fit.get("roll_rms_rad"),
        )
        by_name = {"position": position, "heading": heading, "roll": roll}
        return {
            name: 1.0 - rms["patched"] / rms["recalibrated"] for name, rms in by_name.items() if rms
        }

    def write(self, folder: Name) -> None:
        """All files of `boatsim diagnose`: report.html, report.md, diagnosis.json, patched.toml, diagnosis.rrd."""
        output_files.write(self.found, Path(folder))


@dataclass(frozen=True)
class Sweep:
    """Many runs; `found` is all of them, with their plan."""

    found: Results
    complete: bool  # whether all runs of the plan are done
    folder: Path  # of sweep.parquet and report.html

    @property
    def columns(self) -> dict[str, Sequence[Any]]:
        """Columns of sweep.parquet, a row each run: what was varied and drawn, norms, None where there is none."""
        return self.found.columns()

    @property
    def spreads(self) -> list[Spread]:
        """Mean and quantiles of each norm at each point of the grid."""
        return spreads(self.found)

    @property
    def pairs(self) -> list[Pair]:
        """Controllers on the same draws, where `controller.use` was varied."""
        return pairs(self.found)

    @property
    def indices(self) -> list[Index]:
        """Sobol indices, where the design was "sobol"."""
        return indices(self.found)

    @property
    def failures(self) -> dict[str, int]:
        """Why runs failed, and how many of each."""
        return self.found.reasons


def load_vessel(name: Name, load: Names = ()) -> Vessel:
    """A vessel by name, folder or file, in load conditions. Raises BadInput.

    >>> import boatsim
    >>> boat = boatsim.load_vessel("joystick_boat", ["heavy"])
    >>> boat.freedoms, boat.length
    (('surge', 'sway', 'yaw'), 1.25)
    """
    return vessels.load(str(name), _names(load))


def run(
    scenario: Name, seed: int | None = None, controller: Name | None = None, out: Name | None = None
) -> Run:
    """Run a scenario by name or file, steered by its own controller or another; `out` is a folder for the files.

    An interruption ends the run and keeps what was reached. Raises BadInput or BadPhysics.

    >>> import boatsim
    >>> done = boatsim.run("joystick_boat/sway_1", out="out/sway_1")
    >>> rms = done.norms["yaw_rate_rms"]
    >>> f"{rms.value:.2f} {rms.unit}", done.ok
    ('0.18 deg/s', True)
    >>> float(done.recording["y_m"][-1]) > 0.9  # [m] to starboard
    True
    """
    told = steered(str(scenario), None if controller is None else str(controller))
    if out is None:
        done = simulate(told, seed)
        filmed = done.camera if "yaw" in told.vessel.dof else None
        return Run(told.name, done.seed, done.complete, done.recording, filmed, all_norms(done))
    from boatsim.view.outputs import CAMERA, run_into  # rerun takes half a second

    folder = Path(out)
    content = run_into(folder, told, seed)
    film = folder / f"{CAMERA}.csv"
    return Run(
        told.name,
        content["seed"],
        content["complete"],
        table.read(folder / "recording.csv"),
        table.read(film) if film.is_file() else None,
        {name: _norm(entry) for name, entry in content["norms"].items()},
        folder,
    )


def _norm(entry: NormEntry) -> Norm:
    """A norm of norms.json."""
    said = {f.name: entry[f.name] for f in fields(Norm)}  # type: ignore[literal-required]
    if guard := entry["guard"]:
        said["guard"] = tuple(
            end if end is not None else (-inf, inf)[i] for i, end in enumerate(guard)
        )
    return Norm(**said)


def read(path: Name, vessel: Name | None = None, load: Names = ()) -> Recording:
    """A recording (.csv, .parquet, an .rrd of ours), checked, with what its recording.toml says. Raises BadInput.

    >>> import boatsim
    >>> done = boatsim.run("joystick_boat/sway_1", out="out/sway_1")
    >>> log = boatsim.read("out/sway_1/camera.csv")
    >>> log.notes.vessel, log.unit("psi_rad")
    ('joystick_boat', 'rad')
    """
    file = Path(path)
    if vessel is None and not notes_for(file).notes.vessel:
        return table.read(file)
    return pipeline.open_recording(file, None if vessel is None else str(vessel), _names(load))[0]


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
    """Say which physics a vessel leaves out of recordings: files that are fitted, and files to judge the result on.

    Without a `vessel` it is the one of the recordings' recording.toml. `library` and `without` are entries to try too
    and not to try, `horizon` is the length [s] of the free runs by which it is judged, `settings` change the
    configuration (`boatsim.diagnosis.config`), such as {"select.odds": 3.0}. Raises BadInput.

    >>> import boatsim
    >>> done = boatsim.run("joystick_boat/sway_1_as_published", out="out/published")
    >>> found = boatsim.diagnose("out/published/camera.csv")
    >>> found.verdict, found.names
    ('named', ('weak_reverse',))
    >>> value, sd = found.parameters["weak_reverse"]["astern_factor"]
    >>> abs(value - 0.694) < 2 * sd  # which the scenario added to the vessel
    True
    >>> found.skill["position"] > 0.9
    True
    >>> found.write("out/diagnosis")
    """
    name = None if vessel is None else str(vessel)
    tried = _names(library), _names(without)
    return Diagnosis(
        pipeline.diagnose(
            _paths(runs),
            _paths(hold_out),
            name,
            _names(load),
            *tried,
            horizon,
            config=from_settings(settings or {}),
        )
    )


def replay(
    recording: Name, vessel: Name | None = None, load: Names = (), horizon: float = 6.0
) -> Recording:
    """Free runs of a vessel, each of `horizon` [s] from a recorded state with the recorded commands alone.

    The result has the pose at the times of the recording, and the number of each free run in `segment`. `vessel` may be
    a patched.toml. Raises BadInput.

    >>> import boatsim
    >>> done = boatsim.run("joystick_boat/sway_1_as_published", out="out/published")
    >>> as_written = boatsim.replay("out/published/camera.csv")
    >>> sorted(as_written.signals)
    ['psi_rad', 'segment', 'x_m', 'y_m']
    """
    opened, boat = pipeline.open_recording(
        Path(recording), None if vessel is None else str(vessel), _names(load)
    )
    return joined(replayed(opened, boat, horizon))


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
    report: Report = silent,
) -> Sweep:
    """Run scenarios at every point of a grid, with the same draws at each; goes on where one was left in `out`.

    `vary` is a key and its values, or "LOW:HIGH:COUNT", `draw` a key and a distribution; `norms` are those told and
    drawn, all if there are none. A script that has more than one of the `jobs` needs `if __name__ == "__main__":`.
    Raises BadInput.

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
    axes = [
        axis_of(key, values if isinstance(values, str) else list(values))
        for key, values in (vary or {}).items()
    ]
    draws = [draw_of(key, law) for key, law in (draw or {}).items()]
    made = plan(_names(scenarios), axes, draws, runs, seed, design)
    return Sweep(*swept(made, Path(out), jobs, ray, _names(norms), report), Path(out))


def _paths(given: Names) -> list[Path]:
    return [Path(one) for one in _names(given)]


def _names(given: Names) -> list[str]:
    return [str(given)] if isinstance(given, str | Path) else [str(one) for one in given]
