"""Samples of a regular sensor that a program polls at another rate get the sensor's times."""

from pathlib import Path

import numpy as np
import pytest

from boatsim.recordings.importing.convert import convert_log
from boatsim.recordings.importing.log import Log, Signal
from boatsim.recordings.importing.mapping import Map
from boatsim.recordings.importing.regular_times import regular_times

PERIOD = 0.2  # [s] of the sensor


def track_at(t: np.ndarray) -> np.ndarray:
    """Positions [m] of a boat of 1.5 m/s on a circle."""
    return 20.0 * np.exp(1.5j * t / 20.0)


def polled(loop: float, seed: int = 0, lost: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
    """Times of measurement, and times at which a program with a loop of this length read them."""
    rng = np.random.default_rng(seed)
    true = 1.7e9 + PERIOD * np.arange(600)
    true = true[rng.random(600) >= lost]
    reads = 1.7e9 + 0.013 + np.cumsum(loop + 0.004 * rng.normal(size=round(130.0 / loop)))
    return true, reads[np.searchsorted(reads, true)]


@pytest.mark.parametrize("loop", [0.05, 0.109])
@pytest.mark.parametrize("lost", [0.0, 0.1])
def test_the_times_of_the_sensor_come_back_up_to_the_mean_delay(loop, lost):
    true, read = polled(loop, lost=lost)
    track = track_at(true - true[0])
    found, period = regular_times(read, track)
    assert period == pytest.approx(PERIOD, rel=1e-3)
    off = found - true
    assert np.std(off - np.mean(off)) < 0.35 * np.std(read - true)
    assert 0.0 < np.mean(off) < loop


def test_random_and_regular_times_are_left_as_they_are():
    rng = np.random.default_rng(4)
    t = 1.7e9 + np.cumsum(0.05 + 0.3 * rng.random(600))
    assert regular_times(t, track_at(t - t[0])) is None
    t = 1.7e9 + PERIOD * np.arange(600)
    assert regular_times(t, track_at(t - t[0])) is None


def test_a_track_that_is_smooth_by_its_stamps_keeps_them():
    _, read = polled(0.109)
    assert regular_times(read, track_at(read - read[0])) is None


def test_an_import_moves_the_positions_and_reports_it():
    true, read = polled(0.109)
    rows = np.unique(np.concatenate([read, read + 0.05]))
    last = np.searchsorted(read, rows, side="right") - 1
    track = track_at(true - true[0])[last]
    heading = 10.0 * np.sin(0.3 * rows) + 0.01 * np.random.default_rng(5).normal(size=len(rows))
    signals = {
        "north": Signal(rows, track.real),
        "east": Signal(rows, track.imag),
        "yaw": Signal(rows, heading),
    }
    map = Map(columns={"x_m": "north", "y_m": "east", "psi_rad": "yaw * deg"})
    run = convert_log(Log(Path("log.csv"), signals), map, "map.toml")
    assert any("the sensor measured every 0.2 s" in remark for remark in run.remarks)
    seen = np.isfinite(run["x_m"])
    speed = np.abs(np.diff(run["x_m"][seen] + 1j * run["y_m"][seen]) / np.diff(run.t[seen]))
    assert np.percentile(np.abs(speed - 1.5), 90) < 0.3


def queued(seed: int = 0) -> tuple[np.ndarray, np.ndarray]:
    """Times of measurement, and times at which messages of a queue arrived, up to 0.5 s later.

    A link lets messages through in bursts, in order and at least 20 ms apart.
    """
    rng = np.random.default_rng(seed)
    true = 1.7e9 + PERIOD * np.arange(600)
    true = true[rng.random(600) >= 0.03]
    arrived = true + 0.05 + 0.45 * rng.random(len(true)) ** 2
    for i in range(1, len(arrived)):
        arrived[i] = max(arrived[i], arrived[i - 1] + 0.02)
    return true, arrived


@pytest.mark.parametrize("seed", range(4))
def test_delays_of_more_than_a_period_are_removed_up_to_the_mean_delay(seed):
    true, arrived = queued(seed)
    noise = 0.005 * np.random.default_rng(seed).normal(size=(2, len(true)))
    track = track_at(true - true[0]) + noise[0] + 1j * noise[1]
    found, period = regular_times(arrived, track)
    assert period == pytest.approx(PERIOD, rel=1e-3)
    off = found - true
    assert np.std(off) < 0.25 * np.std(arrived - true)
    assert 0.0 < np.mean(off) < 0.5


def test_samples_at_irregular_times_are_left_as_they_are_where_their_track_is_smooth():
    rng = np.random.default_rng(7)
    true = 1.7e9 + np.cumsum(0.05 + 0.3 * rng.random(600))
    read = true + 0.1 * rng.random(600)
    assert regular_times(np.sort(read), track_at(true - true[0])) is None


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("step", [1e-3, 1e-310])
def test_a_velocity_beyond_the_largest_number_gives_no_warning(step):
    true, read = polled(0.109)
    track, t = track_at(true - true[0]), read - read[0]
    t[1] = step  # [s] 0.3 m / 1e-310 s exceeds 1.8e308 m/s
    found, period = regular_times(t, track)
    assert period == pytest.approx(PERIOD, rel=1e-3)
    assert np.std((found - (true - true[0]))[2:]) < 0.35 * np.std((t - (true - true[0]))[2:])
