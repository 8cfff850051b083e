"""Fits a hypothesis (which suspects act) inside the filter and scores it by its Laplace evidence."""

from collections.abc import Callable, Sequence
from math import erf, log, sqrt

import numpy as np

from boatsim.diagnosis.filter import NoiseLevels
from boatsim.diagnosis.noise_levels import FINE, ROUGH, fit_force, force_prior
from boatsim.diagnosis.problem import Fit, FreeParameter, Problem
from boatsim.physics.base import Array

SETTLED = 0.3  # [nats] a refit that gains less changes nothing
HALVINGS = 6  # of the way from a start at which the boat runs away to the boat with nothing missing
# share of what a step promised that it must gain for derivatives to be learnt from it
TRUSTED = 0.5
# a step damped this much goes but part of the way, so that it does as promised says nothing
SHORT = 0.1
TINY = 1e-300  # variance of what is known exactly


def fit(problem: Problem, found: Fit, settled: bool = False) -> Fit:
    """Parameters (unless settled), then force levels with the spectra of random forces, then parameters again."""
    variance = np.diag(found.covariance)
    new = any(
        f.searched and v == f.sd**2 for f, v in zip(found.free, variance, strict=True)
    )  # never fitted
    if not new and not settled:
        found = descend(problem, found, iterations=4, enough=SETTLED)
    found = fit_force(problem, found, FINE if new else ROUGH)
    return descend(problem, found, iterations=3, enough=0.1)


def converge(problem: Problem, found: Fit, most: int = 8) -> Fit:
    """Refit until parameters and force levels agree, so that a later gain is not the gain of a refit."""
    for i in range(most):
        again = fit(problem, found, settled=i > 0)
        gain = again.evidence - found.evidence
        if gain > 0:
            found = again
        if gain < SETTLED:
            break
    return found


def reduced(problem: Problem, found: Fit, without: str) -> Fit:
    """The start of a fit without one of the suspects, nearer to nothing missing where the boat would run away."""
    effects = tuple(n for n in found.effects if n != without)
    free = problem.parameters(effects)
    known = {(f.effect, f.name): x for f, x in zip(found.free, found.theta, strict=True)}
    theta, nothing = (
        np.array([known[f.effect, f.name] for f in free]),
        np.array([f.mean for f in free]),
    )
    on = problem.program.switches(effects)
    for _ in range(HALVINGS):
        if np.isfinite(problem.likelihood(free, theta, on, found.levels)):
            break
        theta = 0.5 * (theta + nothing)
    return Fit(effects, free, theta, np.diag([f.sd**2 for f in free]), found.levels, -np.inf)


class Space:
    """Bounds and priors of free parameters, for steps in units of the prior sd."""

    def __init__(self, free: Sequence[FreeParameter]) -> None:
        self.mean, self.sd, self.low, self.high = (
            np.array([getattr(f, a) for f in free], dtype=float)
            for a in ("mean", "sd", "low", "high")
        )

    def clipped(self, theta: Array) -> Array:
        """Within the bounds."""
        return np.asarray(np.clip(theta, self.low, self.high))

    def stepped(self, theta: Array, J: Array, g: Array, damping: float) -> Array:
        """After a damped Gauss-Newton step along gradient g by theta / sd; what wants out of a bound stays at it."""
        A = J.T @ J
        free = np.diag(A) > 0.0
        step = np.zeros(len(g))
        for _ in range(4):
            step[:] = 0.0
            if not free.any():
                break
            B = A[np.ix_(free, free)] + np.eye(int(free.sum())) * (1.0 + 10.0 * damping)
            step[free] = np.linalg.solve(B, g[free])
            stuck = (step < 0) & (theta <= self.low + 1e-12) | (step > 0) & (
                theta >= self.high - 1e-12
            )
            if not (free & stuck).any():
                break
            free &= ~stuck
        return self.clipped(theta + self.sd * step)

    def promised(self, J: Array, g: Array, before: Array, after: Array) -> float:
        """Gain of the score that the quadratic model promises for a step."""
        s = (after - before) / self.sd
        return float(g @ s - 0.5 * (s @ s + np.sum((J @ s) ** 2)))

    def covariance(self, information: Array) -> Array:
        """(F, F) from the information in units of the prior sd."""
        return np.asarray(np.linalg.inv(information) * np.outer(self.sd, self.sd), dtype=np.float64)


def as_promised(gain: float, promised: float) -> bool:
    """Whether a step did what the quadratic model said: the next one would gain next to nothing."""
    return abs(gain - promised) < 0.1 + 0.02 * abs(promised)


def log_prior(free: Sequence[FreeParameter], theta: Array) -> float:
    """Log prior density up to what all hypotheses share; half a normal distribution has twice the density."""
    found = 0.0
    for f, x in zip(free, theta, strict=True):
        found += np.log(2.0) * (f.mean in (f.low, f.high)) - 0.5 * ((float(x) - f.mean) / f.sd) ** 2
    return found


def cut_off(free: Sequence[FreeParameter], theta: Array, covariance: Array) -> float:
    """Log of the share of a posterior that lies within bounds where priors are one-sided: a half for what is at one."""
    found = 0.0
    for f, x, variance in zip(free, theta, np.diag(covariance), strict=True):
        if f.mean in (f.low, f.high):
            found += log(
                0.5 + 0.5 * erf(abs(float(x) - f.mean) / sqrt(2.0 * max(float(variance), TINY)))
            )
    return found


