"""Generation of trials: sample causes, simulate three runs, compute evidence, write files."""

import json
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from validation.practice.boats import BOATS
from validation.practice.cause import Cause, Maker, Rng
from validation.practice.motion import RUNS, Array, Boat
from validation.practice.oracle import Oracle
from validation.practice.pilots import TrackKeeper, sample_open_loop_pilot
from validation.practice.plans import PLANS, Plan
from validation.practice.sail import Voyage, simulate_voyage

COLUMNS = ("x_m", "y_m", "z_m", "phi_rad", "theta_rad", "psi_rad")
FAMILIES = ("position", "position", "heave", "roll", "pitch", "heading")
UNITS = {"position": "m", "heave": "m", "roll": "rad", "pitch": "rad", "heading": "rad"}
STATED = ("position_sd_m", "heading_sd_rad", "roll_sd_rad")  # keys of recording.toml
AXES = ("surge", "sway", "heave", "roll", "pitch", "yaw")
KINDS = (
    "none",
    "single",
    "single",
    "single",
    "pair",
    "unknown",
)  # alternating open-loop and track-keeping trials
CALIBRATION = 0.03  # relative sd of a real boat's damping and thrust
LEAST_FACTOR = 0.3  # of a coefficient of the file
RIGHTING = 0.005  # relative sd of its righting levers
SEEN, SURE = 12.0, (5.0, 20.0)  # [nats] visible from, borderline between
STRANGE_SEEN, STRANGE_SURE = 20.0, (10.0, 40.0)  # [nats] the same of causes outside the library
FIRST, WEAK_TO_STRONG = (
    0.5,
    (0.03, 1.2),
)  # initial strength, scaled to reach the target evidence
WANTED, STRANGE_WANTED = (6.0, 300.0), (40.0, 400.0)  # [nats] sampled log-uniformly
BACKGROUND_WANTED = (3.0, 60.0)  # [nats] of errors of the model's form
OUTLIERS, FAR = 0.02, 15.0  # share of the rows, and size in sd of the instrument


@dataclass(frozen=True)
class Trial:
    """Specification of a trial."""

    name: str
    vessel: str
    kind: str
    concealed: bool
    outliers: bool
    makers: tuple[Maker, ...]
    plan: Plan
    boat: Callable[[], Boat]
    calibration: float = CALIBRATION  # relative sd of the real boat's damping and thrust
    stated: bool = False  # whether recording.toml states that sd
    disturbance: float = 1.0  # ambient force over that of the practice set
    level_stated: bool = True  # whether recording.toml states the level of the ambient force
    background: int = 0  # weak causes outside the library, the last of the makers

    @property
    def strange(self) -> list[bool]:
        """Whether each cause is outside the library; of a mixed trial the last main one is."""
        count = len(self.makers) - self.background
        main = [self.kind == "unknown"] * count
        if self.kind == "mixed":
            main = [False] * (count - 1) + [True]
        return main + [True] * self.background

    def nominal(self) -> Boat:
        """Return the boat of the vessel file, with the uncertainty that the trial states."""
        boat = replace(self.boat(), disturbance=self.disturbance)
        if not self.stated:
            return boat
        kinds = sorted({"damping", "thrust"} & set(boat.kinds.values()))
        return replace(
            boat, uncertainty={**boat.uncertainty, **dict.fromkeys(kinds, self.calibration)}
        )


