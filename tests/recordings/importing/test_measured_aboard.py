"""Inputs measured aboard, from the files of several loggers to the columns of a recording."""

from collections.abc import Mapping
from pathlib import Path

import boats
import numpy as np
import pytest
from raw_logs import imported

from boatsim.physics.base import Array

T = np.arange(0.0, 90.0, 0.2)
LATITUDE, LONGITUDE = 59.9, 10.7  # [deg] of the begin
RADIUS = 6.371e6  # [m]


def voyage() -> dict[str, Array]:
    """A boat that turns to both sides at about 1.5 m/s, with its orders."""
    turn = 0.12 * np.sign(np.sin(0.15 * T))
    psi = 0.3 + 0.2 * np.cumsum(
        np.convolve(np.append(np.zeros(9), turn), np.ones(10) / 10, "valid")
    )
    u = 1.5 + 0.2 * np.sin(0.1 * T)
    north, east = 0.2 * np.cumsum(u * np.cos(psi)), 0.2 * np.cumsum(u * np.sin(psi))
    return {"u": u, "psi": psi, "north": north, "east": east, "turn": turn}


def common_columns(run: Mapping[str, Array]) -> dict[str, Array]:
    """Times, positions, heading and orders as all of the loggers write them."""
    return {
        "time": 1.75e9 + T,
        "lat": LATITUDE + np.degrees(run["north"] / RADIUS),
        "lon": LONGITUDE + np.degrees(run["east"] / RADIUS / np.cos(np.radians(LATITUDE))),
        "heading_deg": np.degrees(run["psi"]) % 360.0,
        "thrust_port_N": 3.0 + 10.0 * run["turn"],
        "thrust_starboard_N": 3.0 - 10.0 * run["turn"],
    }


def boat(folder: Path, more: str) -> Path:
    return boats.written(folder, "measured", boats.PLANAR + more)


@pytest.mark.parametrize(
    ("column", "factor"),
    [("BAT.Curr", 1.0), ("Batteriestrom [A]", 1.0), ("battery_current_mA", 1e3), ("Ibat", -1.0)],
)
def test_a_current_of_the_supply_is_imported_in_amperes(
    tmp_path: Path, column: str, factor: float
) -> None:
    amperes = 20.0 + 12.0 * np.sin(0.4 * T)
    log = {**common_columns(voyage()), column: factor * amperes}
    vessel = boat(tmp_path, "\n[measured]\nbattery_A = { neutral = 30.0 }\n")
    recording, _ = imported(tmp_path, vessel, log)
    found = np.interp(T[20:-20], recording.t, recording["battery_A"])
    assert found == pytest.approx(amperes[20:-20], abs=0.6)


def test_a_map_states_what_a_vessel_without_these_inputs_needs(tmp_path: Path) -> None:
    amperes, volts = 20.0 + 12.0 * np.sin(0.4 * T), 24.5 - 0.01 * T
    log = {**common_columns(voyage()), "battery_current": amperes, "battery_voltage": volts}
    bare = boat(tmp_path, "")
    recording, text = imported(tmp_path, bare, log)
    assert "battery_A" not in recording.signals
    lines = [line.removeprefix("# ") for line in text.splitlines()]
    tables = "\n".join(line for line in lines if "= { neutral" in line)
    assert "battery_V = { neutral = 24" in tables and "battery_A = { neutral = 31" in tables
    (tmp_path / "second").mkdir()
    named = boat(tmp_path / "second", f"\n[measured]\n{tables}\n")
    recording, _ = imported(tmp_path / "second", named, log)
    assert {"battery_A", "battery_V"} <= set(recording.signals)


# ---- wind


def blown(run: Mapping[str, Array], seed: int = 0) -> tuple[Array, Array]:
    """Apparent wind [m/s] and its direction from the bow [rad], with gusts."""
    rng = np.random.default_rng(seed)
    kernel = np.exp(-0.2 * np.arange(60) / 4.0)
    gusts = np.convolve(rng.standard_normal(len(T) + 59), kernel, "valid") / np.sqrt(10.0)
    over_ground = -(4.0 + 0.5 * gusts) * np.exp(1j * (2.0 + 0.05 * np.roll(gusts, 50)))
    past = over_ground - run["u"] * np.exp(1j * run["psi"])
    past = past * np.exp(-1j * run["psi"])
    return abs(past), np.angle(-past)


