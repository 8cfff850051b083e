"""Spectra, dispersion and spreading: published formulas written out here, and integrals of them."""

from collections.abc import Callable
from math import exp, gamma, log, pi, sqrt
from typing import Any

import numpy as np
import pytest
from scipy.integrate import quad

from boatsim.physics.base import Array
from boatsim.physics.debugging import interpreted
from boatsim.physics.waves import spectra
from boatsim.physics.waves.dispersion import pressure_attenuation, wave_number
from boatsim.physics.waves.spreading import (
    cosine_power,
    half_angle_cosine_power,
    random_direction,
)

G = 9.81
Density = Callable[[float], float]
JONSWAP, TORSETHAUGEN = interpreted(spectra.jonswap), interpreted(spectra.torsethaugen)
BRETSCHNEIDER = interpreted(spectra.bretschneider)
PIERSON_MOSKOWITZ = interpreted(spectra.pierson_moskowitz)
SYSTEMS = interpreted(spectra.wave_systems)
NUMBER, ATTENUATION = interpreted(wave_number), interpreted(pressure_attenuation)


def moment(density: Density, peak: float, order: int = 0) -> float:
    """Moment of a spectrum about zero, over parts between which it bends."""
    ends = [0.2, 0.7, 0.9, 1.0, 1.1, 1.3, 2.0, 5.0, 20.0, 200.0]
    total = 0.0
    for low, high in zip(ends, ends[1:], strict=False):
        part = quad(lambda w: w**order * density(w), low * peak, high * peak, limit=200)
        total += part[0]
    return total


def height(density: Density, peak: float) -> float:
    return 4.0 * sqrt(moment(density, peak))


def peak_of(density: Callable[[Array], Array], low: float, high: float) -> float:
    w = np.linspace(low, high, 20001)
    return float(w[np.argmax(density(w))])


# ---- spectra of one peak


@pytest.mark.parametrize("period", [1.2, 7.5])
def test_bretschneider_has_its_height_peak_and_mean_periods(period: float) -> None:
    modal = 2 * pi / period

    def density(w: Any) -> Any:
        return BRETSCHNEIDER(w, 1.7, modal)

    assert height(density, modal) == pytest.approx(1.7, rel=1e-4)
    assert peak_of(density, 0.5 * modal, 2 * modal) == pytest.approx(modal, rel=1e-3)
    m0, m1, m2 = (moment(density, modal, order) for order in range(3))
    assert 2 * pi * m0 / m1 / period == pytest.approx(0.772, abs=1e-3)
    assert 2 * pi * sqrt(m0 / m2) / period == pytest.approx(0.710, abs=2e-3)


def test_bretschneider_is_the_spectrum_of_the_issc_by_the_mean_period() -> None:
    mean = 8.0
    for w in (0.5, 0.7, 1.5):
        published = 173.0 * 2.0**2 / mean**4 / w**5 * exp(-691.0 / mean**4 / w**4)
        assert BRETSCHNEIDER(w, 2.0, 2 * pi * 0.772 / mean) == pytest.approx(published, rel=0.01)


@pytest.mark.parametrize("high", [0.2, 3.0])
def test_pierson_moskowitz_is_the_published_spectrum_of_a_developed_sea(high: float) -> None:
    for w in (0.8 / sqrt(high), 1.3 / sqrt(high), 3.0 / sqrt(high)):
        published = 8.1e-3 * G**2 / w**5 * exp(-3.11 / high**2 / w**4)
        assert PIERSON_MOSKOWITZ(w, high) == pytest.approx(published, rel=5e-3)
    modal = 0.4 * sqrt(G / high)
    assert height(lambda w: PIERSON_MOSKOWITZ(w, high), modal) == pytest.approx(high, rel=1e-3)


@pytest.mark.parametrize("enhancement", [1.0, 2.0, 3.3, 5.0, 7.0])
def test_jonswap_has_its_height_and_peak(enhancement: float) -> None:
    def density(w: Any) -> Any:
        return JONSWAP(w, 0.6, 2.1, enhancement)

    assert height(density, 2.1) == pytest.approx(0.6, rel=0.01)
    assert peak_of(density, 1.0, 4.0) == pytest.approx(2.1, rel=1e-3)


