"""Spectra of the elevation of the sea, by significant height and modal frequency.

S(w) is one-sided: its integral over the angular frequency is the variance m0 of the elevation, and
the significant height is 4 sqrt(m0). Frequencies are numbers or arrays, above zero.
"""

from typing import Any, NamedTuple

import numpy as np
from numba import njit

from boatsim.physics.particulars import GRAVITY

# Factor of the exponent of W. J. Pierson and L. Moskowitz, J. Geophysical Research 69(24), 1964,
# with the significant height in place of the wind speed: T. I. Fossen, Handbook of Marine Craft
# Hydrodynamics and Motion Control, 2nd ed. 2021, section 10.2
FULLY_DEVELOPED = 3.11  # [m^2/s^4] B Hs^2
# Width of the JONSWAP peak below and above it, K. Hasselmann et al., Dt. Hydrogr. Z. A8(12), 1973
WIDTH_BELOW, WIDTH_ABOVE = 0.07, 0.09
# Loss of energy per ln(gamma) that normalises the JONSWAP spectrum, DNV-RP-C205, section 3.5.5
JONSWAP_NORMAL = 0.287
# K. Torsethaugen and S. Haver, Simplified double peak spectral model for ocean waves, ISOPE 2004,
# table 1, for an unlimited fetch. Lengths are in m and times in s: the formulas have dimensions.
TAIL_NORMAL = 3.26  # factor that normalises x^-4 exp(-x^-4); 4 / Gamma(3 / 4) = 3.2643
FETCH = 6.6  # [s m^-1/3] modal period of a fully developed sea by the cube root of its height
STEEPEST = 2.0  # [s m^-1/2] least modal period by the square root of the height
LONGEST = 25.0  # [s] largest modal period
SWELL_LATER = 2.0  # [s] modal period of the swell above that of the fully developed sea
PEAKEDNESS, PEAKEDNESS_POWER = 35.0, 0.857  # of the steepness of the primary peak
PEAKED_SWELL = 6.0  # increase of gamma with the distance from the fully developed sea
WIND_SHARE, WIND_SCALE = 0.7, 0.5  # least share of the height in the wind sea, and its decay
SWELL_SHARE, SWELL_SCALE = 0.6, 0.3  # the same of the swell
# Energy of a peak over that without enhancement: 1 + 0.2653 (gamma^0.8186 - 1), fitted to the
# integral for gamma from 1 to 30. The height errs by 0.4 % at most; by the published normalisation
# of the peak, (1 + 1.1 (ln gamma)^1.19) / gamma, it errs by 1.8 %.
PEAK_ENERGY, PEAK_ENERGY_POWER = 0.2653, 0.8186


@njit
def bretschneider(frequency: Any, significant_height: float, modal_frequency: float) -> Any:
    """Return the two-parameter spectrum of Bretschneider, also called that of the ISSC.

    S(w) = 5 / 16 Hs^2 wm^4 / w^5 exp(-5 / 4 (wm / w)^4)

    The mean period is 0.772 of the modal one, and the zero-crossing period 0.710.

    Args:
        frequency: Angular frequency w [rad/s], a number or an array (N,).
        significant_height: Hs [m].
        modal_frequency: Frequency at the peak wm [rad/s].

    Returns:
        Spectral density [m^2 s], of the shape of `frequency`.
    """
    ratio = modal_frequency / frequency
    power = ratio * ratio * ratio * ratio
    level = 0.3125 * significant_height * significant_height / frequency
    return level * power * np.exp(-1.25 * power)


@njit
def fully_developed_frequency(significant_height: float) -> float:
    """Return the modal frequency [rad/s] of a fully developed sea, by Pierson and Moskowitz.

    Args:
        significant_height: Hs [m], above zero.
    """
    return (0.8 * FULLY_DEVELOPED) ** 0.25 / np.sqrt(significant_height)


@njit
def pierson_moskowitz(frequency: Any, significant_height: float) -> Any:
    """Return the spectrum of a fully developed sea, whose modal frequency follows from its height.

    Its level is such that the significant height is exact; the published one, 8.1e-3 g^2 / w^5, is
    0.3 % higher.

    Args:
        frequency: Angular frequency w [rad/s], a number or an array (N,).
        significant_height: Hs [m].

    Returns:
        Spectral density [m^2 s], of the shape of `frequency`.
    """
    modal = fully_developed_frequency(significant_height)
    return bretschneider(frequency, significant_height, modal)


@njit
def peak_enhancement(frequency: Any, modal_frequency: float, gamma: float) -> Any:
    """Return the factor by which the peak of a growing sea exceeds that of a developed one.

    gamma^exp(-(w / wm - 1)^2 / (2 s^2)), s = 0.07 below the peak and 0.09 above it

    Args:
        frequency: Angular frequency w [rad/s], a number or an array (N,).
        modal_frequency: Frequency at the peak wm [rad/s].
        gamma: Factor at the peak, at least 1.
    """
    off = frequency / modal_frequency - 1.0
    middle, half = 0.5 * (WIDTH_ABOVE + WIDTH_BELOW), 0.5 * (WIDTH_ABOVE - WIDTH_BELOW)
    share = off / (middle + half * np.sign(off))
    return gamma ** np.exp(-0.5 * share * share)


