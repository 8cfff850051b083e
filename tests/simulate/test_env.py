"""The boat as a dm_control environment: dm_env's conformance, the scenario's own trajectory,
nothing left behind."""

import copy
import os
import pickle
import subprocess
import sys
import unittest
from collections.abc import Iterator
from math import cos, sin
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
import pytest

pytest.importorskip("dm_control", reason="dm_control does not support Python 3.13 and later")
from dm_env import test_utils

from boatsim.errors import BadInput, BadPhysics
from boatsim.physics.commands import clipped_recorded_commands
from boatsim.recordings.notes import unit_of
from boatsim.simulate import env, scenario  # before dm_control, whose renderer it chooses
from boatsim.simulate.cases import ScenarioLocation
from boatsim.simulate.engine import Engine
from boatsim.simulate.run import run
from boatsim.simulate.scenario import Scenario

# isort: split
from dm_control import mujoco as dm_mujoco
from dm_control.rl.control import PhysicsError

CHANNELS = [
    "thrust_port_N",
    "thrust_starboard_N",
    "steer_port_rad",
    "steer_starboard_rad",
    "pwm_port",
    "pwm_starboard",
]
AHEAD = np.array([0.0, 0.0, 0.3, -0.2, 150.0, 120.0])  # outboards at different angles
POSE = ("x_m", "y_m", "psi_rad", "u_mps", "v_mps", "r_radps")
NO_DISPLAY = {
    k: v for k, v in os.environ.items() if k not in ("DISPLAY", "WAYLAND_DISPLAY", "MUJOCO_GL")
}


@pytest.fixture(autouse=True)
def callback_is_out_again() -> Iterator[None]:
    yield
    assert mujoco.get_mjcb_passive() is None


def short(name: str = "joystick_boat/yaw_1", duration: float = 0.8, **more: Any) -> Scenario:
    return scenario.load(name, {"duration": duration, "until": {}, **more})


def random_actions(boat: Any, rows: int, seed: int) -> np.ndarray[Any, Any]:
    spec = boat.action_spec()
    return np.random.default_rng(seed).uniform(spec.minimum, spec.maximum, (rows, *spec.shape))


def seen(step: Any) -> list[float]:
    return [float(step.observation[name]) for name in POSE]


def played(boat: Any, actions: Any) -> np.ndarray[Any, Any]:
    """(rows + 1, 6) pose and velocities from a reset on."""
    return np.array([seen(boat.reset()), *(seen(boat.step(action)) for action in actions)])


class TestConformance(test_utils.EnvironmentTestMixin, unittest.TestCase):  # type: ignore[misc]
    """dm_env's own tests; 20 actions reach the end of an episode of 10."""

    def make_object_under_test(self) -> Any:
        return env.load(short())


class TestFlatConformance(test_utils.EnvironmentTestMixin, unittest.TestCase):  # type: ignore[misc]
    """The same with one flat observation."""

    def make_object_under_test(self) -> Any:
        return env.load(short(), flat_observation=True)


@pytest.mark.parametrize(
    ("name", "more"),
    [
        ("joystick_boat/sway_1", {}),
        ("joystick_boat/yaw_1_as_published", {}),  # begins with its servos parked at an angle
        (
            "joystick_boat/sway_1",
            {"tank": {"length": 1.5, "width": 1.0, "centre": [0.1, 0.0]}},
        ),  # runs into the wall
        ("joystick_boat/sway_1", {"start": {"x": 0.1, "psi": 0.3, "u": 0.1, "v": -0.1, "r": 0.2}}),
    ],
    ids=["sway", "as published", "into the wall", "moving start"],
)
def test_commands_of_a_scenario_give_its_trajectory(name: str, more: dict[str, Any]) -> None:
    one = short(name, 12.0, **more)
    rows = run(one).recording
    actions = clipped_recorded_commands(one.vessel, rows.signals, len(rows))[
        :600:4
    ]  # steps of 20 ms, a new command every 80 ms
    expected = np.column_stack([rows[n] for n in POSE])[:601:4]
    found = played(env.load(one), actions)
    assert np.ptp(expected, axis=0).max() > 0.1
    if "tank" in more:
        assert rows["contacts"].max() > 0
    assert found == pytest.approx(expected, rel=0, abs=1e-9)