def test_jonswap_is_the_published_formula_and_without_enhancement_that_of_bretschneider() -> None:
    modal, high = 0.9, 2.5
    for w in (0.6, 0.85, 0.9, 0.97, 2.0):
        width = 0.07 if w <= modal else 0.09
        smooth = 5 / 16 * high**2 * modal**4 * w**-5 * exp(-1.25 * (w / modal) ** -4)
        peaked = 3.3 ** exp(-0.5 * ((w - modal) / (width * modal)) ** 2)
        published = (1 - 0.287 * log(3.3)) * smooth * peaked
        assert JONSWAP(w, high, modal, 3.3) == pytest.approx(published, rel=1e-12)
        assert JONSWAP(w, high, modal, 1.0) == pytest.approx(smooth, rel=1e-12)


# ---- Torsethaugen's spectrum of wind sea and swell

FREQUENCIES = np.array([0.3, 0.45, 0.6, 0.8, 1.2, 2.0])
# Hs, Tp, and S at FREQUENCIES by the package waveresponse 1.4.1, which has the published
# normalisation of the peak and another gravity
PUBLISHED = [
    (2.0, 5.0, [3.8632e-07, 0.063808, 0.20029, 0.1354, 0.25246, 0.047301]),
    (4.0, 9.0, [0.0020048, 0.29697, 1.3802, 1.4858, 0.39916, 0.056941]),
    (2.0, 14.0, [0.02137, 0.81973, 0.18082, 0.22693, 0.10514, 0.016592]),
    (6.0, 18.0, [1.7053, 2.6398, 3.2229, 1.6898, 0.40492, 0.054714]),
    (1.0, 6.0, [2.0282e-16, 7.2728e-05, 0.0028166, 0.032117, 0.061698, 0.012864]),
]


@pytest.mark.parametrize(("high", "period", "published"), PUBLISHED)
def test_torsethaugen_has_the_values_of_another_program(
    high: float, period: float, published: list[float]
) -> None:
    found = TORSETHAUGEN(FREQUENCIES, high, 2 * pi / period)
    assert found == pytest.approx(np.array(published), rel=0.036)


def published_systems(high: float, period: float) -> tuple[float, float, float, float, float]:
    """Hs and Tp of both systems and gamma, by table 1 of Torsethaugen and Haver 2004."""
    developed = 6.6 * high ** (1 / 3)
    if period <= developed:
        near = min((developed - period) / (developed - 2.0 * sqrt(high)), 1.0)
        share = 0.3 * exp(-((near / 0.5) ** 2)) + 0.7
        first = share * high
        peaked = 35.0 * (2 * pi / G * first / period**2) ** 0.857
        return first, period, peaked, sqrt(1 - share**2) * high, developed + 2.0
    near = (period - developed) / (25.0 - developed)
    share = 0.4 * exp(-((near / 0.3) ** 2)) + 0.6
    peaked = 35.0 * (2 * pi / G * high / developed**2) ** 0.857 * (1 + 6.0 * near)
    second = sqrt(1 - share**2) * high
    return share * high, period, peaked, second, 6.6 * second ** (1 / 3)


SEAS = [(2.0, 5.0), (4.0, 9.0), (2.0, 14.0), (6.0, 18.0), (8.0, 11.0), (11.0, 19.0)]


@pytest.mark.parametrize(("high", "period"), SEAS)
def test_torsethaugen_has_the_published_systems_and_their_energy(
    high: float, period: float
) -> None:
    first, one, peaked, second, two = published_systems(high, period)
    found = SYSTEMS(high, 2 * pi / period)
    assert found == pytest.approx((first, 2 * pi / one, peaked, second, 2 * pi / two), rel=1e-9)
    assert sqrt(first**2 + second**2) == pytest.approx(high)
    normal = 4 / gamma(0.75)  # of x^-4 exp(-x^-4)

    def density(w: float) -> float:
        x, y = w * one / (2 * pi), w * two / (2 * pi)
        shape = (
            x**-4 * exp(-(x**-4)) * peaked ** exp(-0.5 * ((x - 1) / (0.07 if x < 1 else 0.09)) ** 2)
        )
        swell = normal * second**2 / 16 * two / (2 * pi) * y**-4 * exp(-(y**-4))
        return level * shape + swell

    level = 0.0
    rest = moment(density, 2 * pi / two)
    assert rest == pytest.approx(second**2 / 16, rel=1e-3)
    level = 1.0
    level = first**2 / 16 / (moment(density, 2 * pi / one) - rest)
    for w in (0.3, 0.5, 2 * pi / one, 1.1, 2.0):
        assert TORSETHAUGEN(w, high, 2 * pi / period) == pytest.approx(density(w), rel=0.01)
    whole = height(lambda w: float(TORSETHAUGEN(w, high, 2 * pi / period)), 2 * pi / period)
    assert whole == pytest.approx(high, rel=0.005)


