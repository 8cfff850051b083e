"""What the standard MMG model of a tanker leaves out: `python -m validation.real.kvlcc2_mmg [hsva] [marin]`.

The nominal is the published model with the derivatives of captive tests in another tank, the baseline the same with
them, a_H, gamma_R and the gains of propeller and rudder refitted. The free-running tests and the unseen runs are those
of kvlcc2_hsva_zigzag (7 m model) and kvlcc2_marin_free (full-scale values), read there for a linear model.
"""

import sys
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from boatsim.diagnosis import loading, pipeline, priors
from boatsim.diagnosis.checks.position_outliers import drop_position_outliers
from boatsim.diagnosis.evaluation import MODELS, models
from boatsim.diagnosis.filter import MappedRecording
from boatsim.diagnosis.fit import converge, gauss_newton
from boatsim.diagnosis.free_runs import errors, free_runs
from boatsim.diagnosis.loading import Loaded
from boatsim.diagnosis.noise_levels import fit_force, force_prior
from boatsim.diagnosis.pipeline import Diagnosis
from boatsim.diagnosis.problem import Fit, Problem
from boatsim.errors import BadInput, unknown_name
from boatsim.physics.base import Array
from boatsim.recordings.table import Recording
from validation.real import kvlcc2_hsva_zigzag as hsva
from validation.real import kvlcc2_marin_free as marin
from validation.real.common import print_verdict, report, runs_of, table

NAME = "kvlcc2_mmg"
VESSELS = {"hsva": "kvlcc2_mmg", "marin": "kvlcc2_mmg_full_scale"}
FACTS = {"steering_measured": True}  # both tanks measured the rudder's angle
# [Hz] of rows at most, for the time it takes: the 7 m model needs half a minute for a swing
RATE = 3.0
GOAL = 0.5  # of the recalibrated model's error
COUNT = ("first", "second")  # overshoots that are looked at
# of the rudder angle of one side of a zig-zag: below it the rudder is on its way to the other side
HELD = 0.97
DRAWS = 50  # of coefficients from what the fitted runs leave open
# share of its prior sd below which the sd of a coefficient says that the recordings know it
TOLD = 0.5


# ---- overshoots


def reversals(delta: Array) -> list[int]:
    """Rows in which the rudder leaves one side (N,) [rad] of a zig-zag for the other."""
    over = np.flatnonzero(np.abs(delta) > 0.5 * np.median(np.abs(delta)))
    ends = np.flatnonzero(np.diff(np.sign(delta[over])))
    found = []
    for first, last in zip((0, *(ends + 1)), ends, strict=False):
        side = over[first : last + 1]
        angle = np.abs(delta[side])
        found.append(int(side[np.flatnonzero(angle > HELD * np.median(angle))[-1]]))
    return found


def overshoots(psi: Array, delta: Array, at: Sequence[int]) -> list[float]:
    """How far the heading (N,) [rad] goes on behind each reversal [deg], up to the next one; the last only if it ends.

    It ends where the ship has turned back before the rows do.
    """
    found = []
    for start, end in zip(at, (*at[1:], len(psi) - 1), strict=False):
        part = float(np.sign(delta[start])) * (psi[start : end + 1] - psi[start])
        if int(np.argmax(part)) < end - start:
            found.append(float(np.degrees(part.max())))
    return found


def swings(found: Diagnosis, run: Recording) -> dict[str, list[float]]:
    """First overshoots [deg] as recorded and in one free run of each model, from the first row on."""
    at = reversals(run["delta_rad"])
    rows = at[len(COUNT)] + 1 if len(at) > len(COUNT) else len(run)
    delta, at = run["delta_rad"][:rows], at[: len(COUNT)]
    out = {"recorded": overshoots(run["psi_rad"][:rows], delta, at)}
    laid = found.map_recording(run)
    heading = int(laid.codes[laid.signals.index("psi_rad")])
    for name, fit in models(found.ranking).items():
        values, on = (
            found.problem.values(laid, fit.free, fit.theta),
            found.problem.program.switches(fit.effects),
        )
        first, y = laid.free_runs(
            values, on, fit.levels, float(laid.times[rows - 1] - laid.times[0])
        )[0]
        out[name] = overshoots(y[:, heading], delta[first:], [i - first for i in at])
    return out


