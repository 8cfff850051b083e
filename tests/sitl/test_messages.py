"""What goes over the wire: servo outputs in, readings of the sensors out, and commands in between."""

import struct
from math import atan2, cos, hypot, pi, radians, sin
from pathlib import Path

import numpy as np
import pytest

from boatsim.errors import BadInput
from boatsim.physics.vessel import load_vessel
from boatsim.sitl.motion_sample import MotionSample, body_components, inertial_reading
from boatsim.sitl.sensor_message import apparent_wind, sensor_message
from boatsim.sitl.servo_map import (
    Servo,
    ServoMap,
    default_servo_map,
    servo_map_of_file,
    servo_map_of_options,
)
from boatsim.sitl.servo_packet import parse_servo_packet
from boatsim.sitl.surroundings import Surroundings, parse_numbers
from boatsim.sitl.task import SitlTask
from boatsim.sitl.true_wind import TrueWind
from tests.ardupilot_stand_in import read_message

GRAVITY = 9.80665
REST = MotionSample(0.0, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0))


def packet(magic: int, rate: int, outputs: int) -> bytes:
    return struct.pack(f"<HHI{outputs}H", magic, rate, 7, *range(1000, 1000 + outputs))


@pytest.mark.parametrize(("magic", "outputs"), [(18458, 16), (29569, 32)])
def test_a_packet_has_16_or_32_servo_outputs(magic: int, outputs: int) -> None:
    frame = parse_servo_packet(packet(magic, 50, outputs))
    assert frame is not None and (frame.rate, frame.counter) == (50, 7)
    assert frame.pulses == tuple(range(1000, 1000 + outputs))


@pytest.mark.parametrize(
    "malformed",
    [
        b"",
        b"{}",
        packet(18459, 50, 16),
        packet(18458, 0, 16),
        packet(18458, 50, 16)[:-1],
        packet(18458, 50, 16) + b"\0",
        packet(29569, 50, 16),
        packet(18458, 50, 32),
    ],
)
def test_any_other_packet_is_malformed(malformed: bytes) -> None:
    assert parse_servo_packet(malformed) is None


@pytest.mark.parametrize(
    ("vessel", "channels"),
    [
        ("otter", {1: ["n_port_radps"], 3: ["n_starboard_radps"]}),
        ("blueboat", {1: ["thrust_port_N"], 3: ["thrust_starboard_N"]}),
        ("twin_usv", {1: ["pwm_left_us"], 3: ["pwm_right_us"]}),
        (
            "joystick_boat",
            {1: ["steer_port_rad", "steer_starboard_rad"], 3: ["pwm_port", "pwm_starboard"]},
        ),
        ("catamaran", {1: ["azimuth_rad"], 3: ["thrust_N"]}),
        ("kvlcc2_mmg", {1: ["delta_rad"], 3: ["n_rps"]}),
        ("mariner", {1: ["delta_rad"]}),
    ],
)
def test_the_default_outputs_are_those_of_rovers_frames(
    vessel: str, channels: dict[int, list[str]]
) -> None:
    found: dict[int, list[str]] = {}
    for servo in default_servo_map(load_vessel(vessel)).servos:
        found.setdefault(servo.output, []).append(servo.channel)
    assert {output: sorted(names) for output, names in found.items()} == channels


def test_the_default_map_uses_the_whole_range_and_turns_to_starboard_for_long_pulses() -> None:
    skid = default_servo_map(load_vessel("blueboat"))
    assert skid.commands([2000, 0, 1000]) == {"thrust_port_N": 55.3, "thrust_starboard_N": -27.7}
    assert skid.commands([1750, 0, 1500]) == {"thrust_port_N": 27.65, "thrust_starboard_N": 0.0}
    steered = default_servo_map(load_vessel("joystick_boat")).commands([2000, 0, 1500])
    # thrust at the transom to port turns the bow to starboard
    assert steered == {
        "steer_port_rad": -0.7854,
        "steer_starboard_rad": -0.7854,
        "pwm_port": 0.0,
        "pwm_starboard": 0.0,
    }
    pulses = default_servo_map(load_vessel("twin_usv")).commands([1100, 0, 1900])
    assert pulses == {"pwm_left_us": 1100.0, "pwm_right_us": 1900.0}


