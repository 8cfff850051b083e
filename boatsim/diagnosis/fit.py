"""Fits one hypothesis with the filter and computes its Laplace evidence."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import erf, log, sqrt

import numpy as np

from boatsim.diagnosis.filter import NoiseLevels
from boatsim.diagnosis.noise_levels import fit_latent_force_level, log_noise_level_prior
from boatsim.diagnosis.problem import (
    FilterPasses,
    Fit,
    FreeParameter,
    Problem,
    free_parameter_values,
    prior_arrays,
)
from boatsim.physics.base import Array

TINY = 1e-300  # variance of what is known exactly
ON_BOUND = 1e-12  # distance from a bound at which a parameter is held there
LOST = 1e-6  # [nats] that a step may lose by rounding


def fit(problem: Problem, found: Fit, converged: bool = False) -> Fit:
    """Fit the parameters and the noise levels of one hypothesis to the recordings.

    A hypothesis is the vessel model with a given set of candidate effects. Parameters are fitted
    first, then the levels of the latent force with the spectra of stochastic forces, then the
    parameters again.

    Args:
        problem: The estimation problem: recordings, vessel model, candidate effects and priors.
        found: Hypothesis with the values from which the fit starts.
        converged: Whether the parameters have already been fitted to the present noise levels.
    """
    config = problem.config.fit
    variance = np.diag(found.covariance)
    new = False
    for parameter, v in zip(found.free, variance, strict=True):
        new = new or bool(parameter.searched and v == parameter.sd**2)  # never fitted
    if not new and not converged:
        end = _ascend(
            _hypothesis(problem, found), found.theta, config.first_steps, config.refit_gain
        )
        found = replace(found, theta=end.point.theta)
    found = fit_latent_force_level(problem, found, config.fine_gain if new else config.rough_gain)
    return gauss_newton(problem, found, config.last_steps, config.step_gain)


def converge(problem: Problem, found: Fit) -> Fit:
    """Refit a hypothesis until its parameters and its noise levels no longer change.

    A hypothesis is the vessel model with a given set of candidate effects. A later gain of evidence
    is then not merely the gain of a refit.

    Args:
        problem: The estimation problem: recordings, vessel model, candidate effects and priors.
        found: Hypothesis with the values from which the fit starts.
    """
    config = problem.config.fit
    for i in range(config.most_refits):
        again = fit(problem, found, converged=i > 0)
        gain = again.evidence - found.evidence
        if gain > 0:
            found = again
        if gain < config.refit_gain:
            break
    return found


def remove_effect(problem: Problem, found: Fit, name: str) -> Fit:
    """Remove one candidate effect from a fit; the result is a starting point for a new fit.

    The other parameters are moved towards zero effect where the simulated boat would diverge.

    Args:
        problem: The estimation problem: recordings, vessel model, candidate effects and priors.
        found: Fit of the vessel model with some candidate effects.
        name: Name of one of its effects.
    """
    effects = tuple(n for n in found.effects if n != name)
    free = problem.free_parameters(effects)
    theta = free_parameter_values(free, found.values())
    nothing = prior_arrays(free).mean
    on = problem.program.effect_switches(effects)
    for _ in range(problem.config.fit.halvings):
        if np.isfinite(problem.log_likelihood(free, theta, on, found.levels)):
            break
        theta = 0.5 * (theta + nothing)
    return unfitted_hypothesis(effects, free, theta, found.levels)


def unfitted_hypothesis(
    effects: tuple[str, ...], free: tuple[FreeParameter, ...], theta: Array, levels: NoiseLevels
) -> Fit:
    """Return a hypothesis at given parameter values, before any fit.

    A hypothesis is the vessel model with a set of candidate effects. Its covariance is that of the
    prior, and its evidence is minus infinity.

    Args:
        effects: Names of the candidates that act.
        free: Its free parameters.
        theta: (F,) their values.
        levels: Levels of sensor noise and of the latent (unmodelled) force.
    """
    covariance = np.diag([f.sd**2 for f in free])
    return Fit(effects, free, theta, covariance, levels, -np.inf)


class ParameterSpace:
    """Bounds and normal priors of the free parameters of a hypothesis, for Gauss-Newton steps.

    Steps are measured in prior standard deviations.
    """

    def __init__(self, free: Sequence[FreeParameter]) -> None:
        self.mean, self.sd, self.low, self.high = prior_arrays(free)

    def clip(self, theta: Array) -> Array:
        """Return the values (F,) of the F free parameters, each limited to its bounds."""
        return np.asarray(np.clip(theta, self.low, self.high))

    def damped_step(self, theta: Array, A: Array, g: Array, damping: float) -> Array:
        """Return the parameters after a damped Gauss-Newton step.

        A parameter whose step leads out of a bound stays at the bound.

        Args:
            theta: (F,) parameters before the step.
            A: (F, F) information J.T @ J of the derivatives J of the whitened errors by theta / sd.
            g: (F,) gradient of the score by theta / sd.
            damping: Damping of the step; 0.1 doubles the weight of the prior.
        """
        free = np.diag(A) > 0.0
        step = np.zeros(len(g))
        for _ in range(4):  # seldom reached: the step is limited to the bounds in any case
            step[:] = 0.0
            if not free.any():
                break
            B = A[np.ix_(free, free)] + np.eye(int(free.sum())) * (1.0 + 10.0 * damping)
            step[free] = np.linalg.solve(B, g[free])
            at_low = (step < 0) & (theta <= self.low + ON_BOUND)
            at_high = (step > 0) & (theta >= self.high - ON_BOUND)
            stuck = at_low | at_high
            if not (free & stuck).any():
                break
            free &= ~stuck
        return self.clip(theta + self.sd * step)

    def predicted_gain(self, J: Array, g: Array, before: Array, after: Array) -> float:
        """Return the gain of the log posterior that its quadratic model predicts for a step.

        Args:
            J: (rows, F) derivatives of the whitened errors by theta / sd.
            g: (F,) gradient of the score by theta / sd.
            before: (F,) parameters before the step.
            after: (F,) parameters after the step.
        """
        s = (after - before) / self.sd
        return float(g @ s - 0.5 * (s @ s + np.sum((J @ s) ** 2)))

    def covariance(self, information: Array) -> Array:
        """Return the posterior covariance (F, F) of the parameters, from their information matrix.

        The information matrix (F, F) is given in units of the prior standard deviations.
        """
        return np.asarray(np.linalg.inv(information) * np.outer(self.sd, self.sd), dtype=np.float64)


def agrees_with_prediction(problem: Problem, gain: float, predicted: float) -> bool:
    """Whether a Gauss-Newton step gained what the quadratic model of the log posterior predicted.

    The next step then gains little, and the search may end.

    Args:
        problem: Problem whose configuration holds the tolerance.
        gain: Gain of the score [nats].
        predicted: Predicted gain [nats].
    """
    config = problem.config.fit
    return abs(gain - predicted) < config.agreement + config.agreement_share * abs(predicted)


def log_prior(free: Sequence[FreeParameter], theta: Array) -> float:
    """Return the log prior density of the free parameters of a hypothesis.

    It is exact up to a constant that all hypotheses share. Half of a normal distribution, of a
    parameter with its mean at a bound, has twice the density.

    Args:
        free: Free parameters.
        theta: (F,) their values.
    """
    found = 0.0
    for f, x in zip(free, theta, strict=True):
        found += np.log(2.0) * (f.mean in (f.low, f.high)) - 0.5 * ((float(x) - f.mean) / f.sd) ** 2
    return found


def log_truncation_probability(
    free: Sequence[FreeParameter], theta: Array, covariance: Array
) -> float:
    """Return the log of the share of a normal posterior that lies within one-sided bounds.

    It corrects the Laplace evidence of parameters that are limited on one side.

    Args:
        free: Free parameters.
        theta: (F,) their fitted values.
        covariance: (F, F) their covariance.
    """
    found = 0.0
    for f, x, variance in zip(free, theta, np.diag(covariance), strict=True):
        if f.mean in (f.low, f.high):
            distance = abs(float(x) - f.mean) / sqrt(2.0 * max(float(variance), TINY))
            found += log(0.5 + 0.5 * erf(distance))
    return found


@dataclass(frozen=True)
class _Point:
    """A point of the parameter space with the filter passes there."""

    theta: Array
    passes: FilterPasses
    score: float  # log likelihood plus log prior


@dataclass(frozen=True)
class _Hypothesis:
    """Problem, free parameters, active effects and noise levels of a fit, which stay the same."""

    problem: Problem
    free: tuple[FreeParameter, ...]
    on: Array
    levels: NoiseLevels
    space: ParameterSpace

    def evaluate_at(self, theta: Array) -> _Point:
        """Run the filter at a point."""
        passes = self.problem.filter(self.free, theta, self.on, self.levels)
        return _Point(theta, passes, passes.log_likelihood + log_prior(self.free, theta))


@dataclass(frozen=True)
class _End:
    """End of a sequence of Gauss-Newton steps."""

    point: _Point
    J: Array  # (rows, F) derivatives of the whitened errors by theta / sd
    exact: bool  # whether they were computed at this point or the one before, not updated


def gauss_newton(problem: Problem, start: Fit, iterations: int, enough: float) -> Fit:
    """Maximise the posterior density of a hypothesis over its parameters by Gauss-Newton steps.

    Derivatives are computed at the start and then updated from each step (Broyden 1965). They are
    computed again only where a step does not gain what they predicted.

    Args:
        problem: The estimation problem: recordings, vessel model, candidate effects and priors.
        start: Hypothesis with the values from which the search starts; its noise levels are kept.
        iterations: Largest number of steps.
        enough: A smaller gain ends the search [nats].

    Returns:
        The fit with its covariance and its Laplace evidence.
    """
    hypothesis = _hypothesis(problem, start)
    end = _ascend(hypothesis, start.theta, iterations, enough)
    here, J = end.point, end.J
    if not end.exact:  # the covariance needs exact derivatives
        J, _ = _derivatives(hypothesis, here)
    information = np.eye(len(start.free)) + J.T @ J
    information[np.diag_indices(len(start.free))] += _curvature(hypothesis, here)
    covariance = hypothesis.space.covariance(information)
    evidence = here.score - 0.5 * float(np.linalg.slogdet(information)[1])
    evidence += log_noise_level_prior(problem, start.levels)
    evidence += log_truncation_probability(start.free, here.theta, covariance)
    return replace(start, theta=here.theta, covariance=covariance, evidence=evidence)


def _hypothesis(problem: Problem, start: Fit) -> _Hypothesis:
    """Return the constant part of a fit of a hypothesis: problem, switches, levels and bounds."""
    on = problem.program.effect_switches(start.effects)
    return _Hypothesis(problem, start.free, on, start.levels, ParameterSpace(start.free))


def _ascend(hypothesis: _Hypothesis, theta: Array, iterations: int, enough: float) -> _End:
    """Maximise the posterior density by Gauss-Newton steps, without covariance and evidence."""
    problem, space = hypothesis.problem, hypothesis.space
    config = problem.config.fit
    here = hypothesis.evaluate_at(space.clip(theta))
    damping, known = config.first_damping, False
    J, rest = np.zeros((1, len(theta))), np.zeros(len(theta))
    for _ in range(iterations):
        if not known:
            J, rest = _derivatives(hypothesis, here)
        g = rest - J.T @ here.passes.whitened - (here.theta - space.mean) / space.sd
        A = J.T @ J
        further, gain = None, 0.0
        for _ in range(config.most_dampings):
            trial = hypothesis.evaluate_at(space.damped_step(here.theta, A, g, damping))
            if np.isfinite(trial.score) and trial.score > here.score - LOST:
                further, gain = trial, trial.score - here.score
                break
            damping = max(damping, config.least_damping) * config.damping_growth
        if further is None:
            if not known:
                break
            known = False  # the updates of the derivatives were wrong
            continue
        predicted = space.predicted_gain(J, g, here.theta, further.theta)
        agrees = agrees_with_prediction(problem, gain, predicted)
        agrees = damping < config.short_step_damping and agrees
        step = (further.theta - here.theta) / space.sd
        before = here
        here = replace(further, score=before.score + gain)
        damping /= config.damping_growth
        if (gain < enough or agrees) and (not known or predicted < enough):
            break
        known = gain > config.broyden_share * predicted
        if known:
            change = here.passes.whitened - before.passes.whitened
            J = broyden_update(J, change, step)
    return _End(here, J, not known)


def broyden_update(J: Array, change: Array, step: Array) -> Array:
    """Return a Jacobian updated by Broyden's rank-one formula after a step.

    It agrees with the change of the errors over the step, and otherwise differs least from J.

    Args:
        J: (rows, F) derivatives of the whitened errors by theta / sd.
        change: (rows,) change of the errors over the step.
        step: (F,) the step in units of the prior sd.
    """
    length = float(step @ step)
    return J + np.outer((change - J @ step) / length, step) if length > 0.0 else J


def _derivatives(hypothesis: _Hypothesis, here: _Point) -> tuple[Array, Array]:
    """Derivatives of the whitened errors, and the rest of the gradient that they do not explain."""
    if not hypothesis.problem.is_stiff:
        J = jacobian(
            hypothesis.problem,
            hypothesis.free,
            here.theta,
            hypothesis.on,
            hypothesis.levels,
            here.passes,
        )
        return J, np.zeros(len(hypothesis.free))
    J, g = _full_derivatives(hypothesis, here)
    space = hypothesis.space
    return J, g + J.T @ here.passes.whitened + (here.theta - space.mean) / space.sd


def _full_derivatives(hypothesis: _Hypothesis, here: _Point) -> tuple[Array, Array]:
    """Derivatives by theta / sd of the whitened errors (rows, F) and of the score (F,).

    The gains of the filter change, too. On a stiff hull, damping changes the gains more than the
    errors: with the gains held the score would seem to rise where it falls. The curvature, which
    follows from the errors, is subtracted from the forward differences.
    """
    space, white = hypothesis.space, here.passes.whitened
    size = hypothesis.problem.config.fit.derivative_step
    J, g = np.zeros((len(white), len(here.theta))), np.zeros(len(here.theta))
    for j, f in enumerate(hypothesis.free):
        if f.searched:
            continue
        h = size if here.theta[j] + size * space.sd[j] <= space.high[j] else -size
        moved = here.theta.copy()
        moved[j] += h * space.sd[j]
        there = hypothesis.evaluate_at(moved)
        rise = (there.score - here.score) / h
        if np.isfinite(rise):
            J[:, j] = (there.passes.whitened - white) / h
            g[j] = rise + 0.5 * h * (1.0 + float(J[:, j] @ J[:, j]))
    return J, g


def jacobian(
    problem: Problem,
    free: Sequence[FreeParameter],
    theta: Array,
    on: Array,
    levels: NoiseLevels,
    about: FilterPasses,
    white: Array | None = None,
    first: int = 0,
) -> Array:
    """Return the Jacobian of the whitened prediction errors with respect to the free parameters.

    Parameters are measured in prior standard deviations (theta / sd). The gains of the Kalman
    filter are held fixed.

    Args:
        problem: The estimation problem: recordings, vessel model, candidate effects and priors.
        free: Free parameters.
        theta: (F,) their values.
        on: (effects,) 1 for the effects that act, else 0.
        levels: Levels of sensor noise and of the latent (unmodelled) force.
        about: Passes whose gains are used.
        white: (rows,) whitened errors at theta; None: those of `about`.
        first: Parameters before this one are omitted.

    Returns:
        (rows, F - first) forward differences.
    """
    if white is None:
        white = about.whitened
    size = problem.config.fit.derivative_step
    J = np.zeros((len(white), len(free) - first))
    for j, f in enumerate(free[first:], first):
        if f.searched:
            continue
        moved = theta.copy()
        h = size * f.sd if theta[j] + size * f.sd <= f.high else -size * f.sd
        moved[j] += h
        errors = problem.whitened_errors(free, moved, on, levels, about)
        column = (errors - white) * (f.sd / h)
        if np.isfinite(column).all():  # otherwise the simulated boat diverges there
            J[:, j - first] = column
    return J


def _curvature(hypothesis: _Hypothesis, here: _Point) -> Array:
    """Information on parameters without a gradient, by second differences of the likelihood."""
    problem, free, theta = hypothesis.problem, hypothesis.free, here.theta
    size = problem.config.fit.curvature_step
    found = np.zeros(len(free))
    for j, f in enumerate(free):
        if not f.searched:
            continue
        h = size * f.sd
        centre = theta[j]
        if f.high - f.low > 2 * h:
            centre = float(np.clip(theta[j], f.low + h, f.high - h))
        around = []
        for x in (centre - h, centre, centre + h):
            if x == theta[j]:
                around.append(here.passes.log_likelihood)
                continue
            moved = theta.copy()
            moved[j] = x
            found_there = problem.log_likelihood(free, moved, hypothesis.on, hypothesis.levels)
            around.append(found_there)
        below, middle, above = around
        found[j] = max(0.0, (2.0 * middle - below - above) / size**2)
    return found
