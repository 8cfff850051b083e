"""How far runs of the thesis' eight tests are from its tables, in one number."""

from collections.abc import Iterable, Mapping
from math import log, sqrt

import numpy as np

CLIP = 3.0  # largest residual that counts
SCALE = {
    "heading_at_end": 10.0,
    "moved": 0.1,
}  # [deg], [m] for these errors; all others are log ratios


def J(tests: Iterable[tuple[Mapping[str, float], Mapping[str, float]]]) -> float:
    """Distance of several runs to published values: per test the mean of squared residuals, mean over tests, root.

    Each test is (norms, published), by name; what is not published does not count. A residual is the error over 10 deg
    or 0.1 m for heading and distance moved, a log ratio otherwise, clipped to +-3.
    """
    means = [
        np.mean([_residual(n, values[n], p) ** 2 for n, p in published.items()])
        for values, published in tests
    ]
    return sqrt(float(np.mean(means)))


def _residual(name: str, value: float, published: float) -> float:
    error = (value - published) / SCALE[name] if name in SCALE else log(value / published)
    return min(max(error, -CLIP), CLIP)
