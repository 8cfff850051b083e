"""A current by the speed through the water: its slope in closed form, names and units of logs."""

from pathlib import Path

import boats
import numpy as np
import pytest
from raw_logs import imported

from boatsim.errors import BadInput
from boatsim.physics.base import Array
from boatsim.recordings.importing.conversion_state import ConversionState
from boatsim.recordings.importing.currents import current_columns, slope_over_window
from boatsim.recordings.importing.log import Log, Signal
from boatsim.recordings.importing.mapping import Map
from boatsim.recordings.importing.water_speed_table import WaterSpeed
from boatsim.recordings.importing.water_speeds import water_speeds_of_log

T = np.arange(0.0, 240.0, 0.5)
CURRENT = 0.4 - 0.3j  # [m/s] north + i east
KN = 1852.0 / 3600.0
NAMED = "\n[measured]\ncurrent_north_mps = {}\ncurrent_east_mps = {}\n"


def logged(leeway: float = 0.0, seed: int = 1) -> tuple[dict[str, Array], Array, Array]:
    """Columns of a boat that turns in a current, and its speeds through the water [m/s]."""
    rng = np.random.default_rng(seed)
    psi = 2.5 * np.sin(0.05 * T)
    ahead = 1.8 + 0.3 * np.sin(0.11 * T)
    across = np.full(len(T), leeway)
    velocity = (ahead + 1j * across) * np.exp(1j * psi) + CURRENT
    place = np.append(0.0, np.cumsum(0.25 * (velocity[1:] + velocity[:-1])))
    place += 0.2 * (rng.standard_normal(len(T)) + 1j * rng.standard_normal(len(T)))
    columns = {
        "time": T,
        "x_m": place.real,
        "y_m": place.imag,
        "heading_deg": np.degrees(psi) % 360.0,
        "thrust_port_N": 3.0 + np.sin(0.2 * T),
        "thrust_starboard_N": 3.0 - np.sin(0.2 * T),
    }
    return columns, ahead + 0.02 * rng.standard_normal(len(T)), across


@pytest.mark.parametrize("window", [5.0, 30.0, 1000.0])
def test_the_slope_of_a_straight_line_is_exact_for_every_window(window: float) -> None:
    t = np.cumsum(np.random.default_rng(1).uniform(0.4, 0.6, 200))
    found = slope_over_window(t, (0.3 - 0.2j) * t + 4.0, window)
    assert found == pytest.approx(np.full(200, 0.3 - 0.2j))


@pytest.mark.parametrize(
    ("name", "factor"),
    [
        ("STW", KN),
        ("STW_kn", KN),
        ("speed through water [m/s]", 1.0),
        ("log_speed", 1.0 / 3.6),
        ("VHW.speed_water", KN),
        ("FdW [kn]", KN),
        ("paddlewheel", 1.0),
    ],
)
def test_the_current_of_several_loggers_is_the_known_one(
    tmp_path: Path, name: str, factor: float
) -> None:
    columns, ahead, _ = logged()
    vessel = boats.written(tmp_path, "carried", boats.PLANAR + NAMED)
    recording, text = imported(tmp_path, vessel, {**columns, name: ahead / factor})
    assert np.median(recording["current_north_mps"]) == pytest.approx(CURRENT.real, abs=0.02), text
    assert np.median(recording["current_east_mps"]) == pytest.approx(CURRENT.imag, abs=0.02), text


def test_a_sideways_speed_through_the_water_is_no_current(tmp_path: Path) -> None:
    columns, ahead, across = logged(leeway=0.3)
    vessel = boats.written(tmp_path, "carried", boats.PLANAR + NAMED)
    change = {'speed = "STW_kn * kn"\n': 'speed = "STW_kn * kn"\nacross = "side_mps"\n'}
    log = {**columns, "STW_kn": ahead / KN, "side_mps": across}
    recording, _ = imported(tmp_path, vessel, log, change)
    assert recording["current_north_mps"] == pytest.approx(CURRENT.real, abs=0.05)


def test_a_boat_on_a_straight_course_does_not_show_the_unit() -> None:
    columns, ahead, _ = logged()
    log = Log(Path("run.csv"), {"STW": Signal(T, ahead / KN)})
    (speed,) = water_speeds_of_log(log, None, None)
    assert speed.is_open and "add * kn" in speed.note


@pytest.mark.parametrize("name", ["SOG", "wind_speed", "current_speed", "water_temperature", "log"])
def test_other_speeds_are_not_those_through_the_water(name: str) -> None:
    log = Log(Path("run.csv"), {name: Signal(T, np.sin(T))})
    assert water_speeds_of_log(log, None, None) == []


def test_a_map_states_what_a_vessel_without_a_current_needs(tmp_path: Path) -> None:
    columns, ahead, _ = logged()
    vessel = boats.written(tmp_path, "bare", boats.PLANAR)
    recording, text = imported(tmp_path, vessel, {**columns, "STW_kn": ahead / KN})
    assert "# current_north_mps = { about" in text and "# [current]" in text
    assert "current_north_mps" not in recording.signals


@pytest.mark.parametrize("empty", ["x_m", "psi_rad"])
def test_a_column_of_the_pose_without_any_value_is_stated_in_one_line(empty: str) -> None:
    log = Log(Path("run.csv"), {"STW": Signal(T, np.ones(len(T)))})
    work = ConversionState(log, "map.toml", Map.model_construct(), {})
    poses = {name: np.sin(0.1 * T) for name in ("x_m", "y_m", "psi_rad")}
    poses[empty] = np.full(len(T), np.nan)
    with pytest.raises(BadInput, match=f"map.toml: current needs values of {empty}$"):
        current_columns(work, T, poses, WaterSpeed(speed="STW"))
