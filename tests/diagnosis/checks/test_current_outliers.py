"""Readings of a measured electric current that no supply has: replaced, and reported."""

from dataclasses import replace

import numpy as np
import pytest

from boatsim.diagnosis.checks.current_outliers import current_outliers
from boatsim.diagnosis.checks.data_cleaning import cleaning_findings, prepare_recording
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
    assert finding.kind == "mended" and "4 of 400" in finding.evidence


def test_drives_that_start_stop_and_reverse_in_bursts_are_left_alone() -> None:
    rng = np.random.default_rng(3)
    bursts = np.where(rng.random(400 // 4) > 0.9, 60.0, 0.5).repeat(4)
    assert not current_outliers(bursts + 0.2 * rng.standard_normal(400)).any()
    square = 35.0 * (np.sin(2.0 * T) > 0.0)
    assert not current_outliers(square).any()
    assert not cleaning_findings(prepare_recording(recording(square), BOAT))


def test_a_supply_that_charges_for_some_time_is_no_outlier() -> None:
    assert not current_outliers(np.where(T < 15.0, -10.0, 25.0)).any()


def test_an_instrument_that_was_off_or_fails_often_is_left_alone() -> None:
    assert not current_outliers(np.zeros(50)).any()
    assert not current_outliers(np.full(50, np.nan)).any()
    rng = np.random.default_rng(4)
    wild = np.where(rng.random(400) < 0.3, 900.0 * rng.random(400), AMPERES)
    wild[::3] = np.nan
    assert not current_outliers(wild).any()
