"""Laws of the camera above: any marks fixed to the hull give the pose, as exactly as its notes
say."""

import re
from dataclasses import replace
from math import pi
from pathlib import Path

import numpy as np
import pytest

from boatsim.errors import BadInput
from boatsim.physics import vessel
from boatsim.physics.content import shipped_content_names
from boatsim.simulate import scenario
from boatsim.simulate.camera import Camera
from boatsim.simulate.run import run

MARKS = {"mast": (0.1, 0.0), "port_light": (0.4, -0.3), "cleat": (-0.7, 0.2)}


@pytest.mark.parametrize("pose", [(0.0, 0.0, 0.0), (3.0, -2.0, 1.2), (-5.0, 0.4, -3.0)])
def test_marks_seen_without_noise_give_the_true_pose(pose: tuple[float, float, float]) -> None:
    frame = Camera(mark_sd=0.0, marks=MARKS).take_frame(1.0, pose, np.zeros(6))
    assert (frame.x, frame.y, frame.psi) == pytest.approx(pose, abs=1e-12)


def test_marks_stand_where_a_turned_hull_carries_them() -> None:
    """On an easterly heading what is ahead lies east, what is to starboard south."""
    frame = Camera(marks=MARKS).take_frame(0.0, (10.0, 20.0, pi / 2), np.zeros(6))
    assert frame.marks == pytest.approx((10.0, 20.1, 10.3, 20.4, 9.8, 19.3))


@pytest.mark.parametrize(
    "marks", [MARKS, {"fore": (0.183, 0.0), "aft": (-0.117, 0.0)}], ids=["three", "two"]
)
def test_the_pose_scatters_as_the_notes_say(marks: dict[str, tuple[float, float]]) -> None:
    camera, n = Camera(mark_sd=0.003, marks=marks), 40_000
    noise = np.random.default_rng(1).standard_normal((n, 2 * len(marks)))
    place, psi = camera.fit_pose(
        camera.measured_mark_positions(np.zeros(n), np.full(n, 0.7), noise)
    )
    told = camera.pose_noise()
    assert (place.real.std(), place.imag.std()) == pytest.approx(
        (told["position_sd_m"],) * 2, rel=0.02
    )
    assert psi.std() == pytest.approx(told["heading_sd_rad"], rel=0.02)


def test_the_log_has_a_column_for_each_mark_of_vessel_and_scenario() -> None:
    told = scenario.load(
        "joystick_boat/sway_1", {"duration": 1.0, "camera": {"marks": {"mast": [0.0, 0.1]}}}
    )
    seen = [
        n for n in run(told).recording.signals if n.startswith("camera_") and n.endswith("_x_m")
    ]
    assert seen == ["camera_led_x_m", "camera_button_x_m", "camera_mast_x_m", "camera_x_m"]


def test_general_code_names_no_mark_and_no_work_that_has_them() -> None:
    """What belongs to one tank or one paper stands in its vessel and scenarios."""
    marks = {
        mark for name in shipped_content_names("vessel") for mark in vessel.load_vessel(name).marks
    }
    said = re.compile(rf"\b({'|'.join(marks)}|thesis)\b", re.IGNORECASE)
    files = sorted((Path(__file__).parents[2] / "boatsim").rglob("*.py"))
    assert marks and [(f.name, m.group()) for f in files if (m := said.search(f.read_text()))] == []


def test_a_hull_without_marks_is_followed_by_its_ends() -> None:
    told = scenario.load("mariner/zigzag_10")
    assert dict(told.camera.marks) == {"bow": (80.465, 0.0), "stern": (-80.465, 0.0)}


def test_a_measure_of_a_mark_that_is_not_there_is_one_line() -> None:
    told = scenario.load("joystick_boat/yaw_1")
    with pytest.raises(BadInput, match="yaw: mark 'lead' does not exist; did you mean 'led'"):
        scenario.load("joystick_boat/yaw_1", {"measure": {**told.file.measure, "mark": "lead"}})  # type: ignore[dict-item]


@pytest.mark.parametrize(
    ("marks", "line"),
    [
        ({"led": [0.1]}, r"Camera\.marks\.led = \[0\.1\]; allowed are two numbers"),
        ({"led": [0.1, "far"]}, r"Camera\.marks\.led = "),
        ({"led": [-0.117, 0.0]}, "a heading needs two marks in different places"),
        ([1.0, 2.0], "allowed is a table"),
    ],
)
def test_marks_that_can_not_be_are_one_line(marks: object, line: str) -> None:
    with pytest.raises(BadInput, match=line) as caught:
        scenario.load("joystick_boat/sway_1", {"camera": {"marks": marks}})
    assert str(caught.value).startswith("sway.toml: sway_1: [camera] ")


def test_size_of_the_picture_does_not_turn_the_boat() -> None:
    camera = Camera(marks=MARKS)
    seen = camera.measured_mark_positions(np.array(0j), np.array(0.3), np.zeros(6))
    assert camera.fit_pose(1.05 * seen)[1] == pytest.approx(0.3)
    assert replace(camera, mark_sd=0.0).pose_noise() == {
        "position_sd_m": 0.0,
        "heading_sd_rad": 0.0,
    }
