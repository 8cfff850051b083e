"""Excitation and mean drift of waves on a regular grid of frequency and heading.

Compiled laws read the table of the effect. It has the lowest frequency [rad/s], the distance of
frequencies [rad/s], the numbers of frequencies and of headings, then for each frequency and heading
the real and imaginary part of the six components of the excitation, and after all of these for each
frequency and heading the mean drift in surge, sway and yaw per square of the amplitude. Headings
extend from 0 to pi; those on the other side of the hull follow from its symmetry. Values in between
are linear in the frequency and cubic in the heading.
"""

from functools import lru_cache
from math import atan2, pi
from typing import Any, NamedTuple

import numpy as np
from numba import njit
from scipy.interpolate import CubicSpline, PchipInterpolator

from boatsim.errors import BadInput
from boatsim.physics.coefficients.table import WaveLoads
from boatsim.physics.debugging import interpreted
from boatsim.physics.signals import Array, Wrench

HEAD = 4  # numbers of the table before the values
VALUES, DRIFTS = 12, 3  # of each frequency and heading, of excitation and of drift
# Numbers of frequencies and of headings, of which the first is taken whose values in between err by
# less than `ERROR` of the largest one. A hull in waves of half its length and more needs the first.
# A table that extends to shorter waves needs more frequencies, and a grid that has its headings.
FREQUENCIES = (96, 192, 384, 768)
HEADINGS = (25, 31, 37, 49, 61, 73)
ERROR = 0.01
# Sign of a component in the mirror at the plane of symmetry of the hull
MIRROR = np.array([1.0, -1.0, 1.0, -1.0, 1.0, -1.0])
DRIFT_MIRROR = np.array([1.0, -1.0, -1.0])  # of surge, sway and yaw
# Share of a step by which a frequency may exceed the last one: rounding of a text file
EDGE = 0.01
CLOSE = 1e-3  # [rad] by which the first and last heading may differ from 0 and pi


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


@lru_cache(maxsize=8)
def excitation_grid(found: WaveLoads, label: str) -> tuple[float, ...]:
    """Return the table of excitation and mean drift of a hull, as compiled laws read it.

    The mean drift is zero if it is not known.

    Args:
        found: Loads with headings from 0 to pi.
        label: Folder of the coefficients, for messages.

    Raises:
        BadInput: There are fewer than five headings, or they do not extend from 0 to pi.
    """
    heading = found.heading
    check_headings(heading, f"{label}: the headings of the excitation")
    spline = CubicSpline(found.frequency, found.excitation)
    frequency = _grid_frequencies(found, spline)
    angles = _grid_headings(found)
    grid = _over_headings(heading, spline(frequency), MIRROR)(angles)
    pairs = np.stack([grid.real, grid.imag], axis=-1)
    drift = np.zeros((len(frequency), len(angles), DRIFTS))
    if found.drift is not None:
        # the drift can have a narrow peak at a resonance, next to which a spline would oscillate
        over_frequency = PchipInterpolator(found.frequency, found.drift)(frequency)
        drift = _over_headings(heading, over_frequency, DRIFT_MIRROR)(angles)
    step = frequency[1] - frequency[0]
    head = (float(frequency[0]), float(step), float(len(frequency)), float(len(angles)))
    return (*head, *pairs.ravel().tolist(), *drift.ravel().tolist())


def _grid_frequencies(found: WaveLoads, spline: CubicSpline) -> Array:
    """Return equally spaced frequencies between which a linear function follows the excitation.

    Args:
        found: The table.
        spline: Its excitation over frequency, of shape (H, 6) at each.
    """
    largest = np.abs(found.excitation).max(axis=(0, 1))
    for count in FREQUENCIES:
        grid = np.linspace(found.frequency[0], found.frequency[-1], count)
        values = spline(grid)
        middle = spline(0.5 * (grid[1:] + grid[:-1]))
        error = np.abs(middle - 0.5 * (values[1:] + values[:-1])).max(axis=(0, 1))
        if np.all(error <= ERROR * largest):
            break
    return grid


def _grid_headings(found: WaveLoads) -> Array:
    """Return equally spaced headings between which the law follows the excitation.

    The error is that at the headings of the table and in the middle between them.

    Args:
        found: The table.
    """
    largest = np.abs(found.excitation).max(axis=(0, 1))
    spline = _over_headings(found.heading, found.excitation, MIRROR)
    own = found.heading
    places = np.clip(np.append(own, 0.5 * (own[1:] + own[:-1])), 0.0, pi)
    exact = spline(places)
    for count in HEADINGS:
        grid = np.linspace(0.0, pi, count)
        values = spline(grid)
        error = np.abs(_between_headings(values, places) - exact).max(axis=(0, 1))
        if np.all(error <= ERROR * largest):
            break
    return grid


