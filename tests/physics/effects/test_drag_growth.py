"""Resistance that grows with time: the closed form."""

import pytest

from boatsim.diagnosis.candidates import candidate_library
from boatsim.physics.base import Wrench, make_motion
from boatsim.physics.effects.drag_growth import DragGrowth
from boatsim.physics.vessel import load_vessel

WEED = DragGrowth(rate=0.2, start=10.0)


@pytest.mark.parametrize("u", [1.5, -1.5])
def test_the_drag_coefficient_is_the_rate_times_the_time_and_brakes_both_ways(u: float) -> None:
    assert WEED.wrench(make_motion(t=40.0, u=u, v=0.3, r=0.1)) == pytest.approx(
        Wrench(X=-6.0 * abs(u) * u)
    )


@pytest.mark.parametrize("t", [0.0, 9.0, 10.0])
def test_there_is_none_before_it_starts(t: float) -> None:
    assert WEED.wrench(make_motion(t=t, u=2.0)) == Wrench()


def test_it_acts_on_the_speed_through_the_water() -> None:
    assert WEED.wrench(make_motion(t=40.0, u=0.5, current=(0.5, 0.0))) == Wrench()


def test_a_coasting_boat_slows_down_as_the_integral_of_the_coefficient() -> None:
    """M du/dt = -k (t - t_0) u^2 gives 1/u = 1/u_0 + k (t - t_0)^2 / (2 M)."""
    u, mass, step = 2.0, 50.0, 1e-3
    for k in range(30_000):
        u += step * WEED.wrench(make_motion(t=10.0 + step * k, u=u)).X / mass
    assert 1.0 / u == pytest.approx(0.5 + 0.2 * 30.0**2 / (2.0 * mass), rel=1e-3)


def test_it_is_a_candidate_from_the_first_row_on() -> None:
    boat = load_vessel("trial_boat")
    library = candidate_library(boat, facts={"begin_s": 500.0})
    [candidate] = [one for one in library.entries if one.name == "drag_growth"]
    assert isinstance(candidate, DragGrowth) and candidate.start == 500.0
    assert candidate.wrench(make_motion(t=600.0, u=1.0)) == Wrench()
    assert "drag_growth" in candidate_library(boat).inapplicable
