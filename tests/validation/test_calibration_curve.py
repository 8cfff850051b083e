"""Reliability table, its intervals and its curve."""

import pytest

from validation.calibration.curve import reliability_curve
from validation.calibration.table import (
    Statement,
    calibration_error,
    reliability,
    wilson_interval,
)


def test_stated_probabilities_that_are_the_frequencies_have_no_calibration_error() -> None:
    stated = [Statement(0.8, i < 8) for i in range(10)] + [Statement(0.2, i < 2) for i in range(10)]
    assert calibration_error(reliability(stated)) == pytest.approx(0.0)


def test_the_error_is_the_mean_distance_of_stated_and_observed() -> None:
    stated = [Statement(0.8, False)] * 10 + [Statement(0.2, i < 2) for i in range(10)]
    assert calibration_error(reliability(stated)) == pytest.approx(0.4)


def test_the_interval_is_that_of_wilson() -> None:
    # E. B. Wilson 1927: roots of (p - w)^2 = z^2 w (1 - w) / n
    low, high = wilson_interval(0.3, 50)
    for w in (low, high):
        assert (0.3 - w) ** 2 == pytest.approx(1.96**2 * w * (1.0 - w) / 50)
    assert low < 0.3 < high


def test_the_curve_has_a_point_for_each_range() -> None:
    table = reliability([Statement(0.8, True), Statement(0.2, False)])
    assert reliability_curve(table).count("<circle") == 2