def test_actuators_follow_as_in_the_scenario() -> None:
    one = short("joystick_boat/sway_1", 4.0)
    rows, boat = run(one).recording, env.load(one)
    boat.reset()
    for k, action in enumerate(
        clipped_recorded_commands(one.vessel, rows.signals, len(rows))[:200:4]
    ):
        step = boat.step(action)
        for name in one.vessel.actuators:
            assert step.observation[f"actual_{name}"] == pytest.approx(
                rows[f"actual_{name}"][4 * (k + 1)], abs=1e-12
            )


def test_environments_and_an_engine_side_by_side_do_not_disturb_each_other() -> None:
    one, other = short(duration=8.0), short("joystick_boat/sway_2", 8.0)
    a, b, engine = env.load(one), env.load(other), Engine(other.vessel)
    actions = random_actions(a, 50, seed=1)
    alone = played(env.load(one), actions), played(env.load(other), -actions)
    commands = dict(zip(CHANNELS, AHEAD, strict=True))
    undisturbed = Engine(other.vessel)
    for e in (engine, undisturbed):
        e.reset(None, commands)
    together: tuple[list[Any], list[Any]] = [seen(a.reset())], [seen(b.reset())]
    for action in actions:
        together[0].append(seen(a.step(action)))
        engine.advance(4)
        together[1].append(seen(b.step(-action)))
        undisturbed.advance(4)
    for found, expected in zip(together, alone, strict=True):
        assert (np.array(found) == expected).all()
    assert engine.state == undisturbed.state


def test_models_of_others_compile_and_move_as_ever_between_steps() -> None:
    xml = "<mujoco><worldbody><body><freejoint/><geom size='.1'/></body></worldbody></mujoco>"
    boat = env.load(short())
    boat.reset()
    boat.step(AHEAD)
    ball = dm_mujoco.Physics.from_xml_string(
        xml
    )  # compiling fails where a Python callback is left installed
    boat.step(AHEAD)
    ball.step(100)
    fall = -9.81 * 0.002**2 * 100 * 101 / 2  # semi-implicit Euler: g dt^2 n (n + 1) / 2
    assert ball.data.qpos[2] == pytest.approx(fall)


def test_the_callback_is_taken_out_after_an_error_too() -> None:
    boat = env.load(short())
    boat.reset()
    boat.physics.engine.data.qvel[:] = 1e200
    with pytest.raises((PhysicsError, BadPhysics)):
        boat.step(AHEAD)
    assert mujoco.get_mjcb_passive() is None


def test_every_observation_has_a_unit_in_its_name_and_actions_have_the_vessels_limits() -> None:
    boat = env.load(short())
    observations, actions = boat.observation_spec(), boat.action_spec()
    assert [name for name in observations if not unit_of(name)] == []
    assert [spec.name for spec in observations.values()] == list(observations)
    assert {"x_m", "r_radps", "actual_steer_port_rad", "goal_yaw_radps"} <= set(observations)
    assert actions.name.split("\t") == CHANNELS
    limits = boat.task.scenario.vessel.limits()
    assert [tuple(pair) for pair in zip(actions.minimum, actions.maximum, strict=True)] == [
        limits[n] for n in CHANNELS
    ]
    assert boat.control_timestep() == pytest.approx(0.08)


def test_an_episode_lasts_as_long_as_the_scenario_and_ends_undiscounted() -> None:
    boat = env.load(short(duration=0.8))
    boat.reset()
    steps = [boat.step(AHEAD) for _ in range(10)]
    assert [s.last() for s in steps] == [False] * 9 + [True]
    assert steps[-1].discount == 1.0
    assert boat.physics.time() == pytest.approx(0.8)


def test_a_boat_that_rolls_shows_its_roll() -> None:
    """jet_ski heels when its jet is turned; its heel is observed with its rate."""
    boat = env.load(scenario.load("jet_ski/zigzag"))
    plain = env.load("joystick_boat/sway_1").reset().observation
    assert not {"phi_rad", "p_radps"} & set(plain)
    step, spec = boat.reset(), boat.action_spec()
    for _ in range(20):
        step = boat.step(spec.maximum)
    state = boat.physics.engine.state
    assert abs(state.phi) > 1e-3
    assert (step.observation["phi_rad"], step.observation["p_radps"]) == (state.phi, state.p)