def print_overshoots(found: Diagnosis, runs: dict[str, Recording]) -> None:
    """Of the zig-zags, with the recorded rudder and propeller."""
    rows = []
    for name, run in runs.items():
        seen = "" if name in found.findings.runs else "unseen"
        swung = swings(found, run)
        rows += [
            [f"{name} {seen}".strip(), count, *(cell(swung[m], i) for m in ("recorded", *MODELS))]
            for i, count in enumerate(COUNT)
        ]
    header = ["zig-zag", "overshoot", "recorded", "as published", "recalibrated", "patched"]
    table(
        "heading past that of the rudder's reversal [deg], one free run from the first row",
        header,
        rows,
    )


def cell(swung: Sequence[float], i: int) -> str:
    """An overshoot, if there was one."""
    return f"{swung[i]:.1f}" if i < len(swung) else "-"


# ---- the models


def print_coefficients(found: Diagnosis) -> None:
    """What the recalibration makes of the published coefficients."""
    rows = []
    for f, x, v in zip(
        found.ranking.recalibrated.free,
        found.ranking.recalibrated.theta,
        np.diag(found.ranking.recalibrated.covariance),
        strict=True,
    ):
        told = "yes" if v < (TOLD * f.sd) ** 2 else "hardly"
        rows.append([f"{f.effect} {f.name}", f"{x:.2f} +- {np.sqrt(v):.2f}", told])
    table(
        "recalibrated, as factors of the published model",
        ["coefficient", "factor", "told by the recordings"],
        rows,
    )


def print_left(found: Diagnosis) -> None:
    """What no entry explains."""
    unknown = found.findings.answer["unknown"]
    if not unknown["flag"]:
        print("\nnothing is left over that no entry explains")
        return
    structure = unknown.get("structure")
    goes_with = (
        f"; in {structure['axis']} it goes with {structure['goes_with']}" if structure else ""
    )
    print(f"\nleft over, whatever its cause: {unknown['gain_nats']:.0f} nats{goes_with}")
    for d in found.findings.answer["described"]:
        print(f"  described: {d}")


def opened(runs: dict[str, Path], vessel: str) -> dict[str, Recording]:
    """Recordings as the diagnosis takes them."""
    read = {n: loading.open_recording(path, vessel, ()) for n, path in runs.items()}
    thin = {
        n: drop_position_outliers(r.thinned(min(RATE, priors.rate(b))), b)
        for n, (r, b) in read.items()
    }
    return {
        n: replace(r, name=n, notes=replace(r.notes, facts={**FACTS, **r.notes.facts}))
        for n, r in thin.items()
    }


def diagnosed(
    runs: dict[str, Recording], held_out: Sequence[str], vessel: str, horizon: float
) -> Diagnosis:
    """What the model leaves out of the recordings that are not kept unseen."""
    boats = {r.path: loading.vessel_for(r.path, vessel, ()) for r in runs.values() if r.path}
    fitted, kept = [r for n, r in runs.items() if n not in held_out], [runs[n] for n in held_out]
    return pipeline.diagnose_loaded(
        Loaded(fitted, kept, boats, ", ".join(held_out), horizon=horizon)
    )


# ---- the two tanks

Errors = dict[str, float]


def likely(problem: Problem, found: Fit) -> float:
    """Log likelihood [nats] of the recordings by these coefficients, the water as rough as it then must be."""
    there = fit_force(problem, found)
    on = problem.program.switches(there.effects)
    return problem.log_likelihood(there.free, there.theta, on, there.levels) + force_prior(
        problem, there.levels
    )


