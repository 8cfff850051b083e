"""Integrals of the slope of a wave over a hull."""

from math import cos, sin

from numba import njit


@njit(inline="always")
def wave_slope_integrals(s: float, taper: float) -> tuple[float, float]:
    """Return the integrals of a wave's slope along a hull that give its side force and yaw moment.

    They are the integrals of (1 - taper x^2) cos(s x) and (1 - taper x^2) x sin(s x) over x in [-1,
    1], for a hull of parabolic section areas.

    Args:
        s: Wave number times half the length, along the hull [-].
        taper: Taper of the section areas [-].
    """
    if abs(s) < 0.02:  # series, because the closed forms cancel numerically
        s2 = s * s
        return 2.0 - 2.0 / 3.0 * taper - s2 * (1.0 / 3.0 - taper / 5.0), s * (
            2.0 / 3.0 - 0.4 * taper - s2 * (1.0 / 15.0 - taper / 21.0)
        )
    c, n = cos(s), sin(s)
    # halves of the integrals of cos and x^2 cos
    even = n / s
    square = n / s + 2.0 * c / s**2 - 2.0 * n / s**3
    odd = (n - s * c) / s**2
    cube = (3.0 * s * s * n - s**3 * c + 6.0 * s * c - 6.0 * n) / s**4
    return 2.0 * (even - taper * square), 2.0 * (odd - taper * cube)


@njit(inline="always")
def beam_integrals(s: float) -> tuple[float, float]:
    """Return force and roll moment of a wave on a section over those of waves that are long.

    They are the mean of cos(2 s y / b) over the breadth b, sin s / s, and 3 (sin s - s cos s) /
    s^3: the integral of y sin(2 s y / b) divided by that of y (2 s y / b).

    Args:
        s: Wave number across the hull times half the breadth [-].
    """
    if abs(s) < 0.05:  # series, because the closed forms cancel numerically
        square = s * s
        return 1.0 - square / 6.0 + square * square / 120.0, 1.0 - s * s / 10.0 + s**4 / 280.0
    n = sin(s)
    return n / s, 3.0 * (n - s * cos(s)) / s**3


@njit(inline="always")
def beam_attenuation(s: float) -> float:
    """Return the roll moment of a wave on a section over that of a plane with the wave's slope.

    Args:
        s: Wave number across the hull times half the breadth [-].
    """
    _, moment = beam_integrals(s)
    return moment
