"""Parameters differ from zero alone, together, or by a limit that is well known."""

import numpy as np
import pytest

from boatsim.diagnosis.filter import NoiseLevels
from boatsim.diagnosis.problem import Fit, FreeParameter
from boatsim.diagnosis.significance import distance_from_zero, jointly_differ_from_zero
from boatsim.physics.base import Array
from boatsim.physics.effects.rate_limit import SteeringRateLimit
from boatsim.physics.effects.wind import Wind

LEVELS = NoiseLevels(np.ones(3), 1.0, {"position_sd_m": 0.01})


def fitted(effect: str, theta: dict[str, float], covariance: Array, mean: float) -> Fit:
    """A made-up fit of one effect."""
    free = []
    for place, name in enumerate(theta):
        free.append(FreeParameter(effect, name, (place,), mean, 1.0, -10.0, 10.0))
    return Fit((effect,), tuple(free), np.array(list(theta.values())), covariance, LEVELS, 0.0)


@pytest.mark.parametrize("correlation", [-0.999, 0.0, 0.999])
def test_two_uncertain_sizes_are_significant_if_their_combination_is(correlation: float) -> None:
    """Two sizes of one sd each, of which only the sum or the difference is known."""
    covariance = np.array([[1.0, correlation], [correlation, 1.0]])
    for sign in (-1.0, 1.0):
        fit = fitted("made_up", {"a": 1.0, "b": sign}, covariance, 0.0)
        # the squared distance is 2 / (1 + correlation) along (1, 1), 2 / (1 - correlation) across
        distance = 2.0 / (1.0 + sign * correlation)
        clear = distance > 9.0
        assert jointly_differ_from_zero(fit, "made_up", ("a", "b"), 2.0) is bool(clear)


def test_one_parameter_has_no_joint_significance() -> None:
    fit = fitted("made_up", {"a": 9.0}, np.eye(1), 0.0)
    assert not jointly_differ_from_zero(fit, "made_up", ("a",), 1.0)


def test_a_known_limit_is_far_from_no_limit_wherever_its_prior_lies() -> None:
    for mean in (2.0, 5.0):
        fit = fitted("steering_rate_limit", {"rate": 2.0}, 0.01 * np.eye(1), mean)
        limit = SteeringRateLimit(name="steering_rate_limit")
        assert distance_from_zero(fit, limit, "rate") == 2.0


def test_a_force_is_measured_from_the_value_without_it() -> None:
    fit = fitted("wind", {"force": -0.3}, np.eye(1), 0.0)
    assert distance_from_zero(fit, Wind(name="wind"), "force") == pytest.approx(0.3)
