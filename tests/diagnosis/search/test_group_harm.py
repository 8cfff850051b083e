"""An effect that is wrong in one group of recordings acts in the other groups alone."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest
from pushed_boat import BOAT, Missing, push, sail

from boatsim.diagnosis.candidates import candidate_library
from boatsim.diagnosis.filter import MappedRecording
from boatsim.diagnosis.fit import fit
from boatsim.diagnosis.prior_noise import prior_noise_levels
from boatsim.diagnosis.problem import Fit, Problem
from boatsim.diagnosis.recalibration import decide_recalibration
from boatsim.diagnosis.recording_mapping import map_recording
from boatsim.diagnosis.search.candidate_sets import CandidateSets
from boatsim.diagnosis.search.generalization import harmed_groups
from boatsim.diagnosis.search.group_harm import remove_harm_to_groups
from boatsim.diagnosis.search.pruning import prune
from boatsim.diagnosis.search.ranking import fit_baseline
from boatsim.diagnosis.search.screening import screen
from boatsim.physics.base import Array
from boatsim.physics.program import Program
from boatsim.recordings.table import Recording

PROGRAM = Program(BOAT, candidate_library(BOAT).compiled_effects)
EFFECT = "steady_force"
ASIDE = 0.15  # [N]
HORIZON = 6.0  # [s]
BRIEF = 2.0  # [s]


def weak(t: float, y: Array, command: Array) -> Array:
    """Half of the thrust is missing."""
    return np.asarray(-0.5 * push(command[:2], command[2:]))


def pushed(t: float, y: Array, command: Array) -> Array:
    return np.array([0.0, ASIDE, 0.0])


def sound(t: float, y: Array, command: Array) -> Array:
    return np.zeros(3)


def sailed(name: str, group: str, seed: int, missing: Missing) -> Recording:
    run, _ = sail(name, seed, missing)
    return replace(run, notes=replace(run.notes, groups=(group,)))


def brief() -> Recording:
    """The first two seconds of a red boat, which does not show whether it is pushed."""
    run = sailed("red 1", "red", 3, sound)
    rows = run.t < BRIEF
    signals = {name: values[rows] for name, values in run.signals.items()}
    return replace(run, t=run.t[rows], signals=signals)


def mapped(recordings: Sequence[Recording]) -> list[MappedRecording]:
    return [map_recording(recording, PROGRAM) for recording in recordings]


@pytest.fixture(scope="module")
def common() -> tuple[Problem, Fit, Fit]:
    """Blue boats that are pushed aside, and a fit in which all boats are."""
    runs = [sailed("blue 1", "blue", 1, pushed), sailed("blue 2", "blue", 2, pushed), brief()]
    levels = prior_noise_levels(BOAT, runs)
    problem = Problem(mapped(runs), levels, {"damping": 0.02, "thrust": 0.02})
    base = fit_baseline(problem).recalibrated
    return problem, base, fit(problem, screen(problem, base, [EFFECT])[EFFECT])


def held_out(blue_boat: Missing, red: Missing) -> list[MappedRecording]:
    blue = [sailed(f"blue {k}", "blue", k, blue_boat) for k in (3, 4, 5)]
    return mapped([*blue, sailed("red", "red", 6, red)])


def without_harm(common: tuple[Problem, Fit, Fit], red: Missing) -> tuple[Fit, Fit]:
    """The fit with a force on all boats, and what held-out recordings leave of it."""
    problem, base, found = common
    candidates = (EFFECT, *problem.candidates_in_single_groups([EFFECT]))
    sets = CandidateSets(problem, candidates, base)
    sets.fits[frozenset(found.effects)] = found
    _, named = prune(sets, found)
    return found, remove_harm_to_groups(sets, found, named, held_out(pushed, red))[0]


@pytest.mark.slow
def test_an_effect_that_harms_a_group_acts_in_the_others_alone(
    common: tuple[Problem, Fit, Fit],
) -> None:
    problem, base, _ = common
    found, kept = without_harm(common, sound)
    assert harmed_groups(problem, base, found, held_out(pushed, sound), HORIZON) == ("red",)
    assert kept.effects == (f"{EFFECT}@blue",)
    assert kept.value(kept.effects[0], "sway")[0] == pytest.approx(ASIDE, abs=0.02)
    assert harmed_groups(problem, base, kept, held_out(pushed, sound), HORIZON) == ()


def test_an_effect_that_holds_in_all_groups_stays_common(common: tuple[Problem, Fit, Fit]) -> None:
    found, kept = without_harm(common, pushed)
    assert kept is found


def test_recordings_of_one_group_are_not_compared_by_group(
    common: tuple[Problem, Fit, Fit],
) -> None:
    problem, base, found = common
    alike = held_out(pushed, sound)[-1:]  # the red one
    assert harmed_groups(problem, base, found, alike, HORIZON) == ()


@pytest.mark.slow
def test_refitted_coefficients_that_harm_a_group_are_not_adopted() -> None:
    runs = [sailed("blue 1", "blue", 1, weak), sailed("blue 2", "blue", 2, weak)]
    levels = prior_noise_levels(BOAT, runs)
    problem = Problem(mapped(runs), levels, {"damping": 0.5, "thrust": 0.5})
    nominal, refitted = fit_baseline(problem)
    assert decide_recalibration(problem, nominal, refitted, held_out(weak, weak)).adopted
    assert not decide_recalibration(problem, nominal, refitted, held_out(weak, sound)).adopted
