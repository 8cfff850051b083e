"""Outputs without telling names go to the drives that the motion shows, or the owner is asked."""

import tomllib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from boatsim.recordings.importing.channels import VesselChannel
from boatsim.recordings.importing.log import Log, Signal
from boatsim.recordings.importing.mapping import parse_map
from boatsim.recordings.importing.mapping_proposal import propose_map

T = np.arange(0.0, 240.0, 0.1)
DOF = ("surge", "sway", "yaw")
PORT = VesselChannel("thrust_port_N", -50.0, 50.0, 0, 0.4)
STARBOARD = VesselChannel("thrust_starboard_N", -50.0, 50.0, 0, -0.4)
MOTOR = VesselChannel("thrust_motor_N", -800.0, 1300.0)
HELM = VesselChannel("steer_motor_rad", -0.6, 0.6, 1)
BOW = [replace(PORT, name="bow_port_N"), replace(STARBOARD, name="bow_starboard_N")]
STERN = [replace(PORT, name="stern_port_N"), replace(STARBOARD, name="stern_starboard_N")]
UNITS = {"pulses": (400.0, 1500.0), "per cent": (100.0, 0.0), "shares": (1.0, 0.0)}


def steps(seed: int) -> np.ndarray:
    """Random orders from -1 to 1, each for 4 s."""
    return np.repeat(np.random.default_rng(seed).uniform(-0.6, 1.0, 60), 40)


def lagged(order: np.ndarray, lag: float) -> np.ndarray:
    found = np.zeros(len(order))
    for k in range(1, len(order)):
        found[k] = found[k - 1] + 0.1 / lag * (order[k] - found[k - 1])
    return found


def log_of(push: np.ndarray, turn: np.ndarray, outputs: dict[str, np.ndarray]) -> Log:
    """Log of a boat that gathers way after `push` and turns to starboard after `turn`."""
    rng = np.random.default_rng(9)
    u, r = 1.5 * lagged(push, 3.0), 0.3 * lagged(turn, 0.8)
    psi = 0.4 + 0.1 * np.cumsum(r)
    z = 0.1 * np.cumsum(u * np.exp(1j * psi)) + 0.01 * (rng.normal(size=(2, len(T))).T @ [1, 1j])
    heading = np.degrees(psi + 0.01 * rng.normal(size=len(T))) % 360.0
    poses = {"x_m": z.real, "y_m": z.imag, "heading_deg": heading}
    signals = {name: Signal(T, values) for name, values in (poses | outputs).items()}
    return Log(Path("log.csv"), signals)


def proposed(log: Log, drives: list[VesselChannel]) -> tuple[dict, str]:
    text = propose_map(log, "boat", drives, DOF)
    parse_map(tomllib.loads(text), "map.toml")
    return tomllib.loads(text)["columns"], text


def signal_of(column) -> str:
    if isinstance(column, dict):
        return column["signal"]
    return column.lstrip("-").split(" ")[0]


def twin(names: tuple[str, str], unit: str = "shares", **more: np.ndarray) -> Log:
    """Log of a boat with the port and the starboard thruster of these names."""
    port, starboard = steps(1), steps(2)
    factor, neutral = UNITS[unit]
    outputs = {names[0]: neutral + factor * port, names[1]: neutral + factor * starboard}
    outputs = {name: outputs[name] for name in sorted(outputs)}
    return log_of(0.5 * (port + starboard), port - starboard, outputs | more)


@pytest.mark.parametrize("unit", UNITS)
@pytest.mark.parametrize(
    "names",
    [("m1", "m2"), ("m2", "m1"), ("ch3", "ch1"), ("out1", "out3"), ("act_2", "act_1")]
    + [("servo3", "servo1"), ("servo1_us", "servo3_us"), ("u1", "u2"), ("a2", "a1")],
)
def test_sum_and_difference_show_the_sides_of_two_drives(names, unit):
    columns, text = proposed(twin(names, unit), [PORT, STARBOARD])
    assert signal_of(columns["thrust_port_N"]) == names[0]
    assert signal_of(columns["thrust_starboard_N"]) == names[1]
    assert "CHECK" in text
    assert "which of" not in text


