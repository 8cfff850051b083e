"""Guidance converges to the path, removes the offset in a current, and has no preferred side."""

from math import atan, atan2, cos, hypot, pi, sin, sqrt, tan

import numpy as np
import pytest

from boatsim.control.guidance import LAWS, LineOfSight
from boatsim.control.paths import Legs, Path, cross_track_error
from boatsim.errors import BadInput

SPEED, LOOKAHEAD, PERIOD = 1.0, 6.0, 0.1
HEADING_POLE = 2.0  # [1/s] of the first-order heading loop of the vessel below
ALONG_NORTH = Legs(np.array([[0.0, 0.0], [1e4, 0.0]]), 1.0)


def sail(
    law: str,
    start: tuple[float, float, float],
    current: tuple[float, float] = (0.0, 0.0),
    path: Path = ALONG_NORTH,
    seconds: float = 300.0,
) -> np.ndarray:
    """Rows x, y, heading and cross-track error of a vessel with constant speed through the water.

    Its heading follows the guidance with a first-order lag.
    """
    guidance = LineOfSight(law, LOOKAHEAD)
    x, y, heading = start
    along, rows = path.nearest(x, y), []
    for _ in range(round(seconds / PERIOD)):
        along = path.follow(x, y, along)
        there = path.point(along)
        north = SPEED * cos(heading) + current[0]
        east = SPEED * sin(heading) + current[1]
        course, speed = atan2(east, north), hypot(north, east)
        found = guidance.step(there, x, y, course, speed, PERIOD)
        rows.append((x, y, heading, found.cross_track))
        off = (found.heading - heading + pi) % (2.0 * pi) - pi
        heading += PERIOD * (HEADING_POLE * off + found.heading_rate)
        x, y = x + PERIOD * north, y + PERIOD * east
    return np.array(rows)


@pytest.mark.parametrize("law", LAWS)
def test_every_law_converges_to_a_straight_path(law: str) -> None:
    rows = sail(law, (0.0, 20.0, 0.5))
    assert abs(rows[-1, 3]) < 1e-3 and abs(rows[-1, 2]) < 1e-3
    assert rows[:, 3].min() > -0.6 * LOOKAHEAD  # overshoot of the adaptive law: 0.52


def test_line_of_sight_decays_with_the_rate_of_speed_over_lookahead() -> None:
    rows = sail("line_of_sight", (0.0, 0.1, 0.0), seconds=40.0)
    rate = np.log(rows[200, 3] / rows[300, 3]) / 10.0
    assert rate == pytest.approx(SPEED / LOOKAHEAD, rel=0.05)


def test_line_of_sight_leaves_the_offset_of_the_crab_angle() -> None:
    across = 0.3
    rows = sail("line_of_sight", (0.0, 0.0, 0.0), (0.0, across))
    # the heading is -atan(e / D), and SPEED sin(heading) stems the current
    crab = atan(across / sqrt(SPEED**2 - across**2))
    assert rows[-1, 3] == pytest.approx(LOOKAHEAD * tan(crab), rel=1e-3)


@pytest.mark.parametrize("law", ["integral", "adaptive"])
def test_integral_and_adaptive_laws_remove_the_offset(law: str) -> None:
    rows = sail(law, (0.0, 5.0, 0.0), (-0.1, 0.3), seconds=400.0)
    assert abs(rows[-1, 3]) < 1e-3
    assert sin(rows[-1, 2]) == pytest.approx(-0.3, abs=1e-3)


@pytest.mark.parametrize("law", LAWS)
def test_guidance_has_no_preferred_side(law: str) -> None:
    rows = sail(law, (0.0, 7.0, 0.4), (0.1, 0.2), seconds=60.0)
    mirrored = sail(law, (0.0, -7.0, -0.4), (0.1, -0.2), seconds=60.0)
    assert rows * (1.0, -1.0, -1.0, -1.0) == pytest.approx(mirrored, abs=1e-9)


@pytest.mark.parametrize("law", LAWS)
def test_guidance_has_no_preferred_direction_or_place(law: str) -> None:
    turn, north, east = 2.3, 40.0, -70.0
    c, s = cos(turn), sin(turn)
    ends = np.array([[north, east], [north + 1e4 * c, east + 1e4 * s]])
    rows = sail(law, (0.0, 7.0, 0.4), (0.1, 0.2), seconds=60.0)
    start = (north - 7.0 * s, east + 7.0 * c, 0.4 + turn)
    moved = sail(law, start, (0.1 * c - 0.2 * s, 0.1 * s + 0.2 * c), Legs(ends, 1.0), 60.0)
    assert rows[:, 3] == pytest.approx(moved[:, 3], abs=1e-6)
    assert moved[:, 2] - turn == pytest.approx(rows[:, 2], abs=1e-6)


def test_a_moving_frame_with_a_moving_path_gives_the_same_heading() -> None:
    """Galilean invariance: guidance in a frame that drifts with the water sees no current."""
    drift = np.array([0.2, -0.3])
    still = LineOfSight("adaptive", LOOKAHEAD)
    carried = LineOfSight("adaptive", LOOKAHEAD)
    for k in range(200):
        x, y, heading = 0.05 * k, 5.0 * cos(0.02 * k), -0.3
        here = ALONG_NORTH.point(x)
        moved = drift * PERIOD * k
        there = here._replace(x=here.x + moved[0], y=here.y + moved[1])
        a = still.step(here, x, y, heading, SPEED, PERIOD)
        b = carried.step(there, x + moved[0], y + moved[1], heading, SPEED, PERIOD)
        assert a == pytest.approx(b)


def test_corners_are_rounded_within_the_circle_of_acceptance() -> None:
    path = Legs(np.array([[0.0, 0.0], [60.0, 0.0], [60.0, 60.0]]), 8.0)
    rows = sail("adaptive", (0.0, 0.0, 0.0), path=path, seconds=160.0)
    assert np.hypot(rows[:, 0] - 60.0, rows[:, 1]).min() < 8.0
    assert abs(rows[-1, 3]) < 0.05


def test_the_heading_rate_is_that_of_the_heading() -> None:
    guidance = LineOfSight("adaptive", LOOKAHEAD)
    x, y, course, headings, rates = 0.0, 4.0, -0.2, [], []
    for _ in range(50):
        there = ALONG_NORTH.point(x)
        assert cross_track_error(there, x, y) == pytest.approx(y)
        found = guidance.step(there, x, y, course, SPEED, 0.01)
        headings.append(found.heading)
        rates.append(found.heading_rate)
        x, y = x + 0.01 * SPEED * cos(course), y + 0.01 * SPEED * sin(course)
    assert np.diff(headings) / 0.01 == pytest.approx(np.array(rates[:-1]), abs=1e-5)


def test_wrong_settings_are_refused() -> None:
    with pytest.raises(BadInput, match="did you mean 'adaptive'"):
        LineOfSight("adaptiv", 3.0)
    with pytest.raises(BadInput, match="more than 0"):
        LineOfSight("integral", 0.0)
