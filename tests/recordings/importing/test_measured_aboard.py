"""What is measured aboard, from the files of several loggers to the columns of a recording."""

import csv
from collections.abc import Mapping
from pathlib import Path

import boats
import numpy as np
import pytest
from typer.testing import CliRunner

from boatsim.cli.commands import app
from boatsim.physics.base import Array
from boatsim.recordings.table import Recording, read

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


def imported(
    folder: Path, vessel: Path, log: Mapping[str, Array], change: Mapping[str, str] | None = None
) -> tuple[Recording, str]:
    """The recording after a proposal and a conversion, and the proposed map.

    `change` are texts of the map that its owner replaces.
    """
    names = [folder / name for name in ("raw.csv", "map.toml", "run.csv")]
    with open(names[0], "w", newline="") as file:
        rows = csv.writer(file)
        rows.writerow(log)
        for row in zip(*log.values(), strict=True):
            rows.writerow([f"{x:.9g}" if x < 1e6 else f"{x:.3f}" for x in row])
    raw, proposal, out = map(str, names)
    done = CliRunner().invoke(app, ["import", raw, "--vessel", str(vessel), "--propose", proposal])
    assert done.exit_code == 0, done.output
    text = names[1].read_text()
    for old, new in (change or {}).items():
        assert old in text
        text = text.replace(old, new)
    names[1].write_text(text)
    done = CliRunner().invoke(app, ["import", raw, "--map", proposal, "--out", out])
    assert done.exit_code == 0, done.output
    return read(names[2]), text


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
