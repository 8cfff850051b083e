"""An effect that every group but one replaces or changes is stated for that group."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest
from pushed_boat import BOAT, Missing, sail

from boatsim.diagnosis.candidates import candidate_library
from boatsim.diagnosis.filter import MappedRecording
from boatsim.diagnosis.fit import fit, unfitted_hypothesis
from boatsim.diagnosis.prior_noise import prior_noise_levels
from boatsim.diagnosis.problem import Fit, Problem
from boatsim.diagnosis.recording_mapping import map_recording
from boatsim.diagnosis.search.candidate_sets import CandidateSets
from boatsim.diagnosis.search.differing_groups import (
    group_without_own_value,
    restrict_to_single_groups,
    restricted_fit,
)
from boatsim.diagnosis.search.pruning import prune
from boatsim.diagnosis.search.ranking import fit_baseline
from boatsim.diagnosis.search.screening import screen
from boatsim.physics.base import Array
from boatsim.physics.program import Program

PROGRAM = Program(BOAT, candidate_library(BOAT).compiled_effects)
EFFECT = "steady_force"
BLUE, RED = 0.2, 0.1  # [N] to starboard
SIZES = {  # one parameter of an effect in all recordings, and its values in two single groups
    "wind": ("force", 0.3, (0.2, 0.1)),  # which replace it
    "thrust_gain_error": ("factor", 0.8, (0.9, 1.1)),  # which multiply it
    "payload": ("mass", 0.5, (0.2, -0.1)),  # which are added to it
}


def aside(force: float) -> Missing:
    def missing(_: float, __: Array, ___: Array) -> Array:
        return np.array([0.0, force, 0.0])

    return missing


def mapped(runs: Sequence[tuple[tuple[str, ...], float]], first: int = 0) -> list[MappedRecording]:
    """Recordings with their groups and the force on them."""
    found = []
    for seed, (groups, force) in enumerate(runs, first):
        run, _ = sail(f"run_{seed}", seed, aside(force))
        run = replace(run, notes=replace(run.notes, groups=groups))
        found.append(map_recording(run, PROGRAM))
    return found


def problem_of(recordings: Sequence[MappedRecording]) -> Problem:
    levels = prior_noise_levels(BOAT, [sail("quiet", 1, aside(0.0))[0]])
    return Problem(recordings, levels, {"damping": 0.02, "thrust": 0.02})


def at_prior(problem: Problem, *effects: str) -> Fit:
    free = problem.free_parameters(effects)
    theta = np.array([parameter.mean for parameter in free])
    return unfitted_hypothesis(effects, free, theta, problem.ambient)


@pytest.mark.parametrize(
    ("groups", "changed", "remaining"),
    [
        pytest.param(("a", "b", "c"), ("a", "b"), "c", id="two of three"),
        pytest.param(("a", "b", "c"), ("a",), "", id="one of three"),
        pytest.param(("a", "b"), ("b",), "a", id="one of two"),
        pytest.param(("a", "b", "c"), (), "", id="none"),
        pytest.param(("a", "b", ""), ("a",), "", id="the others are of one group and of none"),
        pytest.param(("a", "b", "b d"), ("a",), "b", id="part of the remaining one is of a build"),
        pytest.param(("a", "a d", "b d"), ("a",), "b", id="a build of recordings of both"),
    ],
)
def test_one_group_remains_where_all_others_have_their_own_value(
    groups: tuple[str, ...], changed: tuple[str, ...], remaining: str
) -> None:
    problem = problem_of(mapped([(tuple(names.split()), 0.0) for names in groups]))
    effects = (EFFECT, *(f"{EFFECT}@{group}" for group in changed), "thrust_gain_error@b")
    assert group_without_own_value(problem, at_prior(problem, *effects), EFFECT) == remaining


@pytest.mark.parametrize("effect", SIZES)
def test_the_fitted_recordings_keep_their_numbers(effect: str) -> None:
    problem = problem_of(mapped([(("a",), 0.0), (("b",), 0.0), (("c",), 0.0)]))
    name, common, own = SIZES[effect]
    found = at_prior(problem, f"{effect}@a", effect, f"{effect}@b")
    values = {f"{effect}@a": own[0], effect: common, f"{effect}@b": own[1]}
    theta = found.theta.copy()
    for i, parameter in enumerate(found.free):
        if parameter.name == name and parameter.effect in values:
            theta[i] = values[parameter.effect]
    found = replace(found, theta=theta)
    restricted = restricted_fit(problem, found, effect, "c")
    assert restricted.effects == (f"{effect}@a", f"{effect}@c", f"{effect}@b")
    for recording in problem.recordings:
        before = problem.parameter_vector(recording, found.free, found.theta)
        after = problem.parameter_vector(recording, restricted.free, restricted.theta)
        assert after == pytest.approx(before, rel=1e-12)
    [further] = mapped([(("d",), 0.0)])  # it is as the vessel file says
    assert problem.parameter_vector(further, restricted.free, restricted.theta) == pytest.approx(
        further.values, rel=1e-12
    )


@pytest.fixture(scope="module")
def two_forces() -> tuple[Problem, Fit, Fit]:
    """Two groups with a force each, one of which was found as common to both."""
    runs = [(("blue",), BLUE)] * 2 + [(("red",), RED)] * 2
    problem = problem_of(mapped(runs))
    base = fit_baseline(problem).recalibrated
    found = fit(problem, screen(problem, base, [EFFECT])[EFFECT])
    own = f"{EFFECT}@red"
    return problem, base, fit(problem, screen(problem, found, [own])[own])


@pytest.mark.slow
@pytest.mark.parametrize(
    ("further", "common"),
    [
        pytest.param(0.0, False, id="a further group without the force"),
        pytest.param(BLUE, True, id="a further group with the force"),
        pytest.param(None, False, id="no further group"),
    ],
)
def test_an_effect_stays_common_only_if_a_further_group_shows_it(
    two_forces: tuple[Problem, Fit, Fit], further: float | None, common: bool
) -> None:
    problem, base, found = two_forces
    assert found.effects == (EFFECT, f"{EFFECT}@red")
    held_out = mapped([(("blue",), BLUE), (("red",), RED)], first=4)
    if further is not None:
        held_out += mapped([(("green",), further)] * 3, first=6)
    candidates = (EFFECT, *problem.candidates_in_single_groups([EFFECT]))
    sets = CandidateSets(problem, candidates, base)
    sets.fits[frozenset(found.effects)] = found
    best, named = prune(sets, found)
    kept, named = restrict_to_single_groups(sets, best, named, held_out)
    if common:
        assert kept is best
        return
    assert {one.name for one in named} == {f"{EFFECT}@blue", f"{EFFECT}@red"}
    assert kept.value(f"{EFFECT}@blue", "sway")[0] == pytest.approx(BLUE, abs=0.02)
    assert kept.value(f"{EFFECT}@red", "sway")[0] == pytest.approx(RED, abs=0.02)
