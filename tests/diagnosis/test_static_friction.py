"""Friction that is larger at rest than while sliding, whose ratio a diagnosis does not fit."""

import numpy as np
import pytest

from tests.driven_pendulum import STRIBECK, Pendulum, diagnosed, recording

SECONDS = 15.0
# it turns over the top and hardly sticks; it swings by 0.4 rad and sticks nearly half of the time
RIGS = (
    Pendulum(friction=0.15, static_ratio=1.5),
    Pendulum(friction=0.3, static_ratio=1.5, amplitude=0.25),
)


@pytest.mark.slow
@pytest.mark.parametrize("real", RIGS)
def test_dry_friction_with_stiction_is_named_with_the_level_of_sliding(real: Pendulum) -> None:
    answer = diagnosed(real, SECONDS)
    assert answer["verdict"] == "named" and not answer["unknown"]["flag"], answer["sentence"]
    (effect,) = answer["effects"]
    assert effect["name"] == "dry_friction" and not effect["tied_with"]
    assert not answer["also_possible"]
    level = effect["parameters"]["roll_Nm"]["value"]
    assert level == pytest.approx(real.friction, rel=0.2)
    assert {finding["name"] for finding in answer["log"]} <= {"at_rest"}  # where it sticks


def test_the_second_rig_sticks_nearly_half_of_the_time() -> None:
    run = recording(1, SECONDS, RIGS[1])
    rates = np.abs(np.gradient(run["phi_rad"], run.t))
    assert 0.3 < np.mean(rates < STRIBECK) < 0.7
