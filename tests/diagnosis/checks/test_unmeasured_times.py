"""Recordings are divided where no pose or rate is measured for as long as a hole of a log."""

from dataclasses import replace

import numpy as np
import pytest

from boatsim.diagnosis.checks.cut_recordings import format_interval, parts_outside_intervals
from boatsim.diagnosis.checks.unmeasured_times import cut_unmeasured_times, unmeasured_times
from boatsim.diagnosis.config import DEFAULT
from boatsim.diagnosis.loading import LoadedRecordings
from boatsim.physics.vessel import Vessel, load_vessel
from boatsim.recordings.table import Recording


@pytest.fixture(scope="module")
def boat() -> Vessel:
    return load_vessel("joystick_boat")  # 1.2 m: a hole is longer than 10 s


def log(begin: float, end: float, rate_goes_on: bool = False) -> Recording:
    """A log of 100 s with commands in all rows, and poses outside an interval only."""
    t = np.arange(0.0, 100.0, 0.1)
    out = (t > begin + 0.01) & (t < end - 0.01)
    signals = {"x_m": 0.1 * t, "y_m": 0.0 * t, "psi_rad": 0.0 * t}
    signals = {name: np.where(out, np.nan, values) for name, values in signals.items()}
    rate = 0.0 * t
    if not rate_goes_on:
        rate = np.where(out, np.nan, rate)
    return Recording("log", t, {**signals, "r_radps": rate, "thrust_N": 1.0 + 0.0 * t})


def loaded(run: Recording, boat: Vessel) -> LoadedRecordings:
    held_out = replace(log(0.0, 0.0), name="held out")
    return LoadedRecordings([run], [held_out], {None: boat}, "")


def test_a_recording_is_divided_and_all_measured_rows_stay(boat: Vessel) -> None:
    run = log(40.0, 60.0)
    found = cut_unmeasured_times(loaded(run, boat), DEFAULT)
    before, behind = found.fitted
    assert before.t[[0, -1]] == pytest.approx([0.0, 40.0])
    assert behind.t[[0, -1]] == pytest.approx([60.0, 99.9])
    known = int(np.isfinite(run["x_m"]).sum())
    assert len(before.t) + len(behind.t) == known
    assert len(found.held_out) == 1
    (finding,) = found.findings
    assert finding.name == "unmeasured" and finding.kind == "mended"
    assert finding.spans[0] == pytest.approx((40.0, 60.0), abs=1e-3)


def test_a_shorter_time_and_one_with_a_rate_are_not_divided(boat: Vessel) -> None:
    for run in (log(40.0, 49.0), log(40.0, 60.0, rate_goes_on=True)):
        assert not unmeasured_times(run, boat, DEFAULT)
        found = cut_unmeasured_times(loaded(run, boat), DEFAULT)
        assert found.fitted == [run] and not found.findings


def test_a_larger_vessel_may_be_unmeasured_for_longer() -> None:
    """Times scale with the square root of the length: 160 m to 1.2 m as 11.5 to 1."""
    ship = load_vessel("mariner")
    assert not unmeasured_times(log(40.0, 60.0), ship, DEFAULT)


@pytest.mark.parametrize(
    ("begin", "end", "text"),
    [
        (40.000001, 59.999999, "40 to 60 s"),
        (12345.0, 12361.0, "12345 to 12361 s"),
        (12345.2, 12345.4, "12345.2 to 12345.4 s"),
        (0.000001, 9999.9, "0 to 10000 s"),
    ],
)
def test_times_are_written_without_powers_of_ten_and_differ(
    begin: float, end: float, text: str
) -> None:
    assert format_interval(begin, end, 4) == text


def test_parts_of_a_long_log_have_different_names_and_the_finding_their_times(boat: Vessel) -> None:
    run = log(40.0, 60.0)
    run = replace(run, t=run.t + 12300.0)
    found = cut_unmeasured_times(loaded(run, boat), DEFAULT)
    names = [part.name for part in found.fitted]
    assert names == ["log (12300 to 12340 s)", "log (12360 to 12400 s)"]
    assert "12340 to 12360 s" in found.findings[0].evidence
    short = replace(run, t=12300.0 + 0.001 * np.arange(len(run.t)))
    parts = parts_outside_intervals(short, [(12300.2005, 12300.2015), (12300.4005, 12300.4015)])
    assert [part.name for part in parts] == [
        "log (12300 to 12300.2 s)",
        "log (12300.2 to 12300.4 s)",
        "log (12300 to 12301 s)",
    ]
