"""Sensors at sea: kinematics of their places, and the statistics of their errors.

Motions are given in closed form; accelerations are derivatives that share no code with the sensors."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from math import cos, exp, pi, radians, sin, tan
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from boatsim.errors import BadInput
from boatsim.physics import vessel
from boatsim.physics.base import Array
from boatsim.physics.content import load_class
from boatsim.physics.vessel.wave_field import wave_field
from boatsim.simulate import run, scenario
from boatsim.simulate.graded_sensor import sensor_grades
from boatsim.simulate.sensor_motion import position_of
from boatsim.simulate.stepper import State

GRAVITY = 9.81
SILENT = {  # no random errors
    "gnss": {"position_sd": 0.0, "drift_sd": 0.0},
    "dvl": {"speed_sd": 0.0, "scale_sd": 0.0},
    "imu": {
        name: 0.0
        for name in (
            "gyro_noise",
            "gyro_bias_sd",
            "gyro_walk",
            "accelerometer_noise",
            "accelerometer_bias_sd",
            "accelerometer_walk",
        )
    },
    "compass": {"heading_sd": 0.0, "deviation": 0.0},
    "echo_sounder": {"range_sd": 0.0, "scale_sd": 0.0},
    "pressure_gauge": {"depth_sd": 0.0, "bias_sd": 0.0},
}
Motion = Callable[[float], State]


@dataclass
class Sailing:
    """An engine whose motion is given."""

    motion: Motion
    t: float = 0.0
    vessel: Any = None

    @property
    def state(self) -> State:
        return self.motion(self.t)


def readings(
    name: str, motion: Motion, times: Array, seed: int = 1, effects: Any = (), **settings: Any
) -> dict[str, Array]:
    sensor = load_class("sensor", name).from_settings(settings)
    instrument = sensor.start(np.random.default_rng(seed))
    engine: Any = Sailing(motion, vessel=SimpleNamespace(effects=effects))
    rows: list[Mapping[str, float]] = []
    for t in times:
        engine.t = float(t)
        rows.append(instrument.read(engine))
    return {key: np.array([row[key] for row in rows]) for key in type(sensor).columns}


def at_rest(**pose: float) -> Motion:
    return lambda t: State(t=t, **pose)


def ahead(speed: float) -> Motion:
    return lambda t: State(t=t, x=speed * t, u=speed)


@pytest.mark.parametrize("name", sensor_grades())
def test_defaults_are_the_consumer_grade_and_survey_grades_are_better(name: str) -> None:
    kind, grades = load_class("sensor", name), sensor_grades()[name]
    default = kind.from_settings({})
    for key, value in grades["consumer"].items():
        assert getattr(kind(), key) == getattr(default, key) == value
    survey = kind.from_settings({"grade": "survey"})
    errors = [key for key in SILENT[name] if key in grades["survey"]]
    assert errors and all(getattr(survey, key) <= getattr(default, key) for key in errors)
    (first,) = errors[:1]
    assert getattr(kind.from_settings({"grade": "survey", first: 0.123}), first) == 0.123
    with pytest.raises(BadInput, match="'surwey' does not exist; did you mean 'survey'"):
        kind.from_settings({"grade": "surwey"})


# ---- satellite receiver


def test_a_fix_is_the_position_at_its_instant_and_is_held_until_the_next_one() -> None:
    times = np.arange(0.0, 20.0, 0.08)
    rate, latency = 5.0, 0.25
    found = readings("gnss", ahead(2.0), times, rate=rate, latency=latency, **SILENT["gnss"])
    instants = np.maximum(np.floor((times - latency) * rate + 1e-9), 0.0) / rate
    assert found["x"] == pytest.approx(2.0 * instants, abs=1e-9)
    assert found["fix_age_s"] == pytest.approx(times - instants, abs=1e-9)
    settled = times > 1.0
    assert found["fix_age_s"][settled].min() >= latency - 1e-9
    assert found["fix_age_s"][settled].max() < latency + 1.0 / rate + 1e-9


def test_the_slow_error_is_a_gauss_markov_process_and_the_rest_is_white() -> None:
    times = np.arange(0.0, 40000.0, 1.0)
    slow = {"position_sd": 0.0, "drift_sd": 2.0, "drift_time": 50.0}
    found = readings("gnss", at_rest(), times, rate=1.0, latency=0.0, **slow)
    for x in (found["x"], found["y"]):
        assert x.std() == pytest.approx(2.0, rel=0.15)  # 400 independent samples
        correlation = np.mean(x[50:] * x[:-50]) / np.mean(x * x)
        assert correlation == pytest.approx(exp(-1.0), abs=0.12)
    assert abs(np.corrcoef(found["x"], found["y"])[0, 1]) < 0.2
    white = readings("gnss", at_rest(), times[:4000], rate=1.0, latency=0.0, drift_sd=0.0)["x"]
    assert white.std() == pytest.approx(0.4, rel=0.05)
    assert abs(np.corrcoef(white[1:], white[:-1])[0, 1]) < 0.05


@pytest.mark.parametrize("name", ["gnss", "dvl"])
def test_outages_have_their_mean_length_and_share_of_time(name: str) -> None:
    times = np.arange(0.0, 60000.0, 0.5)
    settings = {"rate": 2.0, "outage_interval": 60.0, "outage_length": 6.0}
    signal = "x" if name == "gnss" else "u"
    found = readings(name, ahead(1.0), times, **settings)
    out = np.isnan(found[signal])
    if name == "gnss":  # the age grows in an outage
        assert found["fix_age_s"][out].max() > 20.0 > 1.0 > found["fix_age_s"][~out].max()
    assert out.mean() == pytest.approx(6.0 / 66.0, rel=0.15)
    begins = np.count_nonzero(np.diff(out.astype(int)) == 1)
    assert 0.5 * out.sum() / begins == pytest.approx(6.0, rel=0.15)
    without = {**settings, "outage_interval": 0.0}
    assert np.isfinite(readings(name, ahead(1.0), times[:2000], **without)[signal]).all()


def test_an_antenna_on_a_mast_moves_to_the_side_to_which_the_boat_heels() -> None:
    heeled = readings(
        "gnss", at_rest(phi=0.3, psi=0.5 * pi), np.zeros(1), above=4.0, **SILENT["gnss"]
    )
    assert heeled["x"][0] == pytest.approx(-4.0 * sin(0.3))  # starboard is south on a course east
    assert heeled["y"][0] == pytest.approx(0.0, abs=1e-12)


# ---- inertial unit


@pytest.mark.parametrize(("phi", "theta"), [(0.0, 0.0), (0.3, 0.0), (0.0, -0.2), (0.5, 0.4)])
def test_an_inertial_unit_at_rest_feels_gravity_upwards(phi: float, theta: float) -> None:
    found = readings("imu", at_rest(phi=phi, theta=theta), np.array([0.0, 0.1]), **SILENT["imu"])
    expected = (sin(theta), -cos(theta) * sin(phi), -cos(theta) * cos(phi))
    for axis, share in zip(("ax", "ay", "az"), expected, strict=True):
        assert found[axis] == pytest.approx(GRAVITY * share, abs=1e-9)


def tumbling(t: float) -> State:
    """A boat that moves in all six degrees of freedom; its velocities by central differences."""

    def pose(t: float) -> Array:
        x, y, z = 2.0 * t + 0.3 * sin(t), 1.5 * sin(0.7 * t), 0.4 * sin(1.3 * t)
        return np.array([x, y, z, 0.4 * sin(1.1 * t), 0.2 * cos(1.7 * t), 0.5 * t])

    def turn(angles: Array) -> Array:
        (a, b, c), (sa, sb, sc) = np.cos(angles), np.sin(angles)
        roll = np.array([[1, 0, 0], [0, a, -sa], [0, sa, a]])
        pitch = np.array([[b, 0, sb], [0, 1, 0], [-sb, 0, b]])
        yaw = np.array([[c, -sc, 0], [sc, c, 0], [0, 0, 1]])
        return np.asarray(yaw @ pitch @ roll)

    h = 1e-5
    here = pose(t)
    matrix = turn(here[3:])
    speed = matrix.T @ (pose(t + h)[:3] - pose(t - h)[:3]) / (2.0 * h)
    spin = matrix.T @ (turn(pose(t + h)[3:]) - turn(pose(t - h)[3:])) / (2.0 * h)
    return State(t, *here, *speed, spin[2, 1], spin[0, 2], spin[1, 0])


def test_turn_rates_and_specific_force_on_a_mast_follow_from_its_path() -> None:
    times, mast, h = np.arange(0.0, 8.0, 0.01), np.array([1.0, -0.5, -3.0]), 1e-3
    place = {"ahead": 1.0, "starboard": -0.5, "above": 3.0}
    found = readings("imu", tumbling, times, **place, **SILENT["imu"])
    for k in range(50, len(times), 97):
        middle = 0.5 * (times[k] + times[k - 1])
        path = [position_of(tumbling(middle + shift), mast) for shift in (-h, 0.0, h)]
        acceleration = (path[0] - 2.0 * path[1] + path[2]) / h**2
        state = tumbling(middle)
        axes = [position_of(state, unit) - position_of(state, np.zeros(3)) for unit in np.eye(3)]
        force = np.array(axes) @ (acceleration - np.array([0.0, 0.0, GRAVITY]))
        assert [found[axis][k] for axis in ("ax", "ay", "az")] == pytest.approx(force, abs=0.02)
        rates = (state.p, state.q, state.r)
        assert [found[axis][k] for axis in ("p", "q", "r")] == pytest.approx(rates, abs=1e-3)


def test_noise_averages_as_its_density_says_and_the_bias_walks() -> None:
    step, density = 0.02, 1e-3
    times = np.arange(0.0, 400.0, step)
    noisy = {**SILENT["imu"], "gyro_noise": density}
    for axis in ("p", "q", "r"):
        found = readings("imu", at_rest(), times, **noisy)[axis][1:]
        for tau in (step, 1.0):  # Allan deviation of white noise
            count = round(tau / step)
            means = found[: len(found) // count * count].reshape(-1, count).mean(axis=1)
            allan = np.sqrt(0.5 * np.mean(np.diff(means) ** 2))
            assert allan == pytest.approx(density / np.sqrt(tau), rel=0.15)
    walking = {**SILENT["imu"], "gyro_walk": 0.01}
    ends = []
    for seed in range(300):
        ends.append(readings("imu", at_rest(), np.linspace(0.0, 25.0, 6), seed, **walking)["r"][-1])
    assert np.std(ends) == pytest.approx(0.01 * 5.0, rel=0.15)


# ---- compass


@pytest.mark.parametrize("heading", [0.0, 1.0, -2.5])
@pytest.mark.parametrize("heel", [-0.2, 0.3])
def test_a_tilted_magnetometer_shows_the_vertical_field_as_a_heading_error(
    heading: float, heel: float
) -> None:
    tilted = at_rest(phi=heel, psi=heading)
    once = np.zeros(1)
    plain = readings("compass", tilted, once, compensation="none", dip=1.2, **SILENT["compass"])
    # horizontal parts of the field ahead and to starboard, in units of the horizontal field
    forward, starboard = cos(heading), -sin(heading) * cos(heel) + tan(1.2) * sin(heel)
    expected = np.arctan2(-starboard, forward)
    assert np.cos(plain["psi"][0] - expected) == pytest.approx(1.0, abs=1e-12)
    for compensation in ("exact", "accelerometer"):  # at rest gravity is the vertical
        found = readings("compass", tilted, once, compensation=compensation, **SILENT["compass"])
        assert found["psi"][0] == pytest.approx(heading, abs=1e-12)


def test_a_compass_without_gyros_takes_the_push_of_a_turn_for_heel() -> None:
    speed, rate, dip = 4.0, 0.3, 1.2
    radius = speed / rate

    def circle(t: float) -> State:
        psi = rate * t
        return State(t, radius * sin(psi), radius * (1 - cos(psi)), psi=psi, u=speed, r=rate)

    times = np.arange(0.0, 20.0, 0.01)
    found = readings("compass", circle, times, compensation="accelerometer", **SILENT["compass"])
    heading = rate * times[1:]
    apparent = -np.arctan(speed * rate / GRAVITY)  # heel that the push to starboard pretends
    starboard = -np.sin(heading) * np.cos(apparent) - tan(dip) * np.sin(apparent)
    expected = np.arctan2(-starboard, np.cos(heading))
    difference = np.angle(np.exp(1j * (found["psi"][1:] - expected)))
    assert np.abs(difference).max() < 0.02
    error = np.angle(np.exp(1j * (found["psi"][1:] - heading)))
    assert np.abs(error).max() > radians(15.0)


def test_deviation_is_a_sine_of_the_heading() -> None:
    headings = np.linspace(-pi, pi, 73)
    found = readings(
        "compass", lambda t: State(t, psi=t - pi), headings + pi, heading_sd=0.0, deviation=0.05
    )
    error = found["psi"] - headings
    waves = np.column_stack([np.sin(headings), np.cos(headings)])
    amplitudes, residual, *_ = np.linalg.lstsq(waves, error, rcond=None)
    assert np.hypot(*amplitudes) == pytest.approx(0.05) and residual[0] < 1e-20


# ---- velocity log, echo sounder, pressure gauge


def test_a_velocity_log_measures_the_velocity_of_its_place() -> None:
    turning = State(0.0, u=1.0, v=0.2, p=0.1, r=0.3)
    found = readings(
        "dvl", lambda t: turning, np.zeros(1), ahead=2.0, starboard=0.5, below=1.0, **SILENT["dvl"]
    )
    assert found["u"][0] == pytest.approx(1.0 - 0.3 * 0.5)
    assert found["v"][0] == pytest.approx(0.2 + 0.3 * 2.0 - 0.1 * 1.0)
    lost = readings("dvl", at_rest(phi=0.4, theta=0.4), np.zeros(1), largest_tilt=0.5)
    assert np.isnan(lost["u"][0])
    scales = [
        readings("dvl", ahead(2.0), np.zeros(1), seed, speed_sd=0.0, scale_sd=0.01)["u"][0] / 2.0
        for seed in range(300)
    ]
    assert np.std(scales) == pytest.approx(0.01, rel=0.15)
    assert np.mean(scales) == pytest.approx(1.0, abs=0.002)


def test_an_echo_comes_from_the_nearest_bottom_in_the_beam() -> None:
    settings = {"water_depth": 20.0, "below": 0.5, "beam": 0.2, **SILENT["echo_sounder"]}
    for heel, slant in ((0.0, 19.5), (0.05, 20.0 - 0.5 * cos(0.05)), (0.4, None)):
        found = readings("echo_sounder", at_rest(phi=heel, z=0.0), np.zeros(1), **settings)
        expected = slant or (20.0 - 0.5 * cos(heel)) / cos(heel - 0.1)
        assert found["range_m"][0] == pytest.approx(expected)
    heaved = readings("echo_sounder", at_rest(z=0.3), np.zeros(1), **settings)
    assert heaved["range_m"][0] == pytest.approx(19.2)
    deep = readings("echo_sounder", at_rest(), np.zeros(1), water_depth=150.0)
    assert np.isnan(deep["range_m"][0])


def test_a_pressure_gauge_is_deeper_under_a_crest() -> None:
    wave = {
        "use": "irregular_sea",
        "spectrum": "regular",
        "significant_height": 0.4,
        "modal_period": 4.0,
    }
    boat = vessel.load_vessel("otter", extra=[wave])
    times = np.arange(0.0, 8.0, 0.25)
    surface = [float(wave_field(boat.effects).elevation(0.0, 0.0, t)) for t in times]
    found = readings(
        "pressure_gauge",
        at_rest(),
        times,
        effects=boat.effects,
        below=0.3,
        **SILENT["pressure_gauge"],
    )
    assert found["depth_m"] == pytest.approx(0.3 + np.array(surface))
    assert np.ptp(surface) > 0.3


# ---- in a scenario

SCENARIO = """vessel = "otter"
duration = 20.0
controller = {{ use = "open_loop" }}
[[goal]]
{sensors}
"""


def sailed(tmp_path: Any, sensors: str, seed: int = 0) -> Any:
    file = tmp_path / "sensors.toml"
    file.write_text(SCENARIO.format(sensors=sensors), encoding="utf-8")
    return run.run(scenario.load(str(file)), seed)


def test_readings_are_columns_of_the_log_and_depend_on_the_seed_alone(tmp_path: Any) -> None:
    sensors = "\n".join(f'[[sensor]]\nuse = "{name}"' for name in sensor_grades())
    first, again, other = (sailed(tmp_path, sensors, seed).recording for seed in (1, 1, 2))
    for column in ("x_m", "fix_age_s", "u_mps", "q_radps", "az_mps2", "range_m", "depth_m"):
        values = first[f"sensed_{column}"]
        assert np.isfinite(values).all()
        assert np.array_equal(values, again[f"sensed_{column}"])
        if column != "fix_age_s":
            assert not np.array_equal(values, other[f"sensed_{column}"])
    assert first["sensed_az_mps2"].mean() == pytest.approx(-GRAVITY, abs=1.0)


def test_two_sensors_of_one_reading_are_refused(tmp_path: Any) -> None:
    with pytest.raises(BadInput, match="u is read by another sensor already"):
        twice = '[[sensor]]\nuse = "dvl"\n[[sensor]]\nuse = "dvl"\ngrade = "survey"'
        sailed(tmp_path, twice)
