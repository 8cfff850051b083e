"""Numbers drawn by lot for an episode: they depend on its seed alone, not on which boats it is played beside."""

import numpy as np
from numpy.typing import NDArray

from boatsim.physics.signals import Array

Seeds = NDArray[np.uint64]

STRIDE, STEP = np.uint64(0xD1342543DE82EF95), np.uint64(0x9E3779B97F4A7C15)
FIRST, SECOND = np.uint64(0xBF58476D1CE4E5B9), np.uint64(0x94D049BB133111EB)


def _mixed(z: Seeds) -> Seeds:
    """G. Steele et al., SplitMix, OOPSLA 2014."""
    z = (z ^ (z >> np.uint64(30))) * FIRST
    z = (z ^ (z >> np.uint64(27))) * SECOND
    return z ^ (z >> np.uint64(31))


def episode(seeds: Seeds, number: Seeds) -> Seeds:
    """Seeds (k,) of the episodes of those numbers that begin after a reset with the given seeds."""
    return _mixed(_mixed(seeds * STRIDE + STEP) + number * STEP)


def shares(seeds: Seeds, count: int) -> Array:
    """(k, count) numbers between 0 and 1, neither of them."""
    z = _mixed(seeds[:, None] * STRIDE + np.arange(1, count + 1, dtype=np.uint64) * STEP)
    return ((z >> np.uint64(11)).astype(float) + 0.5) / 9007199254740992.0  # 2^53
