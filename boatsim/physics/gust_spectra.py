"""Spectra of the speed of gusts along a mean wind.

S(f) is one-sided: its integral over the frequency in Hz is the variance of the speed.
"""

from typing import Any

from numba import njit

DRAG = 0.0026  # [-] surface drag coefficient over the sea at 10 m, as in Fossen 2021, section 10.1
DAVENPORT_LENGTH = 1200.0  # [m] A. G. Davenport, Quart. J. Royal Met. Soc. 87, 1961
HARRIS_LENGTH = (
    1800.0  # [m] R. I. Harris, Seminar on Modern Design of Wind-Sensitive Structures, 1971
)
NPD_EXPONENT = 0.468  # NORSOK N-003 and DNV-RP-C205, section 2.3.6: measurements at Froya
REFERENCE_HEIGHT = 10.0  # [m] of the mean speed
PROFILE = 1.0 / 7.0  # exponent of the mean speed over open water, Fossen 2021, section 10.1


@njit
def mean_speed_at(height: float, speed: float) -> float:
    """Return the mean speed of the wind at a height [m/s], by the power law with exponent 1 / 7.

    Args:
        height: Height above the water [m].
        speed: Mean speed at 10 m [m/s].
    """
    return speed * (height / REFERENCE_HEIGHT) ** PROFILE


@njit
def davenport(frequency: Any, speed: float) -> Any:
    """Return Davenport's gust spectrum [m^2/s], whose variance is 6 times the drag times U^2.

    S(f) = 4 k U L x / (1 + x^2)^(4/3), x = L f / U, L = 1200 m

    Args:
        frequency: Frequency f [Hz], a number or an array (N,).
        speed: Mean speed U at 10 m [m/s].
    """
    x = DAVENPORT_LENGTH * frequency / speed
    return 4.0 * DRAG * speed * DAVENPORT_LENGTH * x / (1.0 + x * x) ** (4.0 / 3.0)


@njit
def harris(frequency: Any, speed: float) -> Any:
    """Return Harris' gust spectrum [m^2/s], which has more slow gusts than Davenport's.

    S(f) = 4 k U L / (2 + x^2)^(5/6), x = L f / U, L = 1800 m

    Args:
        frequency: Frequency f [Hz], a number or an array (N,).
        speed: Mean speed U at 10 m [m/s].
    """
    x = HARRIS_LENGTH * frequency / speed
    return 4.0 * DRAG * speed * HARRIS_LENGTH / (2.0 + x * x) ** (5.0 / 6.0)


@njit
def npd(frequency: Any, speed: float, height: float) -> Any:
    """Return the gust spectrum of the Norwegian Petroleum Directorate [m^2/s], by the height.

    S(f) = 320 (U / 10)^2 (z / 10)^0.45 / (1 + x^n)^(5 / (3 n)),
    x = 172 f (z / 10)^(2/3) (U / 10)^(-3/4), n = 0.468

    Args:
        frequency: Frequency f [Hz], a number or an array (N,).
        speed: Mean speed U at 10 m [m/s].
        height: Height z above the water [m].
    """
    level = height / REFERENCE_HEIGHT
    strength = speed / 10.0
    x = 172.0 * frequency * level ** (2.0 / 3.0) * strength**-0.75
    size = 320.0 * strength * strength * level**0.45
    return size / (1.0 + x**NPD_EXPONENT) ** (5.0 / (3.0 * NPD_EXPONENT))
