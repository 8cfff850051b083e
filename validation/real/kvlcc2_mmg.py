"""Effects missing from the standard MMG model of a tanker: `python -m validation.real.kvlcc2_mmg`.

Arguments: `hsva`, `marin` or both (default). The nominal is the published model with the
derivatives of captive tests in another tank, the baseline the same with these, a_H, gamma_R and the
gains of propeller and rudder refitted. The free-running tests and the held-out runs are those of
kvlcc2_hsva_zigzag (7 m model) and kvlcc2_marin_free (full-scale values), where a linear model is
judged.
"""

import sys
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from boatsim.diagnosis import loading, pipeline, priors
from boatsim.diagnosis.checks.position_outliers import drop_position_outliers
from boatsim.diagnosis.evaluation import compared_fits
from boatsim.diagnosis.filter import MappedRecording
from boatsim.diagnosis.fit import ParameterSpace, converge, gauss_newton
from boatsim.diagnosis.free_runs import free_runs, rms_errors
from boatsim.diagnosis.loading import LoadedRecordings
from boatsim.diagnosis.noise_levels import fit_latent_force_level, log_latent_force_prior
from boatsim.diagnosis.pipeline import Diagnosis
from boatsim.diagnosis.problem import Fit, Problem
from boatsim.errors import BadInput, unknown_name_message
from boatsim.physics.base import Array
from boatsim.physics.vessel import Vessel
from boatsim.recordings.table import Recording
from validation.real import kvlcc2_hsva_zigzag as hsva
from validation.real import kvlcc2_marin_free as marin
from validation.real.common import (
    by_name,
    format_fixed,
    print_table,
    print_verdict,
    runs_except,
    runs_named,
    runs_of,
    write_report,
)

NAME = "kvlcc2_mmg"
FACTS = {"steering_measured": True}  # both tanks measured the rudder's angle
# [Hz] of rows at most, to limit the computing time: the 7 m model takes 30 s for one oscillation
RATE = 3.0
GOAL = 0.5  # of the recalibrated model's error
COUNT = ("first", "second")  # overshoots that are compared
# of the rudder angle of one side of a zig-zag: below it the rudder is moving to the other side
REACHED = 0.97
SAMPLES = 50  # of coefficients from the posterior of the fitted runs
# share of its prior sd below which the sd of a coefficient means that the recordings determine it
DETERMINED = 0.5
Errors = dict[str, float]


# ---- overshoots


def reversals(delta: Array) -> list[int]:
    """Return the rows in which the rudder leaves one side of a zig-zag for the other.

    Args:
        delta: Rudder angles (N,) [rad].
    """
    over = np.flatnonzero(np.abs(delta) > 0.5 * np.median(np.abs(delta)))
    ends = np.flatnonzero(np.diff(np.sign(delta[over])))
    found = []
    for first, last in zip((0, *(ends + 1)), ends, strict=False):
        side = over[first : last + 1]
        angle = np.abs(delta[side])
        found.append(int(side[np.flatnonzero(angle > REACHED * np.median(angle))[-1]]))
    return found


def overshoots(psi: Array, delta: Array, at: Sequence[int]) -> list[float]:
    """Return the overshoot of each completed reversal [deg].

    A reversal is completed when the ship has turned back before the next one or the last row.

    Args:
        psi: Headings (N,) [rad].
        delta: Rudder angles (N,) [rad].
        at: Rows of the reversals.
    """
    found = []
    for start, end in zip(at, (*at[1:], len(psi) - 1), strict=False):
        part = float(np.sign(delta[start])) * (psi[start : end + 1] - psi[start])
        if int(np.argmax(part)) < end - start:
            found.append(float(np.degrees(part.max())))
    return found


def overshoots_by_model(diagnosis: Diagnosis, run: Recording) -> list[list[float]]:
    """Return the first overshoots [deg] as recorded and in one free run of each model."""
    at = reversals(run["delta_rad"])
    rows = len(run)
    if len(at) > len(COUNT):
        rows = at[len(COUNT)] + 1
    delta, at = run["delta_rad"][:rows], at[: len(COUNT)]
    found = [overshoots(run["psi_rad"][:rows], delta, at)]
    mapped, problem = diagnosis.map_recording(run), diagnosis.problem
    heading = int(mapped.codes[mapped.signals.index("psi_rad")])
    duration = float(mapped.times[rows - 1] - mapped.times[0])
    for fit in compared_fits(diagnosis.ranking).values():
        values = problem.parameter_vector(mapped, fit.free, fit.theta)
        on = problem.program.effect_switches(fit.effects)
        first, states = mapped.free_runs(values, on, fit.levels, duration)[0]
        found.append(overshoots(states[:, heading], delta[first:], (np.array(at) - first).tolist()))
    return found


