"""The probability of a true cause is a logistic regression of limited features."""

from dataclasses import fields, replace
from math import exp, hypot, log

import pytest

from boatsim.diagnosis.config import DEFAULT, DecideConfig
from boatsim.diagnosis.open_set.consistency import Consistency, Factor, Variation
from boatsim.diagnosis.open_set.log_signs import LogSigns
from boatsim.diagnosis.open_set.probability import (
    exceeds_range,
    logistic_features,
    probability_beside_unknown,
    probability_of_true_cause,
)
from boatsim.diagnosis.search.pruning import IdentifiedEffect

CONFIG = DEFAULT.decide
EFFECT = IdentifiedEffect("current", 10.0, 10.0, 1.0, ("wind",), {})
EXTREME = Consistency(
    recordings=(Factor(1.2, 0.1),),
    held_out=Factor(90.0, 1.0),
    between_times=Variation(50.0, 1.0, 1),
    between_ranges=Variation(50.0, 1.0, 1),
    quantity="surge rate",
    parts_that_gain=1.0,
    held_out_gain=-5.0,
    axes=("surge",),
    alternative_gain=1e3,
    prior_distance=0.0,
    at_bound=True,
)
LOG = LogSigns(50.0, 1.0, 50.0, 1e3, 10.0, 1)


def features(config: DecideConfig = CONFIG) -> dict[str, float]:
    return logistic_features(EFFECT, False, EXTREME, LOG, config)


def test_each_feature_has_a_weight_of_its_name() -> None:
    assert set(features()) <= {field.name for field in fields(DecideConfig)}


def test_settings_limit_the_features() -> None:
    found = features()
    assert found["held_out_gain"] == log(CONFIG.least_held_out_gain)
    assert found["held_out_significance"] == CONFIG.held_out_significance_range[1]
    assert found["held_out_deviation"] == CONFIG.largest_held_out_deviation
    assert found["times_apart"] == found["ranges_apart"] == CONFIG.largest_variation
    assert found["unexplained"] == CONFIG.largest_unexplained
    assert found["structure"] == CONFIG.largest_structure
    assert found["alternative"] == CONFIG.largest_alternative
    assert found["coefficient_shift"] == CONFIG.largest_coefficient_shift
    assert features(replace(CONFIG, largest_alternative=3.0))["alternative"] == 3.0


def constancy(variation: Variation) -> float:
    signs = replace(EXTREME, between_times=variation)
    return logistic_features(EFFECT, False, signs, LOG, CONFIG)["times_constant"]


def test_a_constant_size_counts_where_the_parts_determine_it() -> None:
    assert constancy(Variation(0.0, 5.0, 7, precision=1e4)) == CONFIG.largest_constant
    assert constancy(Variation(0.0, 5.0, 7, precision=1e-4)) == pytest.approx(0.0, abs=1e-3)
    assert constancy(Variation(0.0, 0.0, 0)) == 0.0
    # a size that varies by the sd of a stand-in: chi-square is dof (1 + precision sd^2)
    sd = CONFIG.stand_in_variation
    varies = Variation(sd, 7.0 * (1.0 + 1e4 * sd**2), 7, precision=1e4)
    assert constancy(varies) == 0.0


def test_a_constant_size_tells_nothing_where_no_force_is_unexplained() -> None:
    signs = replace(EXTREME, between_times=Variation(0.0, 5.0, 7, precision=1e4))
    clean = replace(LOG, unexplained=0.0)
    assert logistic_features(EFFECT, False, signs, clean, CONFIG)["times_constant"] == 0.0


def test_odds_of_a_constant_size_are_those_of_normal_distributions() -> None:
    config = replace(CONFIG, largest_constant=1e6)
    held_out = Factor(1.2, 0.2)
    signs = replace(EXTREME, held_out=held_out)
    found = logistic_features(EFFECT, False, signs, LOG, config)["held_out_constant"]

    def log_density(spread: float) -> float:
        sd = hypot(held_out.sd, spread)
        return -0.5 * ((held_out.value - 1.0) / sd) ** 2 - log(sd)

    odds = log_density(config.size_tolerance) - log_density(config.stand_in_variation)
    assert found == pytest.approx(odds)


def remainder(log_signs: LogSigns) -> float:
    return logistic_features(EFFECT, False, EXTREME, log_signs, CONFIG)["remainder"]


def test_what_remains_unexplained_counts_relative_to_the_effect() -> None:
    log_signs = LogSigns(0.0, 1.0, 1.0, 0.0, 0.0, 1)
    assert remainder(log_signs) == 0.0
    assert remainder(replace(log_signs, unexplained_gain=EFFECT.gain)) == 0.5
    assert remainder(replace(log_signs, unexplained_gain=1e6)) == pytest.approx(1.0, abs=1e-4)
    # a dependence on the motion counts if it is significant
    chance = replace(log_signs, structure_gain=3.0 * EFFECT.gain)
    assert remainder(chance) == 0.0
    assert remainder(replace(chance, structured=True)) == 0.75
    # identified laws may be wrong by a share of what they explain
    exact = replace(log_signs, unexplained_gain=EFFECT.gain)
    wrong = replace(exact, effects_gain=EFFECT.gain / CONFIG.law_error)
    assert remainder(wrong) == 0.0


def test_an_estimated_model_leaves_force_of_its_own() -> None:
    log_signs = LogSigns(0.0, 1.0, 1.0, 0.0, 0.0, 1, unexplained_gain=1e6, estimated=True)
    assert remainder(log_signs) == 0.0


def test_only_a_stochastic_force_is_doubted_for_one_period_and_a_varying_size() -> None:
    signs = replace(EXTREME, between_times=Variation(0.0, 9.0, 3), at_bound=True)
    sea = logistic_features(EFFECT, True, signs, LOG, CONFIG)
    force = logistic_features(EFFECT, False, signs, LOG, CONFIG)
    assert (sea["stochastic_at_bound"], sea["stochastic_times"]) == (1.0, 2.0)
    assert (force["stochastic_at_bound"], force["stochastic_times"]) == (0.0, 0.0)
    wild = replace(signs, between_times=Variation(0.0, 1e3, 3))
    largest = logistic_features(EFFECT, True, wild, LOG, CONFIG)["stochastic_times"]
    assert largest == CONFIG.largest_ratio


def test_a_parameter_at_a_bound_counts_if_a_recording_requires_more() -> None:
    assert exceeds_range(EXTREME, CONFIG)
    assert not exceeds_range(EXTREME, replace(CONFIG, size_tolerance=0.3))
    assert not exceeds_range(replace(EXTREME, at_bound=False), CONFIG)


def test_the_log_of_the_odds_is_the_weighted_sum_within_its_limit() -> None:
    found = {"stochastic_at_bound": 1.0, "exceeds_range": 1.0}
    odds = CONFIG.intercept + CONFIG.stochastic_at_bound + CONFIG.exceeds_range
    probability = probability_of_true_cause(found, CONFIG)
    assert log(probability / (1.0 - probability)) == pytest.approx(odds)
    narrow = replace(CONFIG, largest_log_odds=1.0)
    assert probability_of_true_cause(found, narrow) == pytest.approx(1.0 / (1.0 + exp(1.0)))


@pytest.mark.parametrize("before", [1e-9, 0.2, 0.63, 0.999])
def test_an_unknown_cause_beside_an_effect_changes_its_odds_by_a_factor(before: float) -> None:
    after = probability_beside_unknown(before, CONFIG)
    factor = exp(CONFIG.odds_beside_unknown)
    assert factor < 1.0
    assert after / (1.0 - after) == pytest.approx(factor * before / (1.0 - before))
