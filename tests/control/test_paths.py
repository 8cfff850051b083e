"""Planned paths are continuous, and Dubins paths are the shortest ones with bounded curvature."""

from math import cos, inf, nan, pi, sin

import numpy as np
import pytest

from boatsim.control.paths import (
    Legs,
    Path,
    PathPoint,
    Spline,
    courses_at,
    cross_track_error,
    dubins_path,
    dubins_words,
    speed_profile,
)
from boatsim.errors import BadInput

CORNER = np.array([[0.0, 0.0], [20.0, 0.0], [20.0, 20.0]])
CURVED = np.array([[0.0, 0.0], [10.0, 4.0], [22.0, -3.0], [30.0, 5.0]])
RADIUS = 1.7
Pose = tuple[float, float, float]


def drive(start: Pose, controls: list[tuple[float, float]]) -> Pose:
    """Pose after arcs of given curvature and length, integrated independently of the paths."""
    x, y, course = start
    for curvature, length in controls:
        parts = 200
        step = length / parts
        for _ in range(parts):  # midpoint rule
            middle = course + 0.5 * step * curvature
            x, y = x + step * cos(middle), y + step * sin(middle)
            course += step * curvature
    return x, y, course


def random_poses(count: int, seed: int) -> list[tuple[Pose, Pose]]:
    """Pairs of poses at random, near to each other and far apart."""
    chance = np.random.default_rng(seed)
    pairs = []
    for _ in range(count):
        spread = chance.choice([1.0, 5.0, 20.0])
        a, b = chance.uniform(-spread, spread, (2, 2))
        courses = chance.uniform(-pi, pi, 2)
        pairs.append(
            ((float(a[0]), float(a[1]), courses[0]), (float(b[0]), float(b[1]), courses[1]))
        )
    return pairs


def test_every_word_of_dubins_leads_to_the_goal() -> None:
    found = set()
    for start, end in random_poses(40, 0):
        for word in dubins_words(start, end, RADIUS):
            controls = []
            for letter, length in zip(word.word, word.arcs, strict=True):
                controls.append(({"R": 1.0, "L": -1.0, "S": 0.0}[letter] / RADIUS, length))
            x, y, course = drive(start, controls)
            assert (x, y) == pytest.approx(end[:2], abs=5e-3)
            assert cos(course - end[2]) == pytest.approx(1.0, abs=1e-6)
            found.add(word.word)
    assert found == {"RSR", "LSL", "RSL", "LSR", "RLR", "LRL"}


def test_no_path_with_bounded_curvature_is_shorter_than_a_dubins_path() -> None:
    chance = np.random.default_rng(1)
    tight = 0
    for _ in range(1500):
        controls, x, y, course = [], 0.0, 0.0, 0.0
        for _ in range(chance.integers(1, 5)):
            bend = chance.choice([-1.0, 0.0, 1.0, chance.uniform(-1.0, 1.0)]) / RADIUS
            controls.append((bend, chance.uniform(0.0, 2.0 * pi * RADIUS)))
        for curvature, length in controls:
            new = course + curvature * length
            if curvature == 0.0:
                x, y = x + length * cos(course), y + length * sin(course)
            else:
                x += (sin(new) - sin(course)) / curvature
                y += (cos(course) - cos(new)) / curvature
            course = new
        total = sum(length for _, length in controls)
        best = min(one.length for one in dubins_words((0, 0, 0), (x, y, course), RADIUS))
        assert best <= total + 1e-6
        tight += best > total - 1e-6
    assert tight > 50  # some of the paths that were drawn are shortest ones


