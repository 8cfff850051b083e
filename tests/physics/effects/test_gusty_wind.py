"""Wind with gusts: published spectra, their variance, and the drag of the sum of mean and gusts."""

from dataclasses import replace
from math import exp, log, pi
from typing import Any

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.special import gamma

from boatsim.errors import BadInput
from boatsim.physics.base import make_motion
from boatsim.physics.debugging import interpreted
from boatsim.physics.effects.fan_wind import FanWind
from boatsim.physics.effects.gusty_wind import FASTEST, SLOWEST, GustyWind
from boatsim.physics.gust_spectra import davenport, harris, npd

DAVENPORT, HARRIS, NPD = interpreted(davenport), interpreted(harris), interpreted(npd)
PUBLISHED: dict[str, Any] = {
    "davenport": lambda f, U, z: (
        4 * 0.0026 * U**2 * (1200 * f / U) ** 2 / (1 + (1200 * f / U) ** 2) ** (4 / 3) / f
    ),
    "harris": lambda f, U, z: 4 * 0.0026 * 1800 * U / (2 + (1800 * f / U) ** 2) ** (5 / 6),
    "npd": lambda f, U, z: (
        320
        * (U / 10) ** 2
        * (z / 10) ** 0.45
        / (1 + (172 * f * (z / 10) ** (2 / 3) * (U / 10) ** -0.75) ** 0.468) ** (5 / 3 / 0.468)
    ),
}


def test_gust_spectra_are_the_published_formulas() -> None:
    for f in (0.002, 0.03, 0.4):
        for U in (4.0, 20.0):
            assert DAVENPORT(f, U) == pytest.approx(PUBLISHED["davenport"](f, U, 0.0))
            assert HARRIS(f, U) == pytest.approx(PUBLISHED["harris"](f, U, 0.0))
            assert NPD(f, U, 3.0) == pytest.approx(PUBLISHED["npd"](f, U, 3.0))


def integral(density: Any) -> float:
    """Over all frequencies, by their logarithm."""
    return float(quad(lambda s: exp(s) * density(exp(s)), log(1e-9), log(1e5), limit=400)[0])


def test_davenport_and_harris_have_the_variance_of_their_closed_forms() -> None:
    assert integral(lambda f: DAVENPORT(f, 10.0)) == pytest.approx(6 * 0.0026 * 100.0, rel=1e-3)
    # integral of 1 / (2 + x^2)^(5/6): 2^(-1/3) sqrt(pi) / 2 Gamma(1/3) / Gamma(5/6)
    closed = 2 ** (-1 / 3) * np.sqrt(pi) / 2 * gamma(1 / 3) / gamma(5 / 6)
    found = integral(lambda f: HARRIS(f, 10.0))
    assert found == pytest.approx(4 * 0.0026 * 100.0 * closed, rel=1e-3)


def wind_speeds(own: GustyWind, t: np.ndarray) -> np.ndarray:
    """Speed of the air at a hull at rest, from its drag ahead."""
    force = np.array([own.wrench(make_motion(t=s)).X for s in t.tolist()])
    return np.sqrt(np.maximum(force, 0.0) / (0.5 * 1.2 * own.front))


@pytest.mark.parametrize("spectrum", ["davenport", "harris", "npd"])
def test_gusts_have_the_mean_and_the_rms_of_the_spectrum(spectrum: str) -> None:
    own = GustyWind(spectrum=spectrum, speed=12.0, height=10.0)
    speed = wind_speeds(own, np.arange(0.0, 40000.0, 0.9))
    density = PUBLISHED[spectrum]
    variance = quad(
        lambda s: exp(s) * density(exp(s), 12.0, 10.0), log(SLOWEST), log(FASTEST), limit=200
    )[0]
    assert speed.mean() == pytest.approx(12.0, rel=0.01)
    assert speed.std() == pytest.approx(np.sqrt(variance), rel=0.02)


def directions(own: GustyWind, t: np.ndarray) -> np.ndarray:
    """Direction of the air, from its velocity."""
    north, east = np.array([own.air_velocity(s) for s in t.tolist()]).T
    return np.unwrap(np.arctan2(east, north))


def test_the_direction_veers_and_varies_with_its_deviation_and_correlation_time() -> None:
    t = np.arange(0.0, 60000.0, 2.7)
    own = GustyWind(spectrum="none", toward=0.4, direction_sd=0.2, direction_time=60.0)
    found = directions(own, t)
    assert found.mean() == pytest.approx(0.4, abs=0.02)
    assert found.std() == pytest.approx(0.2, rel=0.05)
    # energy below a frequency: that of an exponential correlation between both ends
    changes = found[1:] - found[:-1]
    ends = [np.arctan(2.0 * pi * 60.0 * f) for f in (SLOWEST, FASTEST)]
    expected = quad(
        lambda f: (
            4.0 * 60.0 / (1.0 + (2.0 * pi * f * 60.0) ** 2) * (1.0 - np.cos(2 * pi * f * 2.7))
        ),
        SLOWEST,
        FASTEST,
        limit=400,
    )[0]
    expected *= 0.2**2 * 2.0 / (2.0 / pi * (ends[1] - ends[0]))
    assert np.mean(changes**2) == pytest.approx(expected, rel=0.1)
    veering = replace(own, veer=0.001)
    assert directions(veering, t) - found == pytest.approx(0.001 * t)
    # other random numbers than those of the gusts
    gusts = wind_speeds(GustyWind(spectrum="npd", speed=12.0), t[:4000])
    assert abs(np.corrcoef(gusts, found[:4000])[0, 1]) < 0.15


@pytest.mark.parametrize("height", [0.5, 10.0, 40.0])
def test_without_gusts_it_is_a_steady_stream_with_the_profile_of_the_height(height: float) -> None:
    own = GustyWind(spectrum="none", speed=7.0, height=height, toward=0.8, arm=0.1)
    steady = FanWind(speed=7.0 * (height / 10.0) ** (1 / 7), toward=0.8, arm=0.1)
    m = make_motion(t=3.0, psi=0.4, u=0.5, v=-0.1)
    assert own.wrench(m) == pytest.approx(steady.wrench(m), rel=1e-12)


def test_a_seed_gives_one_course_of_gusts_and_another_seed_another_one() -> None:
    own, t = GustyWind(speed=8.0), np.arange(0.0, 60.0, 1.0)
    first, again, other = (wind_speeds(own.with_seed(seed), t) for seed in (4, 4, 5))
    assert (first == again).all() and np.abs(first - other).max() > 0.3
    calm = replace(own, speed=0.0).wrench(make_motion(t=3.0))
    assert calm.X == 0.0 and calm.Y == 0.0


def test_a_spectrum_that_does_not_exist_is_refused() -> None:
    with pytest.raises(BadInput, match="gusty_wind: spectrum 'davenprt' does not exist; did you"):
        GustyWind(spectrum="davenprt")
