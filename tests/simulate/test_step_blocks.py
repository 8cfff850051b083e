"""A run in open water takes many steps at once; nothing of it depends on how many, to the last bit."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
import pytest

from boatsim.control.base import Controller, Sense
from boatsim.errors import BadInput, BadPhysics
from boatsim.physics.vessel.wave_field import wave_field
from boatsim.simulate import block_stepper
from boatsim.simulate.camera import Camera
from boatsim.simulate.run import Run, Simulation, run
from boatsim.simulate.run_options import RunOptions
from boatsim.simulate.scenario import Scenario, load

OPEN = {"engine": "compiled", "tank": None}
NOISY = {"speed_sd": 0.02, "position_sd": 0.1}
SEA = [
    {"use": "gusty_wind", "speed": 4.0, "toward": 1.0, "front": 0.3, "side": 0.6},
    {
        "use": "strip_wave_loads",
        "significant_height": 0.1,
        "modal_period": 2.5,
        "toward": 1.2,
        "components": 8.0,
        "strips": 4.0,
    },
]
CASES: Mapping[str, tuple[str, dict[str, Any]]] = {
    "compiled law, speed sensor, wind, end by distance": ("joystick_boat/sway_1_wind", {}),
    "compiled law with a goal that moves, saturated": (
        "jet_ski/heading_sine",
        {"duration": 4.0, "log": 0.05},
    ),
    "compiled law in gusts and waves, all sensors": (
        "otter/joystick_surge",
        {"duration": 12.0, "goal": [{"surge_mps": 0.8}], "sensors": NOISY, "effect": SEA},
    ),
    "goals as commands in waves": (
        "otter/beam_sea",
        {"duration": 6.0, "sensors": NOISY, "effect": SEA, "log": 0.13},
    ),
    "law in Python with a model, current": ("otter/straight_integral", {"duration": 10.0}),
    "law in Python with a further sensor": ("osv/station", {"duration": 12.0}),
    "manoeuvre that ends the run": ("mariner/zigzag_10", {"log": 0.0}),
    "program of goals and pauses": (
        "joystick_boat/sway_1",
        {"duration": 8.0, "goal": [{"sway_mps": 0.07}, {"from": 3.0, "off": True}]},
    ),
}


def made(case: str) -> Scenario:
    name, over = CASES[case]
    return load(name, OPEN | over)


def step_by_step(scenario: Scenario, seed: int) -> Run:
    """A run that asks something after every step."""
    return Simulation(scenario, RunOptions(seed=seed, finish=lambda: False)).run()


def assert_same(one: Run, other: Run) -> None:
    assert (one.steps, one.saturated, one.complete) == (
        other.steps,
        other.saturated,
        other.complete,
    )
    for mine, theirs in ((one.recording, other.recording), (one.camera, other.camera)):
        np.testing.assert_array_equal(mine.t, theirs.t)
        assert mine.signals.keys() == theirs.signals.keys()
        for name, values in mine.signals.items():
            np.testing.assert_array_equal(values, theirs[name], err_msg=name)


@pytest.mark.parametrize("case", CASES)
def test_blocks_have_the_numbers_of_single_steps(case: str) -> None:
    many = run(made(case), 5)
    assert len(many.recording) > 10 and np.ptp(many.recording["u_mps"]) > 0.0
    assert_same(many, step_by_step(made(case), 5))


@pytest.mark.parametrize("size", [1, 7, 250])
def test_the_size_of_a_block_does_not_matter(size: int, monkeypatch: pytest.MonkeyPatch) -> None:
    case = "compiled law in gusts and waves, all sensors"
    whole = run(made(case), 5)
    monkeypatch.setattr(block_stepper, "MOST_STEPS", size)
    assert_same(run(made(case), 5), whole)


def test_another_seed_gives_other_waves_gusts_and_noise() -> None:
    case = "compiled law in gusts and waves, all sensors"
    one, other = (run(made(case), seed).recording for seed in (5, 6))
    for name in ("wave_elevation_m", "wind_Y_N", "sensed_x_m"):
        assert np.abs(one[name] - other[name])[1:].min() > 0.0


def test_a_motion_that_diverges_ends_both_at_the_same_time() -> None:
    # a time constant of half a millisecond, at steps of 20 ms
    over = {"duration": 5.0, "start": {"u": 0.1}, "set": {"linear_damping": {"surge": 1e5}}}
    messages = []
    for way in (run, step_by_step):
        with pytest.raises(BadPhysics, match="no longer finite at t = ") as raised:
            way(load("otter/turn", OPEN | over), 0)
        messages.append(str(raised.value))
    assert messages[0] == messages[1]


@dataclass
class Failing(Controller):
    """Fails at a time, or sends what is no number."""

    commands: ClassVar = ("n_port_radps",)

    def step(self, sense: Sense, goal: Mapping[str, float]) -> dict[str, float]:
        if sense.t > 1.0:
            raise RuntimeError("no more")
        return {"n_port_radps": 10.0}


def test_an_error_of_a_controller_has_its_own_time() -> None:
    scenario = load("otter/turn", OPEN | {"duration": 5.0, "goal": []})
    messages = []
    for way in (run, step_by_step):
        failing = Scenario(**{**vars(scenario), "controller": Failing()})
        with pytest.raises(BadInput, match="at t = 1.04 s: RuntimeError: no more") as raised:
            way(failing, 0)
        messages.append(str(raised.value))
    assert messages[0] == messages[1]


def test_a_camera_frame_does_not_depend_on_the_others() -> None:
    camera = Camera(marks={"a": (0.4, 0.1), "b": (-0.5, 0.0), "c": (0.1, -0.3)})
    rng = np.random.default_rng(0)
    t, poses, noise = np.arange(97.0), rng.normal(0, 3, (97, 3)), rng.normal(0, 1, (97, 6))
    together = camera.take_frames(t, poses, noise)
    for i in range(len(t)):
        alone = camera.take_frames(t[i : i + 1], poses[i : i + 1], noise[i : i + 1])
        np.testing.assert_array_equal(alone[0], together[i])


def test_the_elevation_at_a_place_does_not_depend_on_the_others() -> None:
    scenario = made("compiled law in gusts and waves, all sensors")
    field = wave_field(scenario.vessel.effects)
    rng = np.random.default_rng(0)
    x, y, t = rng.normal(0, 30, (3, 101))
    together = field.elevation(x, y, t)
    alone = [float(field.elevation(*place)) for place in zip(x, y, t, strict=True)]
    np.testing.assert_array_equal(alone, together)