def print_room(
    found: Diagnosis, held_out: Sequence[MappedRecording], judged: Callable[[Fit], Errors]
) -> None:
    """How far the recalibrated model is off on unseen runs for its structure, how far for what it was not told.

    The same coefficients refitted with the unseen runs among the fitted ones show what the structure can do; those
    drawn from what the fitted runs leave open show what errors they let one expect.
    """
    before = found.ranking.recalibrated
    everything = found.problem.on([*found.problem.recordings, *held_out])
    whole = converge(everything, gauss_newton(everything, before, 6, 0.1))
    taught = judged(whole)
    rng = np.random.default_rng(0)
    low, high = ([getattr(f, end) for f in before.free] for end in ("low", "high"))
    drawn = np.clip(rng.multivariate_normal(before.theta, before.covariance, DRAWS), low, high)
    might = [judged(replace(before, theta=theta)) for theta in drawn]
    rows = []
    for what, error in judged(before).items():
        least, most = np.quantile([m[what] for m in might], [0.1, 0.9])
        rows.append([what, f"{error:.3f}", f"{taught[what]:.3f}", f"{least:.3f} to {most:.3f}"])
    header = [
        "rms error",
        "recalibrated",
        "told the unseen runs too",
        "coefficients as the fitted runs leave them open",
    ]
    table(f"what the structure can do, and the middle 80 % of {DRAWS} draws", header, rows)
    cost = likely(found.problem, before) - likely(found.problem, whole)
    print(f"told the unseen runs too, the model makes the fitted ones {cost:.0f} nats unlikelier")


def of_hsva(found: Diagnosis, runs: dict[str, Recording]) -> None:
    """All runs are zig-zags."""
    held_out = [found.map_recording(runs[n]) for n in hsva.UNSEEN]

    def judged(fit: Fit) -> Errors:
        off = errors(free_runs(found.problem, {"": fit}, held_out, hsva.HORIZON))
        return {what: off[family][""] * factor for family, (what, factor) in hsva.UNITS.items()}

    print_overshoots(found, runs)
    hsva.print_unseen(found, dict.fromkeys(hsva.UNITS, GOAL))
    print_room(found, held_out, judged)


def of_marin(found: Diagnosis, runs: dict[str, Recording]) -> None:
    """Zig-zags, and the circle on which they are judged."""
    circle = found.map_recording(runs[marin.UNSEEN])

    def judged(fit: Fit) -> Errors:
        return dict(zip(marin.GOALS, marin.turn(found, fit, circle).tolist(), strict=True))

    print_overshoots(found, {n: runs[n] for n in marin.FITTED})
    marin.print_circle(found, circle, dict.fromkeys(marin.GOALS, GOAL))
    print_room(found, [circle], judged)


TANKS: dict[
    str, tuple[str, tuple[str, ...], float, Callable[[Diagnosis, dict[str, Recording]], None]]
] = {
    "hsva": (hsva.NAME, hsva.UNSEEN, hsva.HORIZON, of_hsva),
    "marin": (marin.NAME, (marin.UNSEEN,), marin.HORIZON, of_marin),
}  # recordings, unseen runs, horizon [s] of free runs, what is printed of them


def main(tanks: Sequence[str] = ()) -> None:
    """Diagnose the model on the recordings of some tanks, or both. Raises BadInput for a tank that is not known."""
    for tank in tanks or TANKS:
        if tank not in TANKS:
            raise BadInput(unknown_name("tank", tank, TANKS))
        name, held_out, horizon, judge = TANKS[tank]
        runs = runs_of(name)
        read = opened(runs, VESSELS[tank])
        found = diagnosed(read, held_out, VESSELS[tank], horizon)
        print(f"\n{name}, {VESSELS[tank]}")
        report(found, f"{NAME}_{tank}")
        print_verdict(found)
        print_left(found)
        print_coefficients(found)
        judge(found, read)


if __name__ == "__main__":
    main(sys.argv[1:])
