"""Roll decay of a tanker model, measured (SSPA 2018): `python -m validation.real.kvlcc2_roll_decay`.

The nominal is a linear oscillator, the baseline the same with damping and restoring refitted. The release at zero
speed is cut in two ways: into windows of 20 s, every second one unseen, and into thirds, the middle one unseen. Free
runs over what is unseen are split into envelope and phase, with one effect at a time. The release at 15.5 kn (full
scale) is first held out from the zero-speed boat, then diagnosed by itself, and the coefficients are compared.
The recordings lie in tests/data/kvlcc2_roll_decay, so this runs anywhere.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from boatsim.diagnosis import loading, pipeline, priors
from boatsim.diagnosis.evaluation import MODELS, models
from boatsim.diagnosis.filter import MappedRecording
from boatsim.diagnosis.fit import converge
from boatsim.diagnosis.free_runs import errors, free_runs
from boatsim.diagnosis.loading import Loaded
from boatsim.diagnosis.pipeline import Diagnosis
from boatsim.diagnosis.problem import Fit, Problem
from boatsim.diagnosis.search.evidence import required_gain
from boatsim.diagnosis.search.ranking import Ranking, rank
from boatsim.diagnosis.search.screening import screen
from boatsim.physics.base import Array
from boatsim.physics.vessel import Vessel
from boatsim.recordings.table import Recording
from validation.real.common import report, table

NAME = "kvlcc2_roll_decay"
HORIZON = 60.0  # [s] of a free run: a decay shows over many periods
DATA = Path(__file__).parents[2] / "tests" / "data" / NAME
AT_REST, AT_SPEED = "decay_0kn_run2", "decay_15p5kn"
WINDOW = 20.0  # [s] about eight periods
GOALS = {"windows": 0.3, "middle third": 0.2}  # patched / recalibrated
GRAVITY = 9.81  # [m/s^2]
DEG = 57.29578  # [deg/rad]
Rows = list[list[str]]
Table = tuple[str, list[str], Rows]


def opened(name: str) -> tuple[Recording, Vessel]:
    """A release as the diagnosis reads it."""
    recording, vessel = loading.open_recording(DATA / f"{name}.csv", None, ())
    return replace(recording.thinned(priors.rate(vessel)), name=name), vessel


def cut(whole: Recording, edges: Sequence[float]) -> list[Recording]:
    """The parts between edges [s], no row in two of them, named by their times."""
    half = 0.5 * float(np.median(np.diff(whole.t)))
    pairs = zip(edges[:-1], edges[1:], strict=True)
    return [replace(whole.between(a, b - half), name=f"{a:.1f} to {b:.1f} s") for a, b in pairs]


def cut_windows(whole: Recording) -> list[Recording]:
    """All whole windows of 20 s."""
    return cut(whole, np.arange(whole.t[0], whole.t[-1], WINDOW).tolist())


def by_windows(whole: Recording, vessel: Vessel) -> Diagnosis:
    """Windows of 20 s, every second one unseen; the rest at the end is left out."""
    parts = cut_windows(whole)
    note = f"every second window of {WINDOW:g} s"
    return pipeline.diagnose_loaded(
        Loaded(parts[::2], parts[1::2], {whole.path: vessel}, note, horizon=HORIZON)
    )


def by_thirds(whole: Recording, vessel: Vessel, held_out: int = 1) -> Diagnosis:
    """One third unseen, the middle one unless told."""
    parts = thirds(whole)
    kept = parts.pop(held_out)
    note = kept.name
    return pipeline.diagnose_loaded(
        Loaded(parts, [kept], {whole.path: vessel}, note, horizon=HORIZON)
    )


def thirds(whole: Recording) -> list[Recording]:
    """First, middle and last third."""
    return cut(whole, np.linspace(whole.t[0], whole.t[-1], 4).tolist())


def unseen_errors(found: Diagnosis) -> dict[str, float]:
    """Rms roll error of free runs over what was unseen, by model [rad]."""
    return errors(found.findings.free_runs)["roll_rms_rad"]


def ratio(found: Diagnosis) -> float:
    """Patched over recalibrated, on unseen data."""
    rms = unseen_errors(found)
    return rms["patched"] / rms["recalibrated"]


# Envelope and phase
# -----------------------------------------------------------------------------------------------


def with_effects(problem: Problem, base: Fit, names: Sequence[str]) -> Fit:
    """The baseline with these effects added, all refitted."""
    for name in names:
        base = converge(problem, screen(problem, base, [name])[name])
    return base


def one_at_a_time(found: Diagnosis) -> dict[str, Fit]:
    """The linear boat, the same with each effect found alone, and with all of them; each fitted to the same data."""
    problem, base = found.problem, found.ranking.recalibrated
    named = tuple(n.name for n in found.ranking.named)
    sets = {"linear": (), **{f"+ {n}": (n,) for n in named}, "+ all of these": named}
    return {label: with_effects(problem, base, names) for label, names in sets.items()}


def pulsation(laid: MappedRecording) -> float:
    """Of the vessel as written [rad/s]; the measure in which roll and its rate span one phase plane."""
    index, values = laid.program.index, laid.values
    inertia = laid.program.vessel.body.roll_inertia + values[index("added_mass", "roll")]
    return float(np.sqrt(values[index("righting_arm", "stiffness")] / inertia))


def polar(states: Array, omega: float) -> Array:
    """Envelope [rad] and phase [rad] (2, N) of states (N, 2), roll and its rate."""
    phi, p = states[:, 0], states[:, 1] / omega
    return np.stack([np.hypot(phi, p), np.unwrap(-np.arctan2(p, phi))])


def polar_runs(
    problem: Problem, fits: Mapping[str, Fit], laid: MappedRecording
) -> dict[str, Array]:
    """Envelope and phase (2, N) of the recording, smoothed, and of each model's one free run from its first state."""
    omega, last = pulsation(laid), list(fits.values())[-1]
    whole = float(np.ptp(laid.times))
    on = problem.program.switches
    smooth = laid.smooth(
        problem.values(laid, last.free, last.theta), on(last.effects), last.levels
    )[0]
    found = {"recorded": polar(smooth, omega)}
    for label, f in fits.items():
        ((_, states),) = laid.free_runs(
            problem.values(laid, f.free, f.theta), on(f.effects), f.levels, whole
        )
        found[label] = polar(states, omega)
    return found


