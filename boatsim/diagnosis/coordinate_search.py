"""Maximises a smooth score of a few numbers that has no gradient, one coordinate at a time."""

from collections.abc import Callable

import numpy as np

from boatsim.diagnosis.config import DEFAULT, FitConfig
from boatsim.physics.base import Array

FLAT = -1e-9  # second difference of the score above which it has no maximum along a coordinate


def maximize(
    score: Callable[[Array], float],
    x: Array,
    step: float,
    enough: float,
    config: FitConfig = DEFAULT.fit,
) -> tuple[float, Array]:
    """Maximise a smooth function of a few variables without derivatives, one coordinate at a time.

    A coordinate is revisited only if the function has risen by more than `enough` since its last
    visit: most of them are at their maximum after one round. The step along each follows its last
    move.

    Args:
        score: Function of the coordinates (n,).
        x: (n,) the start.
        step: First step along every coordinate.
        enough: Smaller rises of the score are ignored.
        config: Number of rounds, and bounds of the steps.

    Returns:
        The highest value found, and its coordinates (n,).
    """
    score = _evaluated_once(score)
    best, steps, visited = score(x), np.full(len(x), step), np.full(len(x), -np.inf)
    for _ in range(config.search_rounds):
        due = [j for j in range(len(x)) if best > visited[j] + enough]
        if not due:
            break
        for j in due:
            visited[j] = best
            before = x[j]
            best, x = _search_along(score, x, best, j, steps[j], config.search_reach)
            finest, longest = config.search_finest * step, config.search_reach * step
            steps[j] = np.clip(abs(x[j] - before), finest, longest)
    return best, x


def _evaluated_once(score: Callable[[Array], float]) -> Callable[[Array], float]:
    """The score, evaluated only once at each point, because a search returns to its points."""
    known: dict[bytes, float] = {}

    def score_from_cache(x: Array) -> float:
        key = x.tobytes()
        if key not in known:
            known[key] = score(x)
        return known[key]

    return score_from_cache


def _search_along(
    score: Callable[[Array], float], x: Array, best: float, j: int, step: float, reach: float
) -> tuple[float, Array]:
    """The best of x, a step to either side along a coordinate, and the parabola's maximum."""

    def score_after_step(by: float) -> tuple[float, Array]:
        there = x.copy()
        there[j] += by
        return score(there), there

    above, below = score_after_step(step), score_after_step(-step)
    bend = above[0] - 2.0 * best + below[0]
    top = step if above[0] > below[0] else -step
    if bend < FLAT:
        top = 0.5 * step * (below[0] - above[0]) / bend
    options = [
        (best, x),
        score_after_step(float(np.clip(top, -reach * step, reach * step))),
        above,
        below,
    ]
    return max(options, key=lambda option: option[0])
