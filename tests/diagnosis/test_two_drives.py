"""A fault of one of two drives, which is tried only where a force stays unexplained."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from answers import diagnosed, named
from driven_boats import STEP, Drive, paused, trial_boat_runs
from typer.testing import CliRunner

from boatsim.cli.commands import app
from boatsim.diagnosis.candidates import candidate_library
from boatsim.physics import vessel
from boatsim.physics.base import Array
from boatsim.recordings.table import Recording

LAG, PAUSE, DEAD_TIME = 0.8, 0.6, 0.6  # [s]


def lagged(orders: Array) -> Array:
    """Orders (T,) behind a first-order lag."""
    out = orders.copy()
    for row in range(1, len(orders)):
        out[row] = out[row - 1] + (1.0 - np.exp(-STEP / LAG)) * (orders[row] - out[row - 1])
    return out


def runs(fault: Drive, *columns: int) -> list[Recording]:
    """Three recordings of the trial boat with a fault of some of its channels."""

    def drive(orders: Array) -> Array:
        done = orders.copy()
        for column in columns:
            done[:, column] = fault(orders[:, column])
        return done

    return trial_boat_runs(drive)


def test_an_error_of_one_of_two_drives_is_tried_last() -> None:
    library = candidate_library(vessel.load_vessel("trial_boat"))
    assert {"drive_lag", "drive_delay", "drive_exponent", "drive_weak_reverse"} <= set(
        library.tried_last
    )
    assert "thrust_imbalance" in library.inapplicable["drive_gain_error"]
    assert "only where a force stays unexplained" in library.excluded["drive_lag"]
    assert not any(name.startswith("drive_lag") for name in library.tested_names)


def test_where_no_sides_differ_a_weak_drive_is_tested_by_itself(tmp_path: Path) -> None:
    options = "--length 5 --beam 2.8 --mass 1670 --steered 1.8,0,500 --steered -1.8,0,500"
    CliRunner().invoke(app, ["new", str(tmp_path / "ferry"), *options.split()])
    library = candidate_library(vessel.load_vessel(str(tmp_path / "ferry")))
    assert library.inapplicable["thrust_imbalance"] == "no drives on both sides"
    tested = {name for name in library.tested_names if name.startswith("drive_")}
    assert tested == {"drive_gain_error_forward", "drive_gain_error_aft"}


def test_a_requested_one_is_a_candidate_for_each_drive() -> None:
    library = candidate_library(vessel.load_vessel("trial_boat"), ("drive_lag",))
    tested = {name for name in library.tested_names if name.startswith("drive_")}
    assert tested == {"drive_lag_thrust_port_N", "drive_lag_thrust_starboard_N"}
    assert "drive_lag" not in library.excluded and "drive_lag" not in library.tried_last


def test_a_vessel_with_one_drive_has_none() -> None:
    library = candidate_library(vessel.load_vessel("mariner"))
    assert "drive_lag" not in library.tried_last
    assert "fewer than 2" in library.inapplicable["drive_lag"]


def test_a_reason_of_the_vessel_excludes_it_altogether() -> None:
    boat = vessel.load_vessel("trial_boat")
    reasons = {"drive_lag": "both drives have the same controller"}
    diagnosis = boat.diagnosis.model_copy(update={"leave_out": reasons})
    library = candidate_library(replace(boat, diagnosis=diagnosis))
    assert "drive_lag" not in library.tried_last
    assert "same controller" in library.excluded["drive_lag"]


@pytest.mark.slow
def test_the_lag_of_one_drive_is_named_with_its_size(tmp_path: Path) -> None:
    answer = diagnosed(runs(lagged, 1), tmp_path, "trial_boat")
    named(answer, "drive_lag_thrust_starboard_N", {"time_constant_s": LAG})
    assert answer["fit"]["heading_rms_rad"]["patched"] < 0.01  # without the lag 0.09 rad


@pytest.mark.long
@pytest.mark.slow
def test_a_pause_of_one_drive_is_named_with_its_length(tmp_path: Path) -> None:
    def fault(orders: Array) -> Array:
        return paused(orders[:, None], PAUSE)[:, 0]

    answer = diagnosed(runs(fault, 0), tmp_path, "trial_boat")
    named(answer, "drive_reversal_pause_thrust_port_N", {"pause_s": PAUSE})


@pytest.mark.long
@pytest.mark.slow
def test_one_drive_that_is_weak_astern_is_named_with_its_factor(tmp_path: Path) -> None:
    def fault(orders: Array) -> Array:
        return np.where(orders < 0.0, 0.6 * orders, orders)

    answer = diagnosed(runs(fault, 0), tmp_path, "trial_boat")
    named(answer, "drive_weak_reverse_thrust_port_N", {"astern_factor": 0.6})


@pytest.mark.slow
def test_a_lag_of_both_drives_is_not_taken_for_faults_of_single_ones(tmp_path: Path) -> None:
    answer = diagnosed(runs(lagged, 0, 1), tmp_path, "trial_boat")
    named(answer, "thrust_lag", {"time_constant_s": LAG})


def late(orders: Array) -> Array:
    """Orders (T,) after a dead time."""
    rows = round(DEAD_TIME / STEP)
    return np.concatenate([np.repeat(orders[:1], rows), orders[:-rows]])


@pytest.mark.slow
def test_late_directions_of_both_drives_are_one_dead_time_and_no_lag(tmp_path: Path) -> None:
    answer = diagnosed(runs(late, 2, 3), tmp_path, "trial_boat")
    named(answer, "steering_delay", {"delay_s": DEAD_TIME})


@pytest.mark.long
@pytest.mark.slow
def test_a_lag_of_both_directions_is_that_of_the_steering(tmp_path: Path) -> None:
    answer = diagnosed(runs(lagged, 2, 3), tmp_path, "trial_boat")
    named(answer, "steering_rate_limit", {"lag_s": LAG})  # a rate limit with a lag
