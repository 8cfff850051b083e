"""A force along other axes than those of an effect cannot take its place."""

import numpy as np
import pytest
from pushed_boat import BOAT, sail

from boatsim.diagnosis.candidates import candidate_library
from boatsim.diagnosis.fit import converge, unfitted_hypothesis
from boatsim.diagnosis.locate.residual_structure import find_structure
from boatsim.diagnosis.open_set.consistency import effect_consistency
from boatsim.diagnosis.open_set.effect_axes import effect_axes
from boatsim.diagnosis.prior_noise import prior_noise_levels
from boatsim.diagnosis.problem import Fit, Problem, prior_arrays
from boatsim.diagnosis.recording_mapping import map_recording
from boatsim.diagnosis.search.ranking import fit_baseline
from boatsim.physics.base import Array
from boatsim.physics.program import Program

EFFECT = "speed_loss_in_turn"  # a surge force in proportion to sway speed times yaw rate
PROGRAM = Program(BOAT, candidate_library(BOAT).compiled_effects)


def with_unknown_moment(t: float, y: Array, command: Array) -> Array:
    """The loss of speed, and a moment that depends on the heading, which no candidate gives."""
    v, r = y[4:6]
    return np.array([10.0 * v * r, 0.0, 0.05 * np.cos(2.0 * y[2])])


@pytest.fixture(scope="module")
def fitted() -> tuple[Problem, Fit, Fit]:
    """The problem, its fit without the effect, and with it."""
    recordings = [sail("a", 1, with_unknown_moment)[0], sail("b", 2, with_unknown_moment)[0]]
    problem = Problem(
        [map_recording(recording, PROGRAM) for recording in recordings],
        prior_noise_levels(BOAT, recordings),
        {"damping": 0.05, "thrust": 0.05},
    )
    _, without = fit_baseline(problem)
    free = problem.free_parameters((EFFECT,))
    start = unfitted_hypothesis((EFFECT,), free, prior_arrays(free).mean, without.levels)
    return problem, without, converge(problem, start)


def test_an_effect_acts_along_the_axes_of_its_force(fitted: tuple[Problem, Fit, Fit]) -> None:
    problem, _, best = fitted
    assert effect_axes(problem, best, EFFECT) == ("surge",)


@pytest.mark.parametrize(
    "name",
    [
        pytest.param("heading_offset", id="error of an instrument"),
        pytest.param("extra_mass", id="acts with the acceleration"),
    ],
)
def test_an_effect_without_a_force_along_a_given_motion_counts_on_all_axes(
    fitted: tuple[Problem, Fit, Fit], name: str
) -> None:
    problem, without, _ = fitted
    free = problem.free_parameters((name,))
    prior = prior_arrays(free)
    changed = unfitted_hypothesis((name,), free, prior.mean + prior.sd, without.levels)
    assert effect_axes(problem, changed, name) == ("surge", "sway", "yaw")


def test_a_force_in_yaw_can_not_take_the_place_of_an_effect_in_surge(
    fitted: tuple[Problem, Fit, Fit],
) -> None:
    problem, without, best = fitted
    found = find_structure(problem, without, without.levels)
    assert found.gain_along(["yaw"]) > 10.0  # the unknown moment
    signs = effect_consistency(problem, best, {EFFECT: without}, [])[EFFECT]
    assert signs.axes == ("surge",)
    assert signs.alternative_gain == found.gain_along(["surge"])
    assert signs.alternative_gain != found.gain_along(["yaw"])
