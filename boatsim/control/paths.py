"""Planned paths in the horizontal plane: straight legs, cubic splines and Dubins paths.

Axes are those of SNAME: x north, y east, course clockwise from north. A positive curvature turns to
starboard.

L. E. Dubins, On curves of minimal length with a constraint on average curvature, and with
prescribed initial and terminal positions and tangents, American Journal of Mathematics 79, 1957;
T. I. Fossen, Handbook of Marine Craft Hydrodynamics and Motion Control, 2nd ed. 2021, chapter 12.
"""

from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass, field
from math import acos, asin, atan2, cos, hypot, inf, nan, pi, sin, sqrt, tan
from typing import NamedTuple

import numpy as np

from boatsim.control.base import clip, wrap
from boatsim.errors import BadInput
from boatsim.physics.base import Array

FULL_TURN = 2.0 * pi
# [rad] an arc that lacks less than this of a full turn is an arc of zero length: rounding of angles
NO_ARC = 1e-9
# Iterations of Newton's method for the foot point. The error is squared by each one, and the foot
# point moves by less than a tenth of a radius between two control steps.
FOOT_POINT_STEPS = 8
SAME_PLACE = 1e-9  # of the length of the path: the foot point is found
# Of the curvature radius: nearer to the centre of curvature the foot point is not defined, and the
# step of Newton's method is limited.
NEAR_CENTRE = 0.2
# Samples of each piece of a spline for its length: Gauss's rule with four points on each part then
# gives ten digits for smooth splines.
SPLINE_PARTS = 32
WHOLE_PATH_SAMPLES = 400  # places at which the nearest one of the whole path is searched
# Samples of the speed profile over the length of the path: 0.05 % of it, a twentieth of a length
# for a path of 100 lengths.
PROFILE_SAMPLES = 2000
# of the largest speed: no bend, however tight, lets a vessel stop on its way
SLOWEST_SHARE = 0.1
LETTERS = {1.0: "R", -1.0: "L"}  # of a turn to starboard and to port in a word of Dubins

Pair = tuple[float, float]


class PathPoint(NamedTuple):
    """One point of a path."""

    x: float  # [m] north
    y: float  # [m] east
    course: float  # [rad] direction of the path, clockwise from north
    curvature: float  # [1/m] positive to starboard


def cross_track_error(point: PathPoint, x: float, y: float) -> float:
    """Return the distance of a position from the tangent of a path, positive to starboard [m].

    Args:
        point: Point of the path.
        x: Position to north [m].
        y: Position to east [m].
    """
    return -(x - point.x) * sin(point.course) + (y - point.y) * cos(point.course)


def along_track_error(point: PathPoint, x: float, y: float) -> float:
    """Return the distance of a position ahead of a point of a path, along its tangent [m].

    Args:
        point: Point of the path.
        x: Position to north [m].
        y: Position to east [m].
    """
    return (x - point.x) * cos(point.course) + (y - point.y) * sin(point.course)


class Path:
    """Base class of planned paths, which are described by the distance along them.

    Before its start and behind its end a path continues straight.

    Attributes:
        length: Length of the path [m].
        corners: Distance along the path [m] and radius [m] of bends that are no part of the path,
            as a vessel rounds a waypoint.
    """

    length: float
    corners: tuple[tuple[float, float], ...] = ()

    def point(self, along: float) -> PathPoint:
        """Return the point at a distance along the path.

        Args:
            along: Distance from the start [m].
        """
        at = clip(along, 0.0, self.length)
        there = self.point_within(at)
        if at == along:
            return there
        over = along - at
        x, y = there.x + over * cos(there.course), there.y + over * sin(there.course)
        return PathPoint(x, y, there.course, 0.0)

    def point_within(self, along: float) -> PathPoint:
        """Return the point at a distance along the path between its ends.

        Args:
            along: Distance from the start [m].
        """
        raise NotImplementedError

    def follow(self, x: float, y: float, along: float) -> float:
        """Return the distance along the path of the foot point of a position.

        It is found from the previous one, so that another part of the path that passes near the
        position is not taken.

        Args:
            x: Position to north [m].
            y: Position to east [m].
            along: Distance along the path of the previous foot point [m].
        """
        for _ in range(FOOT_POINT_STEPS):
            there = self.point(along)
            slope = 1.0 - there.curvature * cross_track_error(there, x, y)
            step = along_track_error(there, x, y) / max(slope, NEAR_CENTRE)
            along += step
            if abs(step) < SAME_PLACE * self.length:
                break
        return along

    def nearest(self, x: float, y: float) -> float:
        """Return the distance along the path of the point nearest to a position.

        Args:
            x: Position to north [m].
            y: Position to east [m].
        """
        best, shortest = 0.0, inf
        for along in np.linspace(0.0, self.length, WHOLE_PATH_SAMPLES).tolist():
            there = self.point(along)
            distance = hypot(x - there.x, y - there.y)
            if distance < shortest:
                best, shortest = along, distance
        return self.follow(x, y, best)


