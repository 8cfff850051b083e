"""A foil at the stern: lift and drag in closed form, and the directions in which they act."""

from math import cos, pi, radians, sin

import pytest

from boatsim.physics.base import Wrench, make_motion
from boatsim.physics.effects.foil import Foil

HOUSING = Foil(area=9.0, drag=0.3, drag_slope=0.3, lift=0.5, density=1000.0, x=-16.0, y=3.0, z=2.0)


def force(angle: float = 0.0, foil: Foil = HOUSING, **at: float) -> Wrench:
    return foil.wrench(make_motion(**at), angle=angle)


def test_straight_ahead_it_is_a_drag_at_its_place() -> None:
    drag = 0.5 * 1000.0 * 9.0 * 0.3 * 25.0
    found = force(u=5.0)
    assert found.X == pytest.approx(-drag)
    assert found.Y == pytest.approx(0.0, abs=1e-9)
    assert found.N == pytest.approx(3.0 * drag) and found.M == pytest.approx(-2.0 * drag)


@pytest.mark.parametrize("angle", [0.1, 0.35, -0.35])
def test_turned_in_a_straight_flow_it_has_lift_across_and_more_drag(angle: float) -> None:
    pressure = 0.5 * 1000.0 * 9.0 * 25.0
    found = force(angle, u=5.0)
    assert found.Y == pytest.approx(0.5 * sin(2.0 * angle) * pressure)
    assert found.X == pytest.approx(-(0.3 + 0.3 * abs(angle)) * pressure)
    assert found.K == pytest.approx(-2.0 * found.Y)


def test_in_the_flow_of_a_turn_it_damps_the_turn() -> None:
    """The stern of a ship that turns to starboard moves to port and is pushed back."""
    found = force(foil=Foil(area=9.0, lift=0.5, x=-16.0), u=5.0, r=0.02)
    assert found.Y > 0.0 > found.N


def test_in_the_direction_of_the_flow_there_is_no_lift() -> None:
    flow = radians(20.0)
    found = force(flow, Foil(area=9.0, drag=0.3, lift=0.5), u=5.0 * cos(flow), v=5.0 * sin(flow))
    assert found.Y / found.X == pytest.approx(sin(flow) / cos(flow))


@pytest.mark.parametrize("angle", [0.3, 1.2, -0.4])
def test_a_foil_has_two_equal_ends(angle: float) -> None:
    """Turned by half a turn, or with the flow from behind, the forces are those of the other end."""
    ahead = force(angle, u=4.0, v=0.5)
    turned = force(angle + pi, u=4.0, v=0.5)
    assert turned == pytest.approx(ahead)
    astern = force(angle, u=-4.0, v=-0.5)
    assert astern == pytest.approx(tuple(-x for x in ahead))