APPARENT = """
[measured]
apparent_wind_mps = {}
apparent_wind_from_rad = {}
"""
KN = 1852.0 / 3600.0


@pytest.mark.parametrize(
    ("speed", "unit", "angle", "form"),
    [
        ("AWS", KN, "AWA", "degrees to both sides"),
        ("AWS [kn]", KN, "AWA [deg]", "degrees around"),
        ("wind_rel_speed_kmh", 1.0 / 3.6, "wind_rel_dir", "degrees around"),
        ("apparent wind speed", 1.0, "apparent wind angle", "radians"),
        ("Windgeschwindigkeit scheinbar", 1.0 / 3.6, "Windwinkel scheinbar", "degrees to port"),
        ("wind_speed", KN, "wind_angle", "degrees around"),  # the frame is not stated
        ("AWS", KN, "AWA", "degrees to which it goes"),
        ("rel_wind_speed_kn", KN, "rel_wind_to_deg", "degrees to which it goes"),
    ],
)
def test_an_apparent_wind_of_several_loggers_is_imported_in_metres_and_radians(
    tmp_path: Path, speed: str, unit: float, angle: str, form: str
) -> None:
    run = voyage()
    strength, comes_from = blown(run)
    written = {
        "degrees to both sides": np.degrees(comes_from),
        "degrees around": np.degrees(comes_from) % 360.0,
        "degrees to which it goes": np.degrees(comes_from + np.pi) % 360.0,
        "degrees to port": -np.degrees(comes_from) % 360.0,
        "radians": comes_from,
    }[form]
    log = {**common_columns(run), speed: strength / unit, angle: written}
    recording, text = imported(tmp_path, boat(tmp_path, APPARENT), log)
    rows = np.searchsorted(T, recording.t + 1e-6, side="right") - 1
    past = recording["apparent_wind_mps"] * np.exp(1j * recording["apparent_wind_from_rad"])
    true = (strength * np.exp(1j * comes_from))[rows]
    assert np.median(abs(past - true)) < 0.02 * np.median(strength), text


def test_a_unit_that_nothing_shows_is_asked(tmp_path: Path) -> None:
    run = voyage()
    wind = {"TWS": 8.0 + np.sin(0.1 * T), "TWD": 200.0 + 5.0 * np.sin(0.07 * T)}
    vessel = boat(tmp_path, "\n[measured]\nwind_mps = {}\nwind_from_rad = {}\n")
    recording, text = imported(tmp_path, vessel, {**common_columns(run), **wind})
    assert "wind_mps" not in recording.signals
    assert '# wind_mps = "TWS"' in text and "add * kn or * kmh" in text
    changes = {'# wind_mps = "TWS"': 'wind_mps = "TWS * kn"'}
    changes["# wind_from_rad = "] = "wind_from_rad = "
    recording, _ = imported(tmp_path, vessel, {**common_columns(run), **wind}, changes)
    assert np.mean(recording["wind_mps"]) == pytest.approx(8.0 * KN, rel=0.05)
    assert np.degrees(np.mean(recording["wind_from_rad"])) == pytest.approx(200.0, abs=1.0)


def test_a_direction_whose_name_contradicts_the_motion_is_asked(tmp_path: Path) -> None:
    run = voyage()
    strength, comes_from = blown(run)
    log = {**common_columns(run), "rel_wind_speed_kn": strength / KN}
    log["rel_wind_to_deg"] = np.degrees(comes_from) % 360.0
    recording, text = imported(tmp_path, boat(tmp_path, APPARENT), log)
    assert "apparent_wind_from_rad" not in recording.signals
    assert "the motion of the boat shows from which" in text
    assert '# apparent_wind_from_rad = "rel_wind_to_deg * deg + 180 * deg"' in text


def test_a_map_states_the_columns_of_the_wind_that_a_vessel_may_name(tmp_path: Path) -> None:
    run = voyage()
    strength, comes_from = blown(run)
    log = {**common_columns(run), "AWS": strength, "AWA": np.degrees(comes_from)}
    _, text = imported(tmp_path, boat(tmp_path, ""), log)
    assert "# apparent_wind_mps = { about" in text
    assert '# apparent_wind_from_rad = "AWA * deg"' in text