def polar_errors(
    problem: Problem, fits: Mapping[str, Fit], tracks: Sequence[MappedRecording]
) -> dict[str, tuple[float, float]]:
    """Rms error of envelope and of phase [rad] of each model over free runs as long as the tracks."""
    runs = [polar_runs(problem, fits, laid) for laid in tracks]
    found = {}
    for label in fits:
        off = np.hstack([r[label] - r["recorded"] for r in runs])
        off[1] = (off[1] + np.pi) % (2 * np.pi) - np.pi
        envelope, phase = np.sqrt(np.mean(off**2, axis=1)).tolist()
        found[label] = (envelope, phase)
    return found


def laid_on(found: Diagnosis, parts: Sequence[Recording]) -> list[MappedRecording]:
    """Recordings on the program of a diagnosis."""
    return [found.map_recording(p) for p in parts]


def error_rows(
    found: Diagnosis, fits: Mapping[str, Fit], tracks: Sequence[MappedRecording], what: str
) -> Rows:
    """Envelope and phase of what was unseen, and which of the two an effect mends."""
    off = polar_errors(found.problem, fits, tracks)
    first = off["linear"]
    rows = []
    for label, (envelope, phase) in off.items():
        shares = [f"{envelope / first[0]:.2f}", f"{phase / first[1]:.2f}"]
        rows.append([what, label, f"{envelope * DEG:.3f}", f"{phase * DEG:.2f}", *shares])
    return rows


def decay_and_period(run: Array, t: Array, omega: float) -> tuple[float, float]:
    """Equivalent linear damping, as a share of critical, and period [s] of a stretch of envelope and phase."""
    slope = np.polyfit(t, np.stack([np.log(run[0]), run[1]], axis=-1), 1)[0]
    return float(-slope[0] / omega), float(2 * np.pi / slope[1])


