"""The next manoeuvre: which one would best tell the winner of a diagnosis from its look-alikes.

What a manoeuvre is worth is the expected log Bayes factor between winner and rival: the Kullback-Leibler divergence of
what the two predict for it, each with the parameters and the covariance that the data so far have left it (Box and
Hill 1967, Discrimination among mechanistic models, Technometrics 9, 57-71). Both predictions go through the filter, so
that the latent force takes up what it may; both use the winner's noise and force levels. The course that the winner
expects is laid on the program like a recording, without noise, and the rival is refitted to it; what it still misses
it may take for a stronger ambient force, which leaves much less of a large gain.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from boatsim.diagnosis.candidates import called
from boatsim.diagnosis.experiment_design.manoeuvres import menu
from boatsim.diagnosis.experiment_design.simulated_manoeuvre import Course, laid, walls
from boatsim.diagnosis.filter import FilterPass, MappedRecording
from boatsim.diagnosis.problem import Fit, Problem, froude_scale
from boatsim.diagnosis.report.schema import NextEntry
from boatsim.diagnosis.search.pruning import ALIKE, Named
from boatsim.diagnosis.search.ranking import Ranking
from boatsim.physics.base import Array
from boatsim.physics.content import vessel_address
from boatsim.physics.vessel import Vessel

ROUNDS, HALVINGS = 3, 3  # Gauss-Newton steps of a rival's refit, and how often one is halved
NUDGE = 0.05  # [sd] of the posterior by which parameters are moved for a derivative
WORTH = 1.0  # [nats] that a manoeuvre must be expected to tell to be suggested
HINT = 1.0  # [nats] that an entry which is not named must gain for a manoeuvre to ask about it
STEP = 0.02  # [s] of the scenario of a 1.2 m boat; others by Froude's law


@dataclass(frozen=True)
class Plan:
    """A manoeuvre to record next, and what it is expected to tell."""

    manoeuvre: str
    start: Mapping[str, float]  # x, y [m], psi, phi [rad], u [m/s] at its begin
    times: tuple[float, ...]  # [s] from which each row of levels holds
    levels: tuple[Mapping[str, float], ...]  # command -> value
    duration: float  # [s]
    separates: tuple[str, ...]  # what is in question: the winner's own entries, then its rivals
    gains: Mapping[str, float]  # rival -> expected log Bayes factor against it [nats]

    @property
    def expected_gain(self) -> float:
        """Expected log Bayes factor against the rival that is hardest to tell from the winner [nats]."""
        return min(self.gains.values())


def next_experiment(problem: Problem, winner: Fit, rivals: Mapping[str, Fit]) -> Plan | None:
    """The manoeuvre with the largest worst-case expected log Bayes factor; None without rivals, or if none tells them.

    The manoeuvres are those of `manoeuvres.menu`. Deterministic; a few tens of filter passes per manoeuvre and rival.
    """
    best = max(plans(problem, winner, rivals), key=lambda p: p.expected_gain, default=None)
    return best if best is not None and best.expected_gain > WORTH else None


def plans(problem: Problem, winner: Fit, rivals: Mapping[str, Fit]) -> list[Plan]:
    """Every manoeuvre this vessel can do, with what it would tell; none without rivals."""
    if not rivals:
        return []
    own = (n for n in winner.effects if any(n not in r.effects for r in rivals.values()))
    separates = (*own, *rivals)
    able = menu(
        problem.program.vessel, _in_use(problem), _heel(problem), walls(problem) is not None
    )
    courses = (laid(problem, winner, manoeuvre) for manoeuvre in able)
    return [
        _plan(c, separates, expected(problem, c.track, winner, rivals))
        for c in courses
        if c is not None
    ]


def _plan(course: Course, separates: tuple[str, ...], gains: Mapping[str, float]) -> Plan:
    m, names = course.manoeuvre, ("x", "y", "psi", "u") if len(course.start) == 6 else ("phi",)
    start = {name: float(value) for name, value in zip(names, course.start, strict=False)}
    return Plan(m.words, start, m.times, m.levels, m.duration, separates, gains)


def question(ranking: Ranking) -> tuple[Fit, dict[str, Fit]]:
    """What a ranking leaves to be decided: the winner, and its rivals by name.

    Rivals are the look-alikes of what was named; without any, the nearest one of the least certain. Where nothing was
    named, the best entry stands against nothing at all and its own look-alikes, if it gains anything to speak of.
    """
    tied = [n for n in ranking.named if n.tied_with] or sorted(
        ranking.named, key=lambda n: n.probability
    )[:1]
    if tied:
        rivals = {r: n.rivals[r] for n in tied for r in n.tied_with or others(n)[:1]}
        return ranking.best, rivals
    order = sorted(ranking.last, key=lambda n: -ranking.last[n].evidence)
    hints = [n for n in order if ranking.last[n].evidence > ranking.best.evidence + HINT]
    if not hints:
        return ranking.best, {}
    winner = ranking.last[hints[0]]
    alike = {
        n: ranking.last[n] for n in hints[1:3] if ranking.last[n].evidence > winner.evidence - ALIKE
    }
    return winner, {**alike, "nothing": ranking.best}


def entry(plan: Plan | None, scenario: str) -> NextEntry:
    """What diagnosis.json says of a plan; empty without one."""
    if plan is None:
        return {}
    return {
        "manoeuvre": plan.manoeuvre,
        "scenario": scenario,
        "separates": list(plan.separates),
        "expected_gain_nats": round(plan.expected_gain, 2),
    }


def steps(plan: Plan | None) -> tuple[tuple[float, Mapping[str, float]], ...]:
    """From which time [s] on each command has which value; last, without commands, the end. Empty without a plan."""
    if plan is None:
        return ()
    told = [(t, level) for t, level in zip(plan.times, plan.levels, strict=True) if level]
    return (*told, (plan.duration, {})) if told else ()


def scenario_text(plan: Plan, vessel: Vessel) -> str:
    """A scenario file that plays the plan on the vessel that was diagnosed."""
    step = min(float(f"{STEP * froude_scale('s', vessel):.1g}"), 1.0)
    lines = [
        "#!/usr/bin/env -S boatsim run",
        f'about = "What to record next: {plan.manoeuvre}; to tell apart: {", ".join(plan.separates)}."',
        f"vessel = {_quoted(vessel_address(vessel.file))}  # patched.toml plays it with what was found",
        f"load = [{', '.join(_quoted(one) for one in vessel.load)}]",
        f"duration = {plan.duration:g}  # [s]",
        f"step = {step:g}  # [s]",
        "",
        "[start]  # m, rad, m/s",
        *(f"{name} = {value:.4g}" for name, value in plan.start.items() if value),
        "",
        "[controller]",
        'use = "open_loop"',
        f"period = {step:g}  # [s]",
    ]
    for time, level in zip(plan.times, plan.levels, strict=True):
        values = [f"{name} = {value:g}" for name, value in level.items()]
        lines += ["", "[[goal]]", f"from = {time:g}  # [s]", *values] if values else []
    return "\n".join(lines) + "\n"


def _quoted(text: str) -> str:
    return '"' + text.replace("\\", "\\\\").replace('"', '\\"') + '"'


# ---- what a manoeuvre would tell


def others(named: Named) -> list[str]:
    """Rivals that are another idea, not the same on the other side of an actuator."""
    return [r for r in named.rivals if called(r) != called(named.name)]


def expected(
    problem: Problem, track: MappedRecording, winner: Fit, rivals: Mapping[str, Fit]
) -> dict[str, float]:
    """Expected log Bayes factor [nats] of a course that the winner expects, against each rival."""
    score, U = _refitted(problem, track, winner, winner, 0)
    own = U.T @ U
    gains = {}
    for name, rival in rivals.items():
        best, V = _refitted(problem, track, winner, rival, ROUNDS)
        A, B = V.T @ V, V.T @ U
        M = np.eye(len(A)) + A
        # the winner's parameters are not known exactly either: what the rival can not follow of
        # their spread
        spread = np.trace(own) - np.trace(np.linalg.solve(M, A + B @ B.T))
        volume = np.linalg.slogdet(M)[1] - np.linalg.slogdet(np.eye(len(own)) + own)[1]
        gains[name] = _tempered(float(score - best + 0.5 * (volume + spread)), track, winner)
    return gains


def _tempered(gain: float, track: MappedRecording, winner: Fit) -> float:
    """What is left of a gain [nats] if the rival's ambient force is refitted too.

    A misfit of g nats is spread over n independent stretches of the latent force, n = 1 + T / 2 tau for an
    Ornstein-Uhlenbeck process that has to explain a constant; with its variance refitted n/2 log(1 + 2 g / n) is left.
    """
    n = 1.0 + 0.5 * float(np.ptp(track.times)) / winner.levels.time_constant
    return 0.5 * n * float(np.log1p(2.0 * gain / n)) if gain > 0.0 else gain


def _refitted(
    problem: Problem, track: MappedRecording, winner: Fit, model: Fit, rounds: int
) -> tuple[float, Array]:
    """Log posterior of a model at its best for this course, and the derivative of its whitened errors there.

    Parameters are counted in standard deviations along the axes of what the data so far have left: xi = 0 is the fit.
    """
    on = problem.program.switches(model.effects)
    root = np.linalg.cholesky(model.covariance)
    low, high = np.array([f.low for f in model.free]), np.array([f.high for f in model.free])

    def values(xi: Array) -> Array:
        return problem.values(track, model.free, np.clip(model.theta + root @ xi, low, high))

    def score(xi: Array) -> tuple[float, FilterPass]:
        passed = track.filter(values(xi), on, winner.levels)
        return passed.log_likelihood - 0.5 * float(xi @ xi), passed

    def derivative(xi: Array, about: FilterPass) -> tuple[Array, Array]:
        """Whitened errors (M,) and their derivative (M, F), with the gains of a pass."""
        white = about.whitened
        U = np.empty((len(white), len(xi)))
        for j in range(len(xi)):
            moved = xi.copy()
            moved[j] += NUDGE
            U[:, j] = (track.whitened(values(moved), on, winner.levels, about) - white) / NUDGE
        return white, U

    xi = np.zeros(len(model.theta))
    best, about = score(xi)
    white, U = derivative(xi, about)
    for _ in range(rounds):
        step = np.linalg.solve(np.eye(len(xi)) + U.T @ U, -(U.T @ white) - xi)
        for _ in range(HALVINGS):
            value, about = score(xi + step)
            if value > best:
                break
            step *= 0.5
        else:
            break
        gained, best, xi = value - best, value, xi + step
        white, U = derivative(xi, about)
        if gained < 0.1:
            break
    return best, U


# ---- what the recordings were like


def _in_use(problem: Problem) -> dict[str, float]:
    """Median of each command over the recordings."""
    commands = np.concatenate([t.commands for t in problem.recordings])
    return {
        n: float(np.median(commands[:, i])) for i, n in enumerate(problem.program.vessel.commands)
    }


def _heel(problem: Problem) -> float:
    """Largest roll angle recorded [rad]."""
    found = [
        t.measured[:, t.signals.index("phi_rad")]
        for t in problem.recordings
        if "phi_rad" in t.signals
    ]
    return float(np.nanmax(np.abs(np.concatenate(found)))) if found else 0.0