@njit
def jonswap(frequency: Any, significant_height: float, modal_frequency: float, gamma: float) -> Any:
    """Return the JONSWAP spectrum of a growing sea, with the normalisation of DNV-RP-C205.

    S(w) = (1 - 0.287 ln gamma) S_Bretschneider(w) gamma^exp(-(w / wm - 1)^2 / (2 s^2))

    With gamma = 1 it is the spectrum of Bretschneider. The significant height is exact within 1 %
    for gamma up to 7.

    Args:
        frequency: Angular frequency w [rad/s], a number or an array (N,).
        significant_height: Hs [m].
        modal_frequency: Frequency at the peak wm [rad/s].
        gamma: Peak enhancement, 1 to 7; 3.3 is the mean of the measurements.

    Returns:
        Spectral density [m^2 s], of the shape of `frequency`.
    """
    level = 1.0 - JONSWAP_NORMAL * np.log(gamma)
    smooth = bretschneider(frequency, significant_height, modal_frequency)
    return level * smooth * peak_enhancement(frequency, modal_frequency, gamma)


class WaveSystems(NamedTuple):
    """The two wave systems of Torsethaugen's spectrum, wind sea and swell.

    The primary one has the modal period of the sea.
    """

    primary_height: float  # [m] significant height
    primary_frequency: float  # [rad/s] at the peak
    gamma: float  # peak enhancement of the primary system
    secondary_height: float  # [m]
    secondary_frequency: float  # [rad/s]


@njit
def wave_systems(significant_height: float, modal_frequency: float) -> WaveSystems:
    """Return heights and frequencies of wind sea and swell of the simplified Torsethaugen spectrum.

    The sea is a wind sea if its modal period is less than that of a fully developed sea, otherwise
    it is dominated by swell.

    Args:
        significant_height: Hs [m], above zero.
        modal_frequency: Frequency at the higher peak [rad/s].
    """
    period = 2.0 * np.pi / modal_frequency
    developed = FETCH * significant_height ** (1.0 / 3.0)
    if period <= developed:
        least = STEEPEST * np.sqrt(significant_height)
        distance = min((developed - period) / (developed - least), 1.0) / WIND_SCALE
        share = WIND_SHARE + (1.0 - WIND_SHARE) * np.exp(-distance * distance)
        steepness = 2.0 * np.pi / GRAVITY * share * significant_height / (period * period)
        gamma = PEAKEDNESS * steepness**PEAKEDNESS_POWER
        rest = significant_height * np.sqrt(1.0 - share * share)
        other = developed + SWELL_LATER
    else:
        distance = min((period - developed) / (LONGEST - developed), 1.0)
        decay = distance / SWELL_SCALE
        share = SWELL_SHARE + (1.0 - SWELL_SHARE) * np.exp(-decay * decay)
        steepness = 2.0 * np.pi / GRAVITY * significant_height / (developed * developed)
        gamma = PEAKEDNESS * steepness**PEAKEDNESS_POWER * (1.0 + PEAKED_SWELL * distance)
        rest = significant_height * np.sqrt(1.0 - share * share)
        other = FETCH * max(rest, 1e-9 * significant_height) ** (1.0 / 3.0)
    return WaveSystems(
        share * significant_height,
        modal_frequency,
        max(gamma, 1.0),
        rest,
        2.0 * np.pi / other,
    )


@njit
def wave_system(
    frequency: Any, significant_height: float, modal_frequency: float, gamma: float
) -> Any:
    """Return the spectrum of one wave system of Torsethaugen's spectrum, whose tail falls by w^-4.

    Args:
        frequency: Angular frequency w [rad/s], a number or an array (N,).
        significant_height: Of the system [m].
        modal_frequency: Frequency at its peak [rad/s].
        gamma: Its peak enhancement, at least 1.

    Returns:
        Spectral density [m^2 s], of the shape of `frequency`.
    """
    ratio = modal_frequency / frequency
    power = ratio * ratio * ratio * ratio
    level = TAIL_NORMAL / 16.0 * significant_height * significant_height / modal_frequency
    smooth = level * power * np.exp(-power)
    energy = 1.0 + PEAK_ENERGY * (gamma**PEAK_ENERGY_POWER - 1.0)
    return smooth * peak_enhancement(frequency, modal_frequency, gamma) / energy


@njit
def torsethaugen(frequency: Any, significant_height: float, modal_frequency: float) -> Any:
    """Return the simplified two-peak spectrum of Torsethaugen and Haver, of wind sea and swell.

    It describes open ocean with waves of 0.5 to 11 m and 3.5 to 19 s. The significant height is
    exact within 0.5 %.

    Args:
        frequency: Angular frequency w [rad/s], a number or an array (N,).
        significant_height: Hs [m], above zero.
        modal_frequency: Frequency at the higher peak [rad/s].

    Returns:
        Spectral density [m^2 s], of the shape of `frequency`.
    """
    sea = wave_systems(significant_height, modal_frequency)
    return wave_system(
        frequency, sea.primary_height, sea.primary_frequency, sea.gamma
    ) + wave_system(frequency, sea.secondary_height, sea.secondary_frequency, 1.0)
