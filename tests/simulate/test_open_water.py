"""A run in compiled code alone is the run on MuJoCo, and so is one that leaps from row to row."""

import numpy as np
import pytest

from boatsim.errors import BadInput
from boatsim.simulate import scenario
from boatsim.simulate.run import Run, run

BARE = {"until": {}, "tank": None, "measure": None, "norms": {}, "check": []}
FULL_STICK = [
    {"sway_mps": 0.07, "surge_mps": 0.05},
    {"from": 6.0, "yaw_radps": 0.6},
]  # more than the outboards give
CASES = {
    "a row a step": ("joystick_boat/sway_1_wind", {"duration": 12.0}),
    "leaps": ("joystick_boat/sway_1_wind", {"duration": 12.0, "log": 0.8}),
    "goals that change, saturated": (
        "joystick_boat/yaw_2",
        {"duration": 12.0, "log": 1.0, "goal": FULL_STICK},
    ),
    "a goal that moves": ("jet_ski/heading_sine", {"duration": 8.0}),
    "a helm that acts between periods": ("kvlcc2_mmg/zigzag_20", {"duration": 20.0}),
    "an adaptive loop": ("jet_ski/turn_disturbance", {"duration": 6.0}),
}


def on(engine: str, case: str) -> Run:
    name, over = CASES[case]
    return run(scenario.load(name, BARE | over | {"engine": engine}), seed=4)


@pytest.mark.parametrize("case", CASES)
def test_all_that_is_logged_is_as_on_mujoco(case: str) -> None:
    ours, theirs = on("twin", case), on("mujoco", case)
    assert (ours.steps, ours.saturated) == (theirs.steps, theirs.saturated)
    for mine, other in ((ours.recording, theirs.recording), (ours.camera, theirs.camera)):
        np.testing.assert_allclose(mine.t, other.t, atol=1e-9)
        assert mine.signals.keys() == other.signals.keys()
        for name, values in mine.signals.items():
            size = np.nanmax(np.abs(other.signals[name]), initial=1e-3)
            # MuJoCo's acceleration is that of the last stage of a step, and of none before the
            # first
            near, first = (0.05, 1) if name.startswith("sensed_a") else (1e-6, 0)
            np.testing.assert_allclose(
                values[first:], other.signals[name][first:], atol=near * size, err_msg=name
            )


def test_walls_are_for_mujoco_alone() -> None:
    with pytest.raises(
        BadInput, match='engine = "twin" with a \\[tank\\]; the compiled engine has open water only'
    ):
        scenario.load("joystick_boat/sway_1", {"engine": "twin"})
