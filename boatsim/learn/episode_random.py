"""Random numbers of episodes; they depend only on the seed of the episode, not on other boats."""

import numpy as np
from numpy.typing import NDArray

from boatsim.physics.signals import Array

Seeds = NDArray[np.uint64]

# Multiplier of a linear congruential generator, from Steele and Vigna, "Computationally easy,
# spectrally good multipliers for congruential pseudorandom number generators", 2022.
STRIDE = np.uint64(0xD1342543DE82EF95)
# Increment and multipliers of SplitMix64: Steele et al., OOPSLA 2014.
STEP = np.uint64(0x9E3779B97F4A7C15)
FIRST = np.uint64(0xBF58476D1CE4E5B9)
SECOND = np.uint64(0x94D049BB133111EB)


def _splitmix64(z: Seeds) -> Seeds:
    """Mixing function of SplitMix64."""
    z = (z ^ (z >> np.uint64(30))) * FIRST
    z = (z ^ (z >> np.uint64(27))) * SECOND
    return z ^ (z >> np.uint64(31))


def episode_seeds(seeds: Seeds, number: Seeds) -> Seeds:
    """Return the random seeds (k,) of episodes from the seed of a reset and the episode number.

    Args:
        seeds: Seeds (k,) of the reset.
        number: Numbers (k,) of the episodes since the reset.
    """
    return _splitmix64(_splitmix64(seeds * STRIDE + STEP) + number * STEP)


def uniform_numbers(seeds: Seeds, count: int) -> Array:
    """Return uniform random numbers (k, count) in the open interval from 0 to 1, by seed.

    The numbers of a seed depend on no other seed.

    Args:
        seeds: Seeds (k,).
        count: Number of random numbers for each seed.
    """
    z = _splitmix64(seeds[:, None] * STRIDE + np.arange(1, count + 1, dtype=np.uint64) * STEP)
    return ((z >> np.uint64(11)).astype(float) + 0.5) / 9007199254740992.0  # 2^53
