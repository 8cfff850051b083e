"""Policy files: what onnxruntime evaluates is the network that was written, and the controller that
runs a file commands what the policy commands in the environment of its training."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

onnx = pytest.importorskip("onnx")
pytest.importorskip("onnxruntime")

from boatsim.control.base import Sense  # noqa: E402
from boatsim.errors import BadInput  # noqa: E402
from boatsim.learn.environment_options import make_simulation  # noqa: E402
from boatsim.learn.play import TaskSimulation  # noqa: E402
from boatsim.learn.policy import ENTRY, load_policy  # noqa: E402
from boatsim.learn.policy_export import Layer, describe_policy, write_policy  # noqa: E402
from boatsim.learn.tasks.joystick import MOVES  # noqa: E402
from boatsim.learn.tasks.names import TASKS  # noqa: E402
from boatsim.physics.content import load_class  # noqa: E402
from boatsim.simulate import run, scenario  # noqa: E402

NAN = float("nan")
Written = tuple[Path, TaskSimulation, list[Layer]]


def written(folder: Path, task: str, seed: int = 1, **options: Any) -> Written:
    """A random network for a task, in a file."""
    play = make_simulation(task, 5, vessel="joystick_boat", **options)
    rng = np.random.default_rng(seed)
    widths = (len(play.signals), 7, 5, len(play.controls.names))
    layers: list[Layer] = []
    for inputs, outputs in zip(widths[:-1], widths[1:], strict=True):
        weights = rng.standard_normal((outputs, inputs)).astype(np.float32)
        layers.append((weights, rng.standard_normal(outputs).astype(np.float32)))
    path = folder / f"{task}.onnx"
    write_policy(path, layers, describe_policy(play))
    return path, play, layers


@pytest.mark.parametrize("task", TASKS)
def test_a_runtime_evaluates_the_network_that_was_written(task: str, tmp_path: Path) -> None:
    path, play, layers = written(tmp_path, task)
    bounds = np.array([signal.bound for signal in play.signals])
    observations = np.random.default_rng(2).uniform(-2.0, 2.0, (9, len(bounds))) * bounds
    values = np.clip(observations / bounds, -1.0, 1.0)
    for number, (weights, bias) in enumerate(layers):
        values = values @ weights.T + bias
        if number < len(layers) - 1:
            values = np.tanh(values)
    actions = load_policy(path).act(observations.astype(np.float32))
    assert actions == pytest.approx(np.clip(values, -1.0, 1.0), abs=1e-5)
    assert np.abs(actions).max() == 1.0 and np.abs(actions).min() < 0.9


def sensed(play: TaskSimulation, boat: int) -> Sense:
    x, y, psi, u, v, r = (float(values[boat]) for values in play.motion)
    return Sense(float(play.t[boat]), psi, r, NAN, NAN, u, v, x, y)


@pytest.mark.parametrize("task", ["berth", "hold_station", "joystick"])
def test_the_controller_commands_what_the_policy_commands_in_its_environment(
    task: str, tmp_path: Path
) -> None:
    path, play, _ = written(tmp_path, task, duration=30.0)
    policy = load_policy(path)
    play.begin_episodes(np.arange(5, dtype=np.uint64), np.arange(5))
    controllers = [load_class("controller", str(path)).from_settings({}) for _ in range(5)]
    for _ in range(60):
        sent = []
        for boat, controller in enumerate(controllers):
            goal = {"x_m": 0.0, "y_m": 0.0, "psi_rad": 0.0}
            if task == "joystick":
                move = int(play.t[boat] / 10.0 + 1e-9) % MOVES
                sway, yaw = play.goals[boat, [move, MOVES + move]]
                goal = {"sway_mps": float(sway), "yaw_radps": float(yaw)}
            commands = controller.step(sensed(play, boat), goal)
            sent.append([commands[name] for name in play.vessel.commands])
        play.step(policy.act(play.observations(normalised=False)))
        assert np.array(sent) == pytest.approx(play.commands, rel=1e-4, abs=1e-3)


def test_a_path_of_waypoints_is_observed_like_the_same_path_of_the_training(tmp_path: Path) -> None:
    path, play, _ = written(tmp_path, "follow_path")
    play.begin_episodes(np.arange(5, dtype=np.uint64), np.arange(5))
    observed = play.observations(normalised=False)
    count = len(play.signals) - len(play.controls.names)
    for boat, (amplitude, wave, phase) in enumerate(play.goals):
        x = np.arange(-2.0, 20.0, 0.2)
        waypoints = np.column_stack([x, amplitude * np.sin(wave * x + phase)]).tolist()
        settings = {"waypoints": waypoints, "path": "spline"}
        controller = load_class("controller", str(path)).from_settings(settings)
        for _ in range(3):  # from the start of the path to the foot point
            controller.step(sensed(play, boat), {})
        values = np.array(controller._observed(sensed(play, boat), {}))
        # the path one length ahead is one length along x there, along the path here
        assert values == pytest.approx(observed[boat, :count], abs=0.03)


def test_a_policy_in_another_frame_commands_the_same(tmp_path: Path) -> None:
    """A station elsewhere, with another heading, is the same station seen from the boat."""
    path, *_ = written(tmp_path, "hold_station")
    one, other = (load_class("controller", str(path)).from_settings({}) for _ in range(2))
    pose, turn, shift = np.array([0.3, -0.2, 0.4]), 2.1, np.array([5.0, -3.0])
    motion = {"r": 0.1, "ax": NAN, "ay": NAN, "u": 0.1, "v": -0.05}
    c, s = np.cos(turn), np.sin(turn)
    x, y = shift + np.array([[c, -s], [s, c]]) @ pose[:2]
    here = one.step(
        Sense(t=0.0, x=pose[0], y=pose[1], psi=pose[2], **motion),
        {"x_m": 0.0, "y_m": 0.0, "psi_rad": 0.0},
    )
    there = other.step(
        Sense(t=0.0, x=x, y=y, psi=pose[2] + turn, **motion),
        {"x_m": shift[0], "y_m": shift[1], "psi_rad": turn},
    )
    assert list(here) == list(there)
    assert list(here.values()) == pytest.approx(list(there.values()), rel=1e-4, abs=1e-3)


SCENARIO = """vessel = "joystick_boat"
duration = 2.0
sensors = {{ ideal = true }}
[controller]
use = "{policy}"
[[goal]]
"""


def scenario_file(folder: Path, policy: str, goals: str = "") -> str:
    file = folder / "station.toml"
    file.write_text(SCENARIO.format(policy=policy) + goals, encoding="utf-8")
    return str(file)


def test_a_scenario_runs_a_policy_next_to_it_without_trust(tmp_path: Path) -> None:
    written(tmp_path, "hold_station")
    one = scenario.load(scenario_file(tmp_path, "hold_station.onnx"))
    assert one.controller.period == 0.2
    result = run.run(one)
    sent = np.array([result.recording[name] for name in one.vessel.commands])
    assert np.ptp(sent, axis=1).max() > 0.0


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"task": "berht"}, "task 'berht' does not exist; did you mean 'berth'?"),
        ({"period": 0.0}, "period"),
        ({"bounds": [1.0]}, "bounds: 1 numbers; allowed are 12"),
        (
            {"observations": ["u_mps"]},
            "observation 'u_mps'; hold_station has 'ahead_m' in its place",
        ),
        ({"up": [-1.0] * 5}, "up"),
        ({"sale": 1.0}, "sale"),
        ({"format": 2}, "format"),
    ],
)
def test_a_wrong_description_is_refused_in_one_line(
    change: dict[str, Any], message: str, tmp_path: Path
) -> None:
    path, *_ = written(tmp_path, "hold_station")
    model = onnx.load(path)
    (entry,) = model.metadata_props
    entry.value = json.dumps({**json.loads(entry.value), **change})
    onnx.save(model, path)
    with pytest.raises(BadInput) as refused:
        load_policy(path)
    assert message in str(refused.value) and "\n" not in str(refused.value)
    assert "hold_station.onnx" in str(refused.value)


def test_files_that_are_no_policy_are_refused_in_one_line(tmp_path: Path) -> None:
    for content, message in ((None, "no such file"), (b"text", "no network in ONNX")):
        path = tmp_path / "wrong.onnx"
        if content is not None:
            path.write_bytes(content)
        with pytest.raises(BadInput, match=message) as refused:
            scenario.load(scenario_file(tmp_path, "wrong.onnx"))
        assert "\n" not in str(refused.value)
    path, *_ = written(tmp_path, "hold_station")
    model = onnx.load(path)
    del model.metadata_props[:]
    onnx.save(model, path)
    with pytest.raises(BadInput, match=f"metadata lack {ENTRY}"):
        load_policy(path)
    with pytest.raises(BadInput, match="use names no policy"):
        load_class("controller", "learned_policy").from_settings({}).channels()


def test_goals_and_settings_of_another_task_are_refused(tmp_path: Path) -> None:
    path, *_ = written(tmp_path, "berth")
    kind = load_class("controller", str(path))
    sense = Sense(0.0, 0.0, 0.0, NAN, NAN, 0.0, 0.0, 0.0, 0.0)
    with pytest.raises(BadInput, match="needs the goal x_m"):
        kind.from_settings({}).step(sense, {})
    with pytest.raises(BadInput, match="goal sway_mps does not apply to a policy for berth"):
        kind.from_settings({}).step(sense, {"sway_mps": 0.1})
    with pytest.raises(BadInput, match="which has no path"):
        kind.from_settings({"waypoints": [[0.0, 0.0], [1.0, 0.0]]})
    blind = Sense(0.0, 0.0, 0.0, NAN, NAN, NAN, NAN, 0.0, 0.0)
    with pytest.raises(BadInput, match="no sensor measures u, v, which"):
        kind.from_settings({}).step(blind, {"x_m": 0.0, "y_m": 0.0, "psi_rad": 0.0})


def test_the_last_commands_stay_in_an_outage(tmp_path: Path) -> None:
    path, *_ = written(tmp_path, "hold_station")
    controller = load_class("controller", str(path)).from_settings({})
    readings = {"psi": 0.1, "r": 0.0, "ax": NAN, "ay": NAN, "u": 0.1, "v": 0.0}
    first = controller.step(Sense(t=0.0, x=0.3, y=0.1, **readings), {})
    assert controller.step(Sense(t=0.2, x=NAN, y=NAN, **readings), {}) == first
    assert controller.step(Sense(t=0.4, x=0.5, y=0.1, **readings), {}) != first
