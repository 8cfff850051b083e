"""Excitation and mean drift of waves on a regular grid of frequency and heading.

Compiled laws read the table of the effect. It has the numbers of the grid (`wave_grid`), then for
each frequency and heading the real and imaginary part of the six components of the excitation, and
after all of these for each frequency and heading the mean drift in surge, sway and yaw per square
of the amplitude.
"""

from functools import lru_cache
from typing import Any

import numpy as np
from numba import njit
from scipy.interpolate import CubicSpline, PchipInterpolator

from boatsim.physics.coefficients.table import WaveLoads
from boatsim.physics.coefficients.wave_grid import (
    ERROR,
    HEAD,
    MIRROR,
    check_headings,
    folded,
    grid_frequencies,
    grid_headings,
    grid_place,
    largest_values,
    over_headings,
)
from boatsim.physics.signals import Array, Wrench

VALUES, DRIFTS = 12, 3  # of each frequency and heading, of excitation and of drift
DRIFT_MIRROR = np.array([1.0, -1.0, -1.0])  # of surge, sway and yaw


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
    frequency, angles = _grid(found)
    excitation = CubicSpline(found.frequency, found.excitation)(frequency)
    grid = over_headings(heading, excitation, MIRROR)(angles)
    pairs = np.stack([grid.real, grid.imag], axis=-1)
    drift = np.zeros((len(frequency), len(angles), DRIFTS))
    if found.drift is not None:
        # the drift can have a narrow peak at a resonance, next to which a spline would oscillate
        over_frequency = PchipInterpolator(found.frequency, found.drift)(frequency)
        drift = over_headings(heading, over_frequency, DRIFT_MIRROR)(angles)
    step = frequency[1] - frequency[0]
    head = (float(frequency[0]), float(step), float(len(frequency)), float(len(angles)))
    return (*head, *pairs.ravel().tolist(), *drift.ravel().tolist())


def _grid(found: WaveLoads) -> tuple[Array, Array]:
    """Return frequencies and headings of the grid, with which excitation and drift are accurate.

    The drift in yaw is not counted: that of a body of revolution is rounding.

    Args:
        found: The loads.
    """
    size = largest_values(found.excitation)
    spline = CubicSpline(found.frequency, found.excitation)
    frequency = grid_frequencies(found.frequency, spline, size, ERROR)
    angles = grid_headings(found.heading, found.excitation, MIRROR, size, ERROR)
    if found.drift is None:
        return frequency, angles
    forces = found.drift[..., :2]
    largest = np.full(2, np.abs(forces).max())
    curve = PchipInterpolator(found.frequency, forces)
    own = grid_frequencies(found.frequency, curve, largest, ERROR)
    own_angles = grid_headings(found.heading, forces, DRIFT_MIRROR[:2], largest, ERROR)
    return max(frequency, own, key=len), max(angles, own_angles, key=len)


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