@dataclass(frozen=True)
class Legs(Path):
    """Straight legs between waypoints, with a circle of acceptance around each of them.

    The next leg is followed as soon as the vessel is within the circle, or has passed the
    waypoint.

    Attributes:
        waypoints: x, y [m] (n, 2).
        acceptance: Radius of the circles of acceptance [m].
    """

    waypoints: Array
    acceptance: float
    length: float = field(init=False)
    corners: tuple[tuple[float, float], ...] = field(init=False)
    _starts: Array = field(init=False, repr=False)
    _courses: Array = field(init=False, repr=False)

    def __post_init__(self) -> None:
        """Compute lengths, courses and the radii of the bends at the waypoints.

        A bend touches both legs at the distance of the circle of acceptance from the waypoint.

        Raises:
            BadInput: There are less than two waypoints, or two successive ones are equal.
        """
        check_waypoints(self.waypoints)
        steps = np.diff(self.waypoints, axis=0)
        distances = np.hypot(steps[:, 0], steps[:, 1])
        starts = np.concatenate([[0.0], np.cumsum(distances)])
        courses = np.arctan2(steps[:, 1], steps[:, 0])
        corners = []
        for i in range(1, len(courses)):
            turn = abs(wrap(courses[i] - courses[i - 1]))
            reach = min(self.acceptance, 0.5 * distances[i - 1], 0.5 * distances[i])
            if turn > NO_ARC:
                corners.append((float(starts[i]), float(reach / tan(0.5 * turn))))
        for name, value in (
            ("length", float(starts[-1])),
            ("corners", tuple(corners)),
            ("_starts", starts),
            ("_courses", courses),
        ):
            object.__setattr__(self, name, value)

    def point_within(self, along: float) -> PathPoint:
        """Return the point at a distance along the legs.

        Args:
            along: Distance from the start [m].
        """
        return self._point_of_leg(self._leg(along), along)

    def follow(self, x: float, y: float, along: float) -> float:
        """Return the distance along the path of the foot point on the present leg or the next one.

        Args:
            x: Position to north [m].
            y: Position to east [m].
            along: Distance along the path of the previous foot point [m].
        """
        leg = self._leg(along)
        last = len(self._courses) - 1
        while True:
            there = self._point_of_leg(leg, float(self._starts[leg]))
            ahead = along_track_error(there, x, y)
            end = self.waypoints[leg + 1]
            distance = hypot(x - end[0], y - end[1])
            passed = self._starts[leg] + ahead >= self._starts[leg + 1]
            if leg == last or not (passed or distance <= self.acceptance):
                break
            leg += 1
        foot = float(self._starts[leg]) + ahead
        # before the begin of its leg a vessel that rounds a waypoint already follows that leg
        return foot if leg == 0 else max(foot, float(self._starts[leg]))

    def _leg(self, along: float) -> int:
        """Index of the leg at a distance along the path."""
        found = int(np.searchsorted(self._starts, along, side="right")) - 1
        return min(max(found, 0), len(self._courses) - 1)

    def _point_of_leg(self, leg: int, along: float) -> PathPoint:
        """Point of a leg, or of its extension, at a distance along the path."""
        course = float(self._courses[leg])
        over = along - float(self._starts[leg])
        x, y = self.waypoints[leg]
        return PathPoint(float(x) + over * cos(course), float(y) + over * sin(course), course, 0.0)


