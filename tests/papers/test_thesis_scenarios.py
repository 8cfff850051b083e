"""Acceptance: the eight tests of the thesis against section 11 of its review, and what must hold of
every scenario."""

import os
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from alike import long
from runs import SHIPPED, TESTS, found, mean, mean_of, raw

from boatsim.errors import BadInput
from boatsim.physics.content import find_content_file
from boatsim.simulate import scenario
from boatsim.simulate.evaluation import requested_metrics
from boatsim.simulate.run import run
from validation.real.thesis_score import rms_distance

SEEDS = 6  # of the means in section 11
FEW = 3  # where a bar is far away
MODES = [
    (test, mode)
    for test in TESTS
    for mode in ("", "gyro", "wind")
    if not (test.startswith("yaw") and mode == "wind")
]
# Section 11, set B, means of six seeds: norm -> test 1 to 4
AS_PUBLISHED = {
    "sway": {
        "heading_at_end": (7.9, 14.9, 7.7, 14.7),  # deg
        "yaw_rate_inf": (2.0, 2.4, 2.2, 2.4),  # deg/s
        "yaw_rate_l2": (6.6, 7.5, 7.1, 7.8),
        "yaw_rate_l1": (33.0, 36.0, 38.0, 39.0),
        "time_to_end": (13.3, 11.3, 14.8, 12.5),  # s
        "surge_offset": (0.12, 0.13, 0.12, 0.13),  # m
    },
    "yaw": {
        "moved": (0.06, 0.13, 0.06, 0.06),  # m
        "position_inf": (0.11, 0.13, 0.14, 0.18),
        "position_rms": (0.07, 0.10, 0.10, 0.12),
        "turn_time": (32.0, 32.0, 35.0, 35.0),  # s
    },
}
# Bars of section 11 by sensor set: the largest absolute value allowed
GYRO_SWAY = {
    "heading_at_end": 3.0,
    "yaw_rate_inf": 1.0,
    "yaw_rate_l2": 2.5,
    "yaw_rate_l1": 12.0,
    "time_to_end": 20.0,
}
CORRECTED = {
    "sway": GYRO_SWAY | {"surge_offset": 0.10},
    "yaw": {"moved": 0.10, "position_inf": 0.12},
    "sway_gyro": GYRO_SWAY,
    "yaw_gyro": {"moved": 0.30, "excursion": 0.6},
    "sway_wind": GYRO_SWAY | {"surge_offset": 0.10},
}
REQUIRED = {  # T1; 0.15 m is our reading of its "forward/aft translation"
    "sway": {"heading_at_end": 10.0, "surge_offset": 0.15},
    "yaw": {"excursion": 1.2, "moved": 1.2},
}
SCORED = {  # norms that J takes
    "sway": ("heading_at_end", "yaw_rate_inf", "yaw_rate_l2", "yaw_rate_l1"),
    "yaw": ("moved", "position_inf", "position_rms", "position_l1", "turn_time"),
}
# Section 9: gains for actuators without lag, with the faster surge loop that the norm needs
IDEAL_ACTUATORS = {"pole": 1.4, "yaw_bandwidth": 2.0, "surge_bandwidth": 2.0, "heading_gain": 0.2}
EACH_TEST = pytest.mark.parametrize("test", TESTS)


def shipped(test: str, mode: str = "") -> str:
    return f"joystick_boat/{test}{'_' + mode if mode else ''}"


def with_reverse(name: str, factor: float) -> scenario.Scenario:
    """A shipped scenario with another reverse efficiency; in open water, for the boat may leave the
    tank."""
    effects = [
        t | ({"astern_factor": factor} if t["use"] == "weak_reverse" else {})
        for t in raw(name)["effect"]
    ]
    return scenario.load(name, {"tank": None, "effect": effects})


def over(norms: dict[str, float], bars: dict[str, float]) -> dict[str, float]:
    return {name: norms[name] for name, bar in bars.items() if not abs(norms[name]) < bar}


# The thesis' program
# ----------------------------------------------------------------------------------------------


@EACH_TEST
def test_the_thesis_program_gives_the_norms_of_set_b(test: str) -> None:
    manoeuvre, number = test.split("_")
    measured = mean_of(shipped(test, "as_published"), SEEDS)
    wanted = {name: column[int(number) - 1] for name, column in AS_PUBLISHED[manoeuvre].items()}
    assert {name: abs(measured[name]) for name in wanted} == pytest.approx(wanted, rel=0.3)