def test_an_action_beyond_the_limits_acts_as_the_limit() -> None:
    ends = []
    for factor in (1.0, 50.0):
        boat = env.load("joystick_boat/sway_1")
        boat.reset()
        for _ in range(20):
            boat.step(factor * boat.action_spec().maximum)
        ends.append(boat.physics.engine.state)
        assert np.array_equal(boat.physics.control(), boat.action_spec().maximum)
    assert ends[0] == ends[1]


def test_an_episode_begins_with_the_actuators_where_the_scenario_has_them() -> None:
    one = short("joystick_boat/sway_1", 4.0, start={"commands": {"steer_port_rad": 0.3}})
    boat = env.load(one)
    assert (
        boat.reset().observation["actual_steer_port_rad"]
        == run(one).recording["actual_steer_port_rad"][0]
        != 0.0
    )


def test_observations_are_sname() -> None:
    boat = env.load(short())
    boat.reset()
    for _ in range(8):
        step = boat.step(np.array([1.0, -1.0, 0.0, 0.0, 0.0, 0.0]))
    assert (
        step.observation["r_radps"] > 0 and step.observation["psi_rad"] > 0
    )  # port thrust ahead: to starboard
    assert boat.physics.data.qvel[2] < 0  # MuJoCo's z is up


def test_reward_is_minus_the_squared_error_of_velocity() -> None:
    goals = [{"sway_mps": 0.1, "yaw_radps": 0.2}, {"from": 0.15, "surge_mps": 0.3}]
    boat = env.load(short(goal=goals))
    first, rest = boat.reset(), [boat.step(AHEAD) for _ in range(3)]
    assert first.reward is None
    for step, (surge, sway, yaw) in zip(
        rest, [(0, 0.1, 0.2), (0.3, 0, 0), (0.3, 0, 0)], strict=True
    ):
        o = step.observation
        assert (o["goal_surge_mps"], o["goal_sway_mps"], o["goal_yaw_radps"]) == (surge, sway, yaw)
        error = [
            o["u_mps"] - surge,
            o["v_mps"] - sway,
            0.6 * (o["r_radps"] - yaw),
        ]  # 0.6 m: half the boat
        assert step.reward == pytest.approx(-sum(e * e for e in error))


def test_start_is_scattered_by_the_seed_only() -> None:
    starts = {
        key: played(env.load(short(), seed=key[0], scatter=key[1]), [AHEAD] * 3)
        for key in [(1, 0.05), (2, 0.05), (1, 0.0), (2, 0.0)]
    }
    again = env.load(short(), seed=1, scatter=0.05)
    assert (played(again, [AHEAD] * 3) == starts[1, 0.05]).all()
    assert (
        played(again, [AHEAD] * 3) != starts[1, 0.05]
    ).any()  # the next episode starts elsewhere
    assert (starts[1, 0.05][0, :3] != starts[2, 0.05][0, :3]).all()
    assert (starts[1, 0.0] == starts[2, 0.0]).all()
    assert (np.abs(starts[1, 0.05][0, :3]) <= 0.05 * np.array([1.2, 1.2, 1.0])).all()


@pytest.mark.parametrize(
    "duplicate", [copy.deepcopy, lambda p: pickle.loads(pickle.dumps(p)), lambda p: p.copy()]
)
def test_a_copy_goes_on_as_the_original_does(duplicate: Any) -> None:
    boat = env.load(short("joystick_boat/sway_1", 8.0))
    boat.reset()
    for action in random_actions(boat, 5, seed=2):
        boat.step(action)
    physics, other = boat.physics, duplicate(boat.physics)
    assert other.engine.state == physics.engine.state
    for p in (physics, other):
        p.set_control(AHEAD)
    physics.step(20)
    assert other.engine.state != physics.engine.state  # they share nothing
    other.step(20)
    assert other.engine.state == physics.engine.state
    assert other.engine.actuators == physics.engine.actuators


