"""A 15 kg catamaran on a lake: `python -m validation.real.blueboat_lake`.

The nominal is linear in surge, sway and yaw with the source's force map, the baseline the same with
damping and thrust refitted. The report is that of a diagnosis with two held-out runs. For the
figures each of the twelve runs is held out once: the missing effects are selected on eight of the
other runs and fitted on all eleven. Two errors are compared: the position after free runs of 10 s,
and dead reckoning from recorded heading and forward speed alone, before and after the heading is
corrected by the identified measurement effects.
"""

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from boatsim.diagnosis import loading, pipeline, priors
from boatsim.diagnosis.correlation_time import select_correlation_time
from boatsim.diagnosis.filter import MappedRecording, free_run_segments
from boatsim.diagnosis.fit import converge, fit
from boatsim.diagnosis.free_runs import FreeRun, free_runs, rms_errors
from boatsim.diagnosis.pipeline import Diagnosis
from boatsim.diagnosis.prior_noise import shared_noise
from boatsim.diagnosis.problem import Fit, Problem
from boatsim.diagnosis.recording_mapping import map_recording
from boatsim.diagnosis.search.ranking import select_effects
from boatsim.physics.base import Array, MeasuredMotion, Measurement
from boatsim.recordings.table import Recording
from validation.real.common import (
    by_name,
    format_fixed,
    names_of,
    print_table,
    print_verdict,
    runs_except,
    runs_named,
    runs_of,
    write_report,
)

NAME = "blueboat_lake"
VESSEL = "blueboat"
HELD_OUT = ("run_220", "run_225")
GROUPS = 3  # of four runs each; the missing effects of a group are selected on the other eight runs
GOALS = {"free runs": 0.75, "dead reckoning": 0.6}
HORIZON = 10.0  # [s] of a free run
WINDOW = 20.0  # [s] of dead reckoning
SHORTEST = 5.0  # [m] of path below which the relative error of a window has no meaning


def instruments(problem: Problem, found: Fit) -> list[Measurement]:
    """Return the measurement effects of a fit with their fitted values."""
    values: dict[str, dict[str, float]] = {}
    for f, x in zip(found.free, found.theta, strict=True):
        values.setdefault(f.effect, {})[f.name] = float(x)
    candidates = by_name(problem.program.candidates)
    fitted = []
    for name in found.effects:
        effect = candidates.get(name)
        if isinstance(effect, Measurement):
            fitted.append(type(effect)(**values.get(name, {})))
    return fitted


def corrected_heading(heading: Array, effects: Sequence[Measurement]) -> Array:
    """Return the true headings for given compass readings, by fixed-point iteration.

    Args:
        heading: (N,) readings [rad].
        effects: Measurement effects of the compass.
    """
    psi = heading.copy()
    for _ in range(8):
        psi += heading - np.array([_reading(float(x), effects) for x in psi])
    return psi


def _reading(psi: float, effects: Sequence[Measurement]) -> float:
    reading = MeasuredMotion(**dict.fromkeys(MeasuredMotion._fields, 0.0) | {"psi": psi})
    for effect in effects:
        show_as = type(effect).apply_measurement_error
        if show_as is not None:
            reading = show_as(reading, effect.values())
    return float(reading.psi)


def dead_reckoning(run: Recording, heading: Array) -> Iterator[float]:
    """Yield the error per travelled path for windows of 20 s.

    Args:
        run: A recording with the forward speed.
        heading: (N,) headings along which the speed is integrated [rad].
    """
    place = np.column_stack([run["x_m"], run["y_m"]])
    speed = run["estimate_u_mps"][:, None] * np.column_stack([np.cos(heading), np.sin(heading)])
    steps = 0.5 * (speed[1:] + speed[:-1]) * np.diff(run.t)[:, None]
    path = np.hypot(*np.diff(place, axis=0).T)
    for a, b in zip(*free_run_segments(run.t, WINDOW), strict=True):
        travelled = float(path[a:b].sum())
        if travelled >= SHORTEST:
            missed = place[b] - place[a] - steps[a:b].sum(axis=0)
            yield float(np.hypot(*missed)) / travelled


@dataclass(frozen=True)
class Fold:
    """Result of one held-out run."""

    run: str
    effects: tuple[str, ...]  # selected without it
    free_runs: Sequence[FreeRun]
    as_recorded: Sequence[float]  # dead reckoning: error per path of each window
    corrected: Sequence[float]


