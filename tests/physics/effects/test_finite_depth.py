"""Added mass, damping and resistance in shallow water: published limits and numbers."""

from math import inf, log, pi

import pytest

from boatsim.diagnosis.candidates import candidate_library
from boatsim.errors import BadInput
from boatsim.physics.effects.added_mass import AddedMass
from boatsim.physics.effects.damping import LinearDamping
from boatsim.physics.effects.finite_depth import FiniteDepth, resistance_factor
from boatsim.physics.facts import first_invalid_fact
from boatsim.physics.vessel import Vessel, load_vessel

BOAT = load_vessel("trial_boat")
DRAUGHT = BOAT.draught


def in_depth(ratio: float, share: float = 1.0) -> tuple[AddedMass, LinearDamping]:
    """Added mass and damping of the boat in water so many draughts deep."""
    boat = BOAT.with_completed_effect(FiniteDepth(depth=ratio * DRAUGHT, share=share))
    mass, damping = boat.effect("added_mass"), boat.effect("linear_damping")
    assert isinstance(mass, AddedMass) and isinstance(damping, LinearDamping)
    return mass, damping


def test_at_twice_the_draught_the_cosine_is_that_of_45_degrees() -> None:
    mass, damping = in_depth(2.0)
    factor = 16.0 * log(2.0) / pi**2
    assert mass.sway == pytest.approx(9.0 * factor)
    assert mass.yaw == pytest.approx(0.7 * factor)
    assert (mass.surge, mass.coriolis) == (0.3, 0.0)
    assert damping.sway == pytest.approx(10.0 * factor)
    assert damping.yaw == pytest.approx(factor)


def test_far_from_the_bottom_the_increase_falls_with_the_square_of_the_depth() -> None:
    """The series of the logarithm gives k = 1 + pi^2 / 24 (T / h)^2."""
    far, farther = in_depth(10.0)[0].sway - 9.0, in_depth(20.0)[0].sway - 9.0
    assert far == pytest.approx(9.0 * pi**2 / 2400.0, rel=0.01)
    assert far / farther == pytest.approx(4.0, rel=0.02)


@pytest.mark.parametrize(("ratio", "increase"), [(1.0, 0.57), (2.0, 0.1648), (4.0, 0.0477)])
def test_the_resistance_grows_as_published(ratio: float, increase: float) -> None:
    assert resistance_factor(0.2, 0.2 * ratio) == pytest.approx(1.0 + increase, abs=1e-4)


def test_the_resistance_of_the_boat_grows_by_that_factor() -> None:
    assert in_depth(3.0)[1].surge == pytest.approx(3.0 * resistance_factor(1.0, 3.0))


@pytest.mark.parametrize("share", [0.5, 2.0])
def test_the_share_scales_every_increase(share: float) -> None:
    whole, part = in_depth(1.5), in_depth(1.5, share)
    for own, one, other in zip((9.0, 10.0), whole, part, strict=True):
        assert other.sway - own == pytest.approx(share * (one.sway - own))


def test_without_a_share_the_vessel_is_the_same() -> None:
    assert BOAT.with_completed_effect(FiniteDepth(depth=0.1, share=0.0)) == BOAT


@pytest.mark.parametrize("name", ["otter", "kvlcc2_mmg", "mariner", "joystick_boat"])
def test_every_model_of_a_hull_has_numbers_that_depend_on_the_depth(name: str) -> None:
    boat: Vessel = load_vessel(name)
    changes = FiniteDepth(depth=1.3 * boat.draught).changes(boat)
    assert changes
    for change in changes:
        value = getattr(boat.effect(change.owner), change.key)
        assert change.weight / value > 0.0


def test_a_depth_less_than_the_draught_is_one_line() -> None:
    with pytest.raises(BadInput, match=r"finite_depth.depth = 0.05 m; allowed is more than") as no:
        BOAT.with_completed_effect(FiniteDepth(depth=0.05))
    assert "\n" not in str(no.value)
    with pytest.raises(BadInput, match="water_depth_m"):
        BOAT.with_completed_effect(FiniteDepth())


def test_it_is_a_candidate_only_where_the_depth_is_known_and_the_boat_floats() -> None:
    assert "finite_depth" in candidate_library(BOAT).inapplicable
    assert "finite_depth" in candidate_library(BOAT, facts={"water_depth_m": 0.2}).tested_names
    aground = candidate_library(BOAT, facts={"water_depth_m": 0.06})
    assert "more than the draught" in aground.inapplicable["finite_depth"]


@pytest.mark.parametrize("wrong", [0.0, -3.0, inf, True, "deep"])
def test_a_depth_that_is_no_positive_number_is_refused(wrong: object) -> None:
    assert first_invalid_fact({"water_depth_m": wrong}) == ("water_depth_m", "a number above 0")
