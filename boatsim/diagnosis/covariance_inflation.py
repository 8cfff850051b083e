"""Inflates the covariance of a fit where its errors are more correlated than the filter assumes.

A law that is nearly right leaves errors that are alike from row to row. Each row then counts as
independent evidence, and the covariance comes out too small. How much stretches of the recordings
disagree about a value shows its real uncertainty (H. White, Maximum likelihood estimation of
misspecified models, Econometrica 50, 1982: the sandwich estimator).
"""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from boatsim.diagnosis.fit import TINY, jacobian
from boatsim.diagnosis.problem import Fit, Problem, prior_arrays


def inflate_covariance(problem: Problem, found: Fit) -> Fit:
    """Return a fit whose parameter covariance is inflated for correlated prediction errors.

    The sandwich estimator over stretches of the recordings replaces a variance where it is larger.

    Args:
        problem: The estimation problem: recordings, vessel model, candidate effects and priors.
        found: Converged fit of the vessel model with some candidate effects.
    """
    config = problem.config.fit
    blocks = list(blocks_of_whitened_errors(problem, config.stretch * found.levels.time_constant))
    if len(blocks) < config.fewest_stretches or not found.free:
        return found
    on = problem.program.effect_switches(found.effects)
    passes = problem.filter(found.free, found.theta, on, found.levels)
    white = passes.whitened
    J = jacobian(problem, found.free, found.theta, on, found.levels, passes)
    gradients = np.array([J[rows].T @ white[rows] for rows in blocks])  # (blocks, F)
    sd = prior_arrays(found.free).sd
    inverse = found.covariance / np.outer(sd, sd)
    sandwich = inverse @ (np.eye(len(sd)) + gradients.T @ gradients) @ inverse
    ratio = np.diag(sandwich) / np.maximum(np.diag(inverse), TINY)
    wider = np.sqrt(np.maximum(ratio, 1.0))
    return replace(found, covariance=found.covariance * np.outer(wider, wider))


def blocks_of_whitened_errors(problem: Problem, seconds: float) -> Iterator[NDArray[np.intp]]:
    """Yield the indices of the whitened prediction errors that lie in each stretch of recordings.

    A stretch is a short interval of given duration. Errors of different stretches count as
    independent.

    Args:
        problem: Problem with the recordings.
        seconds: Duration of a stretch [s].
    """
    before = 0
    for mapped in problem.recordings:
        number = ((mapped.times - mapped.times[0]) / seconds).astype(int)
        rows = np.repeat(number, mapped.measured.shape[1])
        for block in range(int(number[-1]) + 1):
            yield before + np.flatnonzero(rows == block)
        before += mapped.measured.size