def window_rows(
    found: Diagnosis, fits: Mapping[str, Fit], tracks: Sequence[MappedRecording]
) -> tuple[Rows, Rows]:
    """Damping and period of every window, recorded and as free runs have them."""
    dampings, periods = [], []
    for laid in tracks:
        runs = polar_runs(found.problem, fits, laid)
        pairs = [decay_and_period(r, laid.times, pulsation(laid)) for r in runs.values()]
        about = [laid.name, f"{float(np.mean(runs['recorded'][0])) * DEG:.1f}"]
        dampings.append([*about, *(f"{100 * zeta:.2f}" for zeta, _ in pairs)])
        periods.append([*about, *(f"{period:.4f}" for _, period in pairs)])
    return dampings, periods


# Speed
# ------------------------------------------------------------------------------------------------------------


def coefficients(problem: Problem, fitted: Fit) -> dict[str, tuple[float, float]]:
    """What one release tells of the hull, each with one standard deviation."""
    body, laid = problem.program.vessel.body, problem.recordings[0]
    value = {(f.effect, f.name): i for i, f in enumerate(fitted.free)}

    def of(effect: str, name: str) -> tuple[float, float]:
        i = value[effect, name]
        unit = laid.values[fitted.free[i].at] if fitted.free[i].relative else 1.0
        return float(fitted.theta[i] * unit), float(np.sqrt(fitted.covariance[i, i]) * unit)

    damping, (stiffness, sd) = of("linear_damping", "roll"), of("righting_arm", "stiffness")
    inertia = body.roll_inertia + laid.values[problem.program.index("added_mass", "roll")]
    percent = 100.0 / (2.0 * np.sqrt(stiffness * inertia))
    period, arm = 2.0 * np.pi * np.sqrt(inertia / stiffness), 1e3 / (body.mass * GRAVITY)
    found = {
        "linear damping [N m s]": damping,
        "the same, share of critical [%]": (damping[0] * percent, damping[1] * percent),
        "period of small rolls [s]": (period, 0.5 * period * sd / stiffness),
        "GM at the roll inertia of the vessel file [mm]": (stiffness * arm, sd * arm),
    }
    for f in fitted.free:
        if not f.relative:
            unit = next(
                type(e).params()[f.name].unit
                for e in problem.program.candidates
                if e.name == f.effect
            )
            found[f"{f.effect}, {f.name} [{unit}]"] = of(f.effect, f.name)
    return found


def both_speeds(at_rest: Diagnosis, at_speed: Diagnosis, releases: Sequence[Recording]) -> Rows:
    """The structure found at rest, fitted to the whole of either release: coefficients and how they differ."""
    found = []
    for diagnosis, whole in zip((at_rest, at_speed), releases, strict=True):
        problem = Problem(
            laid_on(diagnosis, [whole]), diagnosis.problem.ambient, diagnosis.problem.uncertainty
        )
        base = converge(problem, diagnosis.ranking.recalibrated)
        found.append(
            coefficients(
                problem, with_effects(problem, base, [n.name for n in at_rest.ranking.named])
            )
        )
    rows = []
    for name, (a, sa) in found[0].items():
        b, sb = found[1][name]
        rows.append(
            [name, pair(a, sa), pair(b, sb), f"{b / a:.2f}", f"{(b - a) / np.hypot(sa, sb):+.1f}"]
        )
    return rows


def pair(value: float, sd: float) -> str:
    """`2.52 ± 0.11`, with two digits of the deviation."""
    digits = max(0, 1 - int(np.floor(np.log10(sd))))
    return f"{value:.{digits}f} ± {sd:.{digits}f}"


def carried_over(at_rest: Diagnosis, whole: Recording) -> Rows:
    """The boats fitted at zero speed on the release at speed, which they have not seen."""
    (laid,) = laid_on(at_rest, [whole])
    problem, fits = at_rest.problem, models(at_rest.ranking)
    stretches = free_runs(problem, fits, [laid], float(np.ptp(laid.times)))
    rms = errors(stretches)["roll_rms_rad"]
    return [[m, f"{rms[m] * DEG:.3f}", f"{rms[m] / rms['recalibrated']:.2f}"] for m in MODELS]


# Tables
# -----------------------------------------------------------------------------------------------------------


