"""Measured roll decay of a tanker model (SSPA 2018): `python -m validation.real.kvlcc2_roll_decay`.

The nominal is a linear oscillator, the baseline the same with damping and restoring refitted. The
release at zero speed is divided in two ways: into windows of 20 s, every second one held out, and
into thirds, the middle one held out. The errors of free runs over held-out data are split into
envelope and phase, with one effect at a time. The release at 15.5 kn (full scale) is first held out
from the boat fitted at zero speed, then diagnosed separately, and the coefficients are compared.
The recordings are in tests/data/kvlcc2_roll_decay, so this benchmark needs no other files.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np

from boatsim.diagnosis import loading, pipeline, priors
from boatsim.diagnosis.evaluation import compared_fits
from boatsim.diagnosis.filter import MappedRecording
from boatsim.diagnosis.fit import converge
from boatsim.diagnosis.free_runs import free_runs, rms_errors
from boatsim.diagnosis.loading import LoadedRecordings
from boatsim.diagnosis.model_names import MODEL_WORDS
from boatsim.diagnosis.pipeline import Diagnosis
from boatsim.diagnosis.problem import Fit, Problem
from boatsim.diagnosis.search.evidence import required_gain
from boatsim.diagnosis.search.ranking import Ranking, select_and_rank_candidates
from boatsim.diagnosis.search.screening import screen
from boatsim.physics.base import Array
from boatsim.physics.vessel import Vessel
from boatsim.recordings.table import Recording
from validation.real.common import (
    DEG,
    MODEL_COLUMNS,
    by_name,
    format_fixed,
    names_of,
    print_table,
    scale_errors,
    write_report,
)

NAME = "kvlcc2_roll_decay"
HORIZON = 60.0  # [s] of a free run: a decay shows over many periods
DATA = Path(__file__).parents[2] / "tests" / "data" / NAME
AT_REST = "decay_0kn_run2"
AT_SPEED = "decay_15p5kn"
WINDOW = 20.0  # [s] about eight periods
GOALS = {"windows": 0.3, "middle third": 0.2}  # patched / recalibrated
GRAVITY = 9.81  # [m/s^2]
Rows = list[list[str]]
Table = tuple[str, list[str], Rows]


def open_release(name: str) -> tuple[Recording, Vessel]:
    """Return a release at the rate of a diagnosis, and its vessel."""
    recording, vessel = loading.open_recording(DATA / f"{name}.csv", None, ())
    return replace(recording.thinned(priors.downsampling_rate(vessel)), name=name), vessel


def split_at(whole: Recording, edges: Sequence[float]) -> list[Recording]:
    """Return the parts between edges [s], named by their times; no row is in two of them."""
    half = 0.5 * float(np.median(np.diff(whole.t)))
    pairs = zip(edges[:-1], edges[1:], strict=True)
    return [replace(whole.between(a, b - half), name=f"{a:.1f} to {b:.1f} s") for a, b in pairs]


def windows_of(whole: Recording) -> list[Recording]:
    """Return all complete windows of 20 s."""
    return split_at(whole, np.arange(whole.t[0], whole.t[-1], WINDOW).tolist())


def thirds_of(whole: Recording) -> list[Recording]:
    """Return the first, middle and last third."""
    return split_at(whole, np.linspace(whole.t[0], whole.t[-1], 4).tolist())


def diagnose_windows(whole: Recording, vessel: Vessel) -> Diagnosis:
    """Diagnose with every second window of 20 s held out; the incomplete last one is not used."""
    parts = windows_of(whole)
    note = f"every second window of {WINDOW:g} s"
    return pipeline.diagnose_loaded(
        LoadedRecordings(parts[::2], parts[1::2], {whole.path: vessel}, note, horizon=HORIZON)
    )


def diagnose_thirds(whole: Recording, vessel: Vessel, held_out: int = 1) -> Diagnosis:
    """Diagnose with one third held out, by default the middle one."""
    parts = thirds_of(whole)
    kept = parts.pop(held_out)
    return pipeline.diagnose_loaded(
        LoadedRecordings(parts, [kept], {whole.path: vessel}, kept.name, horizon=HORIZON)
    )


def held_out_errors(diagnosis: Diagnosis) -> dict[str, float]:
    """Return the rms roll error [rad] of free runs over held-out data, by model."""
    return rms_errors(diagnosis.findings.free_runs)["roll_rms_rad"]


def error_ratio(diagnosis: Diagnosis) -> float:
    """Return the held-out error of the patched model over that of the recalibrated one."""
    rms = held_out_errors(diagnosis)
    return rms["patched"] / rms["recalibrated"]


# ---- envelope and phase


def with_effects(problem: Problem, base: Fit, names: Sequence[str]) -> Fit:
    """Return the baseline with these effects added one by one, all refitted."""
    for name in names:
        base = converge(problem, screen(problem, base, [name])[name])
    return base


def fit_one_effect_at_a_time(diagnosis: Diagnosis) -> dict[str, Fit]:
    """Return the linear boat, the boat with each identified effect alone, and that with all."""
    problem, base = diagnosis.problem, diagnosis.ranking.recalibrated
    names = names_of(diagnosis.ranking.named)
    fits = {"linear": base}
    for name in names:
        fits[f"+ {name}"] = with_effects(problem, base, [name])
    return fits | {"+ all of these": with_effects(problem, base, names)}


def simulate(problem: Problem, mapped: MappedRecording, model: Fit) -> Array:
    """Return the states (N, 2 dof) of one free run over a whole recording."""
    values = problem.parameter_vector(mapped, model.free, model.theta)
    on = problem.program.effect_switches(model.effects)
    ((_, states),) = mapped.free_runs(values, on, model.levels, float(np.ptp(mapped.times)))
    return np.asarray(states)


def natural_frequency(mapped: MappedRecording) -> float:
    """Return the natural frequency of the nominal vessel [rad/s], the scale of the phase plane."""
    index, values = mapped.program.parameter_index, mapped.values
    inertia = mapped.program.vessel.body.roll_inertia + values[index("added_mass", "roll")]
    return float(np.sqrt(values[index("righting_arm", "stiffness")] / inertia))


def envelope_and_phase(states: Array, omega: float) -> Array:
    """Return envelope [rad] and phase [rad] (2, N) of states (N, 2), roll and its rate."""
    phi, p = states[:, 0], states[:, 1] / omega
    return np.stack([np.hypot(phi, p), np.unwrap(-np.arctan2(p, phi))])


def envelope_and_phase_of_runs(
    problem: Problem, fits: Mapping[str, Fit], mapped: MappedRecording
) -> dict[str, Array]:
    """Return envelope and phase (2, N) of the smoothed recording and of one free run per model."""
    omega = natural_frequency(mapped)
    last = list(fits.values())[-1]
    values = problem.parameter_vector(mapped, last.free, last.theta)
    smooth = mapped.smooth(values, problem.program.effect_switches(last.effects), last.levels)[0]
    found = {"recorded": envelope_and_phase(smooth, omega)}
    for label, model in fits.items():
        found[label] = envelope_and_phase(simulate(problem, mapped, model), omega)
    return found


def envelope_and_phase_errors(
    problem: Problem, fits: Mapping[str, Fit], recordings: Sequence[MappedRecording]
) -> dict[str, tuple[float, float]]:
    """Return the rms errors of envelope and phase [rad] of each model over whole recordings."""
    runs = list(map(partial(envelope_and_phase_of_runs, problem, fits), recordings))
    found = {}
    for label in fits:
        off = np.hstack([run[label] - run["recorded"] for run in runs])
        off[1] = (off[1] + np.pi) % (2 * np.pi) - np.pi
        envelope, phase = np.sqrt(np.mean(off**2, axis=1)).tolist()
        found[label] = (envelope, phase)
    return found


def map_all(diagnosis: Diagnosis, parts: Sequence[Recording]) -> list[MappedRecording]:
    """Return recordings mapped on the program of a diagnosis."""
    return list(map(diagnosis.map_recording, parts))


def error_rows(
    diagnosis: Diagnosis, fits: Mapping[str, Fit], held_out: Sequence[MappedRecording], what: str
) -> Rows:
    """Return rows with the errors of envelope and phase over held-out data."""
    off = envelope_and_phase_errors(diagnosis.problem, fits, held_out)
    first = off["linear"]
    rows = []
    for label, (envelope, phase) in off.items():
        row = [what, label, f"{envelope * DEG:.3f}"]
        rows.append([*row, *format_fixed(2, phase * DEG, envelope / first[0], phase / first[1])])
    return rows


def decay_and_period(run: Array, t: Array, omega: float) -> tuple[float, float]:
    """Return the equivalent linear damping, as a share of critical, and the period [s].

    Args:
        run: Envelope and phase (2, N) of a stretch.
        t: Times (N,) [s].
        omega: Natural frequency [rad/s].
    """
    slope = np.polyfit(t, np.stack([np.log(run[0]), run[1]], axis=-1), 1)[0]
    return float(-slope[0] / omega), float(2 * np.pi / slope[1])


def window_rows(
    diagnosis: Diagnosis, fits: Mapping[str, Fit], recordings: Sequence[MappedRecording]
) -> tuple[Rows, Rows]:
    """Return rows with damping and rows with period of every window, recorded and of free runs."""
    dampings, periods = [], []
    for mapped in recordings:
        runs = envelope_and_phase_of_runs(diagnosis.problem, fits, mapped)
        omega = natural_frequency(mapped)
        pairs = [decay_and_period(run, mapped.times, omega) for run in runs.values()]
        damping, period = np.transpose(pairs)
        about = [mapped.name, f"{float(np.mean(runs['recorded'][0])) * DEG:.1f}"]
        dampings.append([*about, *format_fixed(2, *(100 * damping))])
        periods.append([*about, *format_fixed(4, *period)])
    return dampings, periods


# ---- forward speed


def coefficients(problem: Problem, fitted: Fit) -> dict[str, tuple[float, float]]:
    """Return the coefficients of the hull from one release, each with its standard deviation."""
    body, mapped = problem.program.vessel.body, problem.recordings[0]
    values = {}
    for i, f in enumerate(fitted.free):
        scale = 1.0
        if f.relative:
            scale = mapped.values[f.at]
        sd = float(np.sqrt(fitted.covariance[i, i]) * scale)
        values[f.effect, f.name] = (float(fitted.theta[i] * scale), sd)
    damping, damping_sd = values["linear_damping", "roll"]
    stiffness, sd = values["righting_arm", "stiffness"]
    inertia = (
        body.roll_inertia + mapped.values[problem.program.parameter_index("added_mass", "roll")]
    )
    percent = 100.0 / (2.0 * np.sqrt(stiffness * inertia))
    period = 2.0 * np.pi * np.sqrt(inertia / stiffness)
    arm = 1e3 / (body.mass * GRAVITY)
    found = {
        "linear damping [N m s]": (damping, damping_sd),
        "the same, share of critical [%]": (damping * percent, damping_sd * percent),
        "period of small rolls [s]": (period, 0.5 * period * sd / stiffness),
        "GM at the roll inertia of the vessel file [mm]": (stiffness * arm, sd * arm),
    }
    effects = by_name(problem.program.candidates)
    for f in fitted.free:
        if not f.relative:
            unit = type(effects[f.effect]).params()[f.name].unit
            found[f"{f.effect}, {f.name} [{unit}]"] = values[f.effect, f.name]
    return found


def speed_rows(at_rest: Diagnosis, at_speed: Diagnosis, releases: Sequence[Recording]) -> Rows:
    """Return rows that compare the coefficients at both speeds.

    The structure identified at rest is fitted to the whole of each release.
    """
    names = names_of(at_rest.ranking.named)
    found = []
    for diagnosis, whole in zip((at_rest, at_speed), releases, strict=True):
        old = diagnosis.problem
        problem = Problem(map_all(diagnosis, [whole]), old.ambient, old.uncertainty)
        base = converge(problem, diagnosis.ranking.recalibrated)
        found.append(coefficients(problem, with_effects(problem, base, names)))
    rows = []
    for name, (a, sa) in found[0].items():
        b, sb = found[1][name]
        difference = f"{(b - a) / np.hypot(sa, sb):+.1f}"
        rows.append([name, with_sd(a, sa), with_sd(b, sb), f"{b / a:.2f}", difference])
    return rows


def with_sd(value: float, sd: float) -> str:
    """Format a value with its standard deviation as `2.52 ± 0.11`, with two digits of the sd."""
    digits = max(0, 1 - int(np.floor(np.log10(sd))))
    return f"{value:.{digits}f} ± {sd:.{digits}f}"


def transfer_rows(at_rest: Diagnosis, whole: Recording) -> Rows:
    """Return rows with the errors of the boats fitted at zero speed on the release at speed."""
    (mapped,) = map_all(at_rest, [whole])
    fits = compared_fits(at_rest.ranking)
    stretches = free_runs(at_rest.problem, fits, [mapped], float(np.ptp(mapped.times)))
    rms = rms_errors(stretches)["roll_rms_rad"]
    rows = []
    for model, x in rms.items():
        rows.append([MODEL_WORDS[model], f"{x * DEG:.3f}", f"{x / rms['recalibrated']:.2f}"])
    return rows


# ---- tables


def last_third_rows(diagnosis: Diagnosis, whole: Recording) -> tuple[Rows, Ranking]:
    """Return rows with the errors of models over the last third, and the ranking fitted to it.

    The models are those fitted to other parts and those fitted to the last third.
    """
    (tail,) = map_all(diagnosis, thirds_of(whole)[2:])
    problem = diagnosis.problem
    alone = Problem([tail], problem.ambient, problem.uncertainty)
    ranking = select_and_rank_candidates(alone, problem.program.candidate_names)
    fits = dict(compared_fits(diagnosis.ranking))
    fits["linear, fitted here"] = ranking.recalibrated
    gains = {}
    for name, gain in ranking.first.items():
        label = f"{name}, fitted here"
        fits[label] = with_effects(alone, ranking.recalibrated, [name])
        gains[label] = f"{gain:+.1f}"
    rms = rms_errors(free_runs(alone, fits, [tail], float(np.ptp(tail.times))))["roll_rms_rad"]
    rows = []
    for label, x in rms.items():
        rows.append([MODEL_WORDS.get(label, label), f"{x * DEG:.4f}", gains.get(label, "")])
    return rows, ranking


def split_table(splits: Mapping[str, Diagnosis]) -> Table:
    """Return the errors of free runs over held-out data, by the way the release was divided."""
    rows = []
    for name, diagnosis in splits.items():
        goal = "none"
        if name in GOALS:
            goal = f"<= {GOALS[name]}"
        off = format_fixed(4, *scale_errors(held_out_errors(diagnosis), DEG))
        rows.append([name, *off, f"{error_ratio(diagnosis):.3f}", goal])
    header = ["split", "as published", *MODEL_COLUMNS, "goal"]
    return "Rms roll error [deg] of free runs over held-out data", header, rows


def tables(splits: Mapping[str, Diagnosis], releases: Sequence[Recording]) -> list[Table]:
    """Return all tables of this benchmark, in order."""
    whole, moving = releases
    windows, middle, *_, at_speed = splits.values()
    parts = map_all(windows, windows_of(whole))
    fits, of_thirds = fit_one_effect_at_a_time(windows), fit_one_effect_at_a_time(middle)
    dampings, periods = window_rows(windows, fits, parts)
    rows = error_rows(windows, fits, parts[1::2], "windows")
    rows += error_rows(middle, of_thirds, map_all(middle, thirds_of(whole)[1:2]), "middle third")
    header = ["window", "mean envelope [deg]", "recorded", *fits]
    tail, ranking = last_third_rows(middle, whole)
    best, enough = max(ranking.first.values()), required_gain(len(ranking.first))
    verdict = "a model is clearly better than the linear one fitted here"
    if best < enough:
        verdict = "no model is clearly better than the linear one fitted here"
    names = ["held out", "model", "envelope [deg]", "phase [deg]"]
    return [
        split_table(splits),
        (
            "Envelope and phase: rms error of free runs over held-out data, one effect at a time",
            [*names, "envelope / linear", "phase / linear"],
            rows,
        ),
        (
            "Envelope: equivalent linear damping [% of critical] by window; "
            "the first, third, ... were fitted",
            header,
            dampings,
        ),
        ("Phase: period [s] by window", header, periods),
        (
            f"Last third: {verdict} (gain of the best candidate {best:.1f} nats; "
            f"identified from {enough:.1f} on)",
            ["model", "rms roll error [deg]", "gain over linear fitted here [nats]"],
            tail,
        ),
        (
            "The release at 15.5 kn held out from the boats fitted to the windows at zero speed",
            ["model", "rms roll error [deg]", "/ retuned"],
            transfer_rows(windows, moving),
        ),
        (
            "Effect of forward speed: the structure identified at zero speed, "
            "fitted to the whole of either release",
            ["coefficient", "0 kn", "15.5 kn", "ratio", "difference [sd]"],
            speed_rows(windows, at_speed, releases),
        ),
    ]


def main() -> None:
    """Diagnose both releases and print the comparison."""
    whole, vessel = open_release(AT_REST)
    moving, _ = open_release(AT_SPEED)
    at_speed = diagnose_thirds(moving, vessel)
    splits = {
        "windows": diagnose_windows(whole, vessel),
        "middle third": diagnose_thirds(whole, vessel),
        "last third": diagnose_thirds(whole, vessel, held_out=2),
        "15.5 kn alone, middle third": at_speed,
    }
    found = tables(splits, (whole, moving))
    windows = splits["windows"]
    extra = (*windows.findings.extra_tables, *found)
    write_report(replace(windows, findings=replace(windows.findings, extra_tables=extra)), NAME)
    print("15.5 kn alone:")
    write_report(at_speed, f"{NAME}/at_15p5kn")
    note = splits["middle third"].findings.held_out_note
    print(f"split: {windows.findings.held_out_note}; {note}, the middle third")
    print("baseline: the linear oscillator with damping and restoring refitted to the same data")
    for title, header, rows in found:
        print_table(title, header, rows)


if __name__ == "__main__":
    main()
