"""Regular grid of frequency and heading of waves: its size, and the place of a wave on it.

Values on a grid are linear between its frequencies and cubic between its headings. A table that
compiled laws read begins a grid with the lowest frequency [rad/s], the distance of frequencies
[rad/s], and the numbers of frequencies and of headings. Headings extend from 0 to pi; those on the
other side of the hull follow from its symmetry.
"""

from collections.abc import Callable, Sequence
from math import atan2, pi
from typing import Any, NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from boatsim.errors import BadInput
from boatsim.physics.debugging import interpreted
from boatsim.physics.signals import Array

HEAD = 4  # numbers of a table that describe its grid
# Numbers of frequencies and of headings, of which the first is taken whose values in between are
# accurate enough. The excitation of a small hull in waves of half its length and more needs the
# smallest ones. A table that extends to shorter waves needs more. If the headings of a table are
# equally spaced, only numbers are taken with which they are on the grid, unless it has more of them
# than the largest grid.
FREQUENCIES = (96, 192, 384, 768)
HEADINGS = (25, 31, 37, 49, 61, 73)
ERROR = 0.01  # largest error of values on a grid, over the largest value of the axis
# An axis whose largest value is a smaller share of the largest force or moment has no accuracy of
# its own: the coefficients of boundary elements in it are rounding, such as sway in head waves.
NEGLIGIBLE = 1e-4
# Sign of a component in the mirror at the plane of symmetry of the hull
MIRROR = np.array([1.0, -1.0, 1.0, -1.0, 1.0, -1.0])
# Share of a step by which a frequency may exceed the last one: rounding of a text file
EDGE = 0.01
CLOSE = 1e-3  # [rad] by which the first and last heading may differ from 0 and pi

Values = Array | NDArray[np.complex128]


def check_headings(heading: Array, words: str) -> None:
    """Check that headings extend over half a circle, so that their mirror images complete it.

    Args:
        heading: Headings (H,) [rad], increasing.
        words: File or folder and quantity, for the message.

    Raises:
        BadInput: There are fewer than five headings, or they do not extend from 0 to pi.
    """
    if len(heading) < 5 or abs(heading[0]) > CLOSE or abs(heading[-1] - pi) > CLOSE:
        raise BadInput(
            f"{words} extend from {heading[0]:.3g} to {heading[-1]:.3g} rad; at least five from 0 "
            "to pi are required"
        )


def largest_values(values: Values) -> Array:
    """Return the largest value of each axis (6,), to which errors refer.

    It is at least the negligible share of the largest force or moment.

    Args:
        values: Forces and moments (..., 6).
    """
    largest = np.abs(values).reshape(-1, 6).max(axis=0)
    for own in (slice(0, 3), slice(3, 6)):
        largest[own] = np.maximum(largest[own], NEGLIGIBLE * largest[own].max())
    return np.asarray(largest)


def grid_frequencies(
    frequency: Array, function: Callable[[Array], Values], largest: Array, error: float
) -> Array:
    """Return equally spaced frequencies between which linear functions follow those of a table.

    The error is that at the frequencies of the table and halfway between those of the grid.

    Args:
        frequency: Frequencies of the table (N,) [rad/s].
        function: Returns its values (F, ..., C) at frequencies (F,).
        largest: Largest value of each component (C,).
        error: Largest error over the largest value.
    """
    for count in FREQUENCIES:
        grid = np.linspace(frequency[0], frequency[-1], count)
        places = np.append(0.5 * (grid[1:] + grid[:-1]), frequency)
        found = np.abs(_between_frequencies(grid, function(grid), places) - function(places))
        if np.all(found <= error * largest):
            break
    return grid


def _between_frequencies(grid: Array, values: Values, places: Array) -> Values:
    """Return values (P, ...) at frequencies between those of a grid, as compiled laws do.

    Args:
        grid: Frequencies of the grid (F,) [rad/s].
        values: Values on the grid (F, ...).
        places: Frequencies (P,) within the grid [rad/s].
    """
    along = (places - grid[0]) / (grid[1] - grid[0])
    low = np.minimum(along.astype(int), len(grid) - 2)
    part = (along - low).reshape(-1, *[1] * (values.ndim - 1))
    return np.asarray((1.0 - part) * values[low] + part * values[low + 1])


def grid_headings(
    heading: Array, values: Values, mirror: Array, largest: Array, error: float
) -> Array:
    """Return equally spaced headings between which compiled laws follow a spline.

    The error is that at the headings of the table and at three places between each two of them.

    Args:
        heading: Headings of a table (H,) from 0 to pi [rad].
        values: Its values (N, H, C).
        mirror: Signs of the components in the mirror (C,).
        largest: Largest value of each component (C,).
        error: Largest error over the largest value.
    """
    spline = over_headings(heading, values, mirror)
    shares = np.array([0.0, 0.25, 0.5, 0.75])
    between = heading[:-1, None] + shares * np.diff(heading)[:, None]
    places = np.clip(np.append(between, heading[-1]), 0.0, pi)
    exact = spline(places)
    for count in _heading_counts(heading):
        grid = np.linspace(0.0, pi, count)
        found = np.abs(_between_headings(spline(grid), places, mirror) - exact)
        if np.all(found <= error * largest):
            break
    return grid


