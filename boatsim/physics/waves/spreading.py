"""Directional spreading of a sea about its mean direction."""

from math import atan, cos, exp, lgamma, pi, sqrt
from typing import Any

import numpy as np
from numba import njit


def cosine_power(angle: Any, exponent: float) -> Any:
    """Return the share of the energy per direction by the law cos^n.

    D = Gamma(1 + n / 2) / (sqrt(pi) Gamma(1 / 2 + n / 2)) cos^n(angle) up to a right angle, else 0

    Source: DNV-RP-C205, section 3.5.8; n is 2 to 4 for a wind sea, and 6 or more for swell.

    Args:
        angle: Direction from the mean one [rad], a number or an array (N,).
        exponent: n, at least 0.

    Returns:
        Density [1/rad], of the shape of `angle`; its integral is 1.
    """
    level = exp(lgamma(1.0 + 0.5 * exponent) - lgamma(0.5 + 0.5 * exponent)) / sqrt(pi)
    inside = np.abs(angle) <= 0.5 * pi
    return np.where(inside, level * np.abs(np.cos(angle)) ** exponent, 0.0)


def half_angle_cosine_power(angle: Any, exponent: float) -> Any:
    """Return the share of the energy per direction by the law cos^2s of half the angle.

    D = Gamma(s + 1) / (2 sqrt(pi) Gamma(s + 1 / 2)) cos^2s(angle / 2)

    About the mean direction it is as narrow as cos^n with n = s / 2. Source: DNV-RP-C205, section
    3.5.8.

    Args:
        angle: Direction from the mean one, -pi to pi [rad], a number or an array (N,).
        exponent: s, at least 0.

    Returns:
        Density [1/rad], of the shape of `angle`; its integral is 1.
    """
    level = exp(lgamma(1.0 + exponent) - lgamma(0.5 + exponent)) / (2.0 * sqrt(pi))
    return level * np.abs(np.cos(0.5 * angle)) ** (2.0 * exponent)


@njit
def random_direction(first: float, second: float, exponent: float) -> float:
    """Return a random direction whose density is that of `cosine_power` [rad].

    The tangent of the angle has Student's distribution with n + 1 degrees of freedom, scaled by
    1 / sqrt(n + 1), which R. W. Bailey samples in closed form (Mathematics of Computation 62,
    1994).

    Args:
        first: Random number, uniform in [0, 1).
        second: Another one.
        exponent: n, above -1.
    """
    radius = sqrt((1.0 - first) ** (-2.0 / (exponent + 1.0)) - 1.0)
    return atan(radius * cos(2.0 * pi * second))
