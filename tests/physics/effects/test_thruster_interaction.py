"""Thrust of drives in each other's race, against the published ratio and simple limits."""

from dataclasses import replace
from math import exp, pi
from typing import Any

import numpy as np
import pytest

from boatsim.diagnosis.candidates import candidate_library
from boatsim.physics.base import make_motion
from boatsim.physics.effects.thruster import Thruster
from boatsim.physics.effects.thruster_interaction import ThrusterInteraction, thrust_ratio
from boatsim.physics.vessel import load_vessel

AS_PUBLISHED = ThrusterInteraction(size=1.0, diameter=2.0)
AHEAD = Thruster(x=0.0, y=0.0)  # its race goes astern


def drive(at: Thruster, thrust: float, angle: float = 0.0) -> tuple[Any, Any]:
    """Signals and parameters of a drive."""
    return Thruster.signals(thrust=thrust, angle=angle), at.values()


def share_left(
    astern: float,
    angle: float = 0.0,
    others: float = 100.0,
    own: float = 100.0,
    effect: ThrusterInteraction = AS_PUBLISHED,
) -> float:
    """Thrust over open-water thrust of a drive that is `astern` [m] of another one, turned by
    `angle`."""
    behind = replace(AHEAD, x=-astern)
    change = effect.wrench(make_motion(), *drive(behind, own), *drive(AHEAD, others, angle))
    return 1.0 + change.X / own


@pytest.mark.parametrize(
    ("diameters", "ratio"),
    [(1.0, 0.25), (8.0, 1.0 - 0.75**4), (27.0, 1.0 - 0.75**9), (64.0, 1.0 - 0.75**16)],
)
def test_the_ratio_in_line_is_the_published_one(diameters: float, ratio: float) -> None:
    assert thrust_ratio(diameters, 0.0) == pytest.approx(ratio)
    assert share_left(2.0 * diameters) == pytest.approx(ratio)


@pytest.mark.parametrize("degrees", [2.0, 10.0, 30.0])
@pytest.mark.parametrize("diameters", [2.0, 8.0])
def test_a_steered_race_costs_less_by_the_published_formula(
    degrees: float, diameters: float
) -> None:
    t = 1.0 - 0.75 ** (diameters ** (2 / 3))
    steered = t + (1.0 - t) * degrees**3 / (130.0 / t**3 + degrees**3)
    for side in (-1.0, 1.0):
        left = share_left(2.0 * diameters, side * degrees * pi / 180.0)
        assert left == pytest.approx(steered)
    assert t < steered < 1.0


def test_half_the_loss_is_left_at_the_angle_of_the_formula() -> None:
    t = 1.0 - 0.75**4
    half = 130.0 ** (1 / 3) / t * pi / 180.0
    assert 1.0 - thrust_ratio(8.0, half) == pytest.approx(0.5 * (1.0 - t))


def test_a_race_that_points_away_or_that_nobody_makes_costs_nothing() -> None:
    assert share_left(16.0, pi) == pytest.approx(1.0, abs=1e-4)
    assert share_left(16.0, others=-100.0) == pytest.approx(1.0, abs=1e-4)
    assert share_left(16.0, others=0.0) == 1.0
    assert share_left(-16.0, others=-100.0) == pytest.approx(1.0 - 0.75**4)


def test_a_weak_race_costs_less_than_a_strong_one_and_grows_as_the_root_of_the_thrust() -> None:
    lost = [1.0 - share_left(16.0, others=thrust) for thrust in (1.0, 50.0, 100.0, 200.0)]
    assert lost == sorted(lost) and lost[0] < 0.01
    step = 1e-6
    grown = np.log(share_left(16.0, others=100.0 * (1.0 + step)))
    slope = (grown / np.log(share_left(16.0)) - 1.0) / step
    assert slope == pytest.approx(0.5, rel=1e-4)


def test_the_races_of_two_drives_multiply_and_the_thrust_never_changes_sign() -> None:
    behind = replace(AHEAD, x=-16.0)
    twice = AS_PUBLISHED.wrench(make_motion(), *drive(behind, 100.0), *2 * drive(AHEAD, 100.0))
    assert 1.0 + twice.X / 100.0 == pytest.approx((1.0 - 0.75**4) ** 2)
    crowd = replace(AS_PUBLISHED, size=3.0).wrench(
        make_motion(), *drive(behind, 100.0), *9 * drive(AHEAD, 1000.0)
    )
    assert -100.0 <= crowd.X < -99.0


def test_the_loss_begins_in_proportion_to_its_size() -> None:
    small = 1e-6
    lost = 1.0 - share_left(16.0, effect=replace(AS_PUBLISHED, size=small))
    assert lost / small == pytest.approx(-np.log(1.0 - 0.75**4), rel=1e-5)
    none = share_left(16.0, effect=replace(AS_PUBLISHED, size=0.0))
    assert none == 1.0 == exp(0.0)


def test_it_is_tested_where_a_race_can_be_turned_on_another_drive() -> None:
    assert "thruster_interaction" in candidate_library(load_vessel("osv")).tested_names
    for name in ("blueboat", "trial_boat", "catamaran", "otter"):
        reason = candidate_library(load_vessel(name)).inapplicable["thruster_interaction"]
        assert reason == "no drive that can work in the race of another one"


def test_the_diameter_follows_from_the_draught_unless_given() -> None:
    vessel = load_vessel("osv")
    own = vessel.with_effect({"use": "thruster_interaction"}).effect("thruster_interaction")
    given = vessel.with_effect({"use": "thruster_interaction", "diameter": 3.0})
    stated = given.effect("thruster_interaction")
    assert isinstance(own, ThrusterInteraction) and isinstance(stated, ThrusterInteraction)
    assert own.diameter == pytest.approx(0.65 * vessel.draught)
    assert stated.diameter == 3.0
