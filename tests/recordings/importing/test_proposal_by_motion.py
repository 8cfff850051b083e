"""Proposals by what the columns of a log show of one motion, on a simulated twin-screw boat."""

import tomllib
from pathlib import Path

import numpy as np
import pytest

from boatsim.errors import BadInput
from boatsim.recordings.importing.channels import VesselChannel
from boatsim.recordings.importing.convert import convert_log
from boatsim.recordings.importing.log import Log, Signal
from boatsim.recordings.importing.mapping import parse_map
from boatsim.recordings.importing.mapping_proposal import propose_map

RPM = 2.0 * np.pi / 60.0
K, LEVER = 0.01, 0.4  # [N s^2/rad^2] and [m] of the two propellers
SPEED_AT_80 = 1.6  # [m/s] at 80 rad/s
DOF = ("surge", "sway", "yaw")
DRIVES = [
    VesselChannel("n_port_radps", -104.0, 104.0, 0, LEVER, (K, K), 80.0),
    VesselChannel("n_starboard_radps", -104.0, 104.0, 0, -LEVER, (K, K), 80.0),
]


def simulated(seed: int = 0, duration: float = 60.0) -> dict[str, np.ndarray]:
    """Columns of a boat whose speed and rate of turn follow her shafts, with noise."""
    rng = np.random.default_rng(seed)
    t = np.arange(0.0, duration, 0.1)
    mean = 70.0 + 10.0 * np.sin(0.3 * t)
    turn = 25.0 * np.sign(np.sin(0.35 * t)) * (np.sin(0.11 * t) > -0.5)
    port, starboard = mean + turn, mean - turn
    speed = np.convolve(np.append(np.full(20, mean[0]), mean), np.full(21, 1 / 21), "valid")
    u = SPEED_AT_80 / 80.0 * speed
    r = 0.25 * np.convolve(np.append(np.zeros(10), turn / 25.0), np.full(11, 1 / 11), "valid")
    psi = 0.5 + np.cumsum(r) * 0.1
    north = np.cumsum(u * np.cos(psi)) * 0.1
    east = np.cumsum(u * np.sin(psi)) * 0.1
    noise = rng.normal(0.0, 1.0, (4, len(t)))
    return {
        "t": 1.7e9 + t,
        "north": north + 0.005 * noise[0],
        "east": east + 0.005 * noise[1],
        "psi": psi + 0.002 * noise[2],
        "r": r + 0.01 * noise[3],
        "u": u,
        "port": port,
        "starboard": starboard,
    }


def log_of(run: dict[str, np.ndarray], **more: np.ndarray) -> Log:
    """A log as students write it: degrees, numbered signals, positions in degrees."""
    t, count = run["t"], len(run["t"])
    columns = {
        "lat": 59.9 + np.degrees(run["north"] / 6.37e6),
        "lon": 10.7 + np.degrees(run["east"] / 6.37e6 / np.cos(np.radians(59.9))),
        "previous_lat": np.roll(59.9 + np.degrees(run["north"] / 6.37e6), 1),
        "current_orientation_1": 2.0 * np.sin(run["t"]),
        "current_orientation_2": 1.0 * np.cos(run["t"]),
        "current_orientation_3": np.degrees(np.angle(np.exp(1j * run["psi"]))),
        "current_rotational_velocities_1": np.cos(run["t"]),
        "current_rotational_velocities_2": -np.sin(run["t"]),
        "current_rotational_velocities_3": np.degrees(run["r"]),
        "speed_surge": np.zeros(count),
    }
    signals = {name: Signal(t, values) for name, values in (columns | more).items()}
    return Log(Path("log.csv"), signals)


def shafts(run: dict[str, np.ndarray], factor: float = 1.0 / RPM) -> dict[str, np.ndarray]:
    return {"n1": run["port"] * factor, "n2": run["starboard"] * factor}


def proposed(log: Log, speed: float = SPEED_AT_80) -> tuple[dict, str]:
    text = propose_map(log, None, DRIVES, DOF, None, lambda: speed)
    return tomllib.loads(text), text


def test_numbered_signals_are_about_three_axes_and_have_the_unit_of_their_sensor():
    run = simulated()
    columns = proposed(log_of(run, **shafts(run)))[0]["columns"]
    assert columns["psi_rad"] == "current_orientation_3 * deg"
    assert columns["r_radps"] == "current_rotational_velocities_3 * degps"
    full = propose_map(log_of(run), None, (), (*DOF, "roll", "pitch"))
    assert 'phi_rad = "current_orientation_1 * deg"' in full


