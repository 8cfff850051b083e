"""Drives that pause or whose commands have play, in a diagnosis with all candidates."""

from pathlib import Path

import numpy as np
import pytest
from answers import diagnosed, named, nothing_missing
from driven_boats import Drive, paused, played, trial_boat_runs

from boatsim.physics.base import Array
from boatsim.recordings.table import Recording


def runs(fault: Drive) -> list[Recording]:
    """Three recordings of the trial boat with a fault of its thrusts."""

    def drive(orders: Array) -> Array:
        return np.column_stack([fault(orders[:, :2]), orders[:, 2:]])

    return trial_boat_runs(drive)


@pytest.mark.slow
def test_a_pause_is_named_with_its_length(tmp_path: Path) -> None:
    answer = diagnosed(runs(lambda x: paused(x, 0.6)), tmp_path, "trial_boat")
    named(answer, "reversal_pause", {"pause_s": 0.6})


@pytest.mark.slow
def test_play_is_named_with_its_width(tmp_path: Path) -> None:
    answer = diagnosed(runs(lambda x: played(x, 0.3)), tmp_path, "trial_boat")
    named(answer, "thrust_hysteresis", {"width_N": 0.3})


@pytest.mark.slow
def test_drives_without_a_fault_have_nothing_missing(tmp_path: Path) -> None:
    nothing_missing(diagnosed(runs(lambda x: x), tmp_path, "trial_boat"))
