"""Weighted means, covariances and correlations of clock rates have known values."""

import numpy as np
import pytest

from boatsim.diagnosis.checks.clock_rate_comparison import RateComparison


def comparison(track: list[float], turning: list[float], file: list[int]) -> RateComparison:
    weight = np.ones(len(track))
    return RateComparison(np.array(track), np.array(turning), weight, np.array(file))


def test_covariance_and_correlation_are_about_the_means_of_each_file() -> None:
    """Rates of both files differ, but those of a file do not vary alike: 1 and -1 cancel."""
    track = [1.0, 3.0, 1.0, 3.0, 11.0, 13.0, 11.0, 13.0]
    turning = [1.0, 1.0, 3.0, 3.0, 11.0, 11.0, 13.0, 13.0]
    both = comparison(track, turning, [0] * 4 + [1] * 4)
    assert both.correlation == pytest.approx(0.0)
    assert both.covariance() == pytest.approx((0.0, 1.0 / np.sqrt(8.0)))


def test_mean_rate_and_gain_have_the_standard_deviation_of_a_weighted_mean() -> None:
    """Weights 1, 1 and 2 count as 16 / 6 equal ones of mean 2.5."""
    found = RateComparison(
        np.array([2.0, 4.0, 6.0]),
        np.array([1.0, 2.0, 3.5]),
        np.array([1.0, 1.0, 2.0]),
        np.zeros(3, int),
    )
    variance = (1.5**2 + 0.5**2 + 2.0 * 1.0**2) / 4.0
    expected = (2.5, np.sqrt(variance / (16.0 / 6.0)))
    assert found.mean_clock_rate() == pytest.approx(expected)
    doubled = RateComparison(2.0 * found.turning, found.turning, found.weight, found.file)
    assert doubled.velocity_gain() == pytest.approx((2.0, 0.0))


def test_noise_of_the_heading_does_not_bias_the_gain() -> None:
    """The mean of the ratios would be 1 + 0.2^2, four standard deviations off."""
    rng = np.random.default_rng(5)
    count = 4000
    turning = 1.0 + 0.2 * rng.uniform(-np.sqrt(3.0), np.sqrt(3.0), count)
    track = 1.0 + 0.01 * rng.standard_normal(count)
    found = RateComparison(track, turning, np.ones(count), np.zeros(count, int))
    gain, sd = found.velocity_gain()
    assert abs(gain - 1.0) < 3.0 * sd and sd < 0.01
    assert np.mean(track / turning) - 1.0 > 6.0 * sd
