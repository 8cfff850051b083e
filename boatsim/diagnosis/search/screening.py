"""Screens candidates on top of a fit: Gauss-Newton steps with the gains of the filter held."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np

from boatsim.diagnosis.command_range import largest_command
from boatsim.diagnosis.filter import dof_in_state_order
from boatsim.diagnosis.fit import (
    ParameterSpace,
    agrees_with_prediction,
    gauss_newton,
    jacobian,
    log_prior,
    log_truncation_probability,
    unfitted_hypothesis,
)
from boatsim.diagnosis.noise_levels import log_latent_force_prior
from boatsim.diagnosis.problem import FilterPasses, Fit, Problem, free_parameter_values
from boatsim.physics.base import Array, Effect, RandomForce

LARGE = 1e300  # magnitude of a score from which every finite one is better
MARGIN = 1e-6  # of a sum of squares, so that rounding decides nothing


@dataclass(frozen=True)
class Linearisation:
    """A linearised fit, from which gains of evidence by further effects are estimated.

    It holds the whitened prediction errors and their derivatives by the parameters, with the gains
    of the Kalman filter held.
    """

    columns: Array  # (rows, F) derivatives of the whitened errors by its parameters
    slope: Array  # (F,) gradient that the held gains show at its maximum, where there is none
    score: float
    passes: FilterPasses
    # (F, F) inverse of the information on its parameters, in units of their prior sds
    inverse: Array

    @property
    def whitened_errors(self) -> Array:
        """Whitened prediction errors (rows,) of the linearised fit."""
        return self.passes.whitened

    @cached_property
    def half_log_determinant(self) -> float:
        """Half the log determinant of the information matrix of the linearised fit's parameters.

        It is the term of the Laplace evidence that penalises free parameters.
        """
        count = self.columns.shape[1]
        return _half_log_determinant(np.eye(count) + self.columns.T @ self.columns)

    def predicted_gain(self, white: Array) -> float:
        """Predict how much evidence an effect gains from its change of the prediction errors.

        The gain is in nats. The best multiple of that change is used, and the parameters of the
        linearised fit are free, too.

        Args:
            white: (rows,) whitened errors with the effect at a starting point.
        """
        return gain_along(self.columns, self.inverse, self.whitened_errors, white)


def gain_along(columns: Array, inverse: Array, errors: Array, changed: Array) -> float:
    """Predict how much the log posterior gains by the best multiple of a change of the errors.

    The errors are linear in the parameters of the model, which are free, too.

    Args:
        columns: (rows, F) derivatives of the errors by the parameters, in prior sds.
        inverse: (F, F) inverse of the information on these.
        errors: (rows,) errors of the model, in sds.
        changed: (rows,) errors with another effect at a starting point.

    Returns:
        The gain [nats]; minus infinity if the simulated boat diverges.
    """
    change = changed - errors
    with np.errstate(over="ignore", invalid="ignore"):  # the simulated boat may diverge
        along = columns.T @ change
        length = float(change @ change - along @ (inverse @ along))
        own = inverse @ (columns.T @ errors)
        slope = float(errors @ change - along @ own)
    return 0.5 * slope**2 / length if np.isfinite(length) and length > 0.0 else -np.inf


def linearise(problem: Problem, base: Fit) -> Linearisation:
    """Linearise a fit about its parameters, with the gains of the Kalman filter held.

    Args:
        problem: The estimation problem: recordings, vessel model, candidate effects and priors.
        base: Converged fit to which candidate effects are to be added.
    """
    on = problem.program.effect_switches(base.effects)
    passes = problem.filter(base.free, base.theta, on, base.levels)
    white = passes.whitened
    known = jacobian(problem, base.free, base.theta, on, base.levels, passes)
    # base is a maximum: its gradient is zero, whatever the held gains make of it
    space = ParameterSpace(base.free)
    slope = known.T @ white + (base.theta - space.mean) / space.sd
    score = log_prior(base.free, base.theta) - 0.5 * float(white @ white)
    inverse = np.linalg.inv(np.eye(len(slope)) + known.T @ known)
    return Linearisation(known, slope, score, passes, np.asarray(inverse, dtype=np.float64))


def screen(
    problem: Problem,
    base: Fit,
    candidates: Sequence[str],
    report: Callable[[float], None] | None = None,
    about: Linearisation | None = None,
) -> dict[str, Fit]:
    """Estimate the evidence of each candidate effect by a rough fit in addition to a fit.

    Its parameters are near the best ones, and its evidence is accurate enough to choose the
    candidates that are fitted in full.

    Args:
        problem: The estimation problem: recordings, vessel model, candidate effects and priors.
        base: Converged fit to which candidate effects are to be added.
        candidates: Names of the candidates.
        report: Receives the share of the candidates that have been screened.
        about: The given fit linearised; None: linearise it.

    Returns:
        Rough fits by the name of the candidate.
    """
    about = about or linearise(problem, base)
    effects = problem.candidates
    found: dict[str, Fit] = {}
    for name in sorted(candidates, key=lambda n: type(effects[n]).random):
        if type(effects[name]).random:
            found[name] = _screen_stochastic(problem, base, effects[name], about)
        else:
            found[name] = _screen_deterministic(problem, base, effects[name], about)
        if report:
            report(len(found) / len(candidates))
    return found


def largest_gain_on_top(problem: Problem, found: Fit, candidates: Sequence[str]) -> float:
    """Return how much the best of some candidates gains on top of a fit of another program [nats].

    Args:
        problem: The estimation problem, whose program has these candidates.
        found: Converged fit of the same recordings without them, also by another program.
        candidates: Their names.

    Returns:
        The estimated gain by rough fits; minus infinity without candidates.
    """
    if not candidates:
        return -np.inf
    free = problem.free_parameters(found.effects)
    theta = free_parameter_values(free, found.values())
    start = unfitted_hypothesis(found.effects, free, theta, found.levels)
    base = gauss_newton(
        problem, start, problem.config.select.calm_steps, problem.config.fit.step_gain
    )
    rough = screen(problem, base, candidates)
    return max(fit.evidence - base.evidence for fit in rough.values())


def confirm_screening(problem: Problem, base: Fit, screened: Fit) -> Fit:
    """Check the rough fit of a candidate effect with the full Kalman filter; refit it if it fails.

    A rough fit may fail where the held gains no longer suit the hull, for example where much mass
    is missing. It is then refitted from the best smaller step. What seems little at a point that
    the filter confirms may still gain most.

    Args:
        problem: The estimation problem: recordings, vessel model, candidate effects and priors.
        base: Fit to which the candidate was added.
        screened: Rough fit with the candidate added.
    """
    config = problem.config.select
    on = problem.program.effect_switches(screened.effects)
    on_base = problem.program.effect_switches(base.effects)
    at_base = problem.log_likelihood(base.free, base.theta, on_base, base.levels)
    at_base += log_prior(base.free, base.theta)
    predicted = screened.evidence - base.evidence
    nothing = free_parameter_values(screened.free, base.values())
    theta, best = screened.theta, screened
    for i in range(config.recheck_points):
        likelihood = problem.log_likelihood(screened.free, theta, on, screened.levels)
        gain = likelihood + log_prior(screened.free, theta) - at_base
        enough = gain > config.recheck_share * predicted or gain > predicted - config.recheck_loss
        if i == 0 and enough:
            return screened
        if i == 0 or gain > best.evidence - base.evidence:
            best = replace(screened, theta=theta, evidence=base.evidence + min(gain, predicted))
        theta = 0.5 * (theta + nothing)
    further = gauss_newton(problem, best, config.recheck_steps, problem.config.fit.refit_gain)
    return further if np.isfinite(further.evidence) else best


def _half_log_determinant(information: Array) -> float:
    return 0.5 * float(np.linalg.slogdet(information)[1])


def starting_points(problem: Problem, effect: Effect) -> list[dict[str, float]]:
    """Return parameter values from which the fit of a candidate effect starts.

    They are those that the effect declares, scaled by Froude's law, and shares of the largest
    command recorded; a small value where there are none.

    Args:
        problem: The estimation problem: recordings, vessel model, candidate effects and priors.
        effect: The candidate effect.
    """
    kind = type(effect)
    default = {}
    for name, p in kind.params().items():
        scale = problem.scale_from_reference_hull(effect, name)
        mean = p.prior_mean * scale
        step = problem.config.select.screening_start * p.spread * scale
        default[name] = mean + step if mean + step <= p.high else mean - step
    specified = []
    for start in kind.starts:
        specified.append(
            {n: x * problem.scale_from_reference_hull(effect, n) for n, x in start.items()}
        )
    largest = largest_command(problem.recordings, effect, problem.config.load)
    if largest:
        for name, shares in kind.thresholds.items():
            for share in shares:
                specified.append({name: share * largest})
    return [default | start for start in specified or [{}]]


def add_effect(problem: Problem, base: Fit, name: str, start: Mapping[str, float]) -> Fit:
    """Add a candidate effect to a fit at given parameter values; nothing is fitted yet.

    Args:
        problem: The estimation problem: recordings, vessel model, candidate effects and priors.
        base: Fit to which the candidate effect is added.
        name: Name of the candidate that is added.
        start: Parameter values of the candidate by name.
    """
    effects = (*base.effects, name)
    free = problem.free_parameters(effects)
    values = base.values()
    for parameter, x in start.items():
        values.setdefault((name, parameter), x)
    return unfitted_hypothesis(effects, free, free_parameter_values(free, values), base.levels)


def transfer_coefficient_change(start: Fit, effect: Effect) -> Fit:
    """Transfer the change of a coefficient to the factor of an added effect that scales it.

    The recordings determine only the product of both: straight steps along the curve on which it is
    constant would lead nowhere.

    Args:
        start: Fit to which the effect was added, not yet refitted.
        effect: The candidate that was added.
    """
    theta = start.theta.copy()
    coefficients = {f.at: i for i, f in enumerate(start.free) if f.relative}
    for own, f in enumerate(start.free):
        scales = f.effect == effect.name and f.how == "scales" and not (f.relative or f.group)
        if scales and f.at in coefficients:
            coefficient = coefficients[f.at]
            theta[own] = np.clip(theta[coefficient], f.low, f.high)
            theta[coefficient] /= theta[own]
    return replace(start, theta=theta)


def transfer_surplus(start: Fit, effect: Effect, values: Array) -> Fit:
    """Move the excess of a refitted coefficient to the parameter of an effect that it contained.

    Where an effect is missing, the fit of a coefficient of the vessel contains it
    (`Effect.contained_in`).

    Args:
        start: Fit to which the effect was added, not yet refitted.
        effect: The candidate that was added.
        values: Parameter values of the vessel as in its file.
    """
    theta = start.theta.copy()
    own = {f.name: i for i, f in enumerate(start.free) if f.effect == effect.name and not f.group}
    for name, coefficient in type(effect).contained_in.items():
        for i, f in enumerate(start.free):
            if not f.relative or f"{f.effect}.{f.name}" != coefficient or name not in own:
                continue
            surplus = (theta[i] - f.mean) * values[f.at[0]]
            if surplus > theta[own[name]]:
                theta[own[name]] = min(surplus, start.free[own[name]].high)
                theta[i] = f.mean
    return replace(start, theta=theta)


def starting_fits(problem: Problem, base: Fit, effect: Effect) -> list[Fit]:
    """Add a candidate effect to a fit at each of its starting points; nothing is fitted yet.

    Args:
        problem: The estimation problem: recordings, vessel model, candidate effects and priors.
        base: Fit to which the candidate effect is added.
        effect: The candidate effect.
    """
    values = problem.recordings[0].values
    found = []
    for point in starting_points(problem, effect):
        start = add_effect(problem, base, effect.name, point)
        start = transfer_coefficient_change(start, effect)
        found.append(transfer_surplus(start, effect, values))
    return found


def _screen_deterministic(problem: Problem, base: Fit, effect: Effect, about: Linearisation) -> Fit:
    """A first step from the most promising starting points, the best of them followed further."""
    config = problem.config.select
    begun = starting_fits(problem, base, effect)
    if len(begun) > config.screening_starts:
        on = problem.program.effect_switches(begun[0].effects)

        def negative_predicted_gain(start: Fit) -> float:
            theta = ParameterSpace(start.free).clip(start.theta)
            white = problem.whitened_errors(start.free, theta, on, start.levels, about.passes)
            return -about.predicted_gain(white)

        begun.sort(key=negative_predicted_gain)
        begun = begun[: config.screening_starts]
    if len(begun) == 1:
        best = _gauss_newton_steps(problem, begun[0], about, config.screening_steps)
    else:
        first = [_gauss_newton_steps(problem, start, about, 1) for start in begun]
        best = max(first, key=lambda found: found[1])
        best = _gauss_newton_steps(problem, best[0], about, config.screening_steps - 1)
    found, score = best
    truncation = log_truncation_probability(found.free, found.theta, found.covariance)
    truncation -= log_truncation_probability(base.free, base.theta, base.covariance)
    gain = score - about.score + about.half_log_determinant + truncation
    return replace(found, evidence=base.evidence + gain)


class _ScreeningPoint(NamedTuple):
    """A point of a screening search: parameters, whitened prediction errors and score."""

    theta: Array
    white: Array
    score: float


class _ScreeningSearch:
    """Gauss-Newton search from one start; the columns of what was free before are held."""

    def __init__(self, problem: Problem, start: Fit, about: Linearisation) -> None:
        self.problem, self.start, self.about = problem, start, about
        self.on = problem.program.effect_switches(start.effects)
        self.space = ParameterSpace(start.free)
        self.middle = self.space.clip(start.theta)
        added = len(start.free) - len(about.slope)
        self.slope = np.append(about.slope, np.zeros(added))

    def _score(self, x: Array, white: Array) -> float:
        score = log_prior(self.start.free, x) - 0.5 * float(white @ white)
        return score + float(self.slope @ ((x - self.middle) / self.space.sd))

    def evaluate(self, x: Array) -> _ScreeningPoint:
        """Return the point of these parameters."""
        start = self.start
        white = self.problem.whitened_errors(
            start.free, x, self.on, start.levels, self.about.passes
        )
        with np.errstate(over="ignore"):  # the simulated boat may diverge
            return _ScreeningPoint(x, white, self._score(x, white))

    def evaluate_above(self, x: Array, least: float) -> _ScreeningPoint | None:
        """Return the point of these parameters if its score is higher than `least`."""
        start = self.start
        most = log_prior(start.free, x) + float(self.slope @ ((x - self.middle) / self.space.sd))
        most = 2.0 * (most - least)
        with np.errstate(over="ignore", invalid="ignore"):
            white = self.problem.whitened_errors_within(
                start.free, x, self.on, start.levels, self.about.passes, most + MARGIN
            )
        if white is None:
            return None
        point = _ScreeningPoint(x, white, self._score(x, white))
        return point if point.score > least else None

    def _gradient(self, J: Array, at: _ScreeningPoint) -> Array:
        return self.slope - J.T @ at.white - (at.theta - self.space.mean) / self.space.sd

    def first_point(self) -> _ScreeningPoint:
        """Return the start, or a point near it that the recordings do not exclude."""
        point = self.evaluate(self.middle)
        least = self.about.score - self.problem.config.select.screening_loss
        if not point.score > least:
            point = self._compensated(point)
        own = np.arange(len(self.start.free)) >= len(self.about.slope)
        halvings = self.problem.config.select.screening_halvings
        for i in range(halvings):  # a start may be far too strong for this hull
            if np.isfinite(point.score) and point.score > least:
                break
            theta = np.where(own, 0.5 * (point.theta + self.space.mean), point.theta)
            better = self.evaluate_above(theta, least)
            if better is None and i == halvings - 1:
                better = self.evaluate(theta)
            point = better or point._replace(theta=theta)
        return point

    def _compensated(self, point: _ScreeningPoint) -> _ScreeningPoint:
        """Let the other parameters make up for the start: more mass for more thrust and damping."""
        known = self.about.columns
        J = np.hstack([known, np.zeros((len(known), len(self.start.free) - known.shape[1]))])
        moved = self.space.damped_step(point.theta, J.T @ J, self._gradient(J, point), 0.0)
        least = point.score if np.isfinite(point.score) else -LARGE
        return self.evaluate_above(moved, least) or point

    def step(
        self, at: _ScreeningPoint, damping: float
    ) -> tuple[_ScreeningPoint, Array, float, bool]:
        """Take one damped Gauss-Newton step.

        Args:
            at: Where it begins.
            damping: The first damping.

        Returns:
            The point reached, the normal matrix, the last damping, and whether the search ends.
        """
        problem, start, config = self.problem, self.start, self.problem.config.select
        known = self.about.columns
        own = jacobian(
            problem,
            start.free,
            at.theta,
            self.on,
            start.levels,
            self.about.passes,
            at.white,
            known.shape[1],
        )
        J = np.hstack([known, own])
        A, g = J.T @ J, self._gradient(J, at)
        for _ in range(config.screening_dampings):
            theta = self.space.damped_step(at.theta, A, g, damping)
            predicted = self.space.predicted_gain(J, g, at.theta, theta)
            if (
                predicted >= 0.0
                and at.score + predicted < self.about.score + config.screening_promise
            ):
                # too little to follow: the prediction is accepted
                return _ScreeningPoint(theta, at.white, at.score + predicted), A, damping, True
            better = self.evaluate_above(theta, at.score)
            if better is not None:
                gain = better.score - at.score
                ends = agrees_with_prediction(problem, gain, predicted)
                return better, A, damping, ends or gain < problem.config.fit.step_gain
            least, growth = problem.config.fit.least_damping, problem.config.fit.damping_growth
            damping = max(damping, least) * growth
        return at, A, damping, True


def _gauss_newton_steps(
    problem: Problem, start: Fit, about: Linearisation, rounds: int
) -> tuple[Fit, float]:
    """Gauss-Newton steps with the columns of what was free before held.

    Returns the fit, and its score with the determinant.
    """
    search = _ScreeningSearch(problem, start, about)
    point = search.first_point()
    if not np.isfinite(point.score):
        return start, -np.inf
    damping, A = problem.config.fit.first_damping, np.zeros((len(start.free), len(start.free)))
    for _ in range(rounds):
        point, A, damping, ends = search.step(point, damping)
        if ends:
            break
    information = np.eye(len(start.free)) + A
    covariance = search.space.covariance(information)
    found = replace(start, theta=point.theta, covariance=covariance)
    return found, point.score - _half_log_determinant(information)


def _screen_stochastic(problem: Problem, base: Fit, effect: Effect, about: Linearisation) -> Fit:
    """A stochastic force, or the drift of an instrument, takes over from the latent force.

    A force that acts along one axis alone would be spoilt by the others: each axis is omitted in
    turn. The filter is linearised once; the determinant of what was free before hardly changes.
    """
    before = about.passes.log_likelihood
    before += log_prior(base.free, base.theta) + log_latent_force_prior(problem, base.levels)

    def fit_with_evidence(at: Fit) -> Fit:
        on = problem.program.effect_switches(at.effects)
        score = problem.log_likelihood(at.free, at.theta, on, at.levels, about.passes)
        score += log_prior(at.free, at.theta)
        evidence = base.evidence + score + log_latent_force_prior(problem, at.levels) - before
        return replace(at, evidence=evidence)

    best = _most_likely(
        list(map(fit_with_evidence, stochastic_starting_fits(problem, base, effect)))
    )
    if isinstance(effect, RandomForce):
        for i, axis in enumerate(dof_in_state_order(problem.program.vessel)):
            best = _most_likely(
                [best, fit_with_evidence(_without_axis(best, base, effect.name, i, axis))]
            )
        best = _most_likely([best, fit_with_evidence(_at_assumed_disturbance(problem, best, base))])
    return best


def _most_likely(fits: Sequence[Fit]) -> Fit:
    return max(fits, key=lambda found: found.evidence)


def _without_axis(at: Fit, base: Fit, name: str, i: int, axis: str) -> Fit:
    """A start without a force along one axis, whose latent force is as it was."""
    force = at.levels.force.copy()
    force[i] = base.levels.force[i]
    theta = at.theta.copy()
    for j, parameter in enumerate(at.free):
        if (parameter.effect, parameter.name) == (name, axis):
            theta[j] = parameter.mean
    return replace(at, theta=theta, levels=replace(at.levels, force=force))


def _at_assumed_disturbance(problem: Problem, at: Fit, base: Fit) -> Fit:
    """A start in which the latent force along the axes of a stochastic force is the assumed one."""
    takes = at.levels.force < base.levels.force
    calm = np.minimum(at.levels.force, problem.ambient.force)
    return replace(at, levels=replace(at.levels, force=np.where(takes, calm, at.levels.force)))


def stochastic_starting_fits(problem: Problem, base: Fit, effect: Effect) -> list[Fit]:
    """Add a stochastic force, or the drift of an instrument, to a fit at its starting points.

    A stochastic force starts with a share of the latent (unmodelled) force. The drift of an
    instrument starts with the assumed noise levels, because force and noise that were fitted
    without it have absorbed part of it.

    Args:
        problem: The estimation problem: recordings, vessel model, candidate effects and priors.
        base: Fit to which the candidate effect is added.
        effect: The candidate effect.
    """
    shared = problem.config.select.swell_share * base.levels.force
    if isinstance(effect, RandomForce):
        of_axis = dict(
            zip(dof_in_state_order(problem.program.vessel), shared.tolist(), strict=True)
        )
        levels = replace(base.levels, force=shared)
        rms = {name: of_axis.get(name, 0.0) for name in type(effect).strength}
    else:
        calm = np.minimum(base.levels.force, problem.ambient.force)
        levels, rms = replace(base.levels, force=calm, sensors=problem.ambient.sensors), {}
    found = []
    for start in starting_points(problem, effect):
        added = add_effect(problem, base, effect.name, start | rms)
        found.append(replace(added, levels=levels))
    return found
