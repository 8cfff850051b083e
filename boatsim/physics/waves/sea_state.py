"""The components of a sea state: frequency, amplitude, phase and direction of each wave.

Compiled laws compute them from the numbers of a sea, so that no vessel stores a table of waves. A
tabulated sea has its cells in a table, `tabulated.spectrum_table`, and the same random numbers.
"""

from math import atan2, exp, log, pi, sqrt
from typing import Any, NamedTuple

import numpy as np
from numba import njit

from boatsim.physics.debugging import interpreted
from boatsim.physics.noise import uniform_random
from boatsim.physics.signals import Array
from boatsim.physics.waves.spectra import (
    TAIL_NORMAL,
    bretschneider,
    fully_developed_frequency,
    jonswap,
    wave_system,
    wave_systems,
)
from boatsim.physics.waves.spreading import random_direction

FORMULAS = ("bretschneider", "pierson_moskowitz", "jonswap", "torsethaugen", "regular")
SPECTRA = (*FORMULAS, "tabulated")
# place of each spectrum in SPECTRA, by which compiled laws know it
BRETSCHNEIDER, PIERSON_MOSKOWITZ, JONSWAP, TORSETHAUGEN, REGULAR = map(float, range(5))
TABULATED = 5.0
CELLS = 4  # numbers of a tabulated sea before its cells
NO_TABLE = np.zeros(1)  # of a sea that is not tabulated
LOWEST = 0.45  # lowest frequency over the modal one; less than 1e-13 of the energy lies below
HIGHEST = 4.0  # default cut over the modal frequency; 0.5 % of the energy lies above
LOST_TAIL = 0.005  # the same share of the two-peak spectrum, whose tail falls by w^-4
# Random numbers of a sea begin at 0 with frequencies and phases; those of directions and of
# amplitudes begin here, above two for each of the most components that a sea has
DIRECTIONS, AMPLITUDES = 4000, 8000
# Range and number of the frequencies by which the energy above a cut is integrated; beyond the
# range lies less than 1e-6 of it, and the error of the integral is less than 1e-5
WIDEST, FINE = 100.0, 2000


class SeaState(NamedTuple):
    """Numbers that all components of a sea have in common."""

    number: float  # of waves
    low: float  # [rad/s] lowest frequency
    width: float  # [rad/s] of the cell of each wave
    modal_frequency: float  # [rad/s]
    primary_height: float  # [m] of the wave system with the modal frequency
    gamma: float  # its peak enhancement
    secondary_height: float  # [m] of the other system, 0 without one
    secondary_frequency: float  # [rad/s]


@njit
def highest_frequency(q: Any, modal: float) -> float:
    """Return the highest frequency of a sea with one peak [rad/s].

    Args:
        q: Parameters of the effect.
        modal: Modal frequency [rad/s].
    """
    if q.cut > 0.0:
        return max(q.cut, modal)
    return HIGHEST * modal


@njit
def two_peak_sea(q: Any, modal: float) -> SeaState:
    """Return the common numbers of a sea with Torsethaugen's spectrum.

    Its range extends over both peaks. Above its end lies at most `LOST_TAIL` of the energy, by the
    integrals of both tails.

    Args:
        q: Parameters of the effect.
        modal: Modal frequency [rad/s].
    """
    s = wave_systems(q.significant_height, modal)
    low = LOWEST * min(s.primary_frequency, s.secondary_frequency)
    first = (s.primary_height / q.significant_height) ** 2 * s.primary_frequency**3
    second = (s.secondary_height / q.significant_height) ** 2 * s.secondary_frequency**3
    high = (TAIL_NORMAL / 3.0 * (first + second) / LOST_TAIL) ** (1.0 / 3.0)
    if q.cut > 0.0:
        high = max(q.cut, modal)
    width = (high - low) / int(q.components)
    return SeaState(
        q.components,
        low,
        width,
        modal,
        s.primary_height,
        s.gamma,
        s.secondary_height,
        s.secondary_frequency,
    )