@EACH_TEST
def test_bars_in_the_files_are_thirty_percent_about_set_b(test: str) -> None:
    manoeuvre, number = test.split("_")
    content = raw(shipped(test, "as_published"))
    bars = {
        name: tuple(table["guard"]) for name, table in content["norms"].items() if "guard" in table
    }
    wanted = {name: column[int(number) - 1] for name, column in AS_PUBLISHED[manoeuvre].items()}
    assert bars.keys() == wanted.keys() and content["noise_widens_guards"]
    for name, value in wanted.items():
        assert bars[name] == pytest.approx((0.7 * value, 1.3 * value), rel=1e-3)


@pytest.fixture(scope="module")
def score() -> dict[str, float]:
    """J over all eight tests with set B's reverse efficiency, and with ideal reverse and nothing
    else changed."""
    tests: dict[str, Any] = {"set B": [], "ideal": []}
    for test in TESTS:
        content = raw(shipped(test, "as_published"))
        published = {
            name: table["published"]
            for name, table in content["norms"].items()
            if "published" in table
        }
        assert published.keys() <= set(SCORED[test.split("_")[0]])
        tests["set B"].append((mean_of(shipped(test, "as_published"), SEEDS), published))
        told = with_reverse(shipped(test, "as_published"), 1.0)
        tests["ideal"].append(
            (mean([requested_metrics(run(told, seed)) for seed in range(2)]), published)
        )
    return {name: rms_distance(pairs) for name, pairs in tests.items()}


@pytest.mark.slow
@pytest.mark.long
def test_weak_reverse_at_least_halves_the_distance_to_the_thesis(score: dict[str, float]) -> None:
    """Changing the reverse efficiency alone, 1.00 -> 0.694, brings J over all eight tests from 1.33
    to 0.41."""
    assert score["set B"] <= 0.5 * score["ideal"]
    assert score == pytest.approx({"set B": 0.41, "ideal": 1.33}, rel=0.15)


# The corrected controller
# -----------------------------------------------------------------------------------------


@pytest.mark.parametrize("mode", ["", "gyro"], ids=["speed sensor", "gyro only"])
@EACH_TEST
def test_corrected_controller_meets_its_bars(test: str, mode: str) -> None:
    bars = CORRECTED[test.split("_")[0] + ("_gyro" if mode else "")]
    assert not over(mean_of(shipped(test, mode), FEW), bars)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("mode", "factor"), [("", 0.60), ("gyro", 0.75), long("", 0.75), long("gyro", 0.60)]
)
@EACH_TEST
def test_bars_hold_whatever_the_reverse_efficiency(test: str, mode: str, factor: float) -> None:
    seen = requested_metrics(run(with_reverse(shipped(test, mode), factor)))
    assert not over(mean([seen]), CORRECTED[test.split("_")[0] + ("_gyro" if mode else "")])


@EACH_TEST
def test_corrected_controller_with_a_speed_sensor_meets_the_thesis_requirements_in_every_run(
    test: str,
) -> None:
    for seed in range(FEW):
        seen, _ = found(shipped(test), seed)
        assert not over(mean([seen]), REQUIRED[test.split("_")[0]])


@EACH_TEST
def test_gains_for_ideal_actuators_meet_the_bars_of_the_corrected_controller(test: str) -> None:
    case = scenario.load(shipped(test), {"controller": {"use": "l1_joystick", **IDEAL_ACTUATORS}})
    assert not over(mean([requested_metrics(run(case))]), CORRECTED[test.split("_")[0]])


@pytest.mark.parametrize(
    "drift_log",
    [False, pytest.param(True, marks=pytest.mark.slow)],
    ids=["gyro and speed", "drift log"],
)
@EACH_TEST
def test_projected_gradient_law_meets_the_bars_of_the_corrected_controller(
    test: str, drift_log: bool
) -> None:
    changes: dict[str, Any] = {"controller": {"use": "l1_joystick_projection"}}
    if drift_log:
        changes["sensor"] = [{"use": "drift_log"}]
    done = run(scenario.load(shipped(test), changes))
    norms = mean([requested_metrics(done)])
    print(test, {name: round(value, 4) for name, value in norms.items()})
    assert not over(norms, CORRECTED[test.split("_")[0]])
    log = done.recording
    for name in log.signals:
        if f"{name}_low" in log.signals:
            assert np.all(~(log[name] < log[f"{name}_low"])), name
            assert np.all(~(log[name] > log[f"{name}_high"])), name


@pytest.mark.parametrize("test", TESTS[:4])
def test_beam_wind_does_not_turn_a_sway(test: str) -> None:
    assert not over(mean_of(shipped(test, "wind"), FEW), CORRECTED["sway_wind"])