def turned(pose: Pose, side: float, angle: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Places after a turn by angles from a pose; a negative angle is a turn before it."""
    x, y, course = pose
    after = course + side * angle
    east = y - side * RADIUS * (np.cos(after) - cos(course))
    return x + side * RADIUS * (np.sin(after) - sin(course)), east


def test_the_best_word_agrees_with_a_search_over_the_first_turn() -> None:
    """A straight line must lead from the end of the first turn to the begin of the last one."""
    first_turn = np.linspace(0.0, 2.0 * pi, 20001)
    for start, end in random_poses(40, 3):
        shortest = inf
        for first in (1.0, -1.0):
            course = start[2] + first * first_turn
            x, y = turned(start, first, first_turn)
            for last in (1.0, -1.0):
                last_turn = last * (end[2] - course) % (2.0 * pi)
                north, east = turned(end, last, -last_turn)
                north, east = north - x, east - y
                aside = -north * np.sin(course) + east * np.cos(course)
                ahead = north * np.cos(course) + east * np.sin(course)
                meets = (aside[1:] * aside[:-1] <= 0.0) & (np.abs(aside[1:] - aside[:-1]) < 0.05)
                meets &= ahead[1:] > -0.05
                total = RADIUS * (first_turn + last_turn) + ahead
                if meets.any():
                    shortest = min(shortest, float(total[1:][meets].min()))
        best = min(one.length for one in dubins_words(start, end, RADIUS) if one.word[1] == "S")
        assert best == pytest.approx(shortest, abs=0.05)


def check_smooth(path: Path, largest_curvature: float = inf) -> None:
    """The course is the direction of the path, its rate the curvature, and both are continuous."""
    along = np.linspace(0.0, path.length, 1501)
    rows = np.array([path.point(s) for s in along.tolist()])
    step = along[1]
    chords = np.hypot(*np.diff(rows[:, :2], axis=0).T)
    assert chords == pytest.approx(np.full(1500, step), rel=2e-4)
    turns = (np.diff(rows[:, 2]) + pi) % (2.0 * pi) - pi
    assert np.abs(turns).max() < 0.1
    headings = np.arctan2(*np.diff(rows[:, :2], axis=0).T[::-1])
    assert np.abs(np.sin(headings - rows[:-1, 2] - 0.5 * turns)).max() < 3e-3
    mean = 0.5 * (rows[1:, 3] + rows[:-1, 3])
    jumps = np.abs(np.diff(rows[:, 3]))
    smooth = jumps < 0.1
    assert turns[smooth] / step == pytest.approx(mean[smooth], abs=5e-3)
    assert np.abs(rows[:, 3]).max() <= largest_curvature


def test_a_dubins_path_is_smooth_and_respects_its_radius() -> None:
    poses = [(0.0, 0.0, 0.0), (10.0, 3.0, 2.0), (4.0, -9.0, nan), (0.0, 0.0, 1.0)]
    courses = courses_at(np.array([p[:2] for p in poses]), [p[2] for p in poses])
    path = dubins_path([(x, y, c) for (x, y, _), c in zip(poses, courses, strict=True)], RADIUS)
    check_smooth(path, 1.0 / RADIUS + 1e-12)
    end = path.point(path.length)
    assert (end.x, end.y) == pytest.approx((0.0, 0.0), abs=1e-9)
    assert cos(end.course - 1.0) == pytest.approx(1.0)


@pytest.mark.parametrize("courses", [(nan, nan), (0.5, nan), (0.5, -1.0)])
def test_a_spline_passes_its_waypoints_with_continuous_curvature(
    courses: tuple[float, float],
) -> None:
    path = Spline(CURVED, courses)
    check_smooth(path)
    along = np.linspace(0.0, path.length, 4001)
    bends = np.array([path.point(s).curvature for s in along.tolist()])
    assert np.abs(np.diff(bends)).max() < 0.02 * max(np.abs(bends).max(), 0.1) + 0.005
    for x, y in CURVED:
        there = path.point(path.nearest(x, y))
        assert (there.x, there.y) == pytest.approx((x, y), abs=1e-6)
    if courses[0] == courses[0]:
        assert path.point(0.0).course == pytest.approx(courses[0])
    else:
        assert path.point(0.0).curvature == pytest.approx(0.0, abs=1e-9)


def test_a_spline_of_points_on_a_line_is_that_line() -> None:
    path = Spline(np.array([[0.0, 0.0], [1.0, 1.0], [5.0, 5.0]]))
    assert path.length == pytest.approx(5.0 * 2.0**0.5)
    assert path.point(2.0) == pytest.approx((2.0**0.5, 2.0**0.5, pi / 4.0, 0.0), abs=1e-9)


def test_the_cross_track_error_is_positive_to_starboard() -> None:
    north = PathPoint(0.0, 0.0, 0.0, 0.0)
    assert cross_track_error(north, 5.0, 2.0) == pytest.approx(2.0)  # east of a northward path
    south = PathPoint(0.0, 0.0, pi, 0.0)
    assert cross_track_error(south, -5.0, 2.0) == pytest.approx(-2.0)


def test_the_foot_point_is_the_nearest_point() -> None:
    path = Spline(CURVED)
    chance = np.random.default_rng(2)
    for _ in range(50):
        s = chance.uniform(1.0, path.length - 1.0)
        there, aside = path.point(s), chance.uniform(-1.5, 1.5)
        x, y = there.x - aside * sin(there.course), there.y + aside * cos(there.course)
        foot = path.follow(x, y, s + chance.uniform(-0.5, 0.5))
        assert foot == pytest.approx(s, abs=1e-6)
        assert cross_track_error(path.point(foot), x, y) == pytest.approx(aside, abs=1e-6)


def test_the_next_leg_begins_in_the_circle_of_acceptance() -> None:
    path = Legs(CORNER, 3.0)
    assert path.length == pytest.approx(40.0)
    assert path.follow(16.9, 0.0, 10.0) == pytest.approx(16.9)
    assert path.follow(17.1, 0.0, 16.9) == pytest.approx(20.0)  # before the begin of the next leg
    assert path.point(20.0).course == pytest.approx(pi / 2.0)
    # a vessel that passes outside of the circle changes to the next leg, too
    assert path.follow(20.5, 9.0, 16.9) == pytest.approx(29.0)
    assert path.follow(20.0, 30.0, 30.0) == pytest.approx(50.0)
    assert path.point(50.0) == pytest.approx((20.0, 30.0, pi / 2.0, 0.0))


def test_the_speed_profile_slows_down_before_bends_and_at_the_end() -> None:
    path = Legs(CORNER, 3.0)
    profile = speed_profile(path, 2.0, 0.4, 0.1, end_speed=0.0)
    # the turn of 90 degrees within the circle of acceptance has a radius of 3 m
    assert profile.at(20.0) == pytest.approx(0.4 * 3.0)
    assert profile.at(19.0) == pytest.approx((1.44 + 0.2) ** 0.5, abs=1e-3)
    assert profile.at(40.0) == 0.0
    assert profile.at(35.0) == pytest.approx(1.0, abs=1e-3)
    rises = np.diff(profile.speed**2) / np.diff(profile.along) / 2.0
    assert np.abs(rises).max() <= 0.1 + 1e-9
    arcs = dubins_path([(0.0, 0.0, 0.0), (20.0, 20.0, pi / 2.0)], 5.0)
    bent = speed_profile(arcs, 2.0, 0.2, 10.0)
    assert bent.at(arcs.length - 1.0) == pytest.approx(1.0)


@pytest.mark.parametrize("make", [lambda points: Legs(points, 1.0), Spline])
def test_wrong_waypoints_are_refused(make: object) -> None:
    with pytest.raises(BadInput, match="at least two"):
        make(np.zeros((1, 2)))  # type: ignore[operator]
    with pytest.raises(BadInput, match="equal"):
        make(np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 0.0]]))  # type: ignore[operator]


def test_wrong_dubins_paths_are_refused() -> None:
    with pytest.raises(BadInput, match="radius"):
        dubins_words((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), 0.0)
    with pytest.raises(BadInput, match="at least two"):
        dubins_path([(0.0, 0.0, 0.0)], 1.0)
    with pytest.raises(BadInput, match="equal"):
        dubins_path([(0.0, 0.0, 0.0), (0.0, 0.0, 0.0)], 1.0)
