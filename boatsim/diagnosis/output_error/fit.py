"""Fits the parameters of a model to free runs over recordings (output-error method)."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from boatsim.diagnosis.filter import FreeRunStarts
from boatsim.diagnosis.fit import ParameterSpace, broyden_update, log_truncation_probability
from boatsim.diagnosis.output_error.errors import OutputErrors
from boatsim.diagnosis.problem import Fit
from boatsim.physics.base import Array

HELD = 1e-9  # information on a parameter without which the prior alone places it


@dataclass(frozen=True)
class OutputErrorFit:
    """A model whose parameters minimise the errors of its free runs.

    Attributes:
        model: The model; its covariance is that of the posterior given the free runs.
        fixed: Indices of the parameters that were not fitted.
        starts: States from which its free runs begin, by recording.
        residuals: (R,) weighted errors of its free runs.
        J: (R, F) their derivatives by the parameters, in prior sds.
        score: Log posterior density of its parameters.
        evidence: Laplace approximation of the log evidence of the free runs [nats].
    """

    model: Fit
    fixed: tuple[int, ...]
    starts: Sequence[FreeRunStarts]
    residuals: Array
    J: Array
    score: float
    evidence: float

    @property
    def fitted(self) -> list[int]:
        """Indices of the parameters that were fitted."""
        return [j for j in range(len(self.model.free)) if j not in self.fixed]


def fit_to_free_runs(
    errors: OutputErrors, start: Fit, fixed_effects: Sequence[str] = ()
) -> OutputErrorFit:
    """Fit the parameters of a model to free runs by damped Gauss-Newton steps.

    The prior keeps what the free runs do not determine near the value of the vessel file. As in the
    fit with the Kalman filter, derivatives are updated from each step (Broyden 1965), and computed
    again where a step does not gain what they predicted.

    Args:
        errors: Errors of free runs over the fitted recordings.
        start: Model with the values from which the fit starts.
        fixed_effects: Effects whose parameters keep their values.
    """
    config = errors.problem.config
    here = _evaluate(errors, start, fixed_effects)
    damping, are_fresh = 0.0, True
    for _ in range(config.simulate.steps):
        further, damping = _step(errors, here, damping)
        if further is None:
            if are_fresh:
                break
            here, are_fresh = _with_derivatives(errors, here), True
            continue
        gain = further.score - here.score
        are_fresh = gain < config.fit.broyden_share * _predicted_gain(here, further.model.theta)
        here = (
            _with_derivatives(errors, further)
            if are_fresh
            else _with_updated_derivatives(here, further)
        )
        damping /= config.fit.damping_growth
        if gain < config.simulate.step_gain:
            break
    if not are_fresh:
        here = _with_derivatives(errors, here)
    return _with_covariance(here)


def without_fit(
    errors: OutputErrors, model: Fit, fixed_effects: Sequence[str] = ()
) -> OutputErrorFit:
    """Return a model with its parameters unchanged, as if a fit had ended there.

    Args:
        errors: Errors of free runs over the fitted recordings.
        model: Model whose parameters are kept.
        fixed_effects: Effects whose parameters are not fitted later either.
    """
    return _with_covariance(_evaluate(errors, model, fixed_effects))


def add_parameters(
    errors: OutputErrors, base: OutputErrorFit, start: Fit, steps: int
) -> OutputErrorFit:
    """Fit a model with one or two more effects roughly, with held derivatives by old parameters.

    Args:
        errors: Errors of free runs over the fitted recordings.
        base: Fit of the model without these effects.
        start: The model with them; their parameters come last.
        steps: Number of Gauss-Newton steps.

    Returns:
        The fit with its approximate evidence.
    """
    known = base.J.shape[1]
    added = range(known, len(start.free))
    start = replace(start, theta=ParameterSpace(start.free).clip(start.theta))
    starts = None if errors.is_measurement(start, known) else base.starts
    here = _at(errors, start, base.fixed, starts)
    for _ in range(steps):
        own = errors.derivatives(here.model, here.starts, here.residuals, added)
        here = replace(here, J=np.hstack([base.J, own[:, known:]]))
        further, _ = _step(errors, here, 0.0, starts)
        if further is None:
            break
        here = replace(further, J=here.J)
    return _with_covariance(here)


def _evaluate(errors: OutputErrors, start: Fit, fixed_effects: Sequence[str]) -> OutputErrorFit:
    """Return the free runs of a model with their derivatives."""
    fixed = []
    for j, parameter in enumerate(start.free):
        named = not parameter.relative and parameter.effect in fixed_effects
        if named or parameter.searched:
            fixed.append(j)
    theta = ParameterSpace(start.free).clip(start.theta)
    theta[fixed] = start.theta[fixed]
    here = _at(errors, replace(start, theta=theta), tuple(fixed))
    return _with_derivatives(errors, here)


def _at(
    errors: OutputErrors,
    model: Fit,
    fixed: tuple[int, ...],
    starts: Sequence[FreeRunStarts] | None = None,
) -> OutputErrorFit:
    """Return the free runs of a model, without their derivatives."""
    starts = starts or errors.starts(model)
    residuals = errors.residuals(model, starts)
    score = errors.score(model, residuals, fixed)
    none = np.zeros((len(residuals), len(model.free)))
    return OutputErrorFit(model, fixed, starts, residuals, none, score, -np.inf)


def _with_derivatives(errors: OutputErrors, here: OutputErrorFit) -> OutputErrorFit:
    """Return the same free runs with their derivatives."""
    J = errors.derivatives(here.model, here.starts, here.residuals, here.fitted)
    return replace(here, J=J)


def _with_updated_derivatives(before: OutputErrorFit, after: OutputErrorFit) -> OutputErrorFit:
    """Return the free runs after a step with the derivatives before it, corrected by the step."""
    step = (after.model.theta - before.model.theta) / ParameterSpace(after.model.free).sd
    J = broyden_update(before.J, after.residuals - before.residuals, step)
    J[:, list(after.fixed)] = 0.0
    return replace(after, J=J)


def _predicted_gain(here: OutputErrorFit, theta: Array) -> float:
    """Gain of the log posterior that the derivatives predict for a step."""
    g = _gradient(here)
    return ParameterSpace(here.model.free).predicted_gain(here.J, g, here.model.theta, theta)


def _gradient(here: OutputErrorFit) -> Array:
    """Gradient (F,) of the log posterior by the parameters, in prior sds."""
    space = ParameterSpace(here.model.free)
    return np.asarray(-here.J.T @ here.residuals - (here.model.theta - space.mean) / space.sd)


def _step(
    errors: OutputErrors,
    here: OutputErrorFit,
    damping: float,
    starts: Sequence[FreeRunStarts] | None = None,
) -> tuple[OutputErrorFit | None, float]:
    """Take one damped Gauss-Newton step.

    Returns:
        The point reached, None if no step gains anything, and the last damping.
    """
    config = errors.problem.config.fit
    model, space = here.model, ParameterSpace(here.model.free)
    g = _gradient(here)
    A = here.J.T @ here.J
    A[here.fitted, here.fitted] += HELD
    for _ in range(config.most_dampings):
        theta = space.damped_step(model.theta, A, g, damping)
        theta[list(here.fixed)] = model.theta[list(here.fixed)]
        trial = _at(errors, replace(model, theta=theta), here.fixed, starts)
        if trial.score > here.score:
            return trial, damping
        damping = max(damping, config.least_damping) * config.damping_growth
    return None, damping


def _with_covariance(here: OutputErrorFit) -> OutputErrorFit:
    """Return a fit with the posterior covariance of its parameters and its evidence.

    Parameters that were not fitted keep their covariance.
    """
    model, fitted, fixed = here.model, here.fitted, list(here.fixed)
    space, J = ParameterSpace(model.free), here.J[:, here.fitted]
    information = np.eye(len(fitted)) + J.T @ J
    covariance = np.zeros_like(model.covariance)
    covariance[np.ix_(fixed, fixed)] = model.covariance[np.ix_(fixed, fixed)]
    own = np.linalg.inv(information) * np.outer(space.sd[fitted], space.sd[fitted])
    covariance[np.ix_(fitted, fitted)] = own
    evidence = here.score - 0.5 * float(np.linalg.slogdet(information)[1])
    free = [model.free[j] for j in fitted]
    evidence += log_truncation_probability(free, model.theta[fitted], own)
    return replace(here, model=replace(model, covariance=covariance), evidence=evidence)
