"""Recordings that begin with the manoeuvre: the actuators are on their way then, and that is no
missing physics."""

from dataclasses import replace

import numpy as np
import pytest

from boatsim.diagnosis.candidates import program_to_replay
from boatsim.diagnosis.checks.initial_actuator_state import infer_initial_actuator_state
from boatsim.diagnosis.free_runs import free_runs, rms_errors
from boatsim.diagnosis.prior_noise import prior_noise_levels
from boatsim.diagnosis.recording_mapping import map_recording
from boatsim.diagnosis.replay import fit_noise_only
from boatsim.recordings.table import Recording
from boatsim.simulate import scenario
from boatsim.simulate.run import run


@pytest.fixture(scope="module")
def log() -> Recording:
    """An Otter from rest, its propellers told to turn in the first row; they take a tenth of a
    second to follow."""
    found = run(scenario.load("otter/turn")).recording
    shown = {n: found[n] for n in ("x_m", "y_m", "psi_rad", "n_port_radps", "n_starboard_radps")}
    return Recording("turn", found.t, shown)


@pytest.mark.slow
def test_a_log_from_rest_is_replayed_as_it_was(log: Recording) -> None:
    problem, fitted = fit_noise_only(log, scenario.load("otter/turn").vessel)
    off = rms_errors(free_runs(problem, {"simulated": fitted}, problem.recordings, 6.0))
    assert off["position_rms_m"]["simulated"] < 1e-4
    assert off["heading_rms_rad"]["simulated"] < 1e-4


@pytest.mark.slow
def test_a_log_from_under_way_begins_with_actuators_that_have_settled(log: Recording) -> None:
    boat = scenario.load("otter/turn").vessel
    program, _ = program_to_replay(boat)
    levels = prior_noise_levels(boat, [log])
    late = log.between(3.0, 20.0)
    for recording, rows in ((log, 2), (late, 1)):  # of commands, which stay as they are
        assert (
            len(
                infer_initial_actuator_state(
                    map_recording(recording, program), levels
                ).command_values
            )
            == rows
        )


def test_where_nothing_tells_the_actuators_have_settled(log: Recording) -> None:
    boat = scenario.load("otter/turn").vessel
    program, _ = program_to_replay(boat)
    still = replace(log, signals=log.signals | {n: np.zeros(len(log)) for n in boat.commands})
    laid = map_recording(still, program)
    assert infer_initial_actuator_state(laid, prior_noise_levels(boat, [still])) is laid