@pytest.mark.parametrize(("factor", "unit"), [(180.0 / np.pi, " * degps"), (1.0, "")])
def test_the_heading_shows_the_unit_of_the_rate_of_a_boat_that_turns_slowly(factor, unit):
    run = simulated()
    slow = {"yaw_rate": factor * run["r"]}
    assert np.abs(slow["yaw_rate"]).max() < 20.0
    log = log_of(run, **slow)
    del log.signals["current_rotational_velocities_3"]  # type: ignore[attr-defined]
    assert proposed(log)[0]["columns"]["r_radps"] == f"yaw_rate{unit}"


def test_a_constant_column_is_no_speed_of_a_boat_that_moves():
    run = simulated()
    table, text = proposed(log_of(run, **shafts(run)))
    assert "u_mps" not in table["columns"]
    assert "u_mps is not speed_surge: it is 0 throughout, but the track extends over" in text


def test_a_constant_speed_of_a_boat_at_rest_is_kept():
    run = simulated()
    rest = {name: np.full_like(values, values[0]) for name, values in run.items()}
    rest["t"] = run["t"]
    rng = np.random.default_rng(2)
    for name in ("north", "east", "psi"):
        rest[name] = rest[name] + 0.005 * rng.normal(size=len(run["t"]))
    assert proposed(log_of(rest))[0]["columns"]["u_mps"] == "speed_surge"


def test_a_speed_that_differs_from_the_track_is_left_out_and_a_true_one_is_not():
    run = simulated()
    rng = np.random.default_rng(3)
    wrong = 8.0 * rng.random(len(run["t"]))
    table, text = proposed(log_of(run, surge_velocity=wrong))
    assert "u_mps" not in table["columns"]
    assert "u_mps is not surge_velocity: it differs from the derivative of the track" in text
    true = run["u"] + 0.05 * rng.normal(size=len(run["t"]))
    assert proposed(log_of(run, surge_velocity=true))[0]["columns"]["u_mps"] == "surge_velocity"


def test_two_signs_show_that_revolutions_are_in_rpm():
    run = simulated()
    table, text = proposed(log_of(run, **shafts(run)))
    assert table["columns"]["n_port_radps"] == "n1 * rpm"
    assert table["columns"]["n_starboard_radps"] == "n2 * rpm"
    assert "times the speed of the track" in text


@pytest.mark.parametrize("names", [("lat",), ("lon",), ("lat", "lon")])
def test_a_track_with_empty_cells_shows_what_the_whole_track_shows(names):
    run = simulated()
    whole = log_of(run, **shafts(run))
    signals = dict(whole.signals)
    for row, name in enumerate(names, 200):
        signals[name] = Signal(run["t"], signals[name].values.copy())
        signals[name].values[row] = np.nan
    assert proposed(Log(whole.path, signals)) == proposed(whole)


def test_a_row_with_one_coordinate_does_not_hide_positions_before_the_first_fix():
    run = simulated()
    x, y = 300.0 + run["north"], 400.0 + run["east"]
    x[:20], y[:20] = 0.0, 0.0
    x[300] = np.nan
    columns = {"x": x, "y": y, "psi": run["psi"]} | shafts(run, 1.0)
    log = Log(Path("log.csv"), {name: Signal(run["t"], v) for name, v in columns.items()})
    text = 'vessel = "otter"\n[columns]\nx_m = "x"\ny_m = "y"\npsi_rad = "psi"\n'
    text += 'n_port_radps = "n1"\nn_starboard_radps = "n2"\n'
    found = convert_log(log, parse_map(tomllib.loads(text), "m.toml"), "m.toml")
    assert np.nanmin(found["x_m"]) > 200.0
    assert any("omitted 1 coordinate whose" in remark for remark in found.remarks)


@pytest.mark.parametrize("speed", [0.0, 0.05])
def test_one_sign_leaves_the_unit_to_the_owner(speed):
    run = simulated()
    table, text = proposed(log_of(run, **shafts(run)), speed)
    assert table["columns"]["n_port_radps"] == "n1"
    assert 'in rpm it would be "n1 * rpm"' in text


def test_revolutions_slightly_beyond_the_range_keep_their_unit():
    run = simulated()
    columns = proposed(log_of(run, **shafts(run, 1.2)))[0]["columns"]
    assert columns["n_port_radps"] == "n1"