def test_a_state_holds_what_the_actuators_remember() -> None:
    physics = env.load(short()).physics
    physics.set_control(AHEAD)
    physics.step(5)
    saved, ends = physics.get_state(), []
    for _ in range(2):
        with physics.reset_context():
            physics.set_state(saved)
        physics.step(30)
        ends.append(physics.engine.state)
    assert ends[0] == ends[1]
    assert (physics.control() == AHEAD).all()


def test_outboards_are_drawn_at_their_actual_angle() -> None:
    boat = env.load(short())
    boat.reset()
    step = boat.step(AHEAD)
    psi = float(step.observation["psi_rad"])
    for side in ("port", "starboard"):
        angle = float(step.observation[f"actual_steer_{side}_rad"])
        assert abs(angle) > 0.1
        ahead = boat.physics.named.data.xmat[f"outboard_{side}"].reshape(3, 3)[:, 0]
        assert ahead == pytest.approx(
            [cos(psi + angle), -sin(psi + angle), 0.0]
        )  # z up: y is to port


@pytest.mark.parametrize("camera", ["above", "oblique"])
def test_pictures_show_boat_and_motion_without_a_display(camera: str) -> None:
    boat = env.load(short())
    boat.reset()
    try:
        before = boat.physics.render(120, 160, camera_id=camera)
    except (RuntimeError, ImportError) as error:
        pytest.skip(f"no OpenGL: {error}")
    for _ in range(9):
        boat.step(AHEAD)
    after = boat.physics.render(120, 160, camera_id=camera)
    boat.physics.free()
    assert before.shape == (120, 160, 3)
    assert before.std() > 10.0
    changed = np.abs(after.astype(int) - before).max(axis=2) > 30
    assert 20 < changed.sum() < 0.2 * changed.size  # the boat moved, the tank did not


def without_a_display(code: str) -> tuple[int, str, str]:
    """Exit code and output; every warning is printed (as an error, GLFW's would be caught by
    dm_control)."""
    done = subprocess.run(
        [sys.executable, "-W", "always", "-c", code], env=NO_DISPLAY, capture_output=True, text=True
    )
    return done.returncode, done.stdout, done.stderr


def test_importing_without_a_display_is_silent() -> None:
    assert without_a_display("import boatsim.simulate.env") == (0, "", "")


def test_physics_needs_no_opengl() -> None:
    code = """
import ctypes
load = ctypes.CDLL.__init__
def refuse(self, name, *a, **k):
    if name and ("EGL" in str(name) or "OSMesa" in str(name)):
        raise OSError(name)
    load(self, name, *a, **k)
ctypes.CDLL.__init__ = refuse
from boatsim.simulate import env
boat = env.load("joystick_boat/sway_1")
boat.reset()
print(boat.step(boat.action_spec().generate_value()).mid())
"""
    assert without_a_display(code) == (0, "True\n", "")


@pytest.mark.parametrize(
    "action", [np.zeros(5), np.full(6, np.nan), 0.0], ids=["short", "nan", "scalar"]
)
def test_an_action_that_is_none_is_refused_in_a_line(action: Any) -> None:
    boat = env.load(short())
    boat.reset()
    with pytest.raises(BadInput, match=r"action .*allowed are 6 finite numbers: thrust_port_N"):
        boat.step(action)


def test_what_can_be_no_environment_is_refused_in_a_line() -> None:
    rolling = {
        "about": "",
        "vessel": "kvlcc2_roll",
        "duration": 1.0,
        "controller": {"use": "open_loop"},
    }
    with pytest.raises(BadInput, match="kvlcc2_roll is not free in surge, sway and yaw"):
        env.load(scenario.from_table(rolling, ScenarioLocation(Path("rolling.toml"))))
    with pytest.raises(BadInput, match=r"period 0.08 s is not a whole number of steps of 0.03 s"):
        env.load(short(step=0.03))
    with pytest.raises(BadInput, match="allowed 0 to 1"):
        env.load(short(), scatter=-0.1)
    with pytest.raises(ValueError, match="keyframe 0"):
        env.load(short()).physics.reset(0)
