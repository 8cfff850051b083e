"""Causes that hide behind the latent force, behind each other, or behind their own correlation."""

from dataclasses import replace

import numpy as np
import pytest
from pushed_boat import BOAT, laid, sail

from boatsim.diagnosis.candidates import candidate_library
from boatsim.diagnosis.problem import Fit, Problem
from boatsim.diagnosis.search.budget import SearchBudget
from boatsim.diagnosis.search.candidate_sets import CandidateSets
from boatsim.diagnosis.search.further_effects import NOT_SOUGHT, add_further_effects
from boatsim.diagnosis.search.pruning import differs_from_zero
from boatsim.physics.base import Array

CANDIDATES = candidate_library(BOAT).tested_names
Laid = tuple[Problem, Fit]


def side_wind(t: float, y: Array, command: Array) -> Array:
    """A wind towards east: 0.4 N on the beam, half of it end-on, and no moment."""
    return np.array([0.2 * np.sin(y[2]), 0.4 * np.cos(y[2]), 0.0])


def calm_water(t: float, y: Array, command: Array) -> Array:
    """No further force."""
    return np.zeros(3)


@pytest.fixture(scope="module")
def windy() -> Laid:
    return laid(*(sail(f"windy_{seed}", seed, side_wind)[0] for seed in (1, 2)))


@pytest.fixture(scope="module")
def calm() -> Laid:
    return laid(*(sail(f"calm_{seed}", seed, calm_water)[0] for seed in (1, 2)))


def test_an_effect_is_found_at_the_assumed_level_of_the_latent_force(windy: Laid) -> None:
    problem, base = windy
    sets = CandidateSets(problem, ("wind", "thrust_lag", "extra_mass", "steering_offset"), base)
    found = add_further_effects(sets, base)
    assert found is not None and "wind" in found.effects
    assert found.evidence > base.evidence + sets.required_gain
    assert (found.levels.force[:2] < base.levels.force[:2]).any()


def test_nothing_is_sought_where_nothing_is_unexplained(calm: Laid) -> None:
    problem, base = calm
    assert add_further_effects(CandidateSets(problem, CANDIDATES, base), base) is None


def test_nothing_is_added_that_does_not_explain_the_force(windy: Laid) -> None:
    problem, base = windy
    sets = CandidateSets(problem, ("thrust_deadband", "steering_backlash"), base)
    assert add_further_effects(sets, base) is None


def test_refuted_candidates_are_not_added_again(windy: Laid) -> None:
    problem, base = windy
    sets = CandidateSets(problem, ("wind", "thrust_deadband"), base)
    sets.banned.add("wind")
    found = add_further_effects(sets, base)
    assert found is None or "wind" not in found.effects


def test_a_spent_budget_ends_the_search(windy: Laid) -> None:
    problem, base = windy
    config = replace(problem.config, select=replace(problem.config.select, budget=1))
    sets = CandidateSets(replace(problem, config=config), ("wind",), base)
    sets.problem.filter(
        base.free, 1.01 * base.theta, problem.program.effect_switches(), base.levels
    )
    assert sets.budget.is_spent and add_further_effects(sets, base) is None


@pytest.mark.parametrize(("correlation", "expected"), [(0.0, False), (0.999, True)])
def test_a_combination_that_the_recordings_determine_differs_from_zero(
    calm: Laid, correlation: float, expected: bool
) -> None:
    """Each of two scales is within one standard deviation of zero; their difference may not be."""
    problem, base = calm
    free = problem.free_parameters(("camera_scale",))
    own = [i for i, f in enumerate(free) if f.effect == "camera_scale"]
    theta = np.array([f.mean for f in free])
    theta[own] = 0.02, -0.02
    covariance = np.diag([f.sd**2 for f in free])
    covariance[np.ix_(own, own)] = 0.03**2 * np.array([[1.0, correlation], [correlation, 1.0]])
    found = replace(base, effects=("camera_scale",), free=free, theta=theta, covariance=covariance)
    sets = CandidateSets(problem, ("camera_scale",), base)
    assert differs_from_zero(sets, found, "camera_scale") is expected


def test_candidates_are_not_screened_again_with_less_work_than_that_takes(windy: Laid) -> None:
    problem, base = windy
    sets = CandidateSets(problem, ("wind", "thrust_lag", "extra_mass", "steering_offset"), base)
    sets.screen_candidates(base)
    assert sets.screening_work > 0
    sets.budget = SearchBudget(problem.work_count, sets.screening_work // 2)
    before = problem.work_count.work
    assert add_further_effects(sets, base) is None
    assert problem.work_count.work - before < sets.screening_work
    assert NOT_SOUGHT in sets.budget.skipped_work_statements
