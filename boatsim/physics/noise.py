"""Random numbers without a state, and narrow-band noise made of them, for compiled laws."""

from math import cos, pi, sqrt, tan

import numpy as np
from numba import njit

# Number of realisations; a parameter, a float, holds each of these numbers exactly.
REALISATIONS = 1_000_000_000


def seeded_realisation(realisation: float, seed: int) -> float:
    """Return the number of an effect's random realisation under the seed of a scenario.

    The number selects a sequence of random numbers.

    Args:
        realisation: The effect's own number, used unchanged with seed 0.
        seed: Seed of the scenario.
    """
    return float(1 + (int(realisation) - 1 + seed) % REALISATIONS)


@njit(inline="always")
def uniform_random(realisation: float, k: int) -> float:
    """Return number k of a reproducible random sequence, uniform in [0, 1).

    The generator is SplitMix (G. Steele et al., OOPSLA 2014).

    Args:
        realisation: Number of the sequence.
        k: Place in the sequence, from 0.
    """
    z = np.uint64(realisation) * np.uint64(0xD1342543DE82EF95) + np.uint64(k + 1) * np.uint64(
        0x9E3779B97F4A7C15
    )
    z = (z ^ (z >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    z = (z ^ (z >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    return float((z ^ (z >> np.uint64(31))) >> np.uint64(11)) / 9007199254740992.0  # 2^53


@njit(inline="always")
def random_spectral_line(share: float, damping: float) -> tuple[float, float]:
    """Return the frequency of one cosine that samples a narrow-band spectrum, and its weight.

    The frequency is relative to that of the second-order filter that shapes the noise; the weight
    is a factor of its energy. In the variable a = w - 1 / w the spectrum is a Lorentz line times 1
    + a / sqrt(a^2 + 4), whose second part is odd. The weight is that factor.

    Args:
        share: Share of the line below the frequency less a half, in (-1/2, 1/2).
        damping: Damping ratio of the filter.
    """
    a = 2.0 * damping * tan(pi * share)
    root = sqrt(a * a + 4.0)
    return 0.5 * (a + root if a > 0.0 else 4.0 / (root - a)), 1.0 + a / root


@njit
def narrow_band_noise(
    t: float, frequency: float, damping: float, realisation: float, channel: float, count: float
) -> float:
    """Return the value at one time of narrow-band noise with unit variance.

    The noise is a sum of cosines: the spectral line of the filter is divided into equal parts, and
    each contributes one cosine of random frequency and phase. Whole numbers are floats here: numba
    would compile the function again for each integer constant.

    Args:
        t: Time [s].
        frequency: Frequency w of the filter [rad/s].
        damping: Damping ratio of the filter.
        realisation: Number of the random sequence.
        channel: Number of the channel; channels are independent of each other.
        count: Number of cosines.
    """
    total = 0.0
    for k in range(int(count)):
        first = 2 * (int(channel) * int(count) + k)
        w, weight = random_spectral_line(
            (k + uniform_random(realisation, first)) / count - 0.5, damping
        )
        phase = 2.0 * pi * uniform_random(realisation, first + 1)
        total += sqrt(weight) * cos(frequency * w * t + phase)
    return total * sqrt(2.0 / count)