@pytest.mark.parametrize(("high", "period"), SEAS[1:])
def test_torsethaugen_has_its_higher_peak_at_the_modal_period(high: float, period: float) -> None:
    modal = 2 * pi / period
    found = peak_of(lambda w: TORSETHAUGEN(w, high, modal), 0.8 * modal, 1.2 * modal)
    assert found == pytest.approx(modal, rel=0.02)


# ---- dispersion


@pytest.mark.parametrize("depth", [0.05, 0.8, 12.0, 4000.0])
def test_waves_obey_the_dispersion_relation_at_any_depth(depth: float) -> None:
    w = np.geomspace(0.01, 40.0, 200)
    k = NUMBER(w, depth)
    assert G * k * np.tanh(k * depth) == pytest.approx(w**2, rel=1e-12)


def test_deep_water_and_shallow_water_are_the_limits_of_the_dispersion() -> None:
    assert NUMBER(1.3, 0.0) == pytest.approx(1.3**2 / G, rel=1e-12)
    assert NUMBER(1.3, 500.0) == pytest.approx(1.3**2 / G, rel=1e-12)
    assert NUMBER(0.01, 2.0) == pytest.approx(0.01 / sqrt(G * 2.0), rel=1e-5)
    assert NUMBER(np.zeros(2), 2.0) == pytest.approx(np.zeros(2), abs=1e-12)


@pytest.mark.parametrize("depth", [0.3, 5.0])
def test_pressure_decreases_as_linear_theory_says(depth: float) -> None:
    for k, below in ((0.2, 0.1), (3.0, 0.3)):
        published = np.cosh(k * (depth - below)) / np.cosh(k * depth)
        assert ATTENUATION(k, below, depth) == pytest.approx(published, rel=1e-12)
        assert ATTENUATION(k, below, 0.0) == pytest.approx(exp(-k * below), rel=1e-12)


# ---- directional spreading


@pytest.mark.parametrize("exponent", [1.0, 2.0, 3.5, 10.0, 75.0])
def test_spreading_has_all_energy_and_the_published_factor(exponent: float) -> None:
    assert quad(cosine_power, -pi, pi, args=exponent, points=[-pi / 2, 0.0, pi / 2])[
        0
    ] == pytest.approx(1.0, abs=1e-6)
    assert quad(half_angle_cosine_power, -pi, pi, args=exponent, points=[0.0])[0] == pytest.approx(
        1.0, abs=1e-6
    )
    assert cosine_power(2.0, exponent) == 0.0
    if exponent == 2.0:
        assert cosine_power(0.0, exponent) == pytest.approx(2 / pi)


def test_both_laws_are_alike_about_the_mean_direction() -> None:
    angle = np.linspace(-0.3, 0.3, 31)
    assert cosine_power(angle, 40.0) == pytest.approx(
        half_angle_cosine_power(angle, 80.0), rel=0.04
    )


@pytest.mark.parametrize("exponent", [1.0, 2.0, 4.0, 25.0])
def test_random_directions_have_the_density_of_the_law(exponent: float) -> None:
    rng = np.random.default_rng(0)
    sample = interpreted(random_direction)
    found = np.sort([sample(*rng.uniform(size=2), exponent) for _ in range(20000)])
    ends = np.linspace(-pi / 2, pi / 2, 21)
    share = [quad(cosine_power, -pi / 2, end, args=exponent)[0] for end in ends]
    counted = np.searchsorted(found, ends) / len(found)
    # Kolmogorov: exceeded once in 1,000
    assert np.abs(counted - share).max() < 1.95 / sqrt(len(found))
