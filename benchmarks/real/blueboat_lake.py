"""A 15 kg catamaran on a lake: `python -m benchmarks.real.blueboat_lake`.

The nominal is linear in surge, sway and yaw with the source's force map, the baseline the same with damping and thrust
refitted. What is missing is chosen with two runs kept unseen; then each of the twelve runs is left out once, with the
choice kept and every coefficient refitted on the other eleven. Two figures: position after free runs of 10 s, and dead
reckoning from recorded heading and recorded forward speed alone, before and after the heading is corrected by what was
found wrong with the instruments.
"""

from collections.abc import Iterable, Sequence
from pathlib import Path

import numpy as np

from benchmarks.real.common import report, runs_of, table
from boatsim.base import Array, Measurement, Shown
from boatsim.diagnose import analysis, show
from boatsim.diagnose.analysis import Diagnosis
from boatsim.diagnose.filter import segments, stated_noise, track
from boatsim.diagnose.findings import FreeRun
from boatsim.diagnose.fit import converge, fit
from boatsim.diagnose.problem import Fit, Problem
from boatsim.recording import Recording

NAME, VESSEL = "blueboat_lake", "blueboat"
UNSEEN = ("run_220", "run_225")
GOALS = {"free runs": 0.75, "dead reckoning": 0.6}
WINDOW, SHORTEST = 20.0, 5.0  # [s] of dead reckoning; [m] of path below which a window tells nothing


def instruments(problem: Problem, found: Fit) -> list[Measurement]:
    """The measurement effects of a fit, with their fitted values."""
    kinds = {e.name(): type(e) for e in problem.program.suspects if isinstance(e, Measurement)}
    values = {
        n: {f.name: float(x) for f, x in zip(found.free, found.theta, strict=True) if f.effect == n} for n in kinds
    }
    return [kinds[n](**values[n]) for n in found.suspects if n in kinds]


def corrected(heading: Array, effects: Sequence[Measurement]) -> Array:
    """The true headings (N,) [rad] that the instruments show as `heading`, by fixed-point iteration."""
    psi = heading.copy()
    for _ in range(8):
        psi += heading - np.array([_shown(float(x), effects) for x in psi])
    return psi


def _shown(psi: float, effects: Sequence[Measurement]) -> float:
    seen = Shown(0.0, 0.0, psi, 0.0, 0.0, 0.0, 0.0, 0.0)
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
            errors.append(float(np.hypot(*(place[b] - place[a] - steps[a:b].sum(axis=0)))) / travelled)
    return errors


def left_out(found: Diagnosis, runs: dict[str, Path]) -> tuple[list[FreeRun], list[list[list[float]]]]:
    """Free runs over every run by fits that did not see it, and its dead reckoning before and after correction."""
    whole = [analysis.open_recording(path, VESSEL, ())[0] for path in runs.values()]
    stated, rate = stated_noise(found.vessel, whole[0]), found.vessel.diagnosis.rate
    tracks = [track(run.thinned(rate), found.problem.program, stated) for run in whole]
    stretches, reckoned = [], []
    for unseen, run in zip(tracks, whole, strict=True):
        rest = Problem([t for t in tracks if t is not unseen], found.problem.ambient, found.problem.uncertainty)
        starts = {"recalibrated": found.ranking.recalibrated, "patched": found.ranking.best}
        fits = {name: converge(rest, fit(rest, start)) for name, start in starts.items()}
        stretches += show.free_runs(rest, fits, [unseen], found.vessel.diagnosis.horizon)
        heading = corrected(run["psi_rad"], instruments(rest, fits["patched"]))
        reckoned.append([dead_reckoning(run, run["psi_rad"]), dead_reckoning(run, heading)])
    return stretches, reckoned


def print_left_out(stretches: Sequence[FreeRun], reckoned: Sequence[list[list[float]]], names: Sequence[str]) -> None:
    """A row per run, then all of them pooled against the goals."""
    header = ["left out", "recalibrated [m]", "patched [m]", "ratio", "as recorded", "corrected", "ratio"]
    rows = [
        [name, *_free(s for s in stretches if s.run == name), *_medians(*both)]
        for name, both in zip(names, reckoned, strict=True)
    ]
    pooled = [sum((both[i] for both in reckoned), []) for i in (0, 1)]
    rows.append(["all", *_free(stretches), *_medians(*pooled)])
    rows.append(["goal", "", "", f"<= {GOALS['free runs']}", "", "", f"<= {GOALS['dead reckoning']}"])
    table("each run left out once: position rms of free runs of 10 s; error per path of dead reckoning", header, rows)


def _free(stretches: Iterable[FreeRun]) -> list[str]:
    found = show.errors(list(stretches)).get("position_rms_m")
    if not found:
        return ["", "", ""]
    before, after = found["recalibrated"], found["patched"]
    return [f"{before:.3f}", f"{after:.3f}", f"{after / before:.3f}"]


def _medians(before: Sequence[float], after: Sequence[float]) -> list[str]:
    if not before:
        return ["", "", ""]
    a, b = float(np.median(before)), float(np.median(after))
    return [f"{a:.4f}", f"{b:.4f}", f"{b / a:.3f}"]


def print_verdict(found: Diagnosis) -> None:
    """Physics and measurement apart, in order of gain, with parameters."""
    for kind, words in (("physics", "left out of the boat"), ("measurement", "wrong with the instruments")):
        print(f"\n{words}:")
        effects = [e for e in found.findings.answer["effects"] if e["kind"] == kind]
        for e in sorted(effects, key=lambda e: -e["gain_nats"]):
            values = ", ".join(f"{k} {p['value']:.3g} +- {p['sd']:.2g}" for k, p in e["parameters"].items())
            tied = f"; hardly to be told from {', '.join(e['tied_with'])}" if e["tied_with"] else ""
            print(f"  {e['name']} ({e['gain_nats']:.0f} nats): {values}{tied}")
        if not effects:
            print("  nothing found")


def main() -> None:
    """Diagnose, then leave one run out."""
    runs = runs_of(NAME)
    fitted = [path for name, path in runs.items() if name not in UNSEEN]
    found = analysis.diagnose(fitted, [runs[name] for name in UNSEEN], VESSEL)
    report(found, NAME)
    print_verdict(found)
    print_left_out(*left_out(found, runs), list(runs))


if __name__ == "__main__":
    main()