class Segment(NamedTuple):
    """Straight line or arc of a path."""

    start: PathPoint
    length: float  # [m]

    def point(self, along: float) -> PathPoint:
        """Return the point at a distance from the start of the segment.

        Args:
            along: Distance from the start of the segment [m].
        """
        x, y, course, curvature = self.start
        turn = curvature * along
        if abs(turn) < NO_ARC:
            return PathPoint(x + along * cos(course), y + along * sin(course), course, curvature)
        new = course + turn
        east = y + (cos(course) - cos(new)) / curvature
        return PathPoint(x + (sin(new) - sin(course)) / curvature, east, new, curvature)


@dataclass(frozen=True)
class Arcs(Path):
    """Straight lines and arcs that follow each other, as in a Dubins path.

    Attributes:
        segments: The segments; each one starts at the end of the one before.
    """

    segments: tuple[Segment, ...]
    length: float = field(init=False)
    _starts: Array = field(init=False, repr=False)

    def __post_init__(self) -> None:
        """Compute the distances at which the segments start."""
        starts = np.concatenate([[0.0], np.cumsum([one.length for one in self.segments])])
        object.__setattr__(self, "length", float(starts[-1]))
        object.__setattr__(self, "_starts", starts)

    def point_within(self, along: float) -> PathPoint:
        """Return the point at a distance along the segments.

        Args:
            along: Distance from the start [m].
        """
        found = int(np.searchsorted(self._starts, along, side="right")) - 1
        index = min(max(found, 0), len(self.segments) - 1)
        return self.segments[index].point(along - float(self._starts[index]))


