"""Recalibration never harms: laws of which refitted coefficients are adopted."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from pushed_boat import BOAT, COMMANDS, DAMPING, Missing, sail

from boatsim.diagnosis.candidates import candidate_library
from boatsim.diagnosis.config import DEFAULT
from boatsim.diagnosis.filter import NoiseLevels
from boatsim.diagnosis.output.patched_vessel import write_patched_vessel
from boatsim.diagnosis.prior_noise import prior_noise_levels
from boatsim.diagnosis.problem import Fit, FreeParameter, Problem
from boatsim.diagnosis.recalibration import (
    decide_recalibration,
    fix_undetermined_coefficients,
    undetermined_by_simulations,
    undetermined_coefficients,
)
from boatsim.diagnosis.recording_mapping import map_recording
from boatsim.diagnosis.search.ranking import fit_baseline
from boatsim.diagnosis.simulated_information import independent_count
from boatsim.physics.base import Array
from boatsim.physics.program import Program
from boatsim.physics.vessel import load_vessel
from boatsim.recordings.table import Notes, Recording

PROGRAM = Program(BOAT, candidate_library(BOAT).compiled_effects)
DRAG = 0.4  # share by which a boat has more drag than its file


def draggy(t: float, y: Array, command: Array) -> Array:
    return np.asarray(-DRAG * DAMPING * y[3:6])


def gusty(t: float, y: Array, command: Array) -> Array:
    """A force on the beam that no command causes."""
    return np.array([0.0, 0.4 * np.sin(1.3 * t) + 0.3 * np.sin(2.9 * t + 1.0), 0.0])


def slippery(t: float, y: Array, command: Array) -> Array:
    return np.asarray(DRAG * DAMPING * y[3:6])


def at_rest(seed: int) -> Recording:
    """A minute in calm water without any command, and the noise of the instruments."""
    rng, rows = np.random.default_rng(seed), 240
    seen = rng.standard_normal((rows, 3)) * [0.003, 0.003, 0.012]
    signals = dict(zip(("x_m", "y_m", "psi_rad"), seen.T, strict=True))
    signals |= dict.fromkeys(COMMANDS, np.zeros(rows))
    return Recording("rest", np.arange(rows) / 6.0, signals, Notes(vessel=BOAT.name))


def problem_of(recording: Recording) -> Problem:
    return Problem(
        [map_recording(recording, PROGRAM)],
        prior_noise_levels(BOAT, [recording]),
        {"damping": 0.3, "thrust": 0.1},
    )


def posterior(covariance: list[list[float]]) -> Fit:
    """A fit of coefficients with a prior sd of one."""
    names = ("surge", "sway", "yaw")[: len(covariance)]
    free = []
    for i, name in enumerate(names):
        free.append(FreeParameter("damping", name, (i,), 1.0, 1.0, 0.05, 20.0, relative=True))
    theta = np.full(len(free), 1.1)
    levels = NoiseLevels(np.ones(3), 1.0, {})
    return Fit((), tuple(free), theta, np.array(covariance), levels, 0.0)


def test_a_recording_without_excitation_leaves_all_coefficients_as_in_the_file() -> None:
    problem = problem_of(at_rest(1))
    held_out = [map_recording(at_rest(2), PROGRAM)]
    nominal, refitted = fit_baseline(problem)
    found = decide_recalibration(problem, nominal, refitted, held_out)
    assert len(found.undetermined) == len(refitted.free)
    assert np.all(found.fit.theta == 1.0)


@pytest.mark.parametrize(("held_out_boat", "adopted"), [(draggy, True), (slippery, False)])
def test_coefficients_are_adopted_only_if_held_out_data_agree(
    held_out_boat: Missing, adopted: bool, tmp_path: Path
) -> None:
    problem = problem_of(sail("fitted", 1, draggy)[0])
    held_out = [map_recording(sail("held out", 2, held_out_boat)[0], PROGRAM)]
    nominal, refitted = fit_baseline(problem)
    found = decide_recalibration(problem, nominal, refitted, held_out)
    assert found.adopted is adopted
    drag = [i for i, f in enumerate(refitted.free) if "damping" in f.effect]
    if adopted:
        assert found.fit.theta[drag] == pytest.approx(1.0 + DRAG, abs=0.15)
    else:
        assert np.all(found.fit.theta == 1.0)
        # the recordings differ from these numbers by what they were fitted to
        sd = np.sqrt(np.diag(found.fit.covariance))[drag]
        assert np.all(sd > 0.5 * np.abs(refitted.theta[drag] - 1.0))
        patched = tmp_path / "patched.toml"
        write_patched_vessel(problem, BOAT, found.fit, patched)
        assert load_vessel(str(patched)).effects == BOAT.effects


def test_a_boat_that_never_turns_keeps_its_damping_in_sway_whatever_pushes_it() -> None:
    problem = replace(
        problem_of(sail("straight", 3, gusty, straight=True)[0]),
        uncertainty={"damping": 1.0, "thrust": 0.1},
    )
    held_out = [map_recording(sail("held out", 4, gusty, straight=True)[0], PROGRAM)]
    refitted = fit_baseline(problem)[1]
    names = [f"{f.effect}.{f.name}" for f in refitted.free]
    surge, sway = names.index("linear_damping.surge"), names.index("linear_damping.sway")
    sd = np.sqrt(np.diag(refitted.covariance)) / [f.sd for f in refitted.free]
    assert sd[sway] < DEFAULT.fit.undetermined_sd  # the filter believes that it knows
    assert abs(refitted.theta[sway] - 1.0) > 0.2  # and is wrong
    found = fix_undetermined_coefficients(problem, refitted, held_out)
    assert found.theta[sway] == 1.0
    assert found.theta[surge] == pytest.approx(1.0, abs=0.15)
    assert sway in undetermined_by_simulations(problem, refitted)
    assert surge not in undetermined_by_simulations(problem, refitted)


def test_a_boat_that_turns_keeps_none_of_its_damping() -> None:
    problem = problem_of(sail("turns", 1, draggy)[0])
    refitted = fit_baseline(problem)[1]
    kept = [refitted.free[i].effect for i in undetermined_by_simulations(problem, refitted)]
    assert "linear_damping" not in kept


def test_white_errors_are_all_independent_and_a_growing_error_is_one_value() -> None:
    white = np.random.default_rng(1).standard_normal(2000)
    assert independent_count(white) == pytest.approx(2000, rel=0.1)
    assert independent_count(np.linspace(0.0, 1.0, 200)) < 2.0
    assert independent_count(np.full(50, 0.3)) < 1.1
    decay = 0.9  # of an autoregressive process: the time of its correlation is (1 + a) / (1 - a)
    errors = np.zeros(8000)
    for i, kick in enumerate(np.random.default_rng(2).standard_normal(len(errors) - 1)):
        errors[i + 1] = decay * errors[i] + kick
    expected = len(errors) * (1.0 - decay) / (1.0 + decay)
    assert independent_count(errors) == pytest.approx(expected, rel=0.3)
    assert independent_count(np.zeros(5)) == independent_count(np.array([np.nan])) == 1.0


def test_of_two_coefficients_whose_ratio_alone_is_determined_one_is_kept() -> None:
    one_direction = posterior([[0.505, 0.495], [0.495, 0.505]])
    assert len(undetermined_coefficients(one_direction, DEFAULT.fit)) == 1
    neither = posterior([[0.9, 0.0], [0.0, 0.8]])
    assert undetermined_coefficients(neither, DEFAULT.fit) == [0, 1]


def test_only_coefficients_of_the_file_are_kept_and_not_parameters_of_effects() -> None:
    found = posterior([[0.9, 0.0], [0.0, 0.9]])
    effect = replace(found.free[1], effect="wind", relative=False)
    found = replace(found, free=(found.free[0], effect))
    assert undetermined_coefficients(found, DEFAULT.fit) == [0]