def _heading_counts(heading: Array) -> Sequence[int]:
    """Return the numbers of headings of a grid to try, increasing.

    Args:
        heading: Headings of the table (H,) from 0 to pi [rad].
    """
    intervals, counts = len(heading) - 1, []
    if np.ptp(np.diff(heading)) < CLOSE:
        for count in range(intervals + 1, HEADINGS[-1] + 1, intervals):
            if count >= HEADINGS[0]:
                counts.append(count)
    return counts or HEADINGS


def _between_headings(values: Values, places: Array, mirror: Array) -> Any:
    """Return values (N, P, C) at headings between those of a grid, as compiled laws do.

    Args:
        values: Values on the grid (N, H, C).
        places: Headings (P,) from 0 to pi [rad].
        mirror: Signs of the components in the mirror (C,).
    """
    beyond = values[:, 1:2] * mirror, values[:, -2:-1] * mirror
    around = np.concatenate([beyond[0], values, beyond[1]], axis=1)
    bearing = places / pi * (values.shape[1] - 1.0)
    left = np.minimum(bearing.astype(int), values.shape[1] - 2)
    weights = interpreted(cubic_weights)(bearing - left)
    total = np.zeros((len(values), len(places), values.shape[2]), dtype=values.dtype)
    for j, weight in enumerate(weights):
        total += weight[None, :, None] * around[:, left + j]
    return total


def over_headings(heading: Array, values: Values, mirror: Array) -> CubicSpline:
    """Return a spline of values (N, H, C) over the heading, around the whole hull.

    Args:
        heading: Headings (H,) from 0 to pi [rad].
        values: Values at these headings.
        mirror: Signs of the components in the mirror (C,).
    """
    around = np.concatenate([heading, 2.0 * pi - heading[-2:0:-1], [2.0 * pi]])
    other = values[:, -2:0:-1] * mirror
    whole = np.concatenate([values, other, values[:, :1]], axis=1)
    around[0], around[len(heading) - 1] = 0.0, pi
    return CubicSpline(around, whole, axis=1, bc_type="periodic")


@njit(inline="always")
def cubic_weights(u: float) -> tuple[float, float, float, float]:
    """Return the weights of four equally spaced points for a place between the middle ones.

    They are those of the cubic through the middle points with the slopes of the chords (E. Catmull
    and R. Rom, Computer Aided Geometric Design, 1974).

    Args:
        u: Place after the second point, 0 to 1 of the distance.
    """
    u2, u3 = u * u, u * u * u
    return (
        0.5 * (2.0 * u2 - u - u3),
        0.5 * (2.0 - 5.0 * u2 + 3.0 * u3),
        0.5 * (u + 4.0 * u2 - 3.0 * u3),
        0.5 * (u3 - u2),
    )


@njit(inline="always")
def folded(place: Any, last: Any) -> tuple[Any, float]:
    """Return the number of a heading on the grid and its sign in the mirror: -1 beyond an end.

    Args:
        place: Number of the heading, from -1 to one more than the last.
        last: Number of the last heading.
    """
    if place < 0:
        return -place, -1.0
    if place > last:
        return 2 * last - place, -1.0
    return place, 1.0


class GridPlace(NamedTuple):
    """Place of a wave on the grid of frequency and heading."""

    low: Any  # number of the frequency below it
    part: float  # share of the next frequency
    left: Any  # number of the heading before it
    side: float  # -1 for a wave that runs to port
    beyond: bool  # whether its frequency is above those of the grid


@njit(inline="always")
def grid_place(frequency: float, ahead: float, across: float, p: Array, first: Any) -> Any:
    """Return the place of a wave on the grid, and the weights of the four headings around it.

    Frequencies outside the grid have the place of its end.

    Args:
        frequency: Frequency of the wave [rad/s].
        ahead: Cosine of the direction to which the wave runs, relative to the hull.
        across: Sine of it, to starboard.
        p: Parameters and tables.
        first: Index of the table of the grid.
    """
    count, headings = int(p[first + 2]), int(p[first + 3])
    along = max((frequency - p[first]) / p[first + 1], 0.0)
    beyond = along > count - 1.0 + EDGE
    along = min(along, count - 1.0)
    low = min(int(along), count - 2)
    side = 1.0
    if across < 0.0:
        side = -1.0
    bearing = atan2(side * across, ahead) / pi * (headings - 1.0)
    left = min(int(bearing), headings - 2)
    return GridPlace(low, along - low, left, side, beyond), cubic_weights(bearing - left)