@dataclass(frozen=True)
class Spline(Path):
    """Cubic spline through waypoints, with continuous course and curvature.

    Its parameter is the sum of the chords between the waypoints. At an end without a given course
    the curvature is zero (natural spline).

    Attributes:
        waypoints: x, y [m] (n, 2).
        courses: Course at the start and at the end [rad]; nan where it is free.
    """

    waypoints: Array
    courses: tuple[float, float] = (nan, nan)
    length: float = field(init=False)
    _places: list[float] = field(init=False, repr=False)  # [m] parameters of the waypoints
    # coefficients of the pieces: x and y, each from the constant to the cubic term
    _cubics: list[tuple[tuple[float, ...], tuple[float, ...]]] = field(init=False, repr=False)
    _lengths: list[float] = field(init=False, repr=False)
    _parameters: list[float] = field(init=False, repr=False)

    def __post_init__(self) -> None:
        """Solve for the slopes at the waypoints, and tabulate the length.

        Raises:
            BadInput: There are less than two waypoints, or two successive ones are equal.
        """
        check_waypoints(self.waypoints)
        steps = np.diff(self.waypoints, axis=0)
        knots = np.concatenate([[0.0], np.cumsum(np.hypot(steps[:, 0], steps[:, 1]))])
        slopes = spline_slopes(knots, self.waypoints, self.courses)
        width = np.diff(knots)[:, None]
        chords = steps / width
        cubics = np.stack(
            [
                self.waypoints[:-1],
                slopes[:-1],
                (3.0 * chords - 2.0 * slopes[:-1] - slopes[1:]) / width,
                (slopes[:-1] + slopes[1:] - 2.0 * chords) / width**2,
            ],
            axis=-1,
        )
        object.__setattr__(self, "_places", knots.tolist())
        object.__setattr__(self, "_cubics", cubics.tolist())
        lengths, parameters = self._tabulate_length()
        object.__setattr__(self, "_lengths", lengths)
        object.__setattr__(self, "_parameters", parameters)
        object.__setattr__(self, "length", lengths[-1])

    def _tabulate_length(self) -> tuple[list[float], list[float]]:
        """Lengths from the start and the parameters at which they are reached."""
        nodes, weights = np.polynomial.legendre.leggauss(4)
        rule = list(zip(nodes.tolist(), weights.tolist(), strict=True))
        lengths, parameters = [0.0], [0.0]
        for begin, end in zip(self._places[:-1], self._places[1:], strict=True):
            half = 0.5 * (end - begin) / SPLINE_PARTS
            for k in range(SPLINE_PARTS):
                middle = begin + (2 * k + 1) * half
                part = 0.0
                for node, weight in rule:
                    part += weight * half * hypot(*self._motion(middle + node * half)[1])
                lengths.append(lengths[-1] + part)
                parameters.append(middle + half)
        return lengths, parameters

    def point_within(self, along: float) -> PathPoint:
        """Return the point at a distance along the spline.

        Args:
            along: Distance from the start [m].
        """
        lengths, parameters = self._lengths, self._parameters
        at = min(max(bisect_right(lengths, along) - 1, 0), len(lengths) - 2)
        begin, left = parameters[at], along - lengths[at]
        share = left / (lengths[at + 1] - lengths[at])
        parameter = begin + share * (parameters[at + 1] - begin)
        # one step of Newton's method, with the length from the row of the table before by Simpson
        first, last = self._motion(begin)[1], self._motion(parameter)[1]
        middle = self._motion(0.5 * (begin + parameter))[1]
        arc = (parameter - begin) * (hypot(*first) + 4.0 * hypot(*middle) + hypot(*last)) / 6.0
        parameter += (left - arc) / hypot(*last)
        (x, y), (dx, dy), (ddx, ddy) = self._motion(parameter)
        curvature = (dx * ddy - dy * ddx) / hypot(dx, dy) ** 3
        return PathPoint(x, y, atan2(dy, dx), curvature)

    def _motion(self, parameter: float) -> tuple[Pair, Pair, Pair]:
        """Place, and first and second derivative by the parameter."""
        knots = self._places
        piece = min(max(bisect_right(knots, parameter) - 1, 0), len(knots) - 2)
        t = parameter - knots[piece]
        (ax, bx, cx, dx), (ay, by, cy, dy) = self._cubics[piece]
        return (
            (ax + t * (bx + t * (cx + t * dx)), ay + t * (by + t * (cy + t * dy))),
            (bx + t * (2.0 * cx + 3.0 * t * dx), by + t * (2.0 * cy + 3.0 * t * dy)),
            (2.0 * cx + 6.0 * t * dx, 2.0 * cy + 6.0 * t * dy),
        )


def spline_slopes(knots: Array, points: Array, courses: tuple[float, float]) -> Array:
    """Return the slopes of a cubic spline at its knots (n, 2) [m/m].

    The second derivative is continuous. At an end it is zero, or the slope is a unit vector along a
    given course.

    Args:
        knots: Parameter at the points (n,) [m].
        points: x, y [m] (n, 2).
        courses: Course at the start and at the end [rad]; nan where it is free.
    """
    count = len(knots)
    width = np.diff(knots)
    chords = np.diff(points, axis=0) / width[:, None]
    matrix, right = np.zeros((count, count)), np.zeros((count, 2))
    for i in range(1, count - 1):
        matrix[i, i - 1 : i + 2] = (
            1.0 / width[i - 1],
            2.0 / width[i - 1] + 2.0 / width[i],
            1.0 / width[i],
        )
        right[i] = 3.0 * (chords[i - 1] / width[i - 1] + chords[i] / width[i])
    for end, neighbour, chord in ((0, 1, 0), (count - 1, count - 2, count - 2)):
        course = courses[0 if end == 0 else 1]
        matrix[end, end] = 1.0
        right[end] = cos(course), sin(course)
        if course != course:
            matrix[end, end], matrix[end, neighbour] = 2.0, 1.0
            right[end] = 3.0 * chords[chord]
    return np.asarray(np.linalg.solve(matrix, right))


class DubinsWord(NamedTuple):
    """One of the six words of Dubins: three segments and their total length."""

    word: str  # three letters: R to starboard, L to port, S straight
    arcs: tuple[float, float, float]  # [m]
    length: float  # [m]