def trials(seed: int, per_vessel: int) -> Iterator[Trial]:
    """Return all trials of a set: kinds in turn, causes sampled without replacement."""
    number = 0
    for index, (vessel, plan) in enumerate(PLANS.items()):
        rng = np.random.default_rng([seed, index])
        known, strange = Deck(plan.single, rng), Deck(plan.strange, rng)
        for i in range(per_vessel):
            kind, number = KINDS[i % len(KINDS)], number + 1
            if kind == "unknown":
                sampled_causes = strange.sample(1)
            else:
                sampled_causes = known.sample({"none": 0, "single": 1, "pair": 2}[kind])
            concealed = plan.kept and kind != "none" and (i // len(KINDS) + i) % 2 == 1
            yield Trial(
                f"T{number:03d}_{vessel}",
                vessel,
                kind,
                concealed,
                kind == "none" and i > 0,
                sampled_causes,
                plan,
                BOATS[vessel],
            )


class Deck:
    """Causes to sample from, shuffled again when none remain."""

    def __init__(self, makers: tuple[Maker, ...], rng: Rng) -> None:
        self.makers, self.rng, self.left = makers, rng, list[Maker]()

    def sample(self, n: int) -> tuple[Maker, ...]:
        """Return the next n, all different."""
        found: list[Maker] = []
        while len(found) < n:
            if not self.left:
                self.left = [self.makers[i] for i in self.rng.permutation(len(self.makers))]
            if (maker := self.left.pop()) not in found:
                found.append(maker)
        return tuple(found)


def make_trial(trial: Trial, seed: int, out: Path) -> dict[str, Any]:
    """Write one trial to its folder and return its answer."""
    seeds = (seed, int(trial.name[1:].partition("_")[0]))
    strange = any(trial.strange)
    strengths, oracle, gains = choose_strengths(trial, seeds)
    answer = {
        "kind": trial.kind,
        "vessel": trial.vessel,
        "concealed": trial.concealed,
        "strength": [round(float(s), 3) for s in strengths],
        "outliers": trial.outliers,
        "calibration_error": trial.calibration,
        "effects": [cause_entry(c) for c in oracle.causes],
        **{
            f"noise_{f}_{UNITS[f]}": float(f"{s:.3g}")
            for f, s in zip(FAMILIES, oracle.noise, strict=True)
            if s
        },
        **evidence_entries(trial, gains),
        **equivalent_effects(trial, oracle.causes),
    }
    rng = np.random.default_rng([*seeds, 1])
    if 0 in oracle.nominal.free:
        rms = oracle.free_runs(6.0 * oracle.nominal.scale, rng)
        left_out = "true_structure" if strange else ""
        answer["reference_position_rms_m"] = {
            k: round(v, 6) for k, v in rms.items() if k != left_out
        }
    voyage = add_outliers(oracle.voyage, oracle.noise, rng) if trial.outliers else oracle.voyage
    write_trial(out / trial.name, oracle.nominal, voyage, answer, trial)
    return answer


def choose_strengths(trial: Trial, seeds: tuple[int, int]) -> tuple[Array, Oracle, Array]:
    """Return the trial with strengths that give about the target evidence.

    Returns:
        The strengths of the causes, the trial, and the gains [nats].
    """
    wanted = []
    main = len(trial.makers) - trial.background
    for i, strange in enumerate(trial.strange):
        low, high = np.log(STRANGE_WANTED if strange else WANTED)
        if i >= main:
            low, high = np.log(BACKGROUND_WANTED)
        wanted.append(np.exp(np.random.default_rng([*seeds, 0, i]).uniform(low, high)))
    strengths = np.full(len(wanted), FIRST)
    oracle = simulate_trial(trial, seeds, strengths)
    if not wanted:
        return strengths, oracle, strengths
    found = np.maximum(evidence_gains(oracle, trial.strange), 0.1)
    strengths = np.clip(strengths * np.sqrt(np.array(wanted) / found), *WEAK_TO_STRONG)
    oracle = simulate_trial(trial, seeds, strengths)
    return strengths, oracle, evidence_gains(oracle, trial.strange)


def simulate_trial(trial: Trial, seeds: tuple[int, int], strengths: Array) -> Oracle:
    """Simulate the trial with causes of these strengths; all other samples are unchanged."""
    nominal, plan = trial.nominal(), trial.plan
    grid, rng = plan.grid(), np.random.default_rng([*seeds, 2])
    noise = sample_instrument_noise(nominal, plan, rng)
    real = sample_true_boat(nominal, rng, trial.calibration)
    causes = []
    for i, (maker, s) in enumerate(zip(trial.makers, strengths, strict=True)):
        causes.append(
            round_latency(maker(nominal, np.random.default_rng([*seeds, 3, i]), float(s)), grid.dt)
        )
    pilot = (
        TrackKeeper(nominal, grid, rng)
        if trial.concealed
        else sample_open_loop_pilot(nominal, grid, rng)
    )
    return Oracle(
        nominal, real, causes, simulate_voyage(real, causes, pilot, grid, noise, rng), noise
    )


def round_latency(cause: Cause, dt: float) -> Cause:
    """Round the latency of a clock to whole fine steps."""
    if not cause.late:
        return cause
    late = max(round(cause.late / dt), 1) * dt
    return replace(cause, late=late, parameters={name: late for name in cause.parameters})


def sample_instrument_noise(boat: Boat, plan: Plan, rng: Rng) -> Array:
    """Return the instrument noise (6,) of this trial (sd)."""
    usual = {f: sd * rng.uniform(0.7, 1.3) for f, sd in plan.noise.items()}
    return np.array([usual[f] if i in boat.free else 0.0 for i, f in enumerate(FAMILIES)])


def sample_true_boat(nominal: Boat, rng: Rng, calibration: float) -> Boat:
    """Return a boat with coefficients sampled near those of the file."""
    sd = {"damping": calibration, "thrust": calibration, "restoring": RIGHTING}
    factors = {}
    for name, kind in nominal.kinds.items():
        factors[name] = max(1.0 + sd[kind] * rng.standard_normal(), LEAST_FACTOR)
    return replace(nominal, c={n: x * factors.get(n, 1.0) for n, x in nominal.c.items()})


def cause_entry(cause: Cause) -> dict[str, Any]:
    """Return the entry of a cause in answer.json."""
    found: dict[str, Any] = {
        "name": cause.name,
        "parameters": {k: float(v) for k, v in cause.parameters.items()},
    }
    return found | ({"not_compared": list(cause.not_compared)} if cause.not_compared else {})


def evidence_gains(oracle: Oracle, strange: Sequence[bool]) -> Array:
    """Return the evidence gain [nats] of each cause over the others, or over the library."""
    gains = []
    for cause, outside in zip(oracle.causes, strange, strict=True):
        alone = outside and len(strange) == 1
        gains.append(oracle.beyond_library(cause) if alone else oracle.marginal(cause))
    return np.array(gains)


def evidence_entries(trial: Trial, gains: Array) -> dict[str, Any]:
    """Return the entries about evidence in answer.json, of all causes but the background."""
    gains = gains[: len(gains) - trial.background]
    if not len(gains):
        return {}
    strange = trial.strange[: len(gains)]
    thresholds = np.array([STRANGE_SEEN if outside else SEEN for outside in strange])
    weakest = int(np.argmin(gains / thresholds))
    low, high = STRANGE_SURE if strange[weakest] else SURE
    least = float(gains[weakest])
    return {
        "visible": bool(least > thresholds[weakest]),
        "borderline": low < least < high,
        "marginal_gain_nats": [round(float(g), 1) for g in gains],
    }


def equivalent_effects(trial: Trial, causes: tuple[Cause, ...]) -> dict[str, Any]:
    """Return the effects that are equivalent to the true ones."""
    found = {c.name: [*c.same, *(() if trial.concealed else c.same_by_hand)] for c in causes}
    found = {name: others for name, others in found.items() if others}
    if found:
        return {"equivalent": found}
    return {}


def uncertainty_table(boat: Boat) -> str:
    """Return the table of recording.toml with the uncertainty of the boat's coefficients."""
    lines = [f"{kind} = {sd:g}" for kind, sd in sorted(boat.uncertainty.items())]
    return "\n[coefficient_uncertainty]\n" + "\n".join(lines) + "\n"


def add_outliers(voyage: Voyage, noise: Array, rng: Rng) -> Voyage:
    """Add outliers to two per cent of the rows, as by reflections or receiver jumps."""
    hit = rng.random((len(voyage.recorded), RUNS)) < OUTLIERS
    jump = FAR * noise[:, None] * rng.standard_normal((len(voyage.recorded), 6, RUNS))
    jump[:, 5] = 0.0
    return replace(voyage, recorded=voyage.recorded + jump * hit[:, None, :])


def ambient_table(boat: Boat) -> str:
    """Return the table of recording.toml with the level of the ambient force."""
    size = dict(zip(AXES, boat.ambient(), strict=True))
    free = [AXES[i] for i in boat.free]
    force_rms = ", ".join(f"{size[axis]:.3g}" for axis in free)
    return f"\n[ambient]\naxes = {json.dumps(free)}\nforce_rms = [{force_rms}]\n"


def write_trial(
    folder: Path, boat: Boat, voyage: Voyage, answer: dict[str, Any], trial: Trial
) -> None:
    """Write recording.toml, three runs and answer.json."""
    folder.mkdir(parents=True, exist_ok=True)
    noise = {f"{f}_sd_{UNITS[f]}": sd for f, sd in trial.plan.noise.items()}
    notes = f'vessel = "{boat.name}"\n\n[noise]\n'
    notes += "".join(f"{k} = {noise[k]:g}\n" for k in STATED if k in noise)
    if trial.level_stated:
        notes += ambient_table(boat)
    if trial.stated:
        notes += uncertainty_table(boat)
    (folder / "recording.toml").write_text(notes)
    t = np.arange(voyage.grid.rows) * voyage.grid.row
    used = [i for i in range(len(boat.channels)) if np.any(voyage.commands[:, i])]
    names = ["t_s", *(COLUMNS[i] for i in boat.free), *(list(boat.channels)[i] for i in used)]
    for run in range(RUNS):
        table = np.column_stack(
            [t, voyage.recorded[:, boat.free, run], voyage.commands[:, used, run]]
        )
        np.savetxt(
            folder / f"run_{run + 1}.csv", table, "%.7g", ",", header=",".join(names), comments=""
        )
    (folder / "answer.json").write_text(json.dumps(answer, indent=1) + "\n")
