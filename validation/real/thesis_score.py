"""Distance between simulated runs of the thesis' eight tests and its tables, as one number."""

from collections.abc import Iterable, Mapping
from math import log, sqrt

import numpy as np

CLIP = 3.0  # largest residual that counts
# [deg], [m] for these errors; all others are log ratios
SCALE = {"heading_at_end": 10.0, "moved": 0.1}


def rms_distance(tests: Iterable[tuple[Mapping[str, float], Mapping[str, float]]]) -> float:
    """Return the rms distance between runs and published values.

    A residual is the error over 10 deg or 0.1 m for heading and distance moved, and a log ratio
    otherwise, clipped to +-3. The squares are averaged over each test, then over the tests.

    Args:
        tests: For each test its metrics and the published values, by name. Metrics that are not
            published do not count.
    """
    means = []
    for values, published in tests:
        residuals = [residual(name, values[name], x) for name, x in published.items()]
        means.append(np.mean(np.clip(residuals, -CLIP, CLIP) ** 2))
    return sqrt(float(np.mean(means)))


def residual(name: str, value: float, published: float) -> float:
    """Return the residual of one metric, not clipped."""
    if name in SCALE:
        return (value - published) / SCALE[name]
    return log(value / published)