def print_overshoots(diagnosis: Diagnosis, runs: dict[str, Recording]) -> None:
    """Print the overshoots of zig-zags with the recorded rudder and propeller."""
    rows = []
    for name, run in runs.items():
        label = f"{name} held out"
        if name in diagnosis.findings.runs:
            label = name
        by_model = overshoots_by_model(diagnosis, run)
        for i, count in enumerate(COUNT):
            row = [label, count]
            for found in by_model:
                row += format_fixed(1, *found[i : i + 1]) or ["-"]
            rows.append(row)
    header = ["zig-zag", "overshoot", "recorded", "as published", "retuned", "corrected"]
    title = "overshoot after the rudder's reversal [deg], one free run from the first row"
    print_table(title, header, rows)


# ---- the models


def print_coefficients(diagnosis: Diagnosis) -> None:
    """Print the recalibrated coefficients as factors of the published ones."""
    fit = diagnosis.ranking.recalibrated
    rows = []
    for f, x, variance in zip(fit.free, fit.theta, np.diag(fit.covariance), strict=True):
        determined = "yes" if variance < (DETERMINED * f.sd) ** 2 else "hardly"
        rows.append([f"{f.effect} {f.name}", f"{x:.2f} +- {np.sqrt(variance):.2f}", determined])
    header = ["coefficient", "factor", "determined by the recordings"]
    print_table("retuned, as factors of the published model", header, rows)


def print_residual(diagnosis: Diagnosis) -> None:
    """Print the residual force that no candidate explains."""
    answer = diagnosis.findings.answer
    unknown = answer["unknown"]
    if not unknown["flag"]:
        print("\nno unexplained residual force")
        return
    line = f"\nunexplained residual force: {unknown['gain_nats']:.0f} nats"
    structure = unknown.get("structure")
    if structure:
        line += f"; in {structure['axis']} it correlates with {structure['goes_with']}"
    print(line)
    for term in answer["described"]:
        print(f"  described: {term['statement']}")


def open_runs(runs: dict[str, Path], vessel_name: str) -> dict[str, Recording]:
    """Return the recordings of a diagnosis by run."""
    opened = {}
    for name, path in runs.items():
        run, vessel = loading.open_recording(path, vessel_name, ())
        thin = drop_position_outliers(
            run.thinned(min(RATE, priors.downsampling_rate(vessel))), vessel
        )
        notes = replace(thin.notes, facts={**FACTS, **thin.notes.facts})
        opened[name] = replace(thin, name=name, notes=notes)
    return opened


def diagnose(
    runs: dict[str, Recording], held_out: Sequence[str], vessel_name: str, horizon: float
) -> Diagnosis:
    """Diagnose the model with all runs that are not held out."""
    vessels: dict[Path | None, Vessel] = {}
    for run in runs.values():
        if run.path:
            vessels[run.path] = loading.vessel_of_recording_file(run.path, vessel_name, ())
    kept = runs_named(runs, held_out)
    note = ", ".join(held_out)
    fitted = runs_except(runs, held_out)
    return pipeline.diagnose_loaded(LoadedRecordings(fitted, kept, vessels, note, horizon=horizon))


# ---- the two tanks


def log_likelihood(problem: Problem, found: Fit) -> float:
    """Return the log likelihood [nats] of these coefficients with a refitted disturbance level."""
    refitted = fit_latent_force_level(problem, found)
    on = problem.program.effect_switches(refitted.effects)
    likelihood = problem.log_likelihood(refitted.free, refitted.theta, on, refitted.levels)
    return likelihood + log_latent_force_prior(problem, refitted.levels)


