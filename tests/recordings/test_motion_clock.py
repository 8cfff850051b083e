"""The time that a motion took is found from poses and velocities together."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from turning_ship import wandering_rate, winding_ship

from boatsim.errors import BadInput
from boatsim.recordings.motion_clock import (
    corrected_times,
    estimate_clock_rates,
    motion_stretches,
    times_by_motion,
)
from boatsim.recordings.table import Recording, read, write_csv


def stamped(ship: Recording, rate: np.ndarray) -> Recording:
    """The ship's log with a clock that lasts `rate` true seconds per recorded second."""
    recorded = np.concatenate(([0.0], np.cumsum(np.diff(ship.t) / rate)))
    return replace(ship, t=recorded)


@pytest.mark.parametrize("seed", [0, 1, 2])
def test_a_wandering_clock_is_corrected_to_a_third(seed: int) -> None:
    ship = winding_ship(seed)
    log = stamped(ship, wandering_rate(ship.t, 0.1, seed))
    found = times_by_motion(log.t, log.signals, "ship")
    for span in (20, 120):  # rows; 10 and 60 s
        true = ship.t[span:] - ship.t[:-span]
        before = log.t[span:] - log.t[:-span] - true
        after = found[span:] - found[:-span] - true
        assert np.sqrt(np.mean(after**2)) < 0.34 * np.sqrt(np.mean(before**2))


def test_a_right_clock_stays_as_it_is() -> None:
    ship = winding_ship(3)
    found = times_by_motion(ship.t, ship.signals, "ship")
    assert np.abs(np.diff(found) / np.diff(ship.t) - 1.0).max() < 0.05
    assert abs(found[-1] - ship.t[-1]) < 0.005 * ship.t[-1]


def test_the_gain_of_the_speed_sensor_is_found_beside_the_clock() -> None:
    """The yaw rate alone tells the clock, track and clock together tell the gain."""
    runs = []
    for seed in range(4):
        ship = winding_ship(seed)
        log = stamped(ship, wandering_rate(ship.t, 0.1, seed))
        slow = {name: 0.95 * log[name] for name in ("u_mps", "v_mps")}
        run = motion_stretches(log.t, log.signals | slow)
        assert run is not None
        runs.append(run)
    found = estimate_clock_rates(runs)
    assert found.speed_gain == pytest.approx(1.0 / 0.95, abs=0.01)
    assert found.sd == pytest.approx(0.1, rel=0.3)


def test_a_leap_of_the_position_tells_no_clock_rate() -> None:
    ship = winding_ship(4)
    leap = np.where(ship.t > 300.0, 200.0, 0.0)
    log = ship.signals | {"x_m": ship["x_m"] + leap}
    run = motion_stretches(ship.t, log)
    assert run is not None
    rates = estimate_clock_rates([run], 1.0).rates[0]
    assert np.abs(rates - 1.0).max() < 0.05
    found = corrected_times(ship.t, run, rates)
    assert abs(found[-1] - ship.t[-1]) < 3.0


def test_a_recording_takes_its_times_from_the_motion(tmp_path: Path) -> None:
    ship = winding_ship(5)
    log = stamped(ship, wandering_rate(ship.t, 0.1, 5))
    write_csv(log, tmp_path / "log.csv")
    notes = tmp_path / "recording.toml"
    notes.write_text(f'clock = "motion"\nuse = [{log.t[100]}, {log.t[900]}]\n', encoding="utf-8")
    found = read(tmp_path / "log.csv")
    true = ship.t[900] - ship.t[100]
    [part] = found.parts()
    assert len(part) == 801  # the part to use keeps its rows
    assert abs(np.ptp(part.t) - true) < 0.003 * true
    assert 'clock = "motion"' in found.remarks[-1]


def test_a_clock_without_velocities_is_refused_in_one_line(tmp_path: Path) -> None:
    ship = winding_ship(6)
    signals = {name: ship[name] for name in ("x_m", "y_m", "psi_rad")}
    write_csv(replace(ship, signals=signals), tmp_path / "log.csv")
    (tmp_path / "recording.toml").write_text('clock = "motion"\n', encoding="utf-8")
    with pytest.raises(BadInput, match="no column u_mps, v_mps, r_radps"):
        read(tmp_path / "log.csv")
    (tmp_path / "recording.toml").write_text('clock = "gps"\n', encoding="utf-8")
    with pytest.raises(BadInput, match="clock = 'gps'; allowed is \"motion\""):
        read(tmp_path / "log.csv")