@pytest.mark.parametrize("names", [("m4", "m2"), ("m2", "m4")])
def test_other_numbered_signals_are_left_out(names):
    noise = np.random.default_rng(5).normal(size=(3, len(T)))
    more = {"m1": noise[0], "m3": np.cumsum(noise[1]), "m5": steps(7), "temp1": noise[2]}
    columns, text = proposed(twin(names, "pulses", **more), [PORT, STARBOARD])
    assert signal_of(columns["thrust_port_N"]) == names[0]
    assert signal_of(columns["thrust_starboard_N"]) == names[1]
    assert "by the motion, for with it the boat goes ahead" in text


def test_a_copy_of_an_output_does_not_hide_it():
    log = twin(("m2", "m1"), "pulses", q7=steps(8))
    copy = {"ch1": Signal(T, 3.0 * log.signals["m1"].values)}
    columns, _ = proposed(replace(log, signals={**log.signals, **copy}), [PORT, STARBOARD])
    assert signal_of(columns["thrust_port_N"]) == "m2"
    assert signal_of(columns["thrust_starboard_N"]) == "m1"


@pytest.mark.parametrize("first", [1, 3])
def test_the_motion_shows_the_sides_of_four_drives_and_the_owner_is_asked_for_the_rest(first):
    orders = {f"m{first + i}": steps(20 + i) for i in range(4)}
    starboard = [orders[f"m{first}"], orders[f"m{first + 3}"]]
    port = [orders[f"m{first + 1}"], orders[f"m{first + 2}"]]
    push = 0.25 * sum(orders.values())
    log = log_of(push, 0.5 * (sum(port) - sum(starboard)), orders)
    columns, text = proposed(log, [*BOW, *STERN])
    got = {name: signal_of(columns[name]) for name in columns if name.endswith("_N")}
    assert {got["bow_port_N"], got["stern_port_N"]} == {f"m{first + 1}", f"m{first + 2}"}
    assert {got["bow_starboard_N"], got["stern_starboard_N"]} == {f"m{first}", f"m{first + 3}"}
    questions = [line for line in text.splitlines() if line.startswith("# CHECK: which of")]
    assert len(questions) == 2
    assert f"m{first + 1}, m{first + 2} are bow_port_N and stern_port_N?" in questions[0]


def test_the_motion_goes_before_the_numbers_of_drives():
    orders = {f"motor{i}": steps(30 + i) for i in range(1, 5)}
    starboard, port = orders["motor1"] + orders["motor4"], orders["motor2"] + orders["motor3"]
    log = log_of(0.25 * (port + starboard), 0.5 * (port - starboard), orders)
    columns, text = proposed(log, [*BOW, *STERN])
    assert signal_of(columns["bow_starboard_N"]) in ("motor1", "motor4")
    assert "CHECK: by number" not in text
    in_order = {"motor1": "motor2", "motor2": "motor1", "motor3": "motor3", "motor4": "motor4"}
    renamed = {in_order.get(name, name): s for name, s in log.signals.items()}
    _, text = proposed(replace(log, signals=renamed), [*BOW, *STERN])
    assert "CHECK: by number" in text


@pytest.mark.parametrize("names", [("out1", "out3"), ("out3", "out1"), ("m1", "m2")])
@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_an_angle_steers_and_a_throttle_pushes(names, sense):
    throttle, helm = steps(1), steps(2)
    outputs = {names[0]: 100.0 * throttle, names[1]: 34.0 * helm, "out5": steps(4)}
    columns, text = proposed(log_of(throttle, sense * helm, outputs), [MOTOR, HELM])
    assert signal_of(columns["thrust_motor_N"]) == names[0]
    assert signal_of(columns["steer_motor_rad"]) == names[1]
    assert columns["steer_motor_rad"] == ("-" if sense < 0.0 else "") + f"{names[1]} * deg"
    assert ("sign inverted" in text) == (sense < 0.0)