def print_error_sources(
    diagnosis: Diagnosis, held_out: Sequence[MappedRecording], errors_of: Callable[[Fit], Errors]
) -> None:
    """Print how much of the held-out error is due to the structure and to the coefficients.

    A refit that includes the held-out runs shows the error due to the structure. Coefficients
    sampled from the posterior of the fitted runs show the error that these runs let one expect.

    Args:
        diagnosis: The diagnosis of the fitted runs.
        held_out: The held-out runs.
        errors_of: Returns the errors of a fit on the held-out runs.
    """
    before = diagnosis.ranking.recalibrated
    everything = diagnosis.problem.with_recordings([*diagnosis.problem.recordings, *held_out])
    whole = converge(everything, gauss_newton(everything, before, 6, 0.1))
    with_held_out = errors_of(whole)
    rng = np.random.default_rng(0)
    samples = rng.multivariate_normal(before.theta, before.covariance, SAMPLES)
    expected = []
    for theta in ParameterSpace(before.free).clip(samples):
        expected.append(errors_of(replace(before, theta=theta)))
    rows = []
    for what, error in errors_of(before).items():
        least, most = np.quantile([sample[what] for sample in expected], [0.1, 0.9])
        cells = format_fixed(3, error, with_held_out[what])
        rows.append([what, *cells, f"{least:.3f} to {most:.3f}"])
    header = ["rms error", "retuned", "refitted with the held-out runs"]
    header.append("coefficients sampled from the posterior")
    title = f"error due to structure and coefficients; middle 80 % of {SAMPLES} samples"
    print_table(title, header, rows)
    cost = log_likelihood(diagnosis.problem, before) - log_likelihood(diagnosis.problem, whole)
    print(f"refitted with the held-out runs, the fitted runs are {cost:.0f} nats less likely")


def report_on(
    tank: str, recordings: str, vessel_name: str, held_out: Sequence[str], horizon: float
) -> tuple[Diagnosis, dict[str, Recording]]:
    """Diagnose and report a vessel on a set of recordings; return the diagnosis and the runs."""
    runs = open_runs(runs_of(recordings), vessel_name)
    diagnosis = diagnose(runs, held_out, vessel_name, horizon)
    print(f"\n{recordings}, {vessel_name}")
    write_report(diagnosis, f"{NAME}_{tank}")
    print_verdict(diagnosis)
    print_residual(diagnosis)
    print_coefficients(diagnosis)
    return diagnosis, runs


def judge_hsva() -> None:
    """Diagnose the 7 m model in HSVA's tank; all runs are zig-zags."""
    diagnosis, runs = report_on("hsva", hsva.NAME, NAME, hsva.HELD_OUT, hsva.HORIZON)
    held_out = list(map(diagnosis.map_recording, runs_named(runs, hsva.HELD_OUT)))

    def errors_of(fit: Fit) -> Errors:
        off = rms_errors(free_runs(diagnosis.problem, {"": fit}, held_out, hsva.HORIZON))
        return {what: off[family][""] * factor for family, (what, factor) in hsva.UNITS.items()}

    print_overshoots(diagnosis, runs)
    hsva.print_held_out(diagnosis, dict.fromkeys(hsva.UNITS, GOAL))
    print_error_sources(diagnosis, held_out, errors_of)


def judge_marin() -> None:
    """Diagnose the full-scale ship of MARIN's tests; the turning circle is held out."""
    vessel_name = f"{NAME}_full_scale"
    held_out = (marin.HELD_OUT,)
    diagnosis, runs = report_on("marin", marin.NAME, vessel_name, held_out, marin.HORIZON)
    circle = diagnosis.map_recording(runs[marin.HELD_OUT])

    def errors_of(fit: Fit) -> Errors:
        off = marin.turn_errors(diagnosis, fit, circle)
        return dict(zip(marin.GOALS, off.tolist(), strict=True))

    print_overshoots(diagnosis, by_name(runs_named(runs, marin.FITTED)))
    marin.print_circle(diagnosis, circle, dict.fromkeys(marin.GOALS, GOAL))
    print_error_sources(diagnosis, [circle], errors_of)


TANKS = {"hsva": judge_hsva, "marin": judge_marin}


def main(tanks: Sequence[str] = ()) -> None:
    """Diagnose the model on the recordings of some tanks; both by default.

    Raises:
        BadInput: A tank is not known.
    """
    for tank in tanks or TANKS:
        if tank not in TANKS:
            raise BadInput(unknown_name_message("tank", tank, TANKS))
        TANKS[tank]()


if __name__ == "__main__":
    main(sys.argv[1:])