def descend(problem: Problem, found: Fit, iterations: int, enough: float) -> Fit:
    """Gauss-Newton on prior and whitened prediction errors from `found`, bounds kept; covariance and evidence.

    Derivatives are taken where it begins, and after a step learnt from what it changed (Broyden 1965): only where one
    does not do as these promised are they taken anew.
    """
    free, levels, space = found.free, found.levels, Space(found.free)
    on = problem.program.switches(found.effects)
    theta = space.clipped(found.theta)

    def score(x: Array) -> float:
        return problem.likelihood(free, x, on, levels) + log_prior(free, x)

    def derived(white: Array) -> tuple[Array, Array]:
        """Derivatives of the errors at theta, and what the score has of slope besides, by the gains."""
        if not problem.stiff:
            return jacobian(problem, free, theta, on, levels, white), np.zeros(len(free))
        J, g = slopes(problem, free, score, best, theta, space)
        return J, g + J.T @ white + (theta - space.mean) / space.sd

    best, damping = score(theta), 1e-3
    J, besides, known = np.zeros((1, len(free))), np.zeros(len(free)), False
    for _ in range(iterations):
        white = problem.white()  # at theta: the last pass was a full one there
        if not known:
            J, besides = derived(white)
        g = besides - J.T @ white - (theta - space.mean) / space.sd
        step, gain = None, 0.0
        for _ in range(5):
            trial = space.stepped(theta, J, g, damping)
            value = score(trial)
            if np.isfinite(value) and value > best - 1e-6:
                step, gain = trial, value - best
                break
            damping = max(damping, 1e-2) * 10.0
        if step is None:
            score(theta)
            if not known:
                break
            known = False  # what the last steps taught was wrong
            continue
        promised = space.promised(J, g, theta, step)
        kept = damping < SHORT and as_promised(gain, promised)
        moved = (step - theta) / space.sd
        theta, best, damping = step, best + gain, damping / 10.0
        if (gain < enough or kept) and (not known or promised < enough):
            break
        known = gain > TRUSTED * promised
        if known:
            J = learnt(J, problem.white() - white, moved)
    if known:  # spreads are those of derivatives taken, not learnt
        J, _ = derived(problem.white())
    information = np.eye(len(free)) + J.T @ J
    information[np.diag_indices(len(free))] += _curvature(problem, free, theta, on, levels)
    covariance = space.covariance(information)
    evidence = best - 0.5 * float(np.linalg.slogdet(information)[1]) + force_prior(problem, levels)
    return Fit(
        found.effects, free, theta, covariance, levels, evidence + cut_off(free, theta, covariance)
    )


def learnt(J: Array, change: Array, step: Array) -> Array:
    """Derivatives by theta / sd that agree with the change of the errors over a step, and else differ least from J."""
    length = float(step @ step)
    return J + np.outer((change - J @ step) / length, step) if length > 0.0 else J


def slopes(
    problem: Problem,
    free: Sequence[FreeParameter],
    score: Callable[[Array], float],
    best: float,
    theta: Array,
    space: Space,
) -> tuple[Array, Array]:
    """Derivatives by theta / sd of the whitened errors (rows, F) and of the score (F,), gains and all.

    On a stiff hull damping moves the gains more than the errors: with gains held the score would seem to rise where it
    falls. Forward differences of a hundredth of the prior sd; the curvature, known from the errors, is taken out.
    """
    white = problem.white()
    J, g = np.zeros((len(white), len(theta))), np.zeros(len(theta))
    for j, f in enumerate(free):
        if f.searched:
            continue
        h = 0.01 if theta[j] + 0.01 * space.sd[j] <= space.high[j] else -0.01
        moved = theta.copy()
        moved[j] += h * space.sd[j]
        rise = (score(moved) - best) / h
        if np.isfinite(rise):
            J[:, j] = (problem.white() - white) / h
            g[j] = rise + 0.5 * h * (1.0 + float(J[:, j] @ J[:, j]))
    return J, g


def jacobian(
    problem: Problem,
    free: Sequence[FreeParameter],
    theta: Array,
    on: Array,
    levels: NoiseLevels,
    white: Array,
    only: int = 0,
) -> Array:
    """Derivative of the whitened errors by theta / sd, forward differences of a hundredth of the prior sd.

    Gains are those of the last full pass. Columns before `only` are left out.
    """
    J = np.zeros((len(white), len(free) - only))
    for j, f in enumerate(free[only:], only):
        if f.searched:
            continue
        moved = theta.copy()
        h = 0.01 * f.sd if theta[j] + 0.01 * f.sd <= f.high else -0.01 * f.sd
        moved[j] += h
        column = (problem.whitened(free, moved, on, levels) - white) * (f.sd / h)
        if np.isfinite(column).all():  # otherwise the boat runs away there
            J[:, j - only] = column
    return J


def _curvature(
    problem: Problem, free: Sequence[FreeParameter], theta: Array, on: Array, levels: NoiseLevels
) -> Array:
    """Information on parameters without a gradient, by second differences of the likelihood half a prior sd wide."""
    found = np.zeros(len(free))
    searched = [j for j, f in enumerate(free) if f.searched]
    if not searched:
        return found
    middle = problem.likelihood(free, theta, on, levels)
    for j in searched:
        f, moved = free[j], theta.copy()
        h = 0.5 * f.sd
        centre = (
            float(np.clip(theta[j], f.low + h, f.high - h)) if f.high - f.low > 2 * h else theta[j]
        )
        around = []
        for x in (centre - h, centre, centre + h):
            moved[j] = x
            around.append(middle if x == theta[j] else problem.likelihood(free, moved, on, levels))
        found[j] = max(0.0, (2.0 * around[1] - around[0] - around[2]) / 0.25)
    problem.likelihood(free, theta, on, levels)
    return found
