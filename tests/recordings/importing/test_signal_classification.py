"""What signals are taken for, by names that autopilots, robots and spreadsheets really use."""

from pathlib import Path

import numpy as np
import pytest

from boatsim.recordings.importing.channels import VesselChannel
from boatsim.recordings.importing.log import Log, Signal
from boatsim.recordings.importing.mapping_proposal import propose_map
from boatsim.recordings.importing.signal_classification import classify_signal

T = np.linspace(0.0, 60.0, 600)
NAMES = """
GPS.Lat 59 60 deg latitude deg
vehicle_global_position.lat 50 51 deg latitude deg
/fix.latitude -33 -32 deg latitude deg
lat 500000000 510000000 - latitude deg*1e-7
lon_deg 8 9 deg longitude deg
vehicle_local_position.ref_lat 50 51 - nothing -
ATT.Yaw 0 359 deg psi_rad deg
ATT.DesYaw 0 359 deg nothing -
/imu/data.orientation.yaw -3 3 rad psi_rad -
hdg 0 359 - psi_rad deg
psi -3 3 - psi_rad -
Heading_(deg) 0 359 deg psi_rad deg
Course 0 359 - nothing -
IMU.GyrZ -0.2 0.2 rad/s r_radps -
sensor_combined.gyro_rad[2] -0.2 0.2 - r_radps -
/odom.twist.twist.angular.z -1 1 rad/s r_radps -
yawrate_dps -20 20 - r_radps degps
rate_of_turn -99 99 deg/min r_radps degpmin
yaw_rad_s -0.3 0.3 - r_radps -
XKF1.PN 0 30 m x_m -
y_east 0 30 - y_m -
current_speed_north -1 1 m/s nothing -
vel_east_mps -1 1 m/s nothing -
pos_x 0 30 - x_m -
vehicle_local_position.x 0 30 m x_m -
vehicle_local_position.vx 0 3 m/s nothing -
vehicle_local_position_setpoint.x 0 3 m nothing -
surge_velocity 0 2 - u_mps -
sway_m -0.1 0.1 - y_m -
heave_mm -20 20 - z_m mm
roll_deg -3 3 deg phi_rad deg
RCOU.C1 1100 1900 us command us
RCIN.C1 1100 1900 us stick us
/mavros/rc/out.channels[0] 1100 1900 - command -
/mavros/rc/in.channels[0] 1100 1900 - stick -
manual_control_setpoint.throttle -1 1 - stick -
/joy.axes[1] -1 1 - stick -
ESC.RPM 0 3000 rpm actual rpm
rudder -20 20 - command deg
rudder_rad -0.3 0.3 rad command -
motor1 1100 1900 - command -
rpm_port 0 800 - command rpm
n1 0 10 - command -
left_pct -100 100 - command percent
right_pct 0 80 - command percent
L_pct -100 100 - command percent
Starboard_(%) -100 100 % command percent
battery_pct 0 100 - nothing -
wheel_deg -30 30 - command deg
wheel -30 30 - command deg
wheel -540 540 - command deg
wheel_speed 0 5 - nothing -
tiller -40 40 - command deg
/cmd_vel.linear.x 0 1 m/s nothing -
battery_voltage 11 12 - nothing -
BARO.Temp 20 30 - nothing -
wind_speed 0 9 - nothing -
"""


def log_of(frame: str = "", **signals: tuple[float, float]) -> Log:
    return Log(
        Path("log"), {n: Signal(T, np.linspace(*ends, 600)) for n, ends in signals.items()}, frame
    )


@pytest.mark.parametrize("line", NAMES.strip().splitlines(), ids=lambda line: line.split()[0])
def test_a_name_with_its_unit_and_range_says_what_a_signal_is(line):
    name, low, high, unit, column, word = line.split()
    frame = "ENU" if name.startswith("/") else "NED" if "." in name else ""
    signal = Signal(T, np.linspace(float(low), float(high), 600), "" if unit == "-" else unit)
    found = classify_signal(name.replace("_(", " ("), signal, Log(Path("log"), {}, frame))
    assert (found.column if found else "nothing") == column
    assert ((found.word.replace(" ", "") if found else "") or "-") == word


