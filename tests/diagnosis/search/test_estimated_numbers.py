"""Estimated numbers that a vessel lacks are refined before missing physics is sought."""

from dataclasses import replace

import numpy as np
import pytest
from pushed_boat import BOAT, COMMANDS, sail

from boatsim.diagnosis.candidates import candidate_library
from boatsim.diagnosis.prior_noise import prior_noise_levels
from boatsim.diagnosis.problem import Problem
from boatsim.diagnosis.recording_mapping import map_recording
from boatsim.diagnosis.search.estimated_numbers import (
    candidates_for_absent_numbers,
    refining_candidates,
)
from boatsim.diagnosis.search.ranking import select_and_rank_candidates
from boatsim.physics.base import Array
from boatsim.physics.program import Program
from boatsim.physics.vessel import Vessel
from boatsim.recordings.table import Recording

ROUGH = replace(BOAT, estimated={"lag": 1.0, "mass_centre": 1.0, "damping": 0.3})
CANDIDATES = ("clock_offset", "command_delay", "mass_centre_shift", "quadratic_damping", "wind")


def calm(t: float, y: Array, command: Array) -> Array:
    """No further force."""
    return np.zeros(3)


def late_by_a_row(name: str, seed: int) -> Recording:
    """A recording whose commands act one row later than they are recorded."""
    log = sail(name, seed, calm)[0]
    signals = dict(log.signals)
    for command in COMMANDS:
        signals[command] = np.append(signals[command][1:], signals[command][-1])
    return replace(log, signals=signals)


def selected(vessel: Vessel) -> set[str]:
    """Names of the effects that are selected for two late recordings."""
    program = Program(vessel, candidate_library(vessel).compiled_effects)
    logs = [late_by_a_row(name, seed) for seed, name in enumerate("ab")]
    mapped = [map_recording(log, program) for log in logs]
    uncertain = {"damping": 0.05, "thrust": 0.05}
    problem = Problem(mapped, prior_noise_levels(vessel, logs), uncertain)
    return set(select_and_rank_candidates(problem, CANDIDATES).best.effects)


def test_only_numbers_that_the_file_calls_estimated_are_refined() -> None:
    library = {effect.name: effect for effect in candidate_library(BOAT).entries}
    assert refining_candidates(BOAT, CANDIDATES, library) == frozenset()
    refining = refining_candidates(ROUGH, CANDIDATES, library)
    assert refining == {"command_delay", "mass_centre_shift", "quadratic_damping"}
    # the vessel has a damping, which every fit refits
    absent = candidates_for_absent_numbers(refining, CANDIDATES, library)
    assert absent == ("command_delay", "mass_centre_shift")


@pytest.mark.parametrize(
    ("vessel", "names"),
    [
        pytest.param(BOAT, {"clock_offset", "command_delay"}, id="exact"),
        pytest.param(ROUGH, {"command_delay"}, id="rough"),
    ],
)
def test_a_delay_is_that_of_the_boat_where_its_lags_are_estimates(
    vessel: Vessel, names: set[str]
) -> None:
    """Positions and headings alone do not tell late poses from late commands."""
    found = selected(vessel)
    assert len(found) == 1 and found <= names
