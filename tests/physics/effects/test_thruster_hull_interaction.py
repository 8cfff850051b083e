"""A race that strikes the hull: the loss by its direction, and where it is tested."""

from math import cos, pi, radians

import pytest

from boatsim.diagnosis.candidates import candidate_library
from boatsim.physics.base import make_motion
from boatsim.physics.effects.thruster import Thruster
from boatsim.physics.effects.thruster_hull_interaction import ThrusterHullInteraction
from boatsim.physics.vessel import load_vessel

STERN = Thruster(x=-5.0)


def loss(angle: float, thrust: float = 100.0, at: Thruster = STERN) -> float:
    """Share of its thrust that a drive loses along its axis, for a largest loss of 0.3."""
    effect = ThrusterHullInteraction(loss=0.3)
    signals = Thruster.signals(thrust=thrust, angle=angle)
    change = effect.wrench(make_motion(), signals, at.values())
    along = change.X * signals.cos_angle + change.Y * signals.sin_angle  # type: ignore[attr-defined]
    return -along / thrust


@pytest.mark.parametrize("degrees", [0.0, 20.0, 60.0, 89.0])
def test_the_loss_falls_with_the_square_of_the_cosine(degrees: float) -> None:
    for side in (-1.0, 1.0):
        backing = pi + side * radians(degrees)
        assert loss(backing) == pytest.approx(0.3 * cos(radians(degrees)) ** 2)
        assert loss(backing - pi, thrust=-100.0) == pytest.approx(loss(backing))


def test_a_race_away_from_the_hull_costs_nothing() -> None:
    assert loss(0.0) == loss(1.0) == loss(pi, thrust=-100.0) == 0.0


def test_a_drive_on_the_side_strikes_the_hull_with_its_race_across() -> None:
    starboard = Thruster(y=2.0)
    assert loss(0.5 * pi, at=starboard) == pytest.approx(0.3)
    assert loss(0.0, at=starboard) == pytest.approx(0.0, abs=1e-15)
    assert loss(0.3, at=Thruster()) == 0.0  # below the middle


def test_it_is_tested_where_a_drive_turns_far_enough() -> None:
    assert "thruster_hull_interaction" in candidate_library(load_vessel("osv")).tested_names
    for name in ("trial_boat", "blueboat", "joystick_boat"):
        reason = candidate_library(load_vessel(name)).inapplicable["thruster_hull_interaction"]
        assert reason == "no drive that turns more than 60 degrees to either side"