@pytest.mark.parametrize(("test", "mode"), MODES)
def test_bars_of_the_corrected_controller_in_the_files_are_those_agreed(
    test: str, mode: str
) -> None:
    manoeuvre = test.split("_")[0]
    tables = raw(shipped(test, mode))["norms"]
    bars = CORRECTED["_".join([manoeuvre, mode] if mode else [manoeuvre])]
    for name, bar in bars.items():
        assert tables[name]["guard"] in ([0.0, bar], [-bar, bar])


@pytest.mark.parametrize("seed", range(FEW))
def test_boat_returns_to_its_berth_the_other_way_round(seed: int) -> None:
    seen, touched = found("joystick_boat/berth", seed)
    assert not over(mean([seen]), {"return_distance": 0.15, "return_heading": 5.0})
    assert touched == 0


# Every scenario
# ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", SHIPPED)
def test_one_run_of_a_shipped_scenario_meets_its_bars_and_touches_no_wall(name: str) -> None:
    seen, touched = found(name)
    assert [n for n, norm in seen.items() if norm.ok is False] == []
    assert touched == 0


@pytest.mark.parametrize("name", SHIPPED)
def test_a_shipped_scenario_is_a_script(name: str) -> None:
    path = find_content_file("scenario", name)
    assert path.read_text(encoding="utf-8").startswith("#!/usr/bin/env -S boatsim run\n")
    assert os.access(path, os.X_OK)


def test_all_tests_of_the_thesis_are_shipped() -> None:
    modes = {
        t: ["", "gyro", "as_published", *(["wind"] if t.startswith("sway") else [])] for t in TESTS
    }
    assert {shipped(test, mode) for test in TESTS for mode in modes[test]} | {
        "joystick_boat/berth"
    } <= set(SHIPPED)


@pytest.mark.parametrize("test", TESTS[:4])
def test_sensors_are_all_that_tells_a_gyro_run_from_the_other(test: str) -> None:
    with_speed, without = raw(shipped(test)), raw(shipped(test, "gyro"))
    assert with_speed.pop("sensors") == {"speed_sd": 0.01}
    for different in ("about", "tank", "norms"):
        with_speed.pop(different), without.pop(different)
    assert with_speed == without


def test_same_seed_same_run_other_seed_other_run() -> None:
    told = scenario.load(shipped("sway_1", "as_published"))
    one, same, other = run(told, 4), run(told, 4), run(told, 5)
    assert one.recording["psi_rad"].tobytes() == same.recording["psi_rad"].tobytes()
    assert one.camera["psi_rad"].tobytes() == same.camera["psi_rad"].tobytes()
    assert one.camera["psi_rad"].tobytes() != other.camera["psi_rad"].tobytes()


LOG_OF_THE_MOTORS = """
from boatsim.simulate.sensing import Sensor

class MotorLog(Sensor):
    words = "what the motors push with"
    columns = {"port": "thrust_port_N"}

    def read(self, engine, rng):
        return {"port": engine.actuators["thrust_port_N"]}
"""
LISTENER = """
from boatsim.control.base import Controller

class Listener(Controller):
    goals = ("x",)

    def step(self, sense, goal):
        return {"thrust_starboard_N": sense.more["port"] + 100.0 * (sense.p - sense.more["p"]), "thrust_port_N": 0.25}
"""


@pytest.mark.usefixtures("trusted")
def test_a_sensor_is_one_file_whose_readings_reach_the_controller_and_the_log(
    tmp_path: Path,
) -> None:
    (tmp_path / "motor_log.py").write_text(LOG_OF_THE_MOTORS)
    (tmp_path / "listener.py").write_text(LISTENER)
    told = tmp_path / "heard.toml"
    told.write_text(
        'vessel = "joystick_boat"\nduration = 1.0\ncontroller = { use = "listener" }\n'
        'sensor = [{ use = "inclinometer" }, { use = "motor_log.py" }]\n'
    )
    log = run(scenario.load(str(told)), 1).recording
    assert 0.0 < log["sensed_thrust_port_N"][-1] == pytest.approx(log["thrust_starboard_N"][-1])
    assert len(set(log["sensed_phi_rad"].tolist())) > 1


def test_a_further_sensor_changes_nothing_of_what_the_others_read() -> None:
    plain, more = (
        run(scenario.load(shipped("sway_1"), s), 3).recording
        for s in ({}, {"sensor": [{"use": "inclinometer"}]})
    )
    for name in ("sensed_psi_rad", "sensed_ax_mps2", "psi_rad"):
        assert plain[name].tobytes() == more[name].tobytes()
    assert "sensed_phi_rad" in more.signals and "sensed_phi_rad" not in plain.signals


