"""Chance inside compiled laws: numbers drawn by lot without a state, and narrow-band noise that is made of them."""

from math import cos, pi, sqrt, tan

import numpy as np
from numba import njit

# courses there are; all of them are whole numbers that a parameter holds exactly
MOST = 1_000_000_000


def course(realisation: float, seed: int) -> float:
    """Number of the random course that a scenario's seed gives an effect, whose own number is that of seed 0."""
    return float(1 + (int(realisation) - 1 + seed) % MOST)


@njit(inline="always")
def drawn(realisation: float, k: int) -> float:
    """A number in [0, 1) that depends on realisation and k alone (G. Steele et al., SplitMix, OOPSLA 2014)."""
    z = np.uint64(realisation) * np.uint64(0xD1342543DE82EF95) + np.uint64(k + 1) * np.uint64(
        0x9E3779B97F4A7C15
    )
    z = (z ^ (z >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    z = (z ^ (z >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    return float((z ^ (z >> np.uint64(31))) >> np.uint64(11)) / 9007199254740992.0  # 2^53


@njit(inline="always")
def line(place: float, damping: float) -> tuple[float, float]:
    """A frequency of white noise behind the filter s / (s^2 + 2 damping s + 1), and its weight in the energy.

    In the variable a = w - 1 / w the spectrum is a Lorentz line times 1 + a / sqrt(a^2 + 4), whose second part is odd:
    `place`, in (-1/2, 1/2), is the share of the line below the frequency less a half, the weight is that factor.
    """
    a = 2.0 * damping * tan(pi * place)
    root = sqrt(a * a + 4.0)
    return 0.5 * (a + root if a > 0.0 else 4.0 / (root - a)), 1.0 + a / root


@njit
def noise(
    t: float, frequency: float, damping: float, realisation: float, channel: float, count: float
) -> float:
    """White noise through s / (s^2 + 2 z w0 s + w0^2) with unit variance, as a sum of `count` cosines.

    One cosine by lot from each of as many equal parts of the line; channels are independent of each other. Whole
    numbers as floats: numba would compile it anew for every integer that is written out.
    """
    total = 0.0
    for k in range(int(count)):
        first = 2 * (int(channel) * int(count) + k)
        w, weight = line((k + drawn(realisation, first)) / count - 0.5, damping)
        total += sqrt(weight) * cos(frequency * w * t + 2.0 * pi * drawn(realisation, first + 1))
    return total * sqrt(2.0 / count)