def efforts(run: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    thrust = [K * run[side] * np.abs(run[side]) for side in ("port", "starboard")]
    return {"tau_X": thrust[0] + thrust[1], "tau_N": LEVER * (thrust[0] - thrust[1])}


def test_a_force_and_a_moment_are_distributed_to_the_propellers():
    run = simulated()
    log = log_of(run, **efforts(run))
    table, text = proposed(log)
    assert "CHECK: tau_X and tau_N by the vessel's levers" in text
    recording = convert_log(log, parse_map(table, "map.toml"), "map.toml")
    begin = len(run["t"]) - len(recording)
    for side in ("port", "starboard"):
        there = recording[f"n_{side}_radps"]
        assert there == pytest.approx(run[side][begin:], rel=1e-4)


def test_a_log_without_poses_gets_one_line():
    run = simulated()
    zero = np.zeros(len(run["t"]))
    log = log_of(run, lat=zero, lon=zero, current_orientation_3=zero)
    with pytest.raises(BadInput) as caught:
        proposed(log)
    assert str(caught.value) == (
        "log.csv: no usable poses (no position: lat and lon are 0 in all 600 rows; no heading: "
        "current_orientation_3 is 0 in all 600 rows); it cannot become a recording"
    )


def test_a_constant_heading_is_refused_unless_the_boat_keeps_that_course():
    run = simulated()
    zero = np.zeros(len(run["t"]))
    with pytest.raises(BadInput, match="no heading: current_orientation_3 is 0"):
        proposed(log_of(run, current_orientation_3=zero))
    straight = run | {"north": np.cumsum(run["u"]) * 0.1, "east": 1e-4 * np.sin(run["t"])}
    table, _ = proposed(log_of(straight, current_orientation_3=zero))
    assert table["columns"]["psi_rad"].startswith("current_orientation_3")


@pytest.mark.parametrize(("full", "sign"), [(1.0, 1.0), (100.0, -1.0)])
def test_a_throttle_and_a_steering_order_are_mixed_to_the_propellers(full, sign):
    run = simulated()
    orders = {
        "throttle": full * (run["port"] + run["starboard"]) / 208.0,
        "steering": sign * full * (run["port"] - run["starboard"]) / 208.0,
    }
    log = log_of(run, **orders)
    table, text = proposed(log)
    assert "CHECK: throttle and steering are assumed to be mixed in equal shares" in text
    recording = convert_log(log, parse_map(table, "map.toml"), "map.toml")
    begin = len(run["t"]) - len(recording)
    for side in ("port", "starboard"):
        there = recording[f"n_{side}_radps"]
        assert there == pytest.approx(np.minimum(run[side][begin:], 104.0), rel=1e-4)


def test_drives_that_turn_the_boat_to_the_other_side_are_pointed_out():
    run = simulated()
    right = {"rpm_port": run["port"] / RPM, "rpm_starboard": run["starboard"] / RPM}
    assert "turns to the other side" not in proposed(log_of(run, **right))[1]
    wrong = {"rpm_port": run["starboard"] / RPM, "rpm_starboard": run["port"] / RPM}
    text = proposed(log_of(run, **wrong))[1]
    assert "CHECK: the boat turns to the other side than these commands ask for" in text


@pytest.mark.parametrize(("unit", "factor"), [("kn", 3600 / 1852), ("kmh", 3.6)])
def test_the_track_shows_the_unit_of_a_speed_without_one(unit, factor):
    run = simulated()
    noise = 0.02 * np.random.default_rng(3).normal(size=len(run["t"]))
    table, text = proposed(log_of(run, surge_velocity=factor * (run["u"] + noise)))
    assert table["columns"]["u_mps"] == f"surge_velocity * {unit}"
    assert f"CHECK: in {unit} by the speed of the track" in text
    half_wrong = 1.4 * (run["u"] + noise)  # neither m/s nor another unit
    columns = proposed(log_of(run, surge_velocity=half_wrong))[0]["columns"]
    assert columns["u_mps"] == "surge_velocity"


def test_a_sideways_speed_is_kept_where_the_track_does_not_show_it():
    """A heading that is off by 3 degrees hides the sideways speed of a boat that goes ahead."""
    run = simulated()
    rng = np.random.default_rng(4)
    small = 0.02 * rng.normal(size=len(run["t"]))
    kept = proposed(log_of(run, sway_velocity=small))[0]["columns"]
    assert kept["v_mps"] == "sway_velocity"
    large = 8.0 * rng.random(len(run["t"]))
    table, text = proposed(log_of(run, sway_velocity=large))
    assert "v_mps" not in table["columns"]
    assert "v_mps is not sway_velocity: it differs from the derivative of the track" in text
