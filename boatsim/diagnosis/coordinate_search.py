"""Maximises a smooth score of a few numbers that has no gradient, one coordinate at a time."""

from collections.abc import Callable

import numpy as np

from boatsim.physics.base import Array

ROUNDS = 8  # over all coordinates, at most
FINEST = 0.3  # of the first step: what a coordinate is still tried by when it hardly moves
REACH = 2.0  # steps that a coordinate may go at a time


def climbed(
    score: Callable[[Array], float], x: Array, step: float, enough: float
) -> tuple[float, Array]:
    """The highest score found from `x` on, and where.

    A coordinate is looked at again only if the score has risen by more than `enough` since it was looked at last: most
    are where they belong after one round. The step of each follows how far it went.
    """
    best, steps, since = score(x), np.full(len(x), step), np.full(len(x), -np.inf)
    for _ in range(ROUNDS):
        due = [j for j in range(len(x)) if best > since[j] + enough]
        if not due:
            break
        for j in due:
            since[j], before = best, x[j]
            best, x = _along(score, x, best, j, steps[j])
            steps[j] = np.clip(abs(x[j] - before), FINEST * step, REACH * step)
    return best, x


def _along(
    score: Callable[[Array], float], x: Array, best: float, j: int, step: float
) -> tuple[float, Array]:
    """The best of x, a step on either side of it along one coordinate, and the top of the parabola through these."""

    def moved(by: float) -> tuple[float, Array]:
        there = x.copy()
        there[j] += by
        return score(there), there

    above, below = moved(step), moved(-step)
    bend = above[0] - 2.0 * best + below[0]
    uphill = step if above[0] > below[0] else -step
    top = 0.5 * step * (below[0] - above[0]) / bend if bend < -1e-9 else uphill
    options = [(best, x), moved(float(np.clip(top, -REACH * step, REACH * step))), above, below]
    return max(options, key=lambda o: o[0])
