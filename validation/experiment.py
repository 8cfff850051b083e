"""Benefit of the suggested next experiment: `python -m validation.experiment`.

Options: `--jobs N`, `--quick`. Each candidate effect of trial_boat acts once per seed on a boat
simulated with the compiled engine. Its strength is half of the prior standard deviation; directions
and places are sampled from their prior. Damping and thrust are off by 5 %; ambient force and camera
noise are as in the practice trials. A first, short recording of gentle steering is diagnosed. The
diagnosis is repeated three times with one additional recording of equal length: the suggested
manoeuvre, a random manoeuvre of the same menu, and gentle steering again. The probability of the
truth is its posterior weight among all single effects and the nominal model, as under `candidates`
in diagnosis.json. A case without a suggestion uses the run of gentle steering instead.
"""

import argparse
import os
import time
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from functools import cache

import numpy as np
from rich.progress import track as shown

from boatsim.diagnosis import priors
from boatsim.diagnosis.candidates import candidate_library
from boatsim.diagnosis.experiment_design.next_experiment import (
    Plan,
    all_plans,
    best_plan,
    undecided_hypotheses,
)
from boatsim.diagnosis.filter import dof_in_state_order
from boatsim.diagnosis.prior_noise import prior_noise_levels
from boatsim.diagnosis.problem import Problem, froude_scale
from boatsim.diagnosis.recording_mapping import map_recording
from boatsim.diagnosis.search.ranking import Ranking, select_and_rank_candidates
from boatsim.physics import vessel
from boatsim.physics.base import Array
from boatsim.physics.kernel.records import VesselNumbers
from boatsim.physics.program import Program
from boatsim.recordings.table import Recording

BOAT, STRENGTH, ERROR = "trial_boat", 0.5, 0.05
SHORT, LONG = 20.0, 40.0  # [s] duration of the first and of the additional run
RATE, SUBSTEPS = 6.0, 8  # rows per second, integration steps per row
POSITION_SD, HEADING_SD = (
    (0.002, 0.005),
    (0.009, 0.018),
)  # [m], [rad] ranges of the camera noise (sd)
NOTHING = "nothing"


@dataclass(frozen=True)
class Boat:
    """Differences of a boat from its vessel file: parameters, active effects and camera noise."""

    values: Array
    on: Array
    position_sd: float  # [m]
    heading_sd: float  # [rad]


@dataclass(frozen=True)
class Outcome:
    """Result of one case: probability of the true effect, and the suggestion."""

    truth: str
    before: float
    suggested: float
    other: float
    same: float
    manoeuvre: str
    expected: float  # [nats]
    # [nats] log Bayes factor of the truth over its best rival: after minus before the suggested run
    gained: float


@cache
def program() -> Program:
    """Return the compiled program of the vessel with all its candidates."""
    boat = vessel.load_vessel(BOAT)
    return Program(boat, candidate_library(boat).compiled_effects)


def perturbed_boat(truth: str, rng: np.random.Generator) -> Boat:
    """Return a boat on which one effect acts at half strength, with perturbed coefficients."""
    boat, values = program().vessel, program().values()
    for effect in boat.effects:
        for name, about in type(effect).params().items():
            if about.calibrates:
                values[program().parameter_index(effect.name, name)] *= (
                    1.0 + ERROR * rng.standard_normal()
                )
    kind = next(type(e) for e in program().candidates if e.name == truth)
    for name, about in kind.params().items():
        if about.fit:
            spread = about.spread * froude_scale(about.unit, boat)
            if name in (kind.strength or kind.params()):
                away = rng.choice((-1.0, 1.0)) * STRENGTH
            else:
                away = rng.normal()
            inside = about.low <= about.inactive_value + away * spread <= about.high
            value = about.inactive_value + (away if inside else -away) * spread
            values[program().parameter_index(truth, name)] = np.clip(value, about.low, about.high)
    return Boat(
        values,
        program().effect_switches([truth]),
        rng.uniform(*POSITION_SD),
        rng.uniform(*HEADING_SD),
    )


def gentle_driving(rng: np.random.Generator, length: float) -> tuple[Array, Array]:
    """Return start (x, y, psi, 0, 0, 0) and commands (N, C) of slow, almost straight driving."""
    rows = round(length * RATE)
    commands = np.zeros((rows, 4))
    begin = 0
    while begin < rows:
        end = begin + round(rng.uniform(3.0, 6.0) * RATE)
        thrust = 0.3 * rng.choice((-1.0, 1.0))
        turn = rng.uniform(-0.1, 0.1)
        steer = rng.uniform(-0.2, 0.2)
        commands[begin:end] = thrust + turn, thrust - turn, steer, steer
        begin = end
    return np.array(
        [*rng.uniform(-1.0, 1.0, 2), rng.uniform(-np.pi, np.pi), 0.0, 0.0, 0.0]
    ), commands


def simulated_commands(plan: Plan) -> tuple[Array, Array]:
    """Return start and commands of a plan."""
    t = np.arange(round(plan.duration * RATE)) / RATE
    now = np.searchsorted(np.array(plan.times) - 1e-6, t, side="right") - 1
    rows = np.array([program().command_array(level) for level in plan.levels])
    start = [plan.start.get(n, 0.0) for n in ("x", "y", "psi", "u")]
    return np.array([*start, 0.0, 0.0]), rows[now]


