"""Readings of a measured electric current that no supply has: replaced, and reported."""

from dataclasses import replace

import numpy as np
import pytest

from boatsim.diagnosis.checks.data_cleaning import cleaning_findings, prepare_recording
from boatsim.diagnosis.checks.supply_outliers import current_outliers, replace_supply_outliers
from boatsim.physics.vessel import load_vessel
from boatsim.physics.vessel.schema import MeasuredChannel
from boatsim.recordings.table import Recording

T = 0.1 * np.arange(400)
BOAT = replace(load_vessel("trial_boat"), measured={"battery_A": MeasuredChannel(neutral=30.0)})
AMPERES = 20.0 + 15.0 * np.sin(0.3 * T)


def recording(amperes: np.ndarray) -> Recording:
    poses = {name: 0.1 * T for name in ("x_m", "y_m")} | {"psi_rad": 0.01 * T}
    commands = dict.fromkeys(BOAT.commands, np.sin(0.5 * T))
    return Recording("run", T, {**poses, **commands, "battery_A": amperes})


def test_single_readings_far_from_those_around_them_are_interpolated_and_reported() -> None:
    wrong = AMPERES.copy()
    wrong[[20, 100, 101, 300]] = 655.0, 327.0, np.nan, -80.0
    repaired = prepare_recording(recording(wrong), BOAT)
    assert repaired["battery_A"] == pytest.approx(AMPERES, abs=0.05)
    (finding,) = (f for f in cleaning_findings(repaired) if f.name == "supply_current_outliers")
    assert finding.kind == "mended" and "3 of 399" in finding.evidence


def test_drives_that_start_stop_and_reverse_in_bursts_are_left_alone() -> None:
    rng = np.random.default_rng(3)
    bursts = np.where(rng.random(400 // 4) > 0.9, 60.0, 0.5).repeat(4)
    assert not current_outliers(T, bursts + 0.2 * rng.standard_normal(400)).any()
    square = 35.0 * (np.sin(2.0 * T) > 0.0)
    assert not current_outliers(T, square).any()
    assert not cleaning_findings(prepare_recording(recording(square), BOAT))


def test_a_supply_that_charges_for_some_time_is_no_outlier() -> None:
    assert not current_outliers(T, np.where(T < 15.0, -10.0, 25.0)).any()


def test_an_instrument_that_was_off_or_fails_often_is_left_alone() -> None:
    assert not current_outliers(T[:50], np.zeros(50)).any()
    wild = AMPERES.copy()
    wild[::4] = 900.0
    wild[1::4] = np.nan
    kept = replace_supply_outliers(recording(wild), BOAT)
    known = np.isfinite(wild)
    assert (kept["battery_A"][known] == wild[known]).all() and not kept.remarks
    empty = np.full(400, np.nan)
    assert replace_supply_outliers(recording(empty), BOAT)["battery_A"] is empty


def test_a_value_that_was_not_measured_is_interpolated_and_is_no_outlier() -> None:
    gap = np.where(np.arange(len(T)) == 100, np.nan, AMPERES)
    repaired = prepare_recording(recording(gap), BOAT)
    assert repaired["battery_A"] == pytest.approx(AMPERES, abs=0.05)
    assert not cleaning_findings(repaired)


def test_outliers_are_a_share_of_the_readings_of_a_slower_instrument() -> None:
    wrong = AMPERES.copy()
    wrong[20] = 500.0
    wrong[1:-1:2] = np.nan
    repaired = prepare_recording(recording(wrong), BOAT)
    assert repaired["battery_A"] == pytest.approx(AMPERES, abs=0.1)
    (finding,) = cleaning_findings(repaired)
    assert "1 of 201" in finding.evidence


@pytest.mark.parametrize("rows", [1, 2])
def test_repeated_bursts_of_thrust_in_a_slow_log_are_no_outliers(rows: int) -> None:
    t = np.arange(300.0)
    bursts = np.where((t + 10.0) % 20.0 < rows, 8.0, 0.3)
    assert not current_outliers(t, bursts).any()


def test_wild_readings_of_different_size_in_a_slow_log_are_outliers() -> None:
    t = np.arange(300.0)
    wild = np.where(t % 20.0 < 2.0, 8.0, 0.3)
    wild[[50, 150]] = 655.0, -80.0
    assert np.flatnonzero(current_outliers(t, wild)).tolist() == [50, 150]


def test_a_single_wild_reading_of_a_fast_log_is_the_only_outlier() -> None:
    t = 0.05 * np.arange(1200)
    wild = np.where(t % 20.0 < 2.0, 8.0, 0.3)
    wild[500] = 655.0
    assert np.flatnonzero(current_outliers(t, wild)).tolist() == [500]


def test_bursts_of_a_large_vessel_last_longer_by_the_law_of_froude() -> None:
    t = 0.5 * np.arange(400)
    bursts = np.where(t % 10.0 < 0.9, 60.0, 0.5)  # of two rows
    bursts[:3] = 0.5
    assert not current_outliers(t, bursts).any()
    assert current_outliers(t, bursts, time_scale=4.0).sum() == 38


def test_a_wild_reading_next_to_the_first_one_is_an_outlier_and_hides_no_other() -> None:
    t = np.arange(300.0)
    wild = np.full(300, 0.3)
    wild[[1, 150]] = 655.0, -80.0
    assert np.flatnonzero(current_outliers(t, wild)).tolist() == [1, 150]


def test_a_log_of_few_readings_is_checked_too() -> None:
    assert not current_outliers(T[:3], np.array([1.0, 1.5, 1.2])).any()
    found = current_outliers(0.01 * np.arange(6), np.array([1.0, 1.1, 99.0, 1.2, 1.0, 1.1]))
    assert np.flatnonzero(found).tolist() == [2]
