"""Weights of the signs, fitted to names that were sampled from a known regression."""

import numpy as np
import pytest
from scipy.special import expit

from validation.calibration.weights import (
    WeightPrior,
    cross_validated,
    fit_intercept,
    fit_scale,
    fit_weights,
    weight_prior,
)

TRUE, INTERCEPT = np.array([1.0, -2.0, 0.0]), 0.5


def sample(count: int) -> tuple[np.ndarray, np.ndarray]:
    """Features (count, 3) of different sizes, and whether each name is right."""
    rng = np.random.default_rng(4)
    X = rng.standard_normal((count, 3)) * [1.0, 0.5, 2.0]
    return X, (rng.random(count) < expit(INTERCEPT + X @ TRUE)).astype(float)


def test_many_names_give_the_true_weights_whatever_the_prior() -> None:
    X, right = sample(40_000)
    for mean in (np.zeros(3), -TRUE):
        intercept, weights = fit_weights(X, right, WeightPrior(INTERCEPT, mean, np.full(3, 0.3)))
        assert weights == pytest.approx(TRUE, abs=0.1)
        assert intercept == pytest.approx(INTERCEPT, abs=0.05)


def test_few_names_leave_the_weights_in_use() -> None:
    X, right = sample(3)
    _, weights = fit_weights(X, right, WeightPrior(INTERCEPT, TRUE, np.full(3, 0.02)))
    assert weights == pytest.approx(TRUE, abs=0.02)


def test_only_weights_of_new_signs_change_much() -> None:
    names = ["held_out_gain", "structure", "effects"]
    prior = weight_prior(names, ["structure"])
    X, right = sample(100)
    _, weights = fit_weights(X, right, prior)
    moved = np.abs(weights - prior.mean) * X.std(axis=0)
    assert moved[1] > 5.0 * max(moved[0], moved[2]) > 0.0


def test_the_cross_validated_probability_of_a_trial_does_not_use_that_trial() -> None:
    """The outcomes of one fold have no influence on its own probabilities."""
    X, right = sample(200)
    trials = np.arange(200)
    changed = np.where(trials % 10 == 3, 1.0 - right, right)
    prior = WeightPrior(INTERCEPT, TRUE, np.full(3, 0.3))
    before = cross_validated(X, right, trials, prior)
    after = cross_validated(X, changed, trials, prior)
    own = trials % 10 == 3
    assert np.array_equal(before[own], after[own])
    assert not np.allclose(before[~own], after[~own])


def test_the_intercept_alone_makes_the_mean_probability_the_share_of_right_names() -> None:
    X, right = sample(2000)
    intercept = fit_intercept(X @ TRUE, right)
    assert intercept == pytest.approx(INTERCEPT, abs=0.1)
    assert np.mean(expit(X @ TRUE + intercept)) == pytest.approx(right.mean(), abs=1e-3)


def test_the_scale_of_log_odds_is_found_again() -> None:
    rng = np.random.default_rng(3)
    odds, beside = 2.0 * rng.standard_normal(40_000), rng.integers(0, 2, 40_000).astype(float)
    right = (rng.random(40_000) < expit(0.6 * odds + 0.5 - 1.1 * beside)).astype(float)
    found = fit_scale(odds, beside, right)
    assert tuple(found) == pytest.approx((0.6, 0.5, -1.1), abs=0.05)
