"""How far off fitted values may be where what is left over is not as random as the filter takes it to be.

A law that is nearly right leaves errors alike from row to row; each row then counts as evidence of its own and the
spreads come out too small. How the stretches of the recordings disagree about a value tells how far off it may be
(H. White, Maximum likelihood estimation of misspecified models, Econometrica 50, 1982: the sandwich estimator).
"""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from boatsim.diagnosis.fit import jacobian
from boatsim.diagnosis.problem import Fit, Problem

STRETCH = 4.0  # time constants of the latent force, beyond which errors are independent
FEWEST = 10  # stretches from which a disagreement can be told


def widened(problem: Problem, found: Fit) -> Fit:
    """A fit whose spreads are as wide as its stretches disagree; never narrower than they were."""
    blocks = list(stretches(problem, STRETCH * found.levels.time_constant))
    if len(blocks) < FEWEST or not found.free:
        return found
    on = problem.program.switches(found.effects)
    problem.likelihood(found.free, found.theta, on, found.levels)
    white = problem.white()
    J = jacobian(problem, found.free, found.theta, on, found.levels, white)
    pulls = np.array(
        [J[rows].T @ white[rows] for rows in blocks]
    )  # (blocks, F) of each on every value
    sd = np.array([f.sd for f in found.free])
    inverse = found.covariance / np.outer(sd, sd)
    sandwich = inverse @ (np.eye(len(sd)) + pulls.T @ pulls) @ inverse
    wider = np.sqrt(np.maximum(np.diag(sandwich) / np.maximum(np.diag(inverse), 1e-300), 1.0))
    return replace(found, covariance=found.covariance * np.outer(wider, wider))


def stretches(problem: Problem, seconds: float) -> Iterator[NDArray[np.intp]]:
    """Rows of the whitened errors of all runs, stretch by stretch."""
    before = 0
    for track in problem.recordings:
        number = ((track.times - track.times[0]) / seconds).astype(int)
        rows = np.repeat(number, track.measured.shape[1])
        for block in range(int(number[-1]) + 1):
            yield before + np.flatnonzero(rows == block)
        before += track.measured.size
