"""Positions that were logged late are moved along the track to the times of their rows."""

import numpy as np

from boatsim.diagnosis.checks.position_times import LATE_BY_ROWS, correct_position_times
from boatsim.recordings.table import Recording


def position(t: np.ndarray) -> np.ndarray:
    """Positions [m] of a boat of 1.5 m/s on a circle."""
    return 20.0 * np.exp(1.5j * t / 20.0)


def logged(delays: np.ndarray) -> tuple[Recording, np.ndarray]:
    """A log at 10 Hz of a sensor with 5 Hz, which repeats the last position that has arrived."""
    t = np.arange(0.0, 120.0, 0.1)
    measured = np.arange(0.0, 120.0, 0.2)
    arrived = np.maximum.accumulate(measured + delays[: len(measured)])
    last = np.searchsorted(arrived, t, side="right") - 1
    z = position(measured)[np.maximum(last, 0)]
    return Recording("log", t, {"x_m": z.real, "y_m": z.imag, "psi_rad": np.angle(z)}), t


def test_positions_are_those_at_the_rows_but_for_the_mean_delay():
    recording, t = logged(0.4 * np.random.default_rng(1).random(600))
    found = correct_position_times(recording)
    assert any(LATE_BY_ROWS in remark for remark in found.remarks)
    seen = np.isfinite(found["x_m"])
    assert seen.sum() > 400
    z = found["x_m"][seen] + 1j * found["y_m"][seen]
    before = recording["x_m"][seen] + 1j * recording["y_m"][seen]
    behind = np.angle(position(t[seen]) / z) / (1.5 / 20.0)  # [s] delay that is left
    behind_before = np.angle(position(t[seen]) / before) / (1.5 / 20.0)
    assert np.std(behind) < 0.4 * np.std(behind_before)
    assert abs(np.mean(behind) - np.mean(behind_before)) < 0.05


def test_a_log_without_delays_is_left_as_it_is():
    recording, _ = logged(np.zeros(600))
    assert correct_position_times(recording) is recording