def _between_headings(values: Array, places: Array) -> Array:
    """Return the excitation (N, P, 6) at headings between those of a grid, as the law does.

    Args:
        values: Excitation on the grid (N, H, 6).
        places: Headings (P,) from 0 to pi [rad].
    """
    beyond = values[:, 1:2] * MIRROR, values[:, -2:-1] * MIRROR
    around = np.concatenate([beyond[0], values, beyond[1]], axis=1)
    bearing = places / pi * (values.shape[1] - 1.0)
    left = np.minimum(bearing.astype(int), values.shape[1] - 2)
    weights = interpreted(cubic_weights)(bearing - left)
    total = np.zeros((len(values), len(places), values.shape[2]), dtype=values.dtype)
    for j, weight in enumerate(weights):
        total += weight[None, :, None] * around[:, left + j]
    return total


def _over_headings(heading: Array, values: Array, mirror: Array) -> CubicSpline:
    """Return a spline of values (F, H, C) over the heading, around the whole hull.

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
        first: Index of the table.
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


@njit(inline="always")
def end_of_grid(p: Array, first: Any) -> Any:
    """Return the index after the table of excitation and mean drift.

    Args:
        p: Parameters and tables.
        first: Index of the table.
    """
    return first + HEAD + int(p[first + 2]) * int(p[first + 3]) * (VALUES + DRIFTS)


@njit
def excitation_force(
    frequency: float, ahead: float, across: float, c: float, s: float, p: Array, first: Any
) -> Wrench:
    """Return the force of one wave of unit amplitude on the hull.

    Args:
        frequency: Frequency of the wave [rad/s]. Below the lowest one of the table the value there
            is taken, above the highest one the force is zero.
        ahead: Cosine of the direction to which the wave runs, relative to the hull.
        across: Sine of it, to starboard.
        c: Cosine of the phase of the wave at the origin of motion; a crest has phase 0.
        s: Sine of it.
        p: Parameters and tables.
        first: Index of the table.

    Returns:
        Force [N/m] and moment [N].
    """
    place, weights = grid_place(frequency, ahead, across, p, first)
    if place.beyond:
        return Wrench(0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    headings = int(p[first + 3])
    X = Y = Z = K = M = N = 0.0
    for j in range(4):
        heading, sign = folded(place.left - 1 + j, headings - 1)
        mirrored = place.side * sign
        for i in range(2):
            share = weights[j] * (1.0 - place.part)
            if i == 1:
                share = weights[j] * place.part
            at = first + HEAD + ((place.low + i) * headings + heading) * VALUES
            turned = share * mirrored
            X += share * (p[at] * c - p[at + 1] * s)
            Y += turned * (p[at + 2] * c - p[at + 3] * s)
            Z += share * (p[at + 4] * c - p[at + 5] * s)
            K += turned * (p[at + 6] * c - p[at + 7] * s)
            M += share * (p[at + 8] * c - p[at + 9] * s)
            N += turned * (p[at + 10] * c - p[at + 11] * s)
    return Wrench(X, Y, Z, K, M, N)


@njit
def mean_drift_force(
    frequency: float, ahead: float, across: float, p: Array, first: Any
) -> tuple[float, float, float]:
    """Return the mean drift of one wave of unit amplitude.

    Args:
        frequency: Frequency of the wave [rad/s]. Outside those of the table the value at its end is
            taken: the drift of short waves, which the hull reflects, depends little on them.
        ahead: Cosine of the direction to which the wave runs, relative to the hull.
        across: Sine of it, to starboard.
        p: Parameters and tables.
        first: Index of the table.

    Returns:
        Force in surge and sway [N/m^2] and moment in yaw [N/m].
    """
    place, weights = grid_place(frequency, ahead, across, p, first)
    count, headings = int(p[first + 2]), int(p[first + 3])
    begin = first + HEAD + count * headings * VALUES
    X = Y = N = 0.0
    for j in range(4):
        heading, sign = folded(place.left - 1 + j, headings - 1)
        for i in range(2):
            share = weights[j] * (1.0 - place.part)
            if i == 1:
                share = weights[j] * place.part
            at = begin + ((place.low + i) * headings + heading) * DRIFTS
            turned = share * place.side * sign
            X += share * p[at]
            Y += turned * p[at + 1]
            N += turned * p[at + 2]
    return X, Y, N
