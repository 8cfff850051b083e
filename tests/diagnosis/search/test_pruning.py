"""Which of two effects may only correct the shape of the other one, by their covariance."""

from dataclasses import replace

import numpy as np
import pytest

from boatsim.diagnosis.config import DEFAULT
from boatsim.diagnosis.filter import NoiseLevels
from boatsim.diagnosis.problem import Fit, FreeParameter
from boatsim.diagnosis.search.evidence import (
    combined_gain,
    log_evidence_gains,
    quadratic_evidence_gain,
    unknown_cause_threshold,
)
from boatsim.diagnosis.search.pruning import IdentifiedEffect, may_only_correct_other_effect

DISTANCE = 3.0  # of each parameter from zero effect [sd]


def fit_with_correlation(correlation: float) -> Fit:
    """Two effects, a square and a cube of a speed, with one parameter each."""
    free = []
    for i, name in enumerate(("square", "cube")):
        one = FreeParameter("square", "size", (i,), 0.0, 10.0, -100.0, 100.0)
        free.append(replace(one, effect=name))
    covariance = np.array([[1.0, correlation], [correlation, 1.0]])
    levels = NoiseLevels(np.ones(3), 1.0, {})
    theta = np.full(2, DISTANCE)
    return Fit(("square", "cube"), tuple(free), theta, covariance, levels, 0.0)


def gaining(nats: float) -> IdentifiedEffect:
    return IdentifiedEffect("cube", nats, nats, 1.0, (), {})


def test_independent_effects_explain_together_the_sum_of_what_each_explains() -> None:
    found = fit_with_correlation(0.0)
    assert quadratic_evidence_gain(found, "square") == 0.5 * DISTANCE**2
    assert quadratic_evidence_gain(found, "square", "cube") == DISTANCE**2
    assert not may_only_correct_other_effect(found, gaining(1.0), "square", DEFAULT.select)


@pytest.mark.parametrize(("correlation", "may"), [(-0.9, True), (-0.2, True), (0.5, False)])
def test_an_effect_may_correct_the_shape_of_another_where_only_their_sum_is_determined(
    correlation: float, may: bool
) -> None:
    """The sum explains 1 / (1 + correlation) times as much as both do independently."""
    found = fit_with_correlation(correlation)
    both = DISTANCE**2 / (1.0 + correlation)
    assert quadratic_evidence_gain(found, "square", "cube") == pytest.approx(both)
    assert may_only_correct_other_effect(found, gaining(1.0), "square", DEFAULT.select) is may
    much = 2.0 * unknown_cause_threshold(DEFAULT.select, both)
    assert not may_only_correct_other_effect(found, gaining(much), "square", DEFAULT.select)


@pytest.mark.parametrize("of_reference", [0.0, -np.inf])
def test_a_fit_that_diverges_gains_nothing_whatever_it_is_compared_with(
    of_reference: float,
) -> None:
    found = fit_with_correlation(0.0)
    reference = replace(found, evidence=of_reference)
    for evidence in (-np.inf, np.nan):
        gains = log_evidence_gains({"cube": replace(found, evidence=evidence)}, reference)
        assert gains == {"cube": -np.inf}
        assert combined_gain([*gains.values(), 2.0]) == 2.0
