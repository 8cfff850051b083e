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
RPM = 60.0 / (2.0 * np.pi)  # [1/min] per rad/s
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


@pytest.mark.parametrize(
    ("left", "right"),
    [("stick_left [%]", "stick_right [%]"), ("Stick port (%)", "Stick stbd (%)")],
)
def test_two_sticks_are_the_orders_of_the_two_drives_where_a_log_has_no_others(left, right):
    sticks = {left: Signal(T, PORT, "%"), right: Signal(T, STARBOARD, "%")}
    log = log_of(**sticks)
    text, columns = columns_of(log)
    check_orders(log)  # full command is 100 rad/s, so that per cent are rad/s
    assert "a stick is taken as the order of the drive" in text
    assert not [name for name in columns if name.startswith("stick_")]
    with_orders = log_of(
        **sticks,
        cmd_port_rpm=Signal(T, PORT * RPM),
        cmd_stbd_rpm=Signal(T, STARBOARD * RPM),
    )
    _, columns = columns_of(with_orders)
    assert columns["n_port_radps"] == "cmd_port_rpm * rpm"


def test_the_axes_of_one_stick_are_no_orders_of_drives():
    axes = {"stick_left_x": Signal(T, PORT / 100.0), "stick_right_x": Signal(T, STARBOARD / 100.0)}
    _, columns = columns_of(log_of(**axes))
    assert "n_port_radps" not in columns


@pytest.mark.parametrize(
    ("port", "starboard"),
    [
        ("rpm_feedback_port", "rpm_feedback_stbd"),
        ("ESC1.RPM", "ESC2.RPM"),
        ("ESC2.RPM", "ESC1.RPM"),  # the turning shows the side
    ],
)
def test_reported_shaft_rates_take_the_place_of_orders_with_a_remark(port, starboard):
    log = log_of(**{port: Signal(T, PORT * RPM), starboard: Signal(T, STARBOARD * RPM)})
    text, columns = columns_of(log)
    check_orders(log)
    said = "CHECK: reported, not ordered: lags between order and report cannot be found"
    assert text.count(said) == 2
    assert not [name for name in columns if name.startswith("actual_")]


def test_reports_next_to_orders_are_named_after_the_channel_of_the_vessel():
    orders = {"cmd_port_rpm": PORT, "cmd_stbd_rpm": STARBOARD}
    reports = {"actual_port_rpm": PORT, "actual_stbd_rpm": STARBOARD}
    signals = {}
    for name, values in {**orders, **reports}.items():
        signals[name] = Signal(T, values * RPM)
    text, columns = columns_of(log_of(**signals))
    assert columns["n_port_radps"] == "cmd_port_rpm * rpm"
    assert columns["actual_n_port_radps"] == "actual_port_rpm * rpm"
    assert columns["actual_n_starboard_radps"] == "actual_stbd_rpm * rpm"
    assert "not ordered" not in text and "actual_actual" not in text


def test_the_report_of_one_drive_is_no_order_of_the_other():
    signals = {
        "cmd_port_rpm": Signal(T, PORT * RPM),
        "rpm_feedback_port": Signal(T, PORT * RPM),
        "rpm_feedback_stbd": Signal(T, STARBOARD * RPM),
    }
    _, columns = columns_of(log_of(**signals))
    assert columns["n_port_radps"] == "cmd_port_rpm * rpm"
    assert columns["n_starboard_radps"] == "rpm_feedback_stbd * rpm"
    assert columns["actual_n_port_radps"] == "rpm_feedback_port * rpm"
