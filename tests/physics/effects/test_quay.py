"""Contact with a quay: force, lever, and the direction of rest."""

from math import pi

import numpy as np
import pytest

from boatsim.diagnosis.config import DEFAULT
from boatsim.diagnosis.near_track import small_track_fact
from boatsim.physics.base import make_motion
from boatsim.physics.effects.quay import Quay
from boatsim.physics.vessel import load_vessel
from boatsim.recordings.table import Recording

# a wall along the line y = -1 m, the water to the east; the hull is 2 m long and 1 m wide
WALL = Quay(
    stiffness=1000.0,
    toward=0.5 * pi,
    north=0.0,
    east=-0.5,
    north_reach=0.0,
    east_reach=0.0,
    overlap=0.0,
    half_length=1.0,
    half_beam=0.5,
)


def wrench_at(y: float, psi: float = 0.0, v: float = 0.0, wall: Quay = WALL) -> np.ndarray:
    """The wrench on a hull at rest or drifting sideways."""
    return np.array(wall.wrench(make_motion(y=y, psi=psi, v=v, current=(0.0, 0.0))))


def test_a_hull_away_from_the_quay_feels_nothing() -> None:
    assert wrench_at(1.0) == pytest.approx(np.zeros(6))


def test_a_hull_pressed_to_the_quay_is_pushed_off_in_proportion_to_the_depth() -> None:
    force = wrench_at(-0.7)  # side at -1.2 m, 0.2 m in the wall
    assert force[:2] == pytest.approx([0.0, 200.0], abs=0.01)
    assert force[5] == pytest.approx(0.0)


def test_a_hull_that_lies_askew_is_turned_parallel_to_the_quay() -> None:
    bow_in = wrench_at(-0.8, psi=-0.2)  # bow toward the wall in the west
    assert bow_in[1] > 0.0
    assert bow_in[5] > 0.0
    assert wrench_at(-0.8, psi=0.2)[5] == pytest.approx(-bow_in[5])


def test_an_end_reaches_the_quay_from_half_a_length_away() -> None:
    assert wrench_at(-0.2, psi=0.5 * pi)[0] == pytest.approx(1000.0 * 0.2, rel=1e-3)


def test_a_damped_quay_takes_energy_from_a_hull_that_moves_into_it_and_never_pulls() -> None:
    damped = Quay(**{**WALL.__dict__, "damping": 2.0})
    at_rest = wrench_at(-0.7, wall=damped)[1]
    assert wrench_at(-0.7, v=-0.1, wall=damped)[1] == pytest.approx(1.2 * at_rest)
    assert wrench_at(-0.7, v=0.1, wall=damped)[1] == pytest.approx(0.8 * at_rest)
    assert wrench_at(-0.7, v=2.0, wall=damped)[1] == 0.0


def recording(x: np.ndarray, y: np.ndarray) -> Recording:
    """A recording of positions."""
    return Recording("run", np.arange(len(x)) * 0.1, {"x_m": x, "y_m": y})


def test_tracks_within_a_few_lengths_are_enclosed_and_longer_ones_are_not_near_a_quay() -> None:
    boat = load_vessel("otter")
    far = DEFAULT.load.near_track_lengths * boat.length
    path = np.linspace(0.0, 1.0, 30)
    near = [recording(path * 2.0, 5.0 - path), recording(path - 1.0, 4.0 + path)]
    assert small_track_fact(near, boat) == {"track_m": [0.5, 4.5, 1.5, 0.5]}
    assert small_track_fact([*near, recording(path * 1.1 * far, path)], boat) == {}
    assert small_track_fact([Recording("run", near[0].t, {"psi_rad": path})], boat) == {}