def test_a_pulse_beyond_the_range_is_limited_and_no_signal_is_neutral() -> None:
    servo = Servo(1, "thrust_N", (-3.0, 1.0, 5.0), (1100.0, 1500.0, 1900.0))
    pulses = (0, 499, 900, 1100, 1300, 1500, 1700, 1900, 2100, 2501, 65535)
    expected = (1.0, 1.0, -3.0, -3.0, -1.0, 1.0, 3.0, 5.0, 5.0, 1.0, 1.0)
    assert tuple(map(servo.command, pulses)) == expected
    assert ServoMap((servo,)).commands([]) == {"thrust_N": 1.0}


def test_an_own_map_by_options_or_by_a_file(tmp_path: Path) -> None:
    vessel = load_vessel("otter")
    own = servo_map_of_options(vessel, ["2=n_port_radps", "4=-n_starboard_radps"])
    assert own.commands([0, 2000, 0, 2000]) == {"n_port_radps": 104.0, "n_starboard_radps": -104.0}
    file = tmp_path / "servos.toml"
    file.write_text(
        '[[servo]]\noutput = 5\nchannel = "n_port_radps"\npulse = [1100.0, 1500.0, 1900.0]\n'
        "command = [0.0, 0.0, 50.0]\n"
    )
    own = servo_map_of_file(vessel, file)
    assert own.commands([0] * 4 + [1900]) == {"n_port_radps": 50.0}
    assert own.describe() == ["servo output 5: n_port_radps, 1100 us 0, 1500 us 0, 1900 us 50"]


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "servo"),
        ('[[servo]]\noutput = 0\nchannel = "n_port_radps"', "output"),
        ('[[servo]]\noutput = 1\nchannel = "rudder"', "rudder"),
        ('[[servo]]\noutput = 1\nchannel = "n_port_radps"\npulse = [2.0, 1.0, 3.0]', "ascending"),
        ('[[servo]]\noutput = 1\nchannel = "n_port_radps"\ncommand = [0.0, 0.0, 900.0]', "900"),
        ('[[servo]]\noutput = 1\nchanel = "n_port_radps"', "chanel"),
        ("[[servo", "servos.toml"),
    ],
)
def test_a_mistake_in_a_map_is_named(text: str, said: str, tmp_path: Path) -> None:
    file = tmp_path / "servos.toml"
    file.write_text(text)
    with pytest.raises(BadInput, match=said):
        servo_map_of_file(load_vessel("otter"), file)


@pytest.mark.parametrize(
    "option", ["1", "x=n_port_radps", "1=rudder", "33=n_port_radps", "0=n_port_radps"]
)
def test_a_mistake_in_an_option_is_named(option: str) -> None:
    with pytest.raises(BadInput, match=f"--servo {option}"):
        servo_map_of_options(load_vessel("otter"), [option])
    with pytest.raises(BadInput, match="two servo outputs"):
        servo_map_of_options(load_vessel("otter"), ["1=n_port_radps", "2=n_port_radps"])


# ---- inertial unit


def test_an_inertial_unit_at_rest_measures_gravity_alone() -> None:
    later = REST._replace(t=0.02)
    assert inertial_reading(REST, later) == ((0.0, 0.0, 0.0), (0.0, 0.0, -GRAVITY))


def test_a_heeled_and_trimmed_hull_has_gravity_in_the_body_axes() -> None:
    roll, pitch = 0.3, -0.2
    attitude = (roll, pitch, 2.0)
    _, force = inertial_reading(
        REST._replace(attitude=attitude), REST._replace(t=0.02, attitude=attitude)
    )
    expected = (
        GRAVITY * sin(pitch),
        -GRAVITY * cos(pitch) * sin(roll),
        -GRAVITY * cos(pitch) * cos(roll),
    )
    assert np.allclose(force, expected, atol=1e-14)


def test_a_steady_turn_to_starboard_has_a_centripetal_acceleration_to_starboard() -> None:
    speed, rate, dt = 2.0, 0.5, 1e-3

    def turning(t: float) -> MotionSample:
        yaw = rate * t
        velocity = (speed * cos(yaw), speed * sin(yaw), 0.0)
        return MotionSample(t, (0.0, 0.0, 0.0), (0.0, 0.0, yaw), velocity)

    rates, force = inertial_reading(turning(1.0), turning(1.0 + dt))
    assert np.allclose(rates, (0.0, 0.0, rate), atol=1e-12)
    assert np.allclose(force, (0.0, speed * rate, -GRAVITY), atol=1e-6)


