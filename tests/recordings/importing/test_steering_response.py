"""Which output of a log is which drive, and which way a helm steers: told by what the boat does,
and said to be so."""

import tomllib
from pathlib import Path

import numpy as np
import pytest

from boatsim.recordings.importing.channels import VesselChannel
from boatsim.recordings.importing.log import Log, Signal
from boatsim.recordings.importing.mapping import parse_map
from boatsim.recordings.importing.mapping_proposal import propose_map

T = np.arange(0.0, 120.0, 0.1)
OUTBOARD = [
    VesselChannel("thrust_motor_N", -830.0, 1300.0),
    VesselChannel("steer_motor_rad", -0.7, 0.7, turns=-1),
]
TWIN = [
    VesselChannel("thrust_port_N", -73.0, 100.0),
    VesselChannel("thrust_starboard_N", -73.0, 100.0),
]


def steps(seed: int, low: float, high: float) -> np.ndarray:
    return np.repeat(np.random.default_rng(seed).uniform(low, high, 15), 80)


def follows(order: np.ndarray, lag: float) -> np.ndarray:
    found = np.zeros(len(order))
    for k in range(1, len(order)):
        found[k] = found[k - 1] + 0.1 / lag * (order[k] - found[k - 1])
    return found


HELM, THROTTLE = steps(1, -0.9, 0.9), steps(2, 0.0, 0.9)


def log_of(turned: np.ndarray, speed: np.ndarray, outputs: dict[str, Signal]) -> Log:
    """Of a boat that turns at `turned` [rad/s] to starboard and goes at `speed` [m/s]."""
    psi = np.cumsum(turned) * 0.1
    z = np.cumsum(speed * np.exp(1j * psi)) * 0.1
    poses = {"pose.north": Signal(T, z.real, "m"), "pose.east": Signal(T, z.imag, "m")}
    rates = {"pose.heading": Signal(T, psi, "rad"), "imu.yaw_rate": Signal(T, turned, "rad/s")}
    return Log(Path("log"), poses | rates | outputs, "NED")


def proposed(log: Log, drives: list[VesselChannel]) -> tuple[str, dict]:
    text = propose_map(log, "boat", drives, ("surge", "sway", "yaw"))
    parse_map(tomllib.loads(text), "map.toml")
    return text, tomllib.loads(text)["columns"]


def pulses(share: np.ndarray) -> Signal:
    return Signal(T, 1500.0 + 400.0 * share, "us")


@pytest.mark.parametrize("helm_first", [True, False])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_outputs_without_names_are_told_by_what_the_boat_does(
    helm_first: bool, sign: float
) -> None:
    both = [pulses(HELM), pulses(THROTTLE)]
    outputs = {f"servo.output[{k}]": s for k, s in enumerate(both if helm_first else both[::-1])}
    log = log_of(sign * 0.3 * follows(HELM, 0.8), 3.0 * follows(THROTTLE, 3.0), outputs)
    text, columns = proposed(log, OUTBOARD)
    helm, throttle = ("servo.output[0]", "servo.output[1]")[:: 1 if helm_first else -1]
    assert (columns["steer_motor_rad"]["signal"], columns["thrust_motor_N"]["signal"]) == (
        helm,
        throttle,
    )
    assert columns["steer_motor_rad"]["most"] == -sign * 0.7  # what is positive of it turns to port
    line = next(line for line in text.splitlines() if line.startswith("steer_motor_rad"))
    assert (
        "CHECK: chosen because the boat turns with it" in line
        and "full helm is assumed to be 40 deg" in line
    )
    assert ("sign inverted" in line) == (sign > 0.0)


def test_where_the_boat_shows_nothing_order_decides_and_it_is_said() -> None:
    still = np.zeros(len(T))
    log = log_of(
        still, still + 1.0, {"servo.output[0]": pulses(HELM), "servo.output[1]": pulses(THROTTLE)}
    )
    text, columns = proposed(log, OUTBOARD)
    assert columns["steer_motor_rad"]["most"] == 0.7  # no sign is turned on no evidence
    assert text.count("CHECK: by order only") == 2


