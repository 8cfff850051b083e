"""Errors of free runs."""

import numpy as np

from boatsim.diagnosis.free_runs import DIVERGED, FreeRun, rms_errors
from boatsim.diagnosis.search.generalization import mean_square_errors
from boatsim.physics.base import Array

N = np.nan


def run(recorded: Array, simulated: Array) -> FreeRun:
    channels = {"recorded": {"psi_rad": recorded}, "it": {"psi_rad": simulated}}
    return FreeRun("a", 0.0, np.arange(float(len(recorded))), channels)


def test_rows_without_a_recorded_value_do_not_count() -> None:
    runs = [run(np.array([1.0, N, 3.0]), np.array([1.0, 7.0, 4.0])), run(np.full(3, N), np.ones(3))]
    assert rms_errors(runs)["heading_rms_rad"]["it"] == np.sqrt(0.5)


def test_a_simulation_that_diverges_has_an_infinite_error_stated_as_a_number() -> None:
    sound = run(np.array([1.0, 2.0]), np.array([1.0, 3.0]))
    for end in (N, np.inf, -np.inf):
        diverging = run(np.array([1.0, 2.0]), np.array([1.0, end]))
        squares = mean_square_errors([sound, diverging], "it")["heading_rms_rad"]
        assert squares[0] == 0.5 and squares[1] == np.inf
        assert rms_errors([sound, diverging])["heading_rms_rad"]["it"] == DIVERGED
    unrecorded = run(np.array([1.0, N]), np.array([1.0, N]))
    assert np.isfinite(rms_errors([sound, unrecorded])["heading_rms_rad"]["it"])
