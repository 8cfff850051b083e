"""The next experiment: the manoeuvre that best distinguishes the best hypothesis from its rivals.

The criterion is the expected log Bayes factor between the best hypothesis and a rival: the
Kullback-Leibler divergence of their predictions, each with the posterior of its parameters (Box and
Hill 1967, Discrimination among mechanistic models, Technometrics 9, 57-71). Both predictions pass
through the filter, so that the latent force can absorb differences, and use the noise levels of the
best hypothesis. The expected motion of the best hypothesis is treated as a recording without noise,
and the rival is refitted to it. The rival may attribute the remaining misfit to a larger
disturbance, which reduces a large expected log Bayes factor.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from math import isfinite
from operator import attrgetter

import numpy as np

from boatsim.diagnosis.candidates import name_without_prefixes
from boatsim.diagnosis.config import DiagnosisConfig
from boatsim.diagnosis.experiment_design.manoeuvres import available_manoeuvres
from boatsim.diagnosis.experiment_design.simulated_manoeuvre import (
    SimulatedManoeuvre,
    simulate_manoeuvre,
    wall_distances,
)
from boatsim.diagnosis.filter import FilterPass, MappedRecording
from boatsim.diagnosis.problem import Fit, Problem, froude_scale
from boatsim.diagnosis.search.pruning import IdentifiedEffect
from boatsim.diagnosis.search.ranking import Ranking
from boatsim.files import toml_value
from boatsim.physics.base import Array
from boatsim.physics.content import vessel_reference
from boatsim.physics.groups import without_group
from boatsim.physics.signals import motion_signals
from boatsim.physics.vessel import Vessel

# [s] integration step written into next.toml for a hull of 1.2 m; the diagnosis does not use it
SCENARIO_STEP = 0.02
NOTHING = "nothing"  # name of the rival in which no candidate acts


@dataclass(frozen=True)
class Plan:
    """The manoeuvre to record next, with the evidence that it is expected to give.

    It is chosen to distinguish the best hypothesis on what the vessel model lacks from its rivals.

    Attributes:
        manoeuvre: Name of the manoeuvre.
        start: Initial pose in the degrees of freedom, such as x, y [m] and psi [rad], and u [m/s].
        times: Times [s] from which the rows of `levels` hold.
        levels: Values of the commands.
        duration: Duration [s].
        separates: Effects in question: those of the best hypothesis alone, then the rivals.
        log_bayes_factors: Expected log Bayes factor against each rival [nats].
    """

    manoeuvre: str
    start: Mapping[str, float]
    times: tuple[float, ...]
    levels: tuple[Mapping[str, float], ...]
    duration: float
    separates: tuple[str, ...]
    log_bayes_factors: Mapping[str, float]

    @property
    def expected_log_bayes_factor(self) -> float:
        """Expected log Bayes factor of the manoeuvre against the closest rival hypothesis [nats].

        The closest rival is the one with the smallest expected factor.
        """
        return min(self.log_bayes_factors.values())


def best_plan(problem: Problem, best: Fit, rivals: Mapping[str, Fit]) -> Plan | None:
    """Return the manoeuvre that is expected to distinguish rival hypotheses best.

    It has the largest expected log Bayes factor against the rival that is hardest to distinguish.
    The result is deterministic. Each manoeuvre and rival takes a few tens of filter passes.

    Args:
        problem: The estimation problem.
        best: Fit of the best hypothesis on what the vessel model lacks.
        rivals: Fits of rival hypotheses by name.

    Returns:
        The plan; None without rivals, or if no manoeuvre is expected to distinguish them.
    """
    limit = problem.config.plan.min_gain
    plan = max(
        all_plans(problem, best, rivals), key=lambda p: p.expected_log_bayes_factor, default=None
    )
    if plan is None or plan.expected_log_bayes_factor <= limit:
        return None
    return plan


def all_plans(problem: Problem, best: Fit, rivals: Mapping[str, Fit]) -> list[Plan]:
    """Return every feasible manoeuvre with the evidence that it is expected to give.

    The evidence is the expected log Bayes factor of the best hypothesis against each rival. The
    list is empty if there are no rivals.

    Args:
        problem: The estimation problem.
        best: Fit of the best hypothesis on what the vessel model lacks.
        rivals: Fits of rival hypotheses by name.
    """
    if not rivals:
        return []
    shared = set(best.effects).intersection(*(rival.effects for rival in rivals.values()))
    own = [name for name in best.effects if name not in shared]
    manoeuvres = available_manoeuvres(
        problem.program.vessel,
        _usual_commands(problem),
        _largest_roll_angle(problem),
        wall_distances(problem) is not None,
        problem.config.plan,
    )
    plans = []
    for manoeuvre in manoeuvres:
        simulated = simulate_manoeuvre(problem, best, manoeuvre)
        if simulated is None:
            continue
        gains = expected_log_bayes_factors(problem, simulated.recording, best, rivals)
        if all(map(isfinite, gains.values())):  # a rival that diverges tells nothing
            plans.append(_plan(simulated, (*own, *rivals), gains))
    return plans


def _plan(
    simulated: SimulatedManoeuvre, separates: tuple[str, ...], gains: Mapping[str, float]
) -> Plan:
    manoeuvre = simulated.manoeuvre
    signals = motion_signals(simulated.recording.program.vessel.dof)
    start = {}
    for signal, value in zip(signals, simulated.start.tolist(), strict=True):
        if not signal.rate or signal.symbol == "u":
            start[signal.symbol] = value
    return Plan(
        manoeuvre.name,
        start,
        manoeuvre.times,
        manoeuvre.levels,
        manoeuvre.duration,
        separates,
        gains,
    )


def undecided_hypotheses(ranking: Ranking, config: DiagnosisConfig) -> tuple[Fit, dict[str, Fit]]:
    """Return the hypotheses that a selection of effects leaves undecided, for the next experiment.

    The rivals are the look-alikes of the identified effects. If there are none, the most probable
    of the effects that are only possible is compared with its nearest rival, or with its absence;
    without such effects, the least certain identified effect. If nothing was identified, the best
    candidate effect is compared with no effect and with its own look-alikes, if its evidence is
    large enough.

    Args:
        ranking: Result of the selection of effects.
        config: Settings; the groups `plan` and `select` are used.

    Returns:
        Fit of the best hypothesis, and fits of its rivals by name.
    """
    undecided = list(filter(attrgetter("tied_with"), ranking.named))
    if not undecided and ranking.doubtful:
        return ranking.best, _rivals_of_suspect(ranking)
    if not undecided:
        undecided = sorted(ranking.named, key=lambda named: named.probability)[:1]
    if undecided:
        rivals = {}
        for named in undecided:
            for name in named.tied_with or distinct_rivals(named)[:1]:
                rivals[name] = named.rivals[name]
        return ranking.best, rivals
    least = ranking.best.evidence + config.plan.min_candidate_gain
    order = sorted(ranking.last, key=lambda name: -ranking.last[name].evidence)
    hints = [name for name in order if ranking.last[name].evidence > least]
    if not hints:
        return ranking.best, {}
    best = ranking.last[hints[0]]
    rivals = {}
    for name in hints[1 : config.plan.max_candidates]:
        if ranking.last[name].evidence > best.evidence - config.select.alike:
            rivals[name] = ranking.last[name]
    return best, {**rivals, NOTHING: ranking.best}


def _rivals_of_suspect(ranking: Ranking) -> dict[str, Fit]:
    """Fits of the rivals of the most probable effect that is only possible."""
    suspect = max(ranking.doubtful, key=attrgetter("probability"))
    names = suspect.tied_with or distinct_rivals(suspect)[:1]
    if not names:
        return {NOTHING: ranking.without[suspect.name]}
    return {name: suspect.rivals[name] for name in names}


def command_steps(plan: Plan | None) -> tuple[tuple[float, Mapping[str, float]], ...]:
    """Return the commands of a planned manoeuvre as steps in time.

    Each step has the time [s] from which it holds and the value of each command. The last step,
    without commands, is the end of the manoeuvre.
    """
    if plan is None:
        return ()
    steps = [step for step in zip(plan.times, plan.levels, strict=True) if step[1]]
    if not steps:
        return ()
    return (*steps, (plan.duration, {}))


def scenario_text(plan: Plan, vessel: Vessel) -> str:
    """Return the text of a scenario file that simulates a planned manoeuvre with the vessel."""
    step = min(float(f"{SCENARIO_STEP * froude_scale('s', vessel):.1g}"), 1.0)
    separates = ", ".join(plan.separates)
    base = toml_value(vessel_reference(vessel.file))
    lines = [
        "#!/usr/bin/env -S boatsim run",
        f'about = "Next recording: {plan.manoeuvre}. It distinguishes: {separates}."',
        f"vessel = {base}  # or patched.toml, with all effects",
        f"load = {toml_value(list(vessel.load))}",
        f"duration = {plan.duration:g}  # [s]",
        f"step = {step:g}  # [s]",
        "",
        "[start]  # m, rad, m/s",
    ]
    for name, value in plan.start.items():
        if value:
            lines.append(f"{name} = {value:.4g}")
    lines += ["", "[controller]", 'use = "open_loop"', f"period = {step:g}  # [s]"]
    for time, level in zip(plan.times, plan.levels, strict=True):
        if level:
            lines += ["", "[[goal]]", f"from = {time:g}  # [s]"]
            for name, value in level.items():
                lines.append(f"{name} = {value:g}")
    return "\n".join(lines) + "\n"


def distinct_rivals(named: IdentifiedEffect) -> list[str]:
    """Return the rivals of an identified effect that are different effects.

    The same effect on another actuator does not count as a rival.
    """
    return [
        rival
        for rival in named.rivals
        if name_without_prefixes(without_group(rival))
        != name_without_prefixes(without_group(named.name))
    ]


def expected_log_bayes_factors(
    problem: Problem, recording: MappedRecording, best: Fit, rivals: Mapping[str, Fit]
) -> dict[str, float]:
    """Return the log Bayes factor [nats] that a manoeuvre is expected to give against each rival.

    The best hypothesis is assumed to be true. Each rival is refitted to the motion expected under
    it.

    Args:
        problem: The estimation problem.
        recording: Expected motion of the best hypothesis in a manoeuvre.
        best: Fit of the best hypothesis on what the vessel model lacks.
        rivals: Fits of rival hypotheses by name.
    """
    config = problem.config.plan
    log_posterior, U = _refit(problem, recording, best, best, 0)
    own = U.T @ U
    gains = {}
    for name, rival in rivals.items():
        rival_posterior, V = _refit(problem, recording, best, rival, config.refit_steps)
        A = V.T @ V
        B = V.T @ U
        M = np.eye(len(A)) + A
        # effect of the posterior of the best hypothesis that the rival cannot reproduce
        spread = np.trace(own) - np.trace(np.linalg.solve(M, A + B @ B.T))
        volume = np.linalg.slogdet(M)[1] - np.linalg.slogdet(np.eye(len(own)) + own)[1]
        gain = float(log_posterior - rival_posterior + 0.5 * (volume + spread))
        gains[name] = _with_refitted_disturbance(gain, recording, best)
    return gains


def _with_refitted_disturbance(gain: float, recording: MappedRecording, best: Fit) -> float:
    """Expected log Bayes factor [nats] if the disturbance level of the rival is refitted too.

    A misfit of g nats is distributed over n independent intervals of the latent force, where
    n = 1 + T / 2 tau for an Ornstein-Uhlenbeck process that must explain a constant. If its
    variance is refitted, n/2 log(1 + 2 g / n) remains.
    """
    if not gain > 0.0:
        return gain
    n = 1.0 + 0.5 * float(np.ptp(recording.times)) / best.levels.time_constant
    return 0.5 * n * float(np.log1p(2.0 * gain / n))


def _refit(
    problem: Problem, recording: MappedRecording, best: Fit, model: Fit, max_steps: int
) -> tuple[float, Array]:
    """Maximum of the log posterior of a model, and the derivative of its whitened errors there.

    Parameters are counted in posterior standard deviations from the fit, along the Cholesky factor.
    """
    config = problem.config.plan
    on = problem.program.effect_switches(model.effects)
    root = np.linalg.cholesky(model.covariance)
    low = np.array(list(map(attrgetter("low"), model.free)))
    high = np.array(list(map(attrgetter("high"), model.free)))

    def parameter_values(xi: Array) -> Array:
        return problem.parameter_vector(
            recording, model.free, np.clip(model.theta + root @ xi, low, high)
        )

    def log_posterior(xi: Array) -> tuple[float, FilterPass]:
        passed = recording.filter(parameter_values(xi), on, best.levels)
        return passed.log_likelihood - 0.5 * float(xi @ xi), passed

    def derivative(xi: Array, about: FilterPass) -> Array:
        """Derivative (M, F) of the whitened errors with the gains of a pass."""
        U = np.empty((len(about.whitened), len(xi)))
        for j in range(len(xi)):
            moved = xi.copy()
            moved[j] += config.posterior_step
            changed = recording.whitened_errors(parameter_values(moved), on, best.levels, about)
            U[:, j] = (changed - about.whitened) / config.posterior_step
        return U

    xi = np.zeros(len(model.theta))
    maximum, about = log_posterior(xi)
    U = derivative(xi, about)
    for _ in range(max_steps):
        gradient = -(U.T @ about.whitened) - xi
        step = np.linalg.solve(np.eye(len(xi)) + U.T @ U, gradient)
        for _ in range(config.refit_halvings):
            value, passed = log_posterior(xi + step)
            if value > maximum:
                break
            step *= 0.5
        else:
            break
        gain = value - maximum
        maximum = value
        about = passed
        xi = xi + step
        U = derivative(xi, about)
        if gain < config.refit_min_gain:
            break
    return maximum, U


def _usual_commands(problem: Problem) -> dict[str, float]:
    """Median of each command over the recordings."""
    commands = np.concatenate([mapped.commands for mapped in problem.recordings])
    medians = {}
    for i, name in enumerate(problem.program.vessel.commands):
        medians[name] = float(np.median(commands[:, i]))
    return medians


def _largest_roll_angle(problem: Problem) -> float:
    """Largest recorded roll angle [rad]."""
    angles = []
    for mapped in problem.recordings:
        if "phi_rad" in mapped.signals:
            angles.append(mapped.measured[:, mapped.signals.index("phi_rad")])
    if not angles:
        return 0.0
    return float(np.nanmax(np.abs(np.concatenate(angles))))