def last_third(found: Diagnosis, whole: Recording) -> tuple[Rows, Ranking]:
    """The tail of the decay with what was fitted elsewhere and by itself; and its own ranking."""
    (tail,) = laid_on(found, thirds(whole)[2:])
    alone = Problem([tail], found.problem.ambient, found.problem.uncertainty)
    ranking = rank(alone, found.problem.program.entries)
    fits = models(found.ranking) | {"linear, fitted here": ranking.recalibrated}
    fits |= {
        f"{n}, fitted here": with_effects(alone, ranking.recalibrated, [n]) for n in ranking.first
    }
    rms = errors(free_runs(alone, fits, [tail], float(np.ptp(tail.times))))["roll_rms_rad"]
    gains = {f"{n}, fitted here": f"{g:+.1f}" for n, g in ranking.first.items()}
    return [[label, f"{x * DEG:.4f}", gains.get(label, "")] for label, x in rms.items()], ranking


def split_table(splits: Mapping[str, Diagnosis]) -> Table:
    """Free runs over unseen data, by the way the release was cut."""
    rows = []
    for name, found in splits.items():
        rms = unseen_errors(found)
        goal = f"<= {GOALS[name]}" if name in GOALS else "none"
        rows.append(
            [
                name,
                *(f"{rms[m] * DEG:.4f}" for m in MODELS),
                f"{ratio(found):.3f}",
                goal,
            ]
        )
    header = ["unseen", "as published", "recalibrated", "patched", "patched / recalibrated", "goal"]
    return "Rms roll error [deg] of free runs over what was kept unseen", header, rows


def tables(splits: Mapping[str, Diagnosis], releases: Sequence[Recording]) -> list[Table]:
    """Everything this benchmark says, in order."""
    whole, moving = releases
    windows, middle, *_, at_speed = splits.values()
    parts = laid_on(windows, cut_windows(whole))
    fits, of_thirds = one_at_a_time(windows), one_at_a_time(middle)
    dampings, periods = window_rows(windows, fits, parts)
    errors = error_rows(windows, fits, parts[1::2], "windows")
    errors += error_rows(middle, of_thirds, laid_on(middle, thirds(whole)[1:2]), "middle third")
    header = ["window", "mean envelope [deg]", "recorded", *fits]
    tail, ranking = last_third(middle, whole)
    best, enough = max(ranking.first.values()), required_gain(len(ranking.first))
    return [
        split_table(splits),
        (
            "Envelope and phase apart: rms error of free runs over unseen data, one effect at a time",
            [
                "unseen",
                "model",
                "envelope [deg]",
                "phase [deg]",
                "envelope / linear",
                "phase / linear",
            ],
            errors,
        ),
        (
            "Envelope: equivalent linear damping [% of critical] by window; the first, third, ... were fitted",
            header,
            dampings,
        ),
        ("Phase: period [s] by window", header, periods),
        (
            f"Last third: {'no' if best < enough else 'a'} model beats the linear clearly, once that is fitted here "
            f"(the best entry then gains {best:.1f} nats; named from {enough:.1f} on)",
            ["model", "rms roll error [deg]", "gain over linear fitted here [nats]"],
            tail,
        ),
        (
            "The release at 15.5 kn held out from the boats fitted to the windows at zero speed",
            ["model", "rms roll error [deg]", "/ recalibrated"],
            carried_over(windows, moving),
        ),
        (
            "What changes with forward speed: the structure found at zero speed, fitted to the whole of either release",
            ["coefficient", "0 kn", "15.5 kn", "ratio", "difference [sd]"],
            both_speeds(windows, at_speed, releases),
        ),
    ]


def main() -> None:
    """Diagnose, explain, compare."""
    (whole, vessel), (moving, _) = opened(AT_REST), opened(AT_SPEED)
    splits = {
        "windows": by_windows(whole, vessel),
        "middle third": by_thirds(whole, vessel),
        "last third": by_thirds(whole, vessel, held_out=2),
    }
    at_speed = by_thirds(moving, vessel)
    splits["15.5 kn by itself, middle third"] = at_speed
    found = tables(splits, (whole, moving))
    windows = splits["windows"]
    extra = (*windows.findings.extra_tables, *found)
    report(replace(windows, findings=replace(windows.findings, extra_tables=extra)), NAME)
    print("at 15.5 kn, by itself:")
    report(at_speed, f"{NAME}/at_15p5kn")
    print(
        f"split: {windows.findings.held_out_note}; {splits['middle third'].findings.held_out_note}, the middle third"
    )
    print("baseline: the linear oscillator with damping and restoring refitted to the same data")
    for one in found:
        table(*one)


if __name__ == "__main__":
    main()
