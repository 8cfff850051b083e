"""Reports of drives compared with their orders: dead time, rate, stops, stale and wrong reports."""

import numpy as np
import pytest

from boatsim.diagnosis.checks.drive_response import check_drive_response
from boatsim.diagnosis.checks.finding import Finding
from boatsim.diagnosis.config import DEFAULT
from boatsim.physics.vessel import load_vessel
from boatsim.recordings.table import Recording

STEP = 0.1  # [s]
T = np.arange(1500) * STEP
BOAT = load_vessel("otter")


def orders(seed: int, least: float, most: float) -> np.ndarray:
    """Orders that change every two to six seconds."""
    rng = np.random.default_rng(seed)
    values = []
    while len(values) < len(T):
        values += [rng.uniform(least, most)] * int(rng.integers(20, 60))
    return np.array(values[: len(T)])


def followed(x: np.ndarray, dead: float, rate: float, low: float, high: float) -> np.ndarray:
    """The answer of a drive with a dead time, a limited rate and stops."""
    late = np.concatenate((np.full(round(dead / STEP), x[0]), x))[: len(x)]
    y = np.empty(len(x))
    y[0] = np.clip(x[0], low, high)
    for i in range(1, len(x)):
        y[i] = y[i - 1] + np.clip(
            np.clip(late[i - 1], low, high) - y[i - 1], -rate * STEP, rate * STEP
        )
    return y


def findings(**signals: np.ndarray) -> dict[str, Finding]:
    """Findings by name."""
    found = check_drive_response(Recording("run", T, signals), BOAT, DEFAULT.checks)
    return {finding.name: finding for finding in found}


def test_dead_time_and_rate_of_an_azimuth_drive_are_stated() -> None:
    x = orders(1, 0.0, 1.5)
    y = followed(x, 0.8, 0.5, -9.0, 9.0)
    found = findings(azimuth_rad=x, actual_azimuth_rad=y)
    assert set(found) == {"drive_follows"}
    assert "dead time of 0.8 s" in found["drive_follows"].evidence
    assert "28.6 deg/s" in found["drive_follows"].evidence


def test_whole_turns_of_an_order_change_nothing() -> None:
    x = orders(1, 0.0, 1.5)
    y = followed(x, 0.8, 0.5, -9.0, 9.0)
    turned = x + 2.0 * np.pi * np.round(T / 40.0)
    plain = findings(azimuth_rad=x, actual_azimuth_rad=y)["drive_follows"].evidence
    assert findings(azimuth_rad=turned, actual_azimuth_rad=y)["drive_follows"].evidence == plain


def test_stops_of_an_azimuth_drive_are_stated_in_degrees() -> None:
    x = orders(2, -1.5, 3.0)
    y = followed(x, 0.3, 0.8, 0.0, 0.5 * np.pi)
    found = findings(azimuth_rad=x, actual_azimuth_rad=y)
    assert "does not turn beyond 0 deg and 90 deg" in found["drive_stops"].evidence


def test_saturated_revolutions_are_stated() -> None:
    x = orders(3, 0.0, 100.0)
    found = findings(n_radps=x, actual_n_radps=followed(x, 0.2, 500.0, 0.0, 80.0))
    assert "reaches 80 at most" in found["drive_saturates"].evidence


def test_reports_that_a_logger_repeats_for_seconds_are_stale() -> None:
    x = orders(4, -50.0, 50.0)
    y = followed(x, 0.2, 500.0, -99.0, 99.0)
    held = y[(np.arange(len(y)) // 25) * 25]  # one new value every 2.5 s
    found = findings(n_radps=x, actual_n_radps=held)
    assert "drive_follows" not in found
    assert "n_radps" in found["report_stale"].remedy
    assert "report_stale" not in findings(n_radps=x, actual_n_radps=y)


def test_impossible_reports_are_counted() -> None:
    x = orders(5, -50.0, 50.0)
    y = followed(x, 0.2, 500.0, -99.0, 99.0)
    y[300:303] = 400.0
    current = 10.0 + np.sin(T)
    current[[100, 900]] = -596.0
    rng = np.random.default_rng(0)
    noisy = rng.normal(0.0, 1.0, len(T))
    found = findings(n_radps=x, actual_n_radps=y, sensed_noise=noisy)
    assert "1 impossible report" in found["report_outliers"].evidence
    found = findings(n_radps=x, actual_n_radps=x, sensed_battery_A=current)
    assert "2 impossible reports" in found["report_outliers"].evidence
    assert "first at 10 s" in found["report_outliers"].evidence


@pytest.mark.parametrize("seed", range(3))
def test_a_drive_that_follows_at_once_gives_no_finding(seed: int) -> None:
    x = orders(seed, -50.0, 50.0)
    assert not findings(n_radps=x, actual_n_radps=x, sensed_V=np.full(len(T), 12.0))
