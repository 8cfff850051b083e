"""Readings of a measured voltage that no supply has: replaced, and reported."""

from dataclasses import replace

import numpy as np
import pytest

from boatsim.diagnosis.checks.data_cleaning import cleaning_findings, prepare_recording
from boatsim.diagnosis.checks.supply_outliers import replace_supply_outliers, voltage_outliers
from boatsim.physics.vessel import load_vessel
from boatsim.physics.vessel.schema import MeasuredChannel
from boatsim.recordings.table import Recording

T = 0.1 * np.arange(400)
BOAT = replace(load_vessel("trial_boat"), measured={"battery_V": MeasuredChannel(neutral=24.0)})
VOLTS = 25.0 - 0.05 * T  # a battery that empties


def recording(volts: np.ndarray) -> Recording:
    poses = {name: 0.1 * T for name in ("x_m", "y_m")} | {"psi_rad": 0.01 * T}
    commands = dict.fromkeys(BOAT.commands, np.sin(0.5 * T))
    return Recording("run", T, {**poses, **commands, "battery_V": volts})


def test_single_readings_far_from_the_others_are_interpolated_and_reported() -> None:
    wrong = VOLTS.copy()
    wrong[[20, 100, 101]] = 1.9, 79.0, np.nan
    repaired = prepare_recording(recording(wrong), BOAT)
    assert repaired["battery_V"] == pytest.approx(VOLTS)
    (finding,) = (f for f in cleaning_findings(repaired) if f.name == "voltage_outliers")
    assert finding.kind == "mended" and "2 of 399" in finding.evidence


def test_a_voltage_that_falls_or_sags_under_load_is_left_alone() -> None:
    sagging = VOLTS - 6.0 * (np.sin(0.5 * T) > 0.8)
    assert not voltage_outliers(sagging).any()
    assert not cleaning_findings(prepare_recording(recording(sagging), BOAT))


def test_a_supply_that_was_off_for_long_is_no_outlier() -> None:
    off = np.where(T < 15.0, 0.0, VOLTS)
    assert not voltage_outliers(off).any()
    assert not voltage_outliers(np.zeros(50)).any()


def test_values_that_were_not_measured_are_interpolated_and_are_no_outliers() -> None:
    gap = np.where(np.arange(len(T)) == 100, np.nan, VOLTS)
    repaired = prepare_recording(recording(gap), BOAT)
    assert repaired["battery_V"] == pytest.approx(VOLTS)
    assert not cleaning_findings(repaired)


def test_outliers_are_a_share_of_the_readings_of_a_slower_instrument() -> None:
    wrong = VOLTS.copy()
    wrong[20] = 0.0
    wrong[1::2] = np.nan
    repaired = prepare_recording(recording(wrong), BOAT)
    assert repaired["battery_V"] == pytest.approx(VOLTS, abs=0.01)
    (finding,) = cleaning_findings(repaired)
    assert "1 of 200" in finding.evidence


def test_other_columns_in_volts_are_not_changed() -> None:
    run = recording(VOLTS)
    wrong = np.where(np.arange(len(T)) == 50, 99.0, 5.0)
    run = replace(run, signals={**run.signals, "sensed_V": wrong})
    assert replace_supply_outliers(run, BOAT)["sensed_V"] is wrong
