"""The trained policies of examples/policies do their tasks in scenarios that they did not see in the
training: with noisy sensors, and on a path of waypoints."""

from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("onnxruntime")

from boatsim.physics.signals import Array  # noqa: E402
from boatsim.recordings.table import Recording  # noqa: E402
from boatsim.simulate import run, scenario  # noqa: E402
from boatsim.simulate.scenario import Scenario  # noqa: E402

FOLDER = Path(__file__).parents[2] / "examples" / "policies"


def simulated(name: str) -> tuple[Scenario, Recording]:
    one = scenario.load(str(FOLDER / f"{name}.toml"))
    return one, run.run(one).recording


def pose_errors(log: Recording, x: float, y: float, psi: float) -> tuple[Array, Array]:
    return np.hypot(log["x_m"] - x, log["y_m"] - y), np.abs(log["psi_rad"] - psi)


def test_the_policy_lies_at_its_berth_and_never_touched_the_quay() -> None:
    one, log = simulated("berth")
    distance, turn = pose_errors(log, 0.0, 0.0, 0.0)
    there = log.t > 20.0
    length, beam = one.vessel.length, one.vessel.beam
    assert distance[there].max() < 0.1 * length and turn[there].max() < np.radians(5.0)
    outer_side = log["y_m"] - 0.5 * beam * np.cos(log["psi_rad"])
    reach = 0.5 * length * np.abs(np.sin(log["psi_rad"]))
    assert (outer_side - reach).min() > -(0.5 * beam + 0.15 * length)


def test_the_policy_holds_its_station_and_moves_to_the_next_one() -> None:
    one, log = simulated("hold_station")
    for begin, end, pose in ((10.0, 30.0, (0.0, 0.0, 0.0)), (40.0, 60.0, (0.4, 0.3, 0.4))):
        distance, turn = pose_errors(log, *pose)
        held = (log.t > begin) & (log.t < end)
        assert distance[held].max() < 0.1 * one.vessel.length
        assert turn[held].max() < np.radians(5.0)


def test_the_policy_stays_near_a_path_of_waypoints_and_keeps_its_speed() -> None:
    one, log = simulated("follow_path")
    path = one.controller.planned_path(one.vessel.length)  # type: ignore[attr-defined]
    aside = []
    for x, y in zip(log["x_m"], log["y_m"], strict=True):
        point = path.point(path.nearest(x, y))
        aside.append(np.hypot(x - point.x, y - point.y))
    settled = log.t > 5.0
    assert np.array(aside)[settled].max() < 0.6 * one.vessel.length
    assert log["u_mps"][settled].min() > 0.5


def test_the_policy_turns_as_the_stick_requests_and_moves_to_its_side() -> None:
    """Sideways it reaches a third of the requested speed."""
    _, log = simulated("joystick")
    for begin, end, sway, yaw in (
        (8.0, 15.0, 0.05, 0.0),
        (20.0, 30.0, 0.0, 0.12),
        (38.0, 50.0, -0.05, 0.0),
    ):
        moving = (log.t > begin) & (log.t < end)
        v = log["v_mps"][moving].mean()
        assert v == pytest.approx(sway, abs=0.04) and v * sway >= 0.0
        assert log["r_radps"][moving].mean() == pytest.approx(yaw, abs=0.03)
        assert log["u_mps"][moving].mean() == pytest.approx(0.0, abs=0.03)
