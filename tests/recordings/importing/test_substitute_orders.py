"""Orders of other forms: a force and a moment by their units, two sticks, reports of the drives."""

import tomllib
from pathlib import Path

import numpy as np
import pytest

from boatsim.recordings.importing.channels import VesselChannel
from boatsim.recordings.importing.convert import convert_log
from boatsim.recordings.importing.log import Log, Signal
from boatsim.recordings.importing.mapping import parse_map
from boatsim.recordings.importing.mapping_proposal import propose_map

T = 0.1 * np.arange(900)
LEVER, COEFFICIENT, FULL = 0.4, 0.01, 100.0  # [m], [N s^2/rad^2], [rad/s]
DRIVES = [
    VesselChannel("n_port_radps", -FULL, FULL, 0, LEVER, (COEFFICIENT, COEFFICIENT)),
    VesselChannel("n_starboard_radps", -FULL, FULL, 0, -LEVER, (COEFFICIENT, COEFFICIENT)),
]
MEAN = 60.0 + 15.0 * np.sin(0.11 * T)  # [rad/s]
DIFFERENCE = 20.0 * np.sin(0.002 * T**2)
PORT, STARBOARD = MEAN + DIFFERENCE, MEAN - DIFFERENCE


def log_of(**orders: Signal) -> Log:
    """A boat that turns to starboard where her port drive turns faster, and some more signals."""
    psi = np.cumsum(0.01 * DIFFERENCE) * 0.1
    speed = 0.02 * MEAN
    signals = {
        "x_m": Signal(T, np.cumsum(speed * np.cos(psi)) * 0.1),
        "y_m": Signal(T, np.cumsum(speed * np.sin(psi)) * 0.1),
        "heading_deg": Signal(T, np.degrees(psi) % 360.0),
    }
    return Log(Path("log.csv"), signals | orders)


def columns_of(log: Log) -> tuple[str, dict[str, object]]:
    text = propose_map(log, None, DRIVES, ("surge", "sway", "yaw"))
    return text, tomllib.loads(text)["columns"]


def check_orders(log: Log, port: np.ndarray = PORT, starboard: np.ndarray = STARBOARD) -> None:
    """The proposed map converts the log to these shaft rates."""
    _, columns = columns_of(log)
    run = convert_log(log, parse_map({"columns": columns}, "map.toml"), "map.toml")
    at = np.round(run.t / 0.1).astype(int)
    assert run["n_port_radps"] == pytest.approx(port[at], abs=0.6)
    assert run["n_starboard_radps"] == pytest.approx(starboard[at], abs=0.6)


THRUSTS = [COEFFICIENT * n**2 for n in (PORT, STARBOARD)]
FORCE, MOMENT = THRUSTS[0] + THRUSTS[1], LEVER * (THRUSTS[0] - THRUSTS[1])


@pytest.mark.parametrize(
    ("force", "moment", "unit"),
    [
        ("Force cmd [N]", "Moment cmd [Nm]", "Nm"),
        ("thrust_setpoint", "torque_setpoint", "N m"),
    ],
)
def test_a_force_and_a_moment_without_axes_are_known_by_their_units(force, moment, unit):
    log = log_of(**{force: Signal(T, FORCE, "N"), moment: Signal(T, MOMENT, unit)})
    check_orders(log)


@pytest.mark.parametrize(
    ("force", "moment"),
    [("shaft thrust cmd", "shaft torque cmd"), ("force measured", "moment measured")],
)
def test_loads_of_a_part_and_measured_ones_are_no_orders(force, moment):
    log = log_of(**{force: Signal(T, FORCE, "N"), moment: Signal(T, MOMENT, "Nm")})
    text, _ = columns_of(log)
    assert "sum = [" not in text
