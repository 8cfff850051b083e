"""A 15 kg catamaran on a lake: `python -m validation.real.blueboat_lake`.

The nominal is linear in surge, sway and yaw with the source's force map, the baseline the same with damping and thrust
refitted. The report is of a diagnosis with two runs kept unseen. For the figures each of the twelve runs is left out
once: what is missing is chosen on eight runs of which it is none, and fitted on the other eleven. Position after free
runs of 10 s, and dead reckoning from recorded heading and recorded forward speed alone, before and after the heading is
corrected by what was found wrong with the instruments.
"""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from boatsim.diagnosis import loading, pipeline, priors
from boatsim.diagnosis.correlation_time import with_correlation_time
from boatsim.diagnosis.filter import MappedRecording, map_recording, segments, shared_noise
from boatsim.diagnosis.fit import converge, fit
from boatsim.diagnosis.free_runs import FreeRun, errors, free_runs
from boatsim.diagnosis.pipeline import Diagnosis
from boatsim.diagnosis.problem import Fit, Problem
from boatsim.diagnosis.search.ranking import selection
from boatsim.physics.base import Array, Measurement, Shown
from boatsim.recordings.table import Recording
from validation.real.common import print_verdict, report, runs_of, table

NAME, VESSEL = "blueboat_lake", "blueboat"
UNSEEN = ("run_220", "run_225")
GROUPS = 3  # of four runs each, for which what is missing is chosen on the other eight
GOALS = {"free runs": 0.75, "dead reckoning": 0.6}
HORIZON = 10.0  # [s] of a free run
WINDOW, SHORTEST = (
    20.0,
    5.0,
)  # [s] of dead reckoning; [m] of path below which a window tells nothing


def instruments(problem: Problem, found: Fit) -> list[Measurement]:
    """The measurement effects of a fit, with their fitted values."""
    kinds = {e.name: type(e) for e in problem.program.candidates if isinstance(e, Measurement)}
    values = {
        n: {f.name: float(x) for f, x in zip(found.free, found.theta, strict=True) if f.effect == n}
        for n in kinds
    }
    return [kinds[n](**values[n]) for n in found.effects if n in kinds]


def corrected(heading: Array, effects: Sequence[Measurement]) -> Array:
    """The true headings (N,) [rad] that the instruments show as `heading`, by fixed-point iteration."""
    psi = heading.copy()
    for _ in range(8):
        psi += heading - np.array([_shown(float(x), effects) for x in psi])
    return psi


def _shown(psi: float, effects: Sequence[Measurement]) -> float:
    seen = Shown(**dict.fromkeys(Shown._fields, 0.0) | {"psi": psi})
    for effect in effects:
        show_as = type(effect).shown
        if show_as is not None:
            seen = show_as(seen, effect.values())
    return float(seen.psi)


def dead_reckoning(run: Recording, heading: Array) -> list[float]:
    """Error per path travelled of windows of 20 s: heading (N,) and the recorded forward speed carried forward."""
    place = np.column_stack([run["x_m"], run["y_m"]])
    speed = run["estimate_u_mps"][:, None] * np.column_stack([np.cos(heading), np.sin(heading)])
    steps = 0.5 * (speed[1:] + speed[:-1]) * np.diff(run.t)[:, None]
    path = np.hypot(*np.diff(place, axis=0).T)
    errors = []
    for a, b in zip(*segments(run.t, WINDOW), strict=True):
        if (travelled := float(path[a:b].sum())) >= SHORTEST:
            errors.append(
                float(np.hypot(*(place[b] - place[a] - steps[a:b].sum(axis=0)))) / travelled
            )
    return errors


@dataclass(frozen=True)
class LeftOut:
    """What the fit of all other runs makes of one."""

    run: str
    effects: tuple[str, ...]  # chosen without it
    stretches: Sequence[FreeRun]
    as_recorded: Sequence[float]  # dead reckoning: error per path of each window
    corrected: Sequence[float]