def test_what_stands_still_is_no_latitude_and_what_has_few_samples_is_nothing():
    assert classify_signal("lat", Signal(T, np.zeros(600)), log_of()) is None
    assert classify_signal("yaw", Signal(T[:5], T[:5]), log_of()) is None


def test_a_compass_counts_from_north_in_a_log_of_ros_too():
    signals = {"/compass_hdg.data": Signal(T, np.linspace(0.0, 350.0, 600))}
    assert 'psi_rad = "/compass_hdg.data * deg"' in propose_map(Log(Path("log"), signals, "ENU"))
    signals = {"/imu.orientation.yaw": Signal(T, np.linspace(0.0, 3.0, 600), "rad")}
    assert 'psi_rad = "-/imu.orientation.yaw + 90 * deg"' in propose_map(
        Log(Path("log"), signals, "ENU")
    )


def test_channels_get_the_signals_of_their_side_and_per_cent_becomes_their_range():
    drives = [
        VesselChannel("thrust_port_N", -27.7, 55.3),
        VesselChannel("thrust_starboard_N", -27.7, 55.3),
    ]
    text = propose_map(
        log_of(motor_right=(-80.0, 90.0), motor_left=(-80.0, 91.0), psi=(0.0, 3.0)), "v", drives
    )
    ends = "low = -100, neutral = 0, high = 100, least = -27.7, most = 55.3"
    assert f'thrust_port_N = {{ signal = "motor_left", {ends} }}' in text
    assert f'thrust_starboard_N = {{ signal = "motor_right", {ends} }}' in text


def test_per_cent_of_two_sides_are_shares_of_full_thrust_of_these_sides():
    drives = [VesselChannel("thrust_port_N", -30.0, 60.0)]
    drives.append(VesselChannel("thrust_starboard_N", -30.0, 60.0))
    text = propose_map(log_of(right_pct=(-50.0, 90.0), left_pct=(-40.0, 80.0)), "v", drives)
    ends = "low = -100, neutral = 0, high = 100, least = -30, most = 60"
    assert f'thrust_port_N = {{ signal = "left_pct", {ends} }}' in text
    assert f'thrust_starboard_N = {{ signal = "right_pct", {ends} }}' in text


def test_revolutions_beside_per_cent_are_offered_as_another_line():
    drives = [VesselChannel("thrust_port_N", -30.0, 60.0)]
    drives.append(VesselChannel("thrust_starboard_N", -30.0, 60.0))
    signals = {f"{side}_pct": (-50.0, 90.0) for side in ("left", "right")}
    signals |= {f"rpm_{side}": (-900.0, 2000.0) for side in ("left", "right")}
    text = propose_map(log_of(**signals), "v", drives)
    assert 'thrust_port_N = { signal = "left_pct"' in text
    assert '# or by revolutions: thrust_port_N = { signal = "rpm_left"' in text


def test_revolutions_of_a_thruster_become_thrust_by_their_square():
    text = propose_map(log_of(rpm=(0.0, 2400.0)), "v", [VesselChannel("thrust_motor_N", -30, 60)])
    ends = "low = -2400, neutral = 0, high = 2400, least = -30, most = 60, exponent = 2"
    assert f'thrust_motor_N = {{ signal = "rpm", {ends} }}' in text
    text = propose_map(log_of(rpm=(0.0, 2400.0)), "v", [VesselChannel("n_motor_radps", 0, 252)])
    assert 'n_motor_radps = "rpm * rpm"' in text


def test_a_raw_command_of_the_vessel_is_not_scaled():
    drives = [VesselChannel("throttle_motor", -100.0, 100.0)]
    text = propose_map(log_of(throttle_pct=(-50.0, 90.0)), "v", drives)
    assert 'throttle_motor = "throttle_pct"  #' in text
    pulses = Log(Path("log"), {"motor": Signal(T, np.linspace(1150.0, 1800.0, 600), "us")})
    text = propose_map(pulses, "v", [VesselChannel("throttle_motor", 1100.0, 1900.0)])
    assert 'throttle_motor = "motor"  #' in text


@pytest.mark.parametrize(
    ("limit", "line"),
    [
        (40.0, 'rudder_rad = "wheel * deg"'),
        (20.0, '{ signal = "wheel", low = -30, neutral = 0, high = 30, least = -0.349066'),
    ],
)
def test_a_wheel_is_the_angle_of_the_rudder_or_geared_to_it(limit, line):
    most = np.radians(limit)
    text = propose_map(log_of(wheel=(-30.0, 30.0)), "v", [VesselChannel("rudder_rad", -most, most)])
    assert line in text