@njit
def sea_state(q: Any, p: Array, at: Any) -> SeaState:
    """Return the numbers that all components of a sea have in common.

    Args:
        q: Parameters of the effect, with a significant height above zero.
        p: Parameters and tables of all effects.
        at: Index of the table of a tabulated sea.
    """
    modal = 2.0 * pi / q.modal_period
    if q.spectrum_code == TABULATED:
        return SeaState(p[at], p[at + 1], p[at + 2], modal, q.significant_height, 1.0, 0.0, modal)
    if q.spectrum_code == PIERSON_MOSKOWITZ:
        modal = fully_developed_frequency(q.significant_height)
    if q.spectrum_code == REGULAR:
        return SeaState(1.0, modal, 0.0, modal, q.significant_height, 1.0, 0.0, modal)
    if q.spectrum_code == TORSETHAUGEN:
        return two_peak_sea(q, modal)
    low = LOWEST * modal
    width = (highest_frequency(q, modal) - low) / int(q.components)
    return SeaState(q.components, low, width, modal, q.significant_height, q.gamma, 0.0, modal)


@njit
def spectral_density(frequency: Any, q: Any, sea: SeaState) -> Any:
    """Return the spectral density of the elevation of a sea that is not regular [m^2 s].

    Args:
        frequency: Angular frequency [rad/s], a number or, in plain Python, an array (N,).
        q: Parameters of the effect.
        sea: Common numbers of the components.
    """
    if q.spectrum_code == TORSETHAUGEN:
        first = wave_system(frequency, sea.primary_height, sea.modal_frequency, sea.gamma)
        second = wave_system(frequency, sea.secondary_height, sea.secondary_frequency, 1.0)
        return first + second
    if q.spectrum_code == JONSWAP:
        return jonswap(frequency, sea.primary_height, sea.modal_frequency, sea.gamma)
    return bretschneider(frequency, sea.primary_height, sea.modal_frequency)


@njit(forceinline=True)
def cell_share(k: int, q: Any, sea: SeaState, p: Array, at: Any) -> float:
    """Return the share of the energy of a sea that lies in one cell of frequencies.

    That of Bretschneider's spectrum and of a table is exact, others have the density in the middle
    of the cell.

    Args:
        k: Number of the cell, from 0.
        q: Parameters of the effect.
        sea: Common numbers of the components.
        p: Parameters and tables of all effects.
        at: Index of the table of a tabulated sea.
    """
    if q.spectrum_code == TABULATED:
        return float(p[at + CELLS + k * (int(p[at + 3]) + 2)])
    if q.spectrum_code <= PIERSON_MOSKOWITZ:
        below = 0.0  # share of the energy below the cell
        if k > 0:
            below = exp(-1.25 * (sea.modal_frequency / (sea.low + sea.width * k)) ** 4)
        above = exp(-1.25 * (sea.modal_frequency / (sea.low + sea.width * (k + 1))) ** 4)
        return above - below
    density = spectral_density(sea.low + sea.width * (k + 0.5), q, sea)
    return float(16.0 * density * sea.width / (q.significant_height * q.significant_height))


@njit(forceinline=True)
def wave_component(k: int, q: Any, sea: SeaState, p: Array, at: Any) -> tuple[float, float, float]:
    """Return frequency [rad/s], amplitude [m] and phase [rad] of one wave of the sea.

    Each of the cells of equal width in frequency has one wave, at a random frequency inside the
    cell and with the energy of the spectrum in it. With `random_amplitudes` the energy of a wave
    has an exponential distribution, so that the sea is a Gaussian process also with few waves (M.
    J. Tucker et al., Applied Ocean Research 6(2), 1984). A regular wave has its crest at the
    origin at t = 0.

    Args:
        k: Number of the wave, from 0.
        q: Parameters of the effect.
        sea: Common numbers of the components.
        p: Parameters and tables of all effects.
        at: Index of the table of a tabulated sea.
    """
    if q.spectrum_code == REGULAR:
        return sea.modal_frequency, 0.5 * q.significant_height, pi
    amplitude = q.significant_height * sqrt(cell_share(k, q, sea, p, at) / 8.0)
    if q.random_amplitudes != 0.0:
        amplitude *= sqrt(-log(1.0 - uniform_random(q.realisation, AMPLITUDES + k)))
    return (
        sea.low + sea.width * (k + uniform_random(q.realisation, 2 * k)),
        amplitude,
        2.0 * pi * uniform_random(q.realisation, 2 * k + 1),
    )


