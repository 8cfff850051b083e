"""Velocity of a current between the points of a grid of time and place, for compiled laws.

The numbers of a grid are the numbers of times T, of places along x and along y, then these times
[s] and places [m], then for each time and place the velocity to north and east [m/s], and after
all of these for each time the displacement since the first time [m] and the mean velocity over all
places, each to north and east. Values in between are linear in each variable. Outside the grid they
are those of its edge.
"""

from typing import Any, NamedTuple

import numpy as np
from numba import njit

from boatsim.physics.current_file import CurrentTable
from boatsim.physics.signals import Array
from boatsim.physics.waves.water_path import WaterPath

HEAD = 3  # numbers before the times
# The grid of water at rest
EMPTY = (1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


def current_grid(found: CurrentTable, draught: float) -> tuple[float, ...]:
    """Return the numbers of the grid of a current.

    Args:
        found: The current.
        draught: Depth over which its velocity is averaged [m].
    """
    velocity = found.mean_over_draught(draught)
    path = mean_path(found, draught, 0.0)
    ends = np.concatenate([path.distance, path.velocity], axis=1)
    axes = (found.time, found.north, found.east)
    counts = [float(len(axis)) for axis in axes]
    numbers = np.concatenate([*axes, velocity.ravel(), ends.ravel()])
    return (*counts, *numbers.tolist())


def mean_path(found: CurrentTable, draught: float, start: float) -> WaterPath:
    """Return the path of the water that moves with the mean current of all places.

    Args:
        found: The current.
        draught: Depth over which its velocity is averaged [m].
        start: Time of the table at t = 0 [s].
    """
    velocity = found.mean_over_places(found.mean_over_draught(draught))
    return WaterPath.of_velocities(found.time, velocity, start)


class Span(NamedTuple):
    """Two neighbouring points of one axis of a grid, around a value."""

    low: Any  # number of the point below
    high: Any  # number of the point above; the same if there is only one
    share: float  # share of the point above
    slope: float  # derivative of the share by the value; 0 outside the grid


@njit(inline="always")
def span_around(value: float, p: Array, begin: Any, count: Any) -> Span:
    """Return the points of an axis around a value.

    Args:
        value: The value.
        p: Parameters and tables.
        begin: Place of the first point of the axis in them.
        count: Number of its points.
    """
    if count < 2 or value < p[begin]:
        return Span(0, 0, 0.0, 0.0)
    if value >= p[begin + count - 1]:
        return Span(count - 1, count - 1, 0.0, 0.0)
    low, high = 0, count - 1
    while high - low > 1:
        middle = (low + high) // 2
        if p[begin + middle] <= value:
            low = middle
        else:
            high = middle
    slope = 1.0 / (p[begin + high] - p[begin + low])
    return Span(low, high, (value - p[begin + low]) * slope, slope)


class Corner(NamedTuple):
    """A corner of a cell of a grid: its velocity, and what it contributes."""

    north: float  # [m/s]
    east: float  # [m/s]
    weight: float  # share of the velocity
    by_t: float  # derivatives of the share by time [1/s]
    by_x: float  # and by place [1/m]
    by_y: float


@njit(inline="always")
def corner_of_cell(number: Any, times: Span, xs: Span, ys: Span, p: Array, first: Any) -> Corner:
    """Return one of the eight corners of a cell.

    Args:
        number: Number of the corner, 0 to 7.
        times: Points around the time.
        xs: Points around the place along x.
        ys: Points around the place along y.
        p: Parameters and tables.
        first: Index of the grid.
    """
    count_t, count_x, count_y = int(p[first]), int(p[first + 1]), int(p[first + 2])
    i, at, dt = int(times.low), 1.0 - times.share, -times.slope
    if number % 2 == 1:
        i, at, dt = int(times.high), times.share, times.slope
    j, ax, dx = int(xs.low), 1.0 - xs.share, -xs.slope
    if (number // 2) % 2 == 1:
        j, ax, dx = int(xs.high), xs.share, xs.slope
    k, ay, dy = int(ys.low), 1.0 - ys.share, -ys.slope
    if number // 4 == 1:
        k, ay, dy = int(ys.high), ys.share, ys.slope
    values = first + HEAD + count_t + count_x + count_y
    place = values + 2 * ((i * count_x + j) * count_y + k)
    return Corner(p[place], p[place + 1], at * ax * ay, dt * ax * ay, at * dx * ay, at * ax * dy)


@njit(inline="always")
def spans_around(t: float, x: float, y: float, p: Array, first: Any) -> tuple[Span, Span, Span]:
    """Return the points of a grid around a time and place, for each of its axes.

    Args:
        t: Time of the table [s].
        x: Place along x [m].
        y: Place along y [m].
        p: Parameters and tables.
        first: Index of the grid.
    """
    times, xs, ys = int(p[first]), int(p[first + 1]), int(p[first + 2])
    begin = first + HEAD
    return (
        span_around(t, p, begin, times),
        span_around(x, p, begin + times, xs),
        span_around(y, p, begin + times + xs, ys),
    )


@njit
def grid_velocity(t: float, x: float, y: float, p: Array, first: Any) -> tuple[float, float]:
    """Return the velocity of a current at a time and place.

    Args:
        t: Time of the table [s].
        x: Place along x [m].
        y: Place along y [m].
        p: Parameters and tables.
        first: Index of the grid.

    Returns:
        Velocity to north and east [m/s].
    """
    times, xs, ys = spans_around(t, x, y, p, first)
    north = east = 0.0
    for number in range(8):
        corner = corner_of_cell(number, times, xs, ys, p, first)
        north += corner.weight * corner.north
        east += corner.weight * corner.east
    return north, east


@njit
def grid_change(
    t: float, x: float, y: float, p: Array, first: Any
) -> tuple[float, float, float, float, float, float]:
    """Return the derivatives of the velocity of a current by time and place.

    Args:
        t: Time of the table [s].
        x: Place along x [m].
        y: Place along y [m].
        p: Parameters and tables.
        first: Index of the grid.

    Returns:
        Derivatives of the velocity to north by time [m/s^2], x and y [1/s], then of that to east.
        At a point of the table they are those after it.
    """
    times, xs, ys = spans_around(t, x, y, p, first)
    north_t = north_x = north_y = east_t = east_x = east_y = 0.0
    for number in range(8):
        corner = corner_of_cell(number, times, xs, ys, p, first)
        north_t += corner.by_t * corner.north
        north_x += corner.by_x * corner.north
        north_y += corner.by_y * corner.north
        east_t += corner.by_t * corner.east
        east_x += corner.by_x * corner.east
        east_y += corner.by_y * corner.east
    return north_t, north_x, north_y, east_t, east_x, east_y


@njit
def grid_displacement(t: float, p: Array, first: Any) -> tuple[float, float]:
    """Return the displacement of water that moves with the mean current since the first time.

    Args:
        t: Time of the table [s].
        p: Parameters and tables.
        first: Index of the grid.

    Returns:
        Displacement to north and east [m].
    """
    times, xs, ys = int(p[first]), int(p[first + 1]), int(p[first + 2])
    span = span_around(t, p, first + HEAD, times)
    means = first + HEAD + times + xs + ys + 2 * times * xs * ys
    low, high = means + 4 * int(span.low), means + 4 * int(span.high)
    since, half = t - p[first + HEAD + int(span.low)], 0.5 * span.share
    north = p[low] + since * (p[low + 2] + half * (p[high + 2] - p[low + 2]))
    east = p[low + 1] + since * (p[low + 3] + half * (p[high + 3] - p[low + 3]))
    return north, east
