"""Fits a hypothesis (which suspects act) inside the filter and scores it by its Laplace evidence."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from boatsim.base import Array
from boatsim.diagnose.filter import Levels
from boatsim.diagnose.levels import fit_force, force_prior
from boatsim.diagnose.problem import Fit, Free, Problem, scale_of


def fit(problem: Problem, suspects: Sequence[str], start: Fit, rounds: int = 2) -> Fit:
    """A hypothesis fitted from the values of `start`, force levels refitted in turn; the best of its starts."""
    free = problem.parameters(suspects)
    known = {(f.effect, f.name): x for f, x in zip(start.free, start.theta, strict=True)}
    best: Fit | None = None
    for first in _starts(problem, suspects, start):
        theta = np.array([known.get((f.effect, f.name), first.get((f.effect, f.name), f.mean)) for f in free])
        found = descend(problem, suspects, free, theta, start.levels, iterations=6, enough=0.3)
        if best is None or found.evidence > best.evidence:
            best = found
    assert best is not None
    for _ in range(rounds - 1):
        levels = fit_force(problem, best)
        best = descend(problem, suspects, free, best.theta, levels, iterations=4, enough=0.1)
    return replace(best, evidence=best.evidence + force_prior(problem, best.levels))


def converge(problem: Problem, found: Fit, most: int = 4) -> Fit:
    """Refit until parameters and force levels agree, so that a later gain is not the gain of a refit."""
    for _ in range(most):
        again = fit(problem, found.suspects, found)
        gain = again.evidence - found.evidence
        if gain > 0:
            found = again
        if gain < 0.3:
            break
    return found


def _starts(problem: Problem, suspects: Sequence[str], start: Fit) -> list[dict[tuple[str, str], float]]:
    """Where the newest suspect's parameters start."""
    new = [s for s in suspects if s not in start.suspects]
    if not new:
        return [{}]
    effect = next(e for e in problem.program.effects if e.name() == new[-1])
    params, vessel = type(effect).params(), problem.program.vessel
    default = {}
    for name, p in params.items():
        step = 0.1 * p.spread * scale_of(p.unit, vessel)
        default[name] = p.absent + (step if p.absent + step <= p.high else -step)
    given = [{n: x * scale_of(params[n].unit, vessel) for n, x in s.items()} for s in type(effect).starts] or [{}]
    return [{(new[-1], n): x for n, x in {**default, **s}.items()} for s in given]


def descend(
    problem: Problem, suspects: Sequence[str], free: tuple[Free, ...], theta: Array, levels: Levels, iterations: int,
    enough: float,
) -> Fit:  # fmt: skip
    """Gauss-Newton on prior and whitened prediction errors, bounds kept; evidence without the force levels' prior."""
    on = problem.program.switches(suspects)
    mean, sd = np.array([f.mean for f in free]), np.array([f.sd for f in free])
    low, high = np.array([f.low for f in free]), np.array([f.high for f in free])
    theta = np.clip(theta, low, high)

    def score(x: Array) -> float:
        return problem.likelihood(free, x, on, levels) - 0.5 * float(np.sum(((x - mean) / sd) ** 2))

    best, damping = score(theta), 1e-3
    J = np.zeros((1, len(free)))
    for _ in range(iterations):
        white = problem.white()  # at theta: the last pass was a full one there
        J = _jacobian(problem, free, theta, on, levels, high, sd, white)
        A, g = J.T @ J, -(J.T @ white) - (theta - mean) / sd
        step, gain = None, 0.0
        for _ in range(5):
            trial = np.clip(theta + sd * _bounded_step(A, g, damping, theta, low, high), low, high)
            value = score(trial)
            if np.isfinite(value) and value > best - 1e-6:
                step, gain = trial, value - best
                break
            damping = max(damping, 1e-2) * 10.0
        if step is None:
            score(theta)
            break
        theta, best, damping = step, best + gain, damping / 10.0
        if gain < enough:
            break
    information = np.eye(len(free)) + J.T @ J
    covariance = np.asarray(np.linalg.inv(information) * np.outer(sd, sd), dtype=np.float64)
    evidence = best - 0.5 * float(np.linalg.slogdet(information)[1])
    return Fit(tuple(suspects), free, theta, covariance, levels, evidence)


def _jacobian(
    problem: Problem,
    free: Sequence[Free],
    theta: Array,
    on: Array,
    levels: Levels,
    high: Array,
    sd: Array,
    white: Array,
) -> Array:
    """Derivative of the whitened errors by theta / sd, forward differences of a hundredth of the prior sd."""
    J = np.empty((len(white), len(free)))
    for j in range(len(free)):
        moved = theta.copy()
        h = 0.01 * sd[j] if theta[j] + 0.01 * sd[j] <= high[j] else -0.01 * sd[j]
        moved[j] += h
        J[:, j] = (problem.whitened(free, moved, on, levels) - white) * (sd[j] / h)
    return J


def _bounded_step(A: Array, g: Array, damping: float, theta: Array, low: Array, high: Array) -> Array:
    """Newton step in units of sd; a parameter at its bound that wants out stays."""
    free = np.ones(len(g), dtype=bool)
    step = np.zeros(len(g))
    for _ in range(4):
        step[:] = 0.0
        if not free.any():
            break
        B = A[np.ix_(free, free)] + np.eye(int(free.sum())) * (1.0 + 10.0 * damping)
        step[free] = np.linalg.solve(B, g[free])
        stuck = free & (((step < 0) & (theta <= low + 1e-12)) | ((step > 0) & (theta >= high - 1e-12)))
        if not stuck.any():
            break
        free &= ~stuck
    return step