@pytest.mark.parametrize(("unit", "sense"), [("pulses", 1.0), ("shares", -1.0)])
def test_channels_of_a_mixer_are_mixed(unit, sense):
    factor, neutral = UNITS[unit]
    throttle, steering = steps(1), steps(2)
    outputs = {"ch1": neutral + factor * steering, "ch3": neutral + factor * throttle}
    outputs["ch5"] = neutral + factor * steps(6)
    columns, text = proposed(log_of(throttle, sense * steering, outputs), [PORT, STARBOARD])
    for name, side in (("thrust_port_N", sense), ("thrust_starboard_N", -sense)):
        first, second = columns[name]["sum"]
        assert signal_of(first) == "ch3" and signal_of(second) == "ch1"
        if unit == "pulses":
            assert (first["most"], second["most"]) == (50.0, 50.0 * side)
        else:
            assert second.startswith("-") == (side < 0.0)
    assert "mixed in equal shares" in text


def test_a_drive_that_pulls_astern_is_pointed_out():
    log = twin(("m1", "m2"), "shares", m3=steps(6))
    reversed_one = replace(log.signals["m2"], values=-log.signals["m2"].values)
    log = replace(log, signals={**log.signals, "m2": reversed_one})
    columns, text = proposed(log, [PORT, STARBOARD])
    assert signal_of(columns["thrust_starboard_N"]) == "m2"
    assert "goes astern" in text and "is its sign reversed?" in text


@pytest.mark.parametrize("count", [2, 3])
def test_one_question_is_asked_where_nothing_decides(count):
    """The boat drifts; its outputs do nothing."""
    rng = np.random.default_rng(3)
    outputs = {f"m{i}": steps(40 + i) for i in range(1, count + 1)}
    drift = lagged(rng.normal(size=len(T)), 2.0)
    columns, text = proposed(log_of(1.0 + drift, drift[::-1], outputs), [PORT, STARBOARD])
    questions = [line for line in text.splitlines() if "CHECK: which of" in line]
    assert len(questions) == 1
    assert "Neither names nor the motion show it" in questions[0]
    assert ("thrust_port_N" in columns) == (count == 2)


def test_drives_that_are_always_commanded_together_are_asked_for():
    both = steps(1)
    rng = np.random.default_rng(3)
    outputs = {"m1": both + 0.02 * rng.normal(size=len(T)), "m2": both, "m3": steps(4)}
    columns, text = proposed(log_of(both, 0.1 * steps(5), outputs), [PORT, STARBOARD])
    assert "thrust_port_N" not in columns
    assert "# CHECK: which of m1, m2, m3 are thrust_port_N and thrust_starboard_N?" in text


def test_sensors_with_numbers_are_no_outputs():
    noise = np.random.default_rng(5).normal(size=(4, len(T)))
    sensors = {"temp1": noise[0], "temp2": noise[1], "cell_1": noise[2], "probe2": noise[3]}
    columns, text = proposed(log_of(steps(1), steps(2), sensors), [PORT, STARBOARD])
    assert "thrust_port_N" not in columns
    assert "which of" not in text


def test_without_a_vessel_the_outputs_are_only_named():
    text = propose_map(twin(("m1", "m2")), None)
    assert "# m1, m2 may be outputs to drives: --vessel shows which" in text
    assert "m1" not in str(tomllib.loads(text))


def test_named_orders_are_not_replaced():
    log = twin(("m1", "m2"))
    named = {"rpm_port": Signal(T, 40.0 * steps(11)), "rpm_starboard": Signal(T, 40.0 * steps(12))}
    columns, _ = proposed(replace(log, signals={**log.signals, **named}), [PORT, STARBOARD])
    assert signal_of(columns["thrust_port_N"]) == "rpm_port"
