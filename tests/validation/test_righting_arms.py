"""Righting arms of meshes against closed forms of curved hulls and a printed example."""

import pytest

from validation.waves import righting_arms
from validation.waves.righting_arms import archimedes, box_example, largest_error


@pytest.mark.parametrize(
    "arms", [righting_arms.arms_of_ellipsoid, righting_arms.arms_of_paraboloid]
)
def test_righting_arms_of_curved_hulls_converge_to_their_closed_forms(arms) -> None:  # type: ignore[no-untyped-def]
    """With the square of the panels, at every heel, also with the bottom up."""
    errors = [largest_error(arms(n, n // 2)) for n in (24, 48, 96)]
    assert errors[2] < 1e-3
    for coarse, fine in zip(errors[:2], errors[1:], strict=True):
        assert coarse / fine == pytest.approx(4.0, rel=0.05)


def test_ellipsoid_vanishes_and_changes_its_sign_where_its_closed_form_does() -> None:
    rows = righting_arms.arms_of_ellipsoid()
    for arm in rows:
        assert arm.found == pytest.approx(arm.exact, abs=2e-4)
    assert [arm.found > 0.0 for arm in rows[1:-1]] == [True] * 6 + [False] * 2


def test_homogeneous_paraboloid_floats_upright_above_the_density_of_archimedes() -> None:
    found, exact = archimedes()
    assert exact == (5.0 / 8.0) ** 2
    assert found == pytest.approx(exact, abs=5e-4)


def test_box_shaped_vessel_has_the_printed_righting_arm_and_moment() -> None:
    """The printed moment is the displacement times the arm, rounded to centimetres."""
    for _, (arm, moment), (own, turning) in box_example():
        assert own == pytest.approx(arm, abs=0.005)
        assert turning == pytest.approx(moment, rel=0.005 / arm)