def dubins_words(
    start: tuple[float, float, float], end: tuple[float, float, float], radius: float
) -> list[DubinsWord]:
    """Return the paths by all words of Dubins that lead from one pose to another.

    Args:
        start: x, y [m] and course [rad].
        end: x, y [m] and course [rad].
        radius: Radius of the turns [m].

    Raises:
        BadInput: The radius is not positive.
    """
    if not radius > 0.0:
        raise BadInput(f"radius = {radius:g} m; allowed is more than 0 m")
    found = []
    for first in (1.0, -1.0):
        for last in (1.0, -1.0):
            arcs = _two_turns(start, end, radius, first, last)
            if arcs is not None:
                found.append(_word(LETTERS[first] + "S" + LETTERS[last], arcs))
        for side in (1.0, -1.0):
            arcs = _three_turns(start, end, radius, first, side)
            if arcs is not None:
                found.append(_word(LETTERS[first] + LETTERS[-first] + LETTERS[first], arcs))
    return found


def _word(word: str, arcs: tuple[float, float, float]) -> DubinsWord:
    """A word with its length."""
    return DubinsWord(word, arcs, sum(arcs))


def _arc(angle: float) -> float:
    """Angle of an arc in [0, 2 pi); full turns by rounding are no arc."""
    turn = angle % FULL_TURN
    return 0.0 if turn > FULL_TURN - NO_ARC else turn


def _centre(pose: tuple[float, float, float], radius: float, side: float) -> tuple[float, float]:
    """Centre of a turn from a pose; the side is 1 to starboard and -1 to port."""
    x, y, course = pose
    return x - side * radius * sin(course), y + side * radius * cos(course)


def _two_turns(
    start: tuple[float, float, float],
    end: tuple[float, float, float],
    radius: float,
    first: float,
    last: float,
) -> tuple[float, float, float] | None:
    """Lengths of turn, straight line and turn; None if there is no such path."""
    (x1, y1), (x2, y2) = _centre(start, radius, first), _centre(end, radius, last)
    distance, course = hypot(x2 - x1, y2 - y1), atan2(y2 - y1, x2 - x1)
    straight = distance
    if first != last:
        if distance < 2.0 * radius:
            return None
        straight = sqrt(distance * distance - 4.0 * radius * radius)
        course += first * asin(2.0 * radius / distance)
    elif distance < NO_ARC * radius:
        course = start[2]  # one turn about a common centre
    begin, finish = _arc(first * (course - start[2])), _arc(last * (end[2] - course))
    return radius * begin, straight, radius * finish


def _three_turns(
    start: tuple[float, float, float],
    end: tuple[float, float, float],
    radius: float,
    first: float,
    side: float,
) -> tuple[float, float, float] | None:
    """Lengths of three turns; None if there is no such path.

    The centre of the middle turn is on one side of the line between the other centres, or on the
    other one.
    """
    (x1, y1), (x2, y2) = _centre(start, radius, first), _centre(end, radius, first)
    distance = hypot(x2 - x1, y2 - y1)
    if distance > 4.0 * radius or distance < NO_ARC * radius:
        return None
    direction = atan2(y2 - y1, x2 - x1) + side * acos(distance / (4.0 * radius))
    middle = x1 + 2.0 * radius * cos(direction), y1 + 2.0 * radius * sin(direction)
    courses = []
    for x, y in ((x1, y1), (x2, y2)):
        courses.append(atan2(first * (middle[0] - x), -first * (middle[1] - y)))
    return (
        radius * _arc(first * (courses[0] - start[2])),
        radius * _arc(-first * (courses[1] - courses[0])),
        radius * _arc(first * (end[2] - courses[1])),
    )


