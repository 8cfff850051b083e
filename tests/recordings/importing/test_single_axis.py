"""Logs of a body with one degree of freedom: names, units by the motion, several turns."""

from pathlib import Path

import numpy as np
import pytest

from boatsim.diagnosis.log_check import check_files
from boatsim.physics import vessel
from boatsim.recordings import units
from boatsim.recordings.importing.channels import VesselChannel
from boatsim.recordings.importing.log import Log, Signal
from boatsim.recordings.importing.mapping_proposal import propose_map
from boatsim.recordings.table import read

T = np.arange(0.0, 20.0, 0.005)
ROLL = 2.0 * np.sin(1.3 * T) + 0.8 * T  # [rad] over the top several times
RATE = 2.6 * np.cos(1.3 * T) + 0.8  # [rad/s]
DRIVES = [VesselChannel("torque_Nm", -12.0, 12.0)]


def log_of(**signals: np.ndarray) -> Log:
    return Log(Path("log.csv"), {name: Signal(T, values) for name, values in signals.items()})


def proposed(dof: tuple[str, ...], scale: float = 1.0) -> list[str]:
    log = log_of(position=scale * ROLL, velocity=scale * RATE, torque=0.9 * np.sign(RATE))
    return propose_map(log, "pendulum", DRIVES, dof, turns_over="roll" in dof).splitlines()


def line_of(lines: list[str], column: str) -> str:
    return next((line for line in lines if line.startswith(f"{column} = ")), "")


def test_position_and_velocity_are_the_only_coordinate_and_its_rate() -> None:
    lines = proposed(("roll",))
    assert line_of(lines, "phi_rad").startswith('phi_rad = "position"  #')
    assert line_of(lines, "p_radps").startswith('p_radps = "velocity"  #')
    assert line_of(lines, "torque_Nm").startswith('torque_Nm = "torque"')
    assert not any("psi_rad" in line or line.startswith("rate") for line in lines)


def test_degrees_of_a_body_that_turns_over_are_found_by_its_motion() -> None:
    lines = proposed(("roll",), np.degrees(1.0))
    assert line_of(lines, "phi_rad").startswith('phi_rad = "position * deg"')
    assert line_of(lines, "p_radps").startswith('p_radps = "velocity * degps"')


def test_position_says_nothing_on_a_boat() -> None:
    lines = proposed(("surge", "sway", "yaw"))
    assert not line_of(lines, "phi_rad") and not line_of(lines, "x_m")


@pytest.mark.parametrize("wrapped", [False, True])
def test_a_roll_of_several_turns_is_read_and_runs_on(tmp_path: Path, wrapped: bool) -> None:
    roll = ROLL
    if wrapped:
        roll = np.angle(np.exp(1j * ROLL))
    file = tmp_path / "run.csv"
    table = np.column_stack([T, roll, 0.0 * T])
    np.savetxt(file, table, delimiter=",", header="t_s,phi_rad,torque_Nm", comments="")
    entries, refused = check_files([file], "pendulum")
    assert not refused and not [e for e in entries[file] if "degrees" in e["name"]]
    boat = vessel.load_vessel("pendulum")
    found = read(file, boat.limits(), boat.columns, boat.turns_over)["phi_rad"]
    assert found == pytest.approx(ROLL, abs=1e-6)


def test_a_hull_that_does_not_turn_over_still_has_its_degrees_found() -> None:
    swing = {"t_s": T, "phi_rad": 10.0 * np.sin(0.7 * T)}
    assert "phi_rad" in units.find_columns_in_degrees(swing)
    assert "phi_rad" not in units.find_columns_in_degrees(
        {"t_s": T, "phi_rad": ROLL}, turns_over=True
    )
    tumbling = {"t_s": T, "phi_rad": np.degrees(ROLL)}
    assert "phi_rad" in units.find_columns_in_degrees(tumbling, turns_over=True)