def leave_one_out(diagnosis: Diagnosis, runs: dict[str, Path]) -> list[Fold]:
    """Judge each run by a model selected without its group and fitted without it.

    All folds use one compiled program.
    """
    opened = [loading.open_recording(path, VESSEL, ())[0] for path in runs.values()]
    vessel, program = diagnosis.vessel, diagnosis.problem.program
    noise, rate = shared_noise(vessel, opened), priors.downsampling_rate(vessel)
    mapped = [map_recording(run.thinned(rate), program, noise) for run in opened]
    whole = dict(zip(names_of(mapped), opened, strict=True))
    # the correlation time of this fit would use the held-out runs
    ambient = replace(
        diagnosis.problem.ambient, time_constant=priors.assumed_correlation_time(vessel)
    )
    usual = Problem(mapped, ambient, diagnosis.problem.uncertainty)
    folds = []
    for i in range(GROUPS):
        group = mapped[i::GROUPS]
        rest = hold_out(usual, mapped, group)
        names = rest.program.candidate_names
        selected = select_effects(rest, names)
        again = select_correlation_time(rest, selected[1])
        if again is not rest:
            rest, selected = again, select_effects(again, names)
        for run in group:
            others = hold_out(rest, mapped, [run])
            folds.append(judge(others, selected, run, whole[run.name]))
    return sorted(folds, key=lambda fold: fold.run)


def hold_out(
    problem: Problem, runs: Sequence[MappedRecording], held_out: Sequence[MappedRecording]
) -> Problem:
    """Return the same problem for all runs except the held-out ones."""
    out = set(map(id, held_out))
    kept = [run for run in runs if id(run) not in out]
    return Problem(kept, problem.ambient, problem.uncertainty)


def judge(
    rest: Problem, selected: tuple[Fit, Fit], held_out: MappedRecording, run: Recording
) -> Fold:
    """Fit the recalibrated and the patched boat on `rest`, and judge both on the held-out run."""
    fits = {}
    for name, start in zip(("recalibrated", "patched"), selected, strict=True):
        fits[name] = converge(rest, fit(rest, start))
    runs = free_runs(rest, fits, [held_out], HORIZON)
    psi = run["psi_rad"]
    heading = corrected_heading(psi, instruments(rest, fits["patched"]))
    before, after = list(dead_reckoning(run, psi)), list(dead_reckoning(run, heading))
    return Fold(held_out.name, selected[1].effects, runs, before, after)


def print_leave_one_out(folds: Sequence[Fold]) -> None:
    """Print a row per run, all of them together with the goals, and what each fold selected."""
    chosen = Counter[str]()
    runs: list[FreeRun] = []
    before: list[float] = []
    after: list[float] = []
    for fold in folds:
        chosen.update(fold.effects)
        runs += fold.free_runs
        before += fold.as_recorded
        after += fold.corrected
    whole = Fold("all", (), runs, before, after)
    rows = []
    for fold in (*folds, whole):
        medians = _medians(fold.as_recorded, fold.corrected)
        rows.append([fold.run, *_free(fold.free_runs), *medians])
    goals = list(map("<= {}".format, GOALS.values()))
    rows.append(["goal", "", "", goals[0], "", "", goals[1]])
    header = ["held out", "retuned [m]", "corrected [m]", "ratio"]
    header += ["as recorded", "corrected", "ratio"]
    title = "each run held out once: position rms of free runs of 10 s; "
    print_table(title + "error per path of dead reckoning", header, rows)
    counts = np.array(chosen.most_common(), dtype=str).reshape(-1, 2).tolist()
    print_table("selected without the run: number of runs", ["effect", "runs"], counts)


def _free(runs: Sequence[FreeRun]) -> list[str]:
    rms = rms_errors(runs).get("position_rms_m")
    if not rms:
        return ["", "", ""]
    before, after = rms["recalibrated"], rms["patched"]
    return format_fixed(3, before, after, after / before)


def _medians(before: Sequence[float], after: Sequence[float]) -> list[str]:
    if not before:
        return ["", "", ""]
    a, b = float(np.median(before)), float(np.median(after))
    return [*format_fixed(4, a, b), f"{b / a:.3f}"]


def main() -> None:
    """Diagnose, then leave one run out."""
    runs = runs_of(NAME)
    held_out = runs_named(runs, HELD_OUT)
    fitted = runs_except(runs, HELD_OUT)
    diagnosis = pipeline.diagnose(fitted, held_out, VESSEL, horizon=HORIZON)
    write_report(diagnosis, NAME)
    print_verdict(diagnosis)
    print_leave_one_out(leave_one_out(diagnosis, runs))


if __name__ == "__main__":
    main()