def dubins_path(poses: Sequence[tuple[float, float, float]], radius: float) -> Arcs:
    """Return the shortest path with bounded curvature from each pose to the next one.

    Args:
        poses: x, y [m] and course [rad] of at least two poses.
        radius: Smallest radius of a turn [m].

    Raises:
        BadInput: There are less than two poses, two successive ones are equal, or the radius is
            not positive.
    """
    if len(poses) < 2:
        raise BadInput(f"{len(poses)} waypoints; a path needs at least two")
    segments = []
    for start, end in zip(poses[:-1], poses[1:], strict=True):
        best = min(dubins_words(start, end, radius), key=lambda one: one.length)
        if best.length <= 0.0:
            raise BadInput("two successive waypoints are equal; allowed are different ones")
        x, y, course = start
        for letter, length in zip(best.word, best.arcs, strict=True):
            curvature = {"R": 1.0, "L": -1.0, "S": 0.0}[letter] / radius
            one = Segment(PathPoint(x, y, course, curvature), length)
            x, y, course, _ = one.point(length)
            if length > 0.0:
                segments.append(one)
    return Arcs(tuple(segments))


def courses_at(waypoints: Array, given: Sequence[float]) -> list[float]:
    """Return the course at each waypoint [rad]: a given one, or that between its neighbours.

    Args:
        waypoints: x, y [m] (n, 2).
        given: Course at each of them [rad]; nan where none is given.
    """
    courses = []
    for i, course in enumerate(given):
        before, after = waypoints[max(i - 1, 0)], waypoints[min(i + 1, len(waypoints) - 1)]
        along = atan2(after[1] - before[1], after[0] - before[0])
        courses.append(along if course != course else course)
    return courses


def check_waypoints(waypoints: Array) -> None:
    """Check that waypoints form a path.

    Args:
        waypoints: x, y [m] (n, 2).

    Raises:
        BadInput: There are less than two waypoints, or two successive ones are equal.
    """
    if len(waypoints) < 2:
        raise BadInput(f"{len(waypoints)} waypoints; a path needs at least two")
    steps = np.diff(waypoints, axis=0)
    if not (np.hypot(steps[:, 0], steps[:, 1]) > 0.0).all():
        raise BadInput("two successive waypoints are equal; allowed are different ones")


@dataclass(frozen=True)
class SpeedProfile:
    """Largest speed along a path, with limited acceleration between its points.

    Attributes:
        along: Distances from the start (n,) [m].
        speed: Speeds there (n,) [m/s].
    """

    along: Array
    speed: Array

    def at(self, along: float) -> float:
        """Return the speed at a distance along the path [m/s].

        Between two points its square is linear, which is a constant acceleration.

        Args:
            along: Distance from the start [m].
        """
        return sqrt(float(np.interp(along, self.along, self.speed**2)))


def speed_profile(
    path: Path,
    speed: float,
    turn_rate: float,
    acceleration: float,
    end_speed: float = inf,
) -> SpeedProfile:
    """Return the largest speed along a path for limits of turn rate and acceleration.

    Args:
        path: The path.
        speed: Largest speed [m/s].
        turn_rate: Largest turn rate [rad/s]; the speed in a bend is at most this over the
            curvature, and at least a tenth of the largest speed.
        acceleration: Largest acceleration and deceleration [m/s^2].
        end_speed: Largest speed at the end [m/s].
    """
    along = np.linspace(0.0, path.length, PROFILE_SAMPLES)
    along = np.union1d(along, [clip(at, 0.0, path.length) for at, _ in path.corners])
    curvature = np.abs([path.point(at).curvature for at in along.tolist()])
    allowed = np.full(len(along), speed)
    bent = curvature > 0.0
    allowed[bent] = np.minimum(speed, turn_rate / curvature[bent])
    for at, radius in path.corners:
        index = int(np.searchsorted(along, at))
        allowed[index] = min(allowed[index], turn_rate * radius)
    allowed = np.maximum(allowed, SLOWEST_SHARE * speed)
    allowed[-1] = min(allowed[-1], end_speed)
    squares = allowed**2
    room = 2.0 * acceleration * np.diff(along)
    for i in range(len(along) - 1):
        squares[i + 1] = min(squares[i + 1], squares[i] + room[i])
    for i in range(len(along) - 1, 0, -1):
        squares[i - 1] = min(squares[i - 1], squares[i] + room[i - 1])
    return SpeedProfile(along, np.sqrt(squares))