def left_out(found: Diagnosis, runs: dict[str, Path]) -> list[LeftOut]:
    """Each run judged by a model chosen without its group and fitted without it; one compiled program serves all."""
    whole = [loading.open_recording(path, VESSEL, ())[0] for path in runs.values()]
    stated, rate = shared_noise(found.vessel, whole), priors.rate(found.vessel)
    tracks = [map_recording(run.thinned(rate), found.problem.program, stated) for run in whole]
    recorded = dict(zip((t.name for t in tracks), whole, strict=True))
    of_hull = replace(found.problem.ambient, time_constant=priors.time_constant(found.vessel))
    usual = Problem(
        tracks, of_hull, found.problem.uncertainty
    )  # of how long forces last a run left out tells nothing
    out = []
    for group in (tracks[i::GROUPS] for i in range(GROUPS)):
        rest = without(usual, tracks, group)
        names = rest.program.entries
        chosen = selection(rest, names)
        if (again := with_correlation_time(rest, chosen[1])) is not rest:
            rest, chosen = again, selection(again, names)
        out += [_judged(without(rest, tracks, [t]), chosen, t, recorded[t.name]) for t in group]
    return sorted(out, key=lambda one: one.run)


def without(
    problem: Problem, tracks: Sequence[MappedRecording], held_out: Sequence[MappedRecording]
) -> Problem:
    """The same question about all runs but some."""
    kept = [t for t in tracks if all(t is not u for u in held_out)]
    return Problem(kept, problem.ambient, problem.uncertainty)


def _judged(
    rest: Problem, chosen: tuple[Fit, Fit], held_out: MappedRecording, run: Recording
) -> LeftOut:
    """Coefficients of the recalibrated and the patched boat fitted on `rest`, both judged on the run left out."""
    fits = {
        name: converge(rest, fit(rest, f))
        for name, f in zip(("recalibrated", "patched"), chosen, strict=True)
    }
    stretches = free_runs(rest, fits, [held_out], HORIZON)
    heading = corrected(run["psi_rad"], instruments(rest, fits["patched"]))
    reckoned = dead_reckoning(run, run["psi_rad"]), dead_reckoning(run, heading)
    return LeftOut(held_out.name, chosen[1].effects, stretches, *reckoned)


def print_left_out(folds: Sequence[LeftOut]) -> None:
    """A row per run, then all of them pooled against the goals; what each fold chose."""
    header = [
        "left out",
        "recalibrated [m]",
        "patched [m]",
        "ratio",
        "as recorded",
        "corrected",
        "ratio",
    ]
    rows = [[f.run, *_free(f.stretches), *_medians(f.as_recorded, f.corrected)] for f in folds]
    stretches = [s for f in folds for s in f.stretches]
    before, after = (
        [e for f in folds for e in f.as_recorded],
        [e for f in folds for e in f.corrected],
    )
    rows.append(["all", *_free(stretches), *_medians(before, after)])
    rows.append(
        ["goal", "", "", f"<= {GOALS['free runs']}", "", "", f"<= {GOALS['dead reckoning']}"]
    )
    table(
        "each run left out once: position rms of free runs of 10 s; error per path of dead reckoning",
        header,
        rows,
    )
    chosen = Counter(n for f in folds for n in f.effects)
    table(
        "chosen without the run, and for how many of them",
        ["effect", "runs"],
        [[n, str(k)] for n, k in chosen.most_common()],
    )


def _free(stretches: Sequence[FreeRun]) -> list[str]:
    found = errors(stretches).get("position_rms_m")
    if not found:
        return ["", "", ""]
    before, after = found["recalibrated"], found["patched"]
    return [f"{before:.3f}", f"{after:.3f}", f"{after / before:.3f}"]


def _medians(before: Sequence[float], after: Sequence[float]) -> list[str]:
    if not before:
        return ["", "", ""]
    a, b = float(np.median(before)), float(np.median(after))
    return [f"{a:.4f}", f"{b:.4f}", f"{b / a:.3f}"]


def main() -> None:
    """Diagnose, then leave one run out."""
    runs = runs_of(NAME)
    fitted = [path for name, path in runs.items() if name not in UNSEEN]
    found = pipeline.diagnose(fitted, [runs[name] for name in UNSEEN], VESSEL, horizon=HORIZON)
    report(found, NAME)
    print_verdict(found)
    print_left_out(left_out(found, runs))


if __name__ == "__main__":
    main()
