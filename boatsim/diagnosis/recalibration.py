"""Decides which refitted coefficients are adopted.

A coefficient that the recordings do not determine keeps the value of the vessel file; in the
vessel of the answer, free runs have to determine it. No coefficient of the vessel without effects
is adopted if free runs over held-out recordings are worse with the refitted ones than with those of
the file.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from boatsim.diagnosis.config import FitConfig
from boatsim.diagnosis.filter import MappedRecording
from boatsim.diagnosis.fit import gauss_newton
from boatsim.diagnosis.free_runs import FreeRun, free_run_horizon, free_runs, rms_errors
from boatsim.diagnosis.problem import Fit, Problem, prior_arrays
from boatsim.diagnosis.search import generalization
from boatsim.diagnosis.simulated_information import covariance_by_simulations
from boatsim.physics.base import Array

WRITTEN, REFITTED = "written", "refitted"  # the vessels that are compared


@dataclass(frozen=True)
class Recalibration:
    """The vessel model with those refitted coefficients that replace the values of its file.

    It also names the coefficients that the recordings do not determine.

    Attributes:
        fit: Fit of the vessel model as it is reported.
        undetermined: Coefficients that the recordings do not determine, as "effect.number".
        adopted: Whether the other coefficients are adopted.
        refitted: Rms errors of free runs over held-out recordings with the refitted coefficients,
            by family of signals.
        by_free_runs: Whether they were fitted to free runs, not with the Kalman filter.
    """

    fit: Fit
    undetermined: tuple[str, ...]
    adopted: bool
    refitted: Mapping[str, float]
    by_free_runs: bool = False


def decide_recalibration(
    problem: Problem,
    written: Fit,
    refitted: Fit,
    held_out: Sequence[MappedRecording],
    is_answer: bool = True,
) -> Recalibration:
    """Decide which refitted coefficients of a vessel replace the values of its file.

    They must be determined by the recordings, and must not make simulations of held-out recordings
    worse, nor those of one group of them much worse.

    Args:
        problem: The estimation problem: recordings, vessel model, candidate effects and priors.
        written: The vessel model as specified in its file, with its noise levels fitted.
        refitted: The vessel model without candidate effects, its coefficients fitted.
        held_out: Held-out recordings, at least one.
        is_answer: Whether this vessel is the answer, so that its coefficients must carry over to
            other manoeuvres and free runs have to determine them. Else it is only what the vessel
            with effects is compared with, and its posterior suffices.
    """
    kept = undetermined_coefficients(refitted, problem.config.fit)
    if is_answer:
        known = [i for i in kept if _is_known(refitted, i, problem.config.fit)]
        kept = sorted({*known, *undetermined_by_simulations(problem, refitted)})
    names = tuple(f"{refitted.free[i].effect}.{refitted.free[i].name}" for i in kept)
    found = fix_coefficients(problem, refitted, kept)
    horizon = free_run_horizon(problem, held_out)
    runs = free_runs(problem, {WRITTEN: written, REFITTED: found}, held_out, horizon)
    harmed = generalization.harmed_groups(problem, written, found, held_out, horizon)
    adopted = not is_harmful(runs, problem.config.validate.harmful) and not harmed
    errors = {family: rms[REFITTED] for family, rms in rms_errors(runs).items()}
    if not adopted:
        moved = _move(found, written.theta)
        found = replace(written, covariance=moved.covariance)
    return Recalibration(found, names, adopted, errors)


def fix_undetermined_coefficients(
    problem: Problem, found: Fit, held_out: Sequence[MappedRecording]
) -> Fit:
    """Return a fit with effects whose undetermined coefficients have the value of the vessel file.

    The same fit is returned if simulations of held-out recordings would become much worse: far from
    the fit, its coefficients may depend on each other otherwise than near it.

    Args:
        problem: The estimation problem: recordings, vessel model, candidate effects and priors.
        found: Converged fit of the vessel model with some candidate effects.
        held_out: Held-out recordings, at least one.
    """
    fixed = fix_coefficients(problem, found, undetermined_by_simulations(problem, found))
    if fixed is found:
        return found
    horizon = free_run_horizon(problem, held_out)
    runs = free_runs(problem, {WRITTEN: fixed, REFITTED: found}, held_out, horizon)
    before = generalization.mean_square_errors(runs, REFITTED)
    if not before:
        return fixed
    after = generalization.mean_square_errors(runs, WRITTEN)
    limit = problem.config.validate.group_harm**2
    return fixed if generalization.error_ratio(after, before) <= limit else found


def fix_coefficients(problem: Problem, found: Fit, kept: Sequence[int]) -> Fit:
    """Return a fit in which some coefficients have the value of the vessel file.

    The other parameters are refitted. Noise levels and evidence stay those of the hypothesis in
    which all coefficients are free. The covariance is that of the posterior at the new values.

    Args:
        problem: The estimation problem: recordings, vessel model, candidate effects and priors.
        found: Converged fit of the vessel model with some candidate effects.
        kept: Indices of those coefficients among the free parameters; none: the fit is returned.
    """
    if not kept:
        return found
    theta = prior_arrays(found.free).mean
    rest = [i for i in range(len(found.free)) if i not in kept]
    if rest:
        free = tuple(found.free[i] for i in rest)
        own = found.covariance[np.ix_(rest, rest)]
        start = replace(found, free=free, theta=found.theta[rest], covariance=own)
        config = problem.config.fit
        refitted = gauss_newton(problem, start, config.last_steps, config.step_gain)
        if not np.isfinite(refitted.evidence):  # the simulated boat diverges
            return found
        theta[rest] = refitted.theta
    return _move(found, theta)


def undetermined_by_simulations(problem: Problem, found: Fit) -> list[int]:
    """Return the indices of the fitted coefficients that free runs do not determine.

    Coefficients that the vessel file knows well are not among them: their prior limits what the
    filter can read from disturbances, and it sees more than free runs do.

    Args:
        problem: The estimation problem: recordings, vessel model, candidate effects and priors.
        found: Converged fit of the vessel model with some candidate effects.
    """
    covariance = covariance_by_simulations(problem, found)
    config = problem.config.fit
    kept = undetermined_coefficients(replace(found, covariance=covariance), config)
    return [i for i in kept if not _is_known(found, i, config)]


def _is_known(found: Fit, i: int, config: FitConfig) -> bool:
    """Whether the vessel file knows a coefficient well."""
    return found.free[i].sd <= config.known_sd


def undetermined_coefficients(found: Fit, config: FitConfig) -> list[int]:
    """Return the indices of the fitted coefficients whose covariance does not determine them.

    The coefficient with the largest posterior sd, in prior sds, is held first. The others are then
    more certain, because the recordings may determine a combination of coefficients only, such as
    the ratio of thrust and damping.

    Args:
        found: Converged fit of the vessel model with some candidate effects.
        config: Largest posterior sd of a determined coefficient, in prior sds.
    """
    variance = prior_arrays(found.free).sd ** 2
    covariance = found.covariance.copy()
    coefficients = [i for i, f in enumerate(found.free) if f.relative]
    kept = list[int]()
    while coefficients:
        share = np.diag(covariance)[coefficients] / variance[coefficients]
        worst = coefficients[int(np.argmax(share))]
        if not float(share.max()) > config.undetermined_sd**2:
            break
        kept.append(worst)
        coefficients.remove(worst)
        column = covariance[:, worst].copy()
        covariance -= np.outer(column, column) / column[worst]
    return sorted(kept)


def predicts_worse(
    problem: Problem, found: Fit, simpler: Fit, held_out: Sequence[MappedRecording]
) -> bool:
    """Whether errors on held-out recordings are larger with a fit than with a simpler vessel.

    Args:
        problem: The estimation problem.
        found: Fit of the vessel model with some candidate effects.
        simpler: Fit of the vessel model without them.
        held_out: Held-out recordings, at least one.
    """
    horizon = free_run_horizon(problem, held_out)
    runs = free_runs(problem, {WRITTEN: simpler, REFITTED: found}, held_out, horizon)
    return is_harmful(runs, problem.config.validate.worse)


def is_harmful(runs: Sequence[FreeRun], limit: float) -> bool:
    """Whether refitted coefficients make simulations of held-out recordings worse.

    Their free runs are compared with free runs of the vessel file's coefficients.

    Args:
        runs: Free runs (simulations with recorded commands alone) of both over held-out recordings.
        limit: Ratio of rms errors, geometric mean over the signals, above which they are worse.
    """
    before = generalization.mean_square_errors(runs, WRITTEN)
    if not before:
        return False
    after = generalization.mean_square_errors(runs, REFITTED)
    return not generalization.error_ratio(after, before) <= limit**2


def _move(found: Fit, theta: Array) -> Fit:
    """Move a fit to other values; its covariance becomes that of the posterior about them."""
    off = found.theta - theta
    return replace(found, theta=theta, covariance=found.covariance + np.outer(off, off))