def test_a_sign_is_left_alone_where_the_vessel_does_not_say_which_way_it_steers() -> None:
    outputs = {"rudder_cmd": Signal(T, 0.5 * HELM, "rad"), "throttle_cmd": pulses(THROTTLE)}
    log = log_of(-0.3 * follows(HELM, 0.8), 3.0 * follows(THROTTLE, 3.0), outputs)
    text, columns = proposed(log, [OUTBOARD[0], VesselChannel("rudder_rad", -0.6, 0.6)])
    assert columns["rudder_rad"] == "rudder_cmd" and "sign inverted" not in text


def test_shaft_and_rudder_of_a_network_are_proposed_and_what_is_assumed_is_said() -> None:
    outputs = {
        "RPM[1].shaft": Signal(T, 4000.0 * THROTTLE, "rpm"),
        "RSA.rudder_starboard": Signal(T, 35.0 * follows(HELM, 0.5), "deg"),
    }
    log = log_of(0.3 * follows(HELM, 0.8), 3.0 * follows(THROTTLE, 3.0), outputs)
    text, columns = proposed(log, OUTBOARD)
    assert columns["thrust_motor_N"]["signal"] == "RPM[1].shaft"
    assert columns["steer_motor_rad"] == "-RSA.rudder_starboard * deg"
    assert "the measured angle is used as the command" in text and "exponent = 2" in text


@pytest.mark.parametrize("first", ["port", "starboard"])
def test_engines_with_numbers_get_the_side_that_the_boat_turns_by(first: str) -> None:
    port, starboard = steps(3, 0.1, 0.9), steps(4, 0.1, 0.9)
    pair = [port, starboard] if first == "port" else [starboard, port]
    outputs = {f"RPM[{k}].shaft": Signal(T, 1800.0 * s, "rpm") for k, s in enumerate(pair, 1)}
    log = log_of(
        0.4 * follows(port - starboard, 0.8), 2.0 * follows(port + starboard, 3.0), outputs
    )
    text, columns = proposed(log, TWIN)
    number = 1 if first == "port" else 2
    assert columns["thrust_port_N"]["signal"] == f"RPM[{number}].shaft"
    assert columns["thrust_starboard_N"]["signal"] == f"RPM[{3 - number}].shaft"
    assert text.count("CHECK: side by the turning of the boat") == 2


def test_the_sign_of_a_thrust_is_never_turned_for_what_it_does_alone() -> None:
    port, starboard = steps(3, 0.1, 0.9), steps(4, 0.1, 0.9)
    outputs = {"thrust_left": pulses(port), "thrust_right": pulses(starboard)}
    log = log_of(-0.4 * follows(port, 0.8), 2.0 * follows(port + starboard, 3.0), outputs)
    text, columns = proposed(
        log,
        [
            VesselChannel(d.name, d.low, d.high, turns)
            for d, turns in zip(TWIN, (1, -1), strict=True)
        ],
    )
    assert (
        all(columns[d.name]["least"] < columns[d.name]["most"] for d in TWIN)
        and "sign inverted" not in text
    )


def test_one_helm_steers_both_motors_where_there_is_but_one() -> None:
    outputs = {"servo.output[0]": pulses(HELM)}
    outputs |= {
        f"servo.output[{k}]": pulses(THROTTLE + 0.1 * steps(4 + k, -1.0, 1.0)) for k in (1, 2)
    }
    drives = [
        *TWIN,
        *(
            VesselChannel(f"steer_{side}_rad", -0.5, 0.5, turns=-1)
            for side in ("port", "starboard")
        ),
    ]
    log = log_of(0.3 * follows(HELM, 0.8), 3.0 * follows(THROTTLE, 3.0), outputs)
    text, columns = proposed(log, drives)
    assert {columns[f"steer_{side}_rad"]["signal"] for side in ("port", "starboard")} == {
        "servo.output[0]"
    }
    assert {columns[d.name]["signal"] for d in TWIN} == {"servo.output[1]", "servo.output[2]"}
