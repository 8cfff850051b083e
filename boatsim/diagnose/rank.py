"""Names what is missing: every suspect fitted in the filter, scored by evidence, selected forward, pruned backward."""

from dataclasses import dataclass, replace

import numpy as np

from boatsim.diagnose.fit import converge, fit
from boatsim.diagnose.levels import fit_noise
from boatsim.diagnose.problem import Fit, Problem

ENOUGH = 4.0  # [nats] an effect must gain to be named
ALIKE = 3.0  # [nats] entries this close to the winner are its look-alikes
FRONT, CLOSE = 3, 10.0  # how many candidates, and how near to the first [nats], are looked at more closely
MOST = 3  # effects in one answer
UNKNOWN_FACTOR = 2.0  # what is left is judged against this many times the ambient force


@dataclass(frozen=True)
class Named:
    """An effect the data call for."""

    name: str
    gain: float  # [nats] on top of the others named
    probability: float
    tied_with: tuple[str, ...]  # look-alikes, at most three


@dataclass(frozen=True)
class Ranking:
    """What selection found."""

    nominal: Fit  # the vessel as written, noise and force levels fitted
    recalibrated: Fit  # the nominal structure with its own coefficients refitted
    best: Fit
    named: tuple[Named, ...]
    first: dict[str, float]  # gain of every suspect alone over the recalibrated nominal [nats]
    last: dict[str, Fit]  # every suspect not named, fitted on top of the best set
    left_over: float  # [nats] that a force beyond twice the ambient one gains after the best set


def rank(problem: Problem, candidates: tuple[str, ...]) -> Ranking:
    """Forward selection over the candidates, the incumbent converged before each comparison."""
    nominal = replace(problem.nominal(), levels=fit_noise(problem))
    recalibrated = converge(problem, fit(problem, (), nominal))
    best = recalibrated
    first: dict[str, float] = {}
    for _ in range(2 * MOST):  # additions and prunings together
        tried = _tried(problem, best, candidates)
        gains = {n: f.evidence - best.evidence for n, f in tried.items()}
        first = first or dict(gains)
        if not tried or len(best.suspects) == MOST or max(gains.values()) < ENOUGH:
            break
        name = max(gains, key=lambda n: gains[n])
        best = _pruned(problem, converge(problem, tried[name]))
    best, named = _settled(problem, best, candidates)
    return Ranking(nominal, recalibrated, best, named, first, tried, left_over(problem, best))


def _settled(problem: Problem, best: Fit, candidates: tuple[str, ...]) -> tuple[Fit, tuple[Named, ...]]:
    """The set without members that gain too little on top of the others, and what is to be said of the rest."""
    while True:
        named = tuple(_named(problem, best, n, candidates) for n in best.suspects)
        weak = [n for n in named if n.gain < ENOUGH]
        if not weak:
            return best, named
        least = min(weak, key=lambda n: n.gain).name
        best = converge(problem, fit(problem, tuple(n for n in best.suspects if n != least), best))


def _tried(problem: Problem, best: Fit, candidates: tuple[str, ...]) -> dict[str, Fit]:
    """Every other candidate on top of the best set; those in front with the force levels refitted."""
    tried = {n: fit(problem, (*best.suspects, n), best, rounds=1) for n in candidates if n not in best.suspects}
    order = sorted(tried, key=lambda n: -tried[n].evidence)
    front = [n for i, n in enumerate(order) if i < FRONT or tried[n].evidence > tried[order[0]].evidence - CLOSE]
    return tried | {n: fit(problem, tried[n].suspects, tried[n]) for n in front}


def _pruned(problem: Problem, best: Fit) -> Fit:
    """Without the earlier effects that the newest one has made needless."""
    for name in best.suspects[:-1]:
        rest = tuple(n for n in best.suspects if n != name)
        without = converge(problem, fit(problem, rest, best))
        if without.evidence > best.evidence - ENOUGH:
            best = without
    return best


def _named(problem: Problem, best: Fit, name: str, candidates: tuple[str, ...]) -> Named:
    """Gain of one effect on top of the others, and how its rivals do in its place."""
    rest = tuple(n for n in best.suspects if n != name)
    without = converge(problem, fit(problem, rest, best))
    gain = best.evidence - without.evidence
    others = {n: fit(problem, (*rest, n), without, rounds=1) for n in candidates if n not in best.suspects}
    # the first look is without the force levels refitted, which makes a good explanation better: be generous
    front = sorted(others, key=lambda n: -others[n].evidence)[:FRONT]
    rivals = {n: converge(problem, others[n]).evidence - without.evidence for n in front}
    weights = np.exp(np.array([0.0, gain, *rivals.values()]) - max(gain, 0.0, *rivals.values()))
    order = sorted(rivals, key=lambda n: -rivals[n])
    tied = tuple(n for n in order if rivals[n] > gain - ALIKE)[:3]
    return Named(name, gain, float(weights[1] / weights.sum()), tied)


def left_over(problem: Problem, best: Fit) -> float:
    """Nats that the latent force gains beyond twice the ambient level: what nothing in the library explains."""
    on = problem.program.switches(best.suspects)
    held = replace(best.levels, force=np.minimum(best.levels.force, UNKNOWN_FACTOR * problem.ambient.force))
    free = problem.likelihood(best.free, best.theta, on, best.levels)
    return free - problem.likelihood(best.free, best.theta, on, held)