@njit(inline="always")
def has_directions(q: Any) -> Any:
    """Return whether each wave of a sea has a direction of its own.

    Args:
        q: Parameters of the effect.
    """
    return q.spreading > 0.0 or q.spectrum_code == TABULATED


@njit
def tabulated_direction(k: int, q: Any, p: Array, at: Any) -> float:
    """Return the direction to which one wave of a tabulated sea runs [rad].

    The table has the directions below which the share sin^2(pi j / 2 n) of the energy lies, so that
    both ends of the distribution are fine too; in between they are linear in j.

    Args:
        k: Number of the wave, from 0.
        q: Parameters of the effect.
        p: Parameters and tables of all effects.
        at: Index of the table of the sea.
    """
    shares = int(p[at + 3])
    below = uniform_random(q.realisation, DIRECTIONS + 2 * k)
    place = 2.0 / pi * atan2(sqrt(below), sqrt(1.0 - below)) * shares
    low = min(int(place), shares - 1)
    row = at + CELLS + k * (shares + 2) + 1 + low
    return float(p[row] + (place - low) * (p[row + 1] - p[row]))


@njit
def wave_direction(k: int, q: Any, p: Array, at: Any) -> float:
    """Return the direction to which one wave of the sea runs [rad].

    Args:
        k: Number of the wave, from 0.
        q: Parameters of the effect.
        p: Parameters and tables of all effects.
        at: Index of the table of a tabulated sea.
    """
    toward = float(q.toward)
    if q.spectrum_code == TABULATED:
        toward += tabulated_direction(k, q, p, at)
    if q.spreading <= 0.0:
        return toward
    first = uniform_random(q.realisation, DIRECTIONS + 2 * k)
    second = uniform_random(q.realisation, DIRECTIONS + 2 * k + 1)
    return float(toward + random_direction(first, second, q.spreading))


def components(q: Any, table: Array = NO_TABLE) -> Array:
    """Return all waves of a sea as an array.

    Args:
        q: Parameters of the effect, with a significant height above zero.
        table: Table of a tabulated sea.

    Returns:
        Frequency [rad/s], amplitude [m], phase [rad] and direction [rad] of each wave (N, 4).
    """
    with np.errstate(over="ignore"):  # the random numbers are integers modulo 2^64
        sea = interpreted(sea_state)(q, table, 0)
        wave, direction = interpreted(wave_component), interpreted(wave_direction)
        rows = []
        for k in range(int(sea.number)):
            rows.append((*wave(k, q, sea, table, 0), direction(k, q, table, 0)))
    return np.array(rows)


def energy_above(q: Any) -> tuple[Array, Array]:
    """Return the share of the energy of a sea that lies above each of many frequencies.

    Args:
        q: Parameters of the effect, of a sea with a formula and a height.

    Returns:
        Frequencies (N,) [rad/s], increasing, and shares (N,) [-], decreasing to about 0.
    """
    sea = interpreted(sea_state)(q, NO_TABLE, 0)
    lowest = LOWEST * min(sea.modal_frequency, sea.secondary_frequency)
    frequency = lowest * np.geomspace(1.0, WIDEST, FINE)
    density = interpreted(spectral_density)(frequency, q, sea)
    parts = 0.5 * (density[1:] + density[:-1]) * np.diff(frequency)
    below = np.append(0.0, np.cumsum(parts))
    return frequency, 1.0 - below / below[-1]