def record_boat(
    name: str, boat: Boat, start: Array, commands: Array, rng: np.random.Generator
) -> Recording:
    """Return the recording of a boat under the commands, with ambient force and camera noise."""
    code, y, out = program().simulation_functions, start.copy(), np.zeros((2, 6))
    memory, act = np.zeros(program().memory_size), np.zeros(program().actuator_signal_size)
    code.settle_actuators(commands[0], memory, boat.values, boat.on, act)
    about = program().vessel.diagnosis
    rms = np.array([about.ambient[axis] for axis in dof_in_state_order(program().vessel)])
    kept = np.exp(-1.0 / RATE / priors.assumed_correlation_time(program().vessel))
    force, rows = rms * rng.standard_normal(3), []
    for i in range(len(commands)):
        rows.append(y[:3].copy())
        code.rollout(
            VesselNumbers(program().body, boat.values, boat.on),
            program().vessel_state(y, memory, force),
            commands[i : i + 1],
            i / RATE,
            1.0 / RATE / SUBSTEPS,
            SUBSTEPS,
            out,
        )
        force = kept * force + np.sqrt(1.0 - kept**2) * rms * rng.standard_normal(3)
    sd = np.array([boat.position_sd, boat.position_sd, boat.heading_sd])
    x, y_m, psi = (np.array(rows) + sd * rng.standard_normal((len(rows), 3))).T
    signals = dict(zip(program().vessel.commands, commands.T, strict=True))
    return Recording(
        name, np.arange(len(rows)) / RATE, {"x_m": x, "y_m": y_m, "psi_rad": psi, **signals}
    )


def diagnose(recordings: Sequence[Recording]) -> tuple[Problem, Ranking]:
    """Return the ranking of all candidates."""
    boat = program().vessel
    uncertainty = priors.coefficient_uncertainty(boat)
    problem = Problem(
        [map_recording(r, program()) for r in recordings],
        prior_noise_levels(boat, recordings),
        uncertainty,
    )
    return problem, select_and_rank_candidates(problem, tuple(e.name for e in program().candidates))


def probability(ranking: Ranking, name: str) -> float:
    """Return the posterior weight of one effect among all single effects and the nominal model."""
    gains = {NOTHING: 0.0, **ranking.first}
    return float(np.exp(gains[name] - np.logaddexp.reduce(list(gains.values()))))


def lead_over_others(ranking: Ranking, name: str) -> float:
    """Return the log Bayes factor [nats] of one effect over the best of the others."""
    return ranking.first[name] - max(
        g for n, g in {NOTHING: 0.0, **ranking.first}.items() if n != name
    )


def run_case(truth: str, seed: int) -> Outcome:
    """Return the outcome of one boat, diagnosed four times."""
    rng = np.random.default_rng([seed, *truth.encode()])
    boat = perturbed_boat(truth, rng)
    first = record_boat("first", boat, *gentle_driving(rng, SHORT), rng)
    again = record_boat("same kind", boat, *gentle_driving(rng, LONG), rng)
    problem, before = diagnose([first])
    question = undecided_hypotheses(before, problem.config)
    plan = best_plan(problem, *question)
    _, same = diagnose([first, again])
    after = other = same
    if plan is not None:
        menu = [p for p in all_plans(problem, *question) if p.manoeuvre != plan.manoeuvre]
        any_one = menu[rng.integers(len(menu))]
        after, other = (
            diagnose([first, record_boat(p.manoeuvre, boat, *simulated_commands(p), rng)])[1]
            for p in (plan, any_one)
        )
    return Outcome(
        truth,
        *(probability(r, truth) for r in (before, after, other, same)),
        plan.manoeuvre if plan else "",
        plan.expected_log_bayes_factor if plan else 0.0,
        lead_over_others(after, truth) - lead_over_others(before, truth),
    )


def print_table(found: Sequence[Outcome]) -> None:
    """Print every case, then the means."""
    columns = (
        f"{'before':>7s} {'suggested':>9s} {'other':>6s} {'same':>6s} {'expected':>8s} "
        f"{'gained':>7s}"
    )
    print(f"{'truth':22s} {columns}  suggested manoeuvre")
    for o in found:
        figures = (
            f"{o.before:7.2f} {o.suggested:9.2f} {o.other:6.2f} {o.same:6.2f} "
            f"{o.expected:8.1f} {o.gained:7.1f}"
        )
        print(f"{o.truth:22s} {figures}  {o.manoeuvre or '(none suggested)'}")
    print(f"\nmean probability of the truth over {len(found)} cases")
    print(f"  after a short run of gentle steering  {np.mean([o.before for o in found]):.2f}")
    print(f"  with the suggested manoeuvre added    {np.mean([o.suggested for o in found]):.2f}")
    print(f"  with another one of the menu added    {np.mean([o.other for o in found]):.2f}")
    print(f"  with one more run of gentle steering  {np.mean([o.same for o in found]):.2f}")
    print(f"cases with a suggestion: {sum(bool(o.manoeuvre) for o in found)}")
    print(
        "expected, gained: evidence of the truth over its best rival [nats], predicted "
        "and after the suggested run"
    )


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--quick", action="store_true", help="one seed, every third entry")
    args = parser.parse_args()
    names = [e.name for e in program().candidates if type(e).kind == "physics"]
    if args.quick:
        chosen = [(n, 0) for n in names[::3]]
    else:
        chosen = [(n, seed) for n in names for seed in (0, 1)]
    program().simulation_functions  # noqa: B018  # compile before the processes start
    begin = time.time()
    with ProcessPoolExecutor(args.jobs) as pool:
        found = list(
            shown(pool.map(run_case, *zip(*chosen, strict=True)), "diagnosing", len(chosen))
        )
    print_table(found)
    print(f"{time.time() - begin:.0f} s on {args.jobs} processes")


if __name__ == "__main__":
    main()
