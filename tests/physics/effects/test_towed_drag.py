"""Drag of something towed: the closed form, and where a diagnosis tries it."""

from dataclasses import replace
from math import pi

import numpy as np
import pytest

from boatsim.diagnosis.candidates import candidate_library
from boatsim.physics.base import Wrench, make_motion
from boatsim.physics.effects.towed_drag import TowedDrag
from boatsim.physics.vessel import load_vessel

DINGHY = TowedDrag(drag=5.0, x=-2.0, y=0.3)


def test_straight_ahead_it_brakes_with_the_square_of_the_speed_and_turns_to_its_side() -> None:
    force = DINGHY.wrench(make_motion(u=3.0))
    assert force == pytest.approx(Wrench(X=-45.0, N=0.3 * 45.0))


def test_its_force_is_opposite_to_the_velocity_of_the_attachment_and_acts_there() -> None:
    u, v, r = 1.5, -0.4, 0.6
    ahead, aside = u - 0.3 * r, v - 2.0 * r
    force = -5.0 * np.hypot(ahead, aside) * np.array([ahead, aside])
    moment = -2.0 * force[1] - 0.3 * force[0]
    assert DINGHY.wrench(make_motion(u=u, v=v, r=r)) == pytest.approx(
        Wrench(X=force[0], Y=force[1], N=moment)
    )


@pytest.mark.parametrize("seed", range(5))
def test_it_takes_the_power_of_its_drag_and_never_gives_any(seed: int) -> None:
    u, v, r = np.random.default_rng(seed).uniform(-2.0, 2.0, 3).tolist()
    force = DINGHY.wrench(make_motion(u=u, v=v, r=r))
    speed = np.hypot(u - 0.3 * r, v - 2.0 * r)
    power = force.X * u + force.Y * v + force.N * r
    assert power == pytest.approx(-5.0 * speed**3)


def test_a_boat_that_drifts_with_the_water_feels_nothing() -> None:
    drifting = make_motion(current=(0.5, 0.0), psi=0.5 * pi, v=-0.5)
    assert DINGHY.wrench(drifting) == pytest.approx(Wrench(), abs=1e-12)


def test_a_sea_anchor_at_the_bow_turns_the_bow_into_the_wind() -> None:
    """Blown to port, the boat is held at the bow, whose drag acts to starboard."""
    force = TowedDrag(drag=5.0, x=2.0).wrench(make_motion(v=-1.0))
    assert force == pytest.approx(Wrench(Y=5.0, N=10.0))


def test_the_coasting_speed_falls_as_one_over_the_time() -> None:
    """m du/dt = -c u^2 gives u = u0 / (1 + c u0 t / m), integrated by steps of a millisecond."""
    u, mass, step = 2.0, 50.0, 1e-3
    towed = replace(DINGHY, y=0.0)
    for _ in range(10_000):
        u += step * towed.wrench(make_motion(u=u)).X / mass
    assert u == pytest.approx(2.0 / (1.0 + 5.0 * 2.0 * 10.0 / mass), rel=1e-3)


def test_it_is_a_candidate_unless_nothing_is_towed() -> None:
    boat = load_vessel("trial_boat")
    assert "towed_drag" in candidate_library(boat).tested_names
    alone = candidate_library(boat, facts={"towing": False})
    assert alone.excluded["towed_drag"] == "towing = false"