# Mistakes in files
# ------------------------------------------------------------------------------------------------

MISTAKES = [
    ({"vessle": "joystick_boat"}, r"key 'vessle' .*did you mean 'vessel'"),
    ({"vessel": "joystik_boat"}, r"vessel 'joystik_boat' .*did you mean 'joystick_boat'"),
    ({"load": ["lite"]}, r"load 'lite' .*did you mean 'light'"),
    ({"duration": -1.0}, r"duration = -1"),
    ({"measure": "sawy"}, r"measure 'sawy' does not exist; did you mean 'sway'"),
    ({"tank": {"lenght": 1.5}}, r"key in \[tank\] 'lenght' .*did you mean 'length'"),
    ({"start": {"x": 9.0}}, r"lies outside the tank"),
    (
        {"controller": {"use": "l1_joystik"}},
        r"controller 'l1_joystik' .*did you mean 'l1_joystick'",
    ),
    ({"controller": {"use": "l1_joystick", "pol": 2.0}}, r"setting 'pol' .*did you mean 'pole'"),
    (
        {"controller": {"use": "l1_joystick", "pole": 99.0}},
        r"pole = 99 1/s; allowed 0\.01 to 10 1/s",
    ),
    ({"sensors": {"speed": 0.01}}, r"\[sensors\] .*setting 'speed' .*did you mean 'speed_sd'"),
    ({"sensor": [{"use": "inclinometr"}]}, r"sensor 'inclinometr' .*did you mean 'inclinometer'"),
    (
        {"sensor": [{"use": "inclinometer"}] * 2},
        r"\[\[sensor\]\] inclinometer: phi is read by another sensor",
    ),
    ({"camera": {"mark_sd": 9.0}}, r"\[camera\] .*mark_sd = 9 m; allowed 0 to 0\.1 m"),
    ({"goal": [{"sway": 0.07}]}, r"\[\[goal\]\] key 'sway' .*did you mean 'sway_mps'"),
    ({"goal": [{"from": 3.0}, {"from": 1.0}]}, r"times in ascending order"),
    ({"goal": [{"from": 300.0}]}, r"from = 300 s; the run ends at duration = "),
    ({"goal": [{"sway_mps": 70.0}]}, r"sway_mps = 70; allowed -34\.3 to 34\.3"),
    ({"goal": [{"yaw_radps": 45.0}]}, r"yaw_radps = 45; allowed -28\.6 to 28\.6"),
    ({"goal": [{"sway_mps": "0.07"}]}, r"goal\.0\.sway_mps = '0\.07'; .*valid number"),
    ({"duration": True}, r"duration = True; .*valid number"),
    ({"effect": [{"use": "weak_revers"}]}, r"effect 'weak_revers' .*did you mean 'weak_reverse'"),
    ({"set": {"pwm_thrust": {"at_spa": 0.3}}}, r"setting 'at_spa' .*did you mean 'at_span'"),
    (
        {"norms": {"yaw_rate_l1": {"guard": [2.0, 1.0]}}},
        r"guard = \[2\.0, 1\.0\]; allowed are its lower end",
    ),
    ({"norms": {"yaw_rate_l1": {"tolerance": 1.0}}}, r"tolerance needs published"),
    (
        {"norms": {"yaw_rate_inf": {"guard": [0.0, 1.0], "unit": "m"}}},
        r"\[norms\.yaw_rate_inf\] unit = \"m\"; allowed is \"deg/s\" or \"rad/s\"",
    ),
    ({"norms": {"moved": {"guard": [0.0, 1.0]}}}, r"\[norms\] key 'moved' does not exist"),
]


@pytest.mark.parametrize(
    ("change", "line"),
    MISTAKES,
    ids=lambda value: next(iter(value), None) if isinstance(value, dict) else "",
)
def test_a_mistake_in_a_file_is_one_clear_line(change: dict[str, Any], line: str) -> None:
    with pytest.raises(BadInput, match=line) as caught:
        scenario.load(shipped("sway_1"), change)
    message = str(caught.value)
    assert message.startswith("sway.toml: sway_1: ") and "\n" not in message


def test_scenarios_and_files_that_do_not_exist_are_named(tmp_path: Path) -> None:
    with pytest.raises(BadInput, match="did you mean 'joystick_boat/sway_1'"):
        scenario.load("joystick_boat/sawy_1")
    broken = tmp_path / "mine.toml"
    broken.write_text('about = \nvessel = "joystick_boat"')
    with pytest.raises(BadInput, match=r"mine\.toml: not a TOML file .*line 1"):
        scenario.load(str(broken))