def test_body_rates_are_those_of_the_rotation_matrix() -> None:
    start, per_second, dt = np.array([0.4, -0.3, 1.2]), np.array([0.5, -0.7, 0.9]), 1e-5

    def rotation(attitude: np.ndarray) -> np.ndarray:  # earth to body
        return np.column_stack(
            [body_components(tuple(unit), tuple(attitude)) for unit in np.eye(3)]
        )

    before, after = start - 0.5 * dt * per_second, start + 0.5 * dt * per_second
    rates, _ = inertial_reading(
        REST._replace(attitude=tuple(before)), REST._replace(t=dt, attitude=tuple(after))
    )
    skew = -(rotation(after) - rotation(before)) / dt @ rotation(start).T
    assert np.allclose(rates, (skew[2, 1], skew[0, 2], skew[1, 0]), atol=1e-8)


# ---- message


def test_a_message_is_found_by_the_search_of_ardupilot() -> None:
    motion = MotionSample(12.34, (1e-7, -2.5, 0.1), (0.1, -0.2, 7.0), (0.5, -1e-12, 0.25))
    message = sensor_message(motion, inertial_reading(REST, motion), (3.0, -1.0))
    assert b" " not in message
    found = read_message(message)
    assert found["timestamp"] == (12.34,)
    assert found["position"] == motion.position and found["velocity"] == motion.velocity
    assert np.allclose(found["attitude"], (0.1, -0.2, 7.0 - 2.0 * pi))
    assert np.allclose(found["imu.gyro"], inertial_reading(REST, motion).rates)
    assert np.allclose(found["imu.accel_body"], inertial_reading(REST, motion).specific_force)
    assert found["windvane.speed"] == pytest.approx((hypot(2.5, -1.0),))
    assert "windvane.speed" not in read_message(
        sensor_message(motion, inertial_reading(REST, motion))
    )


@pytest.mark.parametrize(
    ("heading", "velocity", "direction", "speed"),
    [
        (0.0, (0.0, 0.0, 0.0), 0.0, 5.0),  # wind from the north, head to wind
        (90.0, (0.0, 0.0, 0.0), -90.0, 5.0),  # it comes from port
        (-90.0, (0.0, 0.0, 0.0), 90.0, 5.0),
        (0.0, (5.0, 0.0, 0.0), 0.0, 10.0),
        (0.0, (-5.0, 0.0, 0.0), 0.0, 0.0),
        (0.0, (0.0, 5.0, 0.0), 45.0, 50.0**0.5),
    ],
)
def test_the_vane_shows_the_apparent_wind(
    heading: float, velocity: tuple[float, float, float], direction: float, speed: float
) -> None:
    motion = REST._replace(attitude=(0.0, 0.0, radians(heading)), velocity=velocity)
    found = apparent_wind(motion, (-5.0, 0.0))
    assert found == pytest.approx({"direction": radians(direction), "speed": speed})


# ---- surroundings


def test_wind_waves_and_current_are_added_or_set() -> None:
    given = Surroundings(wind=(6.0, 270.0), waves=(0.2, 2.5, 0.0), current=(0.5, 90.0))
    vessel = SitlTask("otter", surroundings=given).scenario.vessel
    assert TrueWind(vessel).velocity(3.0) == pytest.approx((0.0, 6.0))
    assert vessel.effect("current").values()[:2] == pytest.approx((0.0, 0.5))
    sea = vessel.effect("strip_wave_loads").values()
    assert sea.significant_height == 0.2 and abs(sea.toward) == pytest.approx(pi)
    calmer = Surroundings(waves=(0.1, 2.0, 90.0))
    vessel = SitlTask("otter", "beam_sea", surroundings=calmer).scenario.vessel
    sea = vessel.effect("strip_wave_loads").values()
    assert sea.significant_height == 0.1 and sea.hull_spacing == 0.79
    assert TrueWind(vessel).velocity(0.0) is None


@pytest.mark.parametrize("text", ["", "5", "5,x", "-5,90", "5,90,1", "nan,3", "5,inf"])
def test_a_wind_of_other_numbers_is_refused(text: str) -> None:
    with pytest.raises(BadInput, match="--wind"):
        parse_numbers("--wind", text, ("SPEED", "FROM"))


def test_a_vessel_without_surge_and_yaw_is_refused() -> None:
    with pytest.raises(BadInput, match="cannot surge and yaw"):
        SitlTask("kvlcc2_roll")


def test_directions_agree_with_the_compass() -> None:
    north, east = TrueWind(
        SitlTask("blueboat", surroundings=Surroundings(wind=(4.0, 45.0))).scenario.vessel
    ).velocity(0.0) or (0.0, 0.0)
    assert atan2(east, north) == pytest.approx(radians(45.0 - 180.0))  # from the north-east