@pytest.mark.parametrize(
    ("name", "largest", "limit", "line"),
    [
        ("azimuth_port_deg", 180.0, 90.0, 'steer_port_rad = "azimuth_port_deg * deg"'),
        ("azi_port_deg", 180.0, 90.0, 'steer_port_rad = "azi_port_deg * deg"'),
        ("wheel_port_deg", 180.0, 90.0, 'steer_port_rad = { signal = "wheel_port_deg"'),
        ("azimuth_port_deg", 90.0, 30.0, 'steer_port_rad = { signal = "azimuth_port_deg"'),
    ],
)
def test_an_azimuth_beyond_the_range_of_its_channel_is_no_geared_wheel(name, largest, limit, line):
    most = np.radians(limit)
    drives = [VesselChannel("steer_port_rad", -most, most)]
    (found,) = [
        given
        for given in propose_map(log_of(**{name: (-largest, largest)}), "v", drives).splitlines()
        if given.startswith("steer_port_rad")
    ]
    assert found.startswith(line)
    is_azimuth = name.startswith("azi") and largest > 90.0
    assert ("allows only -90 to 90 deg" in found and "vessel.toml" in found) == is_azimuth


def test_a_column_called_as_the_channel_is_that_channel_even_if_it_stands_still_and_no_other_kind_of_thing_is():
    drives = [VesselChannel("delta_rad", -0.7, 0.7), VesselChannel("n_rps", 0.0, 30.0)]
    signals = {"psi": (0.0, 3.0), "delta_rad": (-0.3, 0.3), "thrust_N": (39.0, 52.0)}
    text = propose_map(log_of(**signals), "v", drives)
    assert 'delta_rad = "delta_rad"' in text and '# n_rps = "..."' in text
    text = propose_map(log_of(**signals, n_rps=(10.0, 10.0)), "v", drives)
    assert 'n_rps = "n_rps"' in text


def test_what_the_vessels_file_says_of_its_recordings_comes_before_any_guess():
    stated = {"thrust_port_N": "force_right", "y_m": "-port", "x_m": "none"}
    log = log_of(psi=(0.0, 3.0), force_right=(0.0, 1.0), port=(0.0, 9.0), y=(0.0, 3.0))
    text = propose_map(log, "v", [VesselChannel("thrust_port_N", -1.0, 1.0)], (), stated)
    assert (
        'thrust_port_N = "force_right"  # by' in text
        and 'y_m = "-port"  # by' in text
        and "none" not in text
    )
    assert text.count("y_m = ") == 1


def test_channels_that_no_name_fits_get_the_outputs_in_order_and_it_is_said():
    drives = [VesselChannel("thrust_port_N", -1.0, 1.0), VesselChannel("rudder_rad", -0.5, 0.5)]
    text = propose_map(
        log_of(psi=(0.0, 3.0), **{"rudder": (-0.4, 0.4), "motor 1": (-0.9, 0.9)}), "v", drives
    )
    assert 'rudder_rad = "rudder"' in text and "CHECK: the only signal that is left" in text
    text = propose_map(log_of(psi=(0.0, 3.0)), "v", drives)
    assert '# rudder_rad = "..."' in text


def test_names_of_channels_without_a_unit_and_words_of_sense_are_understood():
    rng = np.random.default_rng(1)
    names = ("x_m", "y_left_m", "yaw_ccw_rad", "fan_a1", "fan_b2")
    values = rng.uniform(0.03, 1.0, (len(T), len(names)))
    signals = {name: Signal(T, values[:, i]) for i, name in enumerate(names)}
    drives = [VesselChannel(f"fan_{fan}_share", 0.0, 1.0) for fan in ("a1", "b2")]
    text = propose_map(Log(Path("run.csv"), signals), "boat", drives, ("surge", "sway", "yaw"))
    for line in (
        'y_m = "-y_left_m"',
        'psi_rad = "-yaw_ccw_rad"',
        'fan_a1_share = "fan_a1"',
        'fan_b2_share = "fan_b2"',
    ):
        assert f"\n{line}" in text
