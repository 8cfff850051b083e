"""Slowly varying drift of pairs of waves: quadratic transfer functions of difference frequencies.

For waves of amplitudes a, phases theta and one direction the slow force is the real part of the sum
over i and k of a_i a_k D(w_i, w_k) exp(i (theta_i - theta_k)). D is Hermitian, and its diagonal is
the mean drift. It is therefore a sum of products l u(w_i) conj(u(w_k)), by which the double sum
becomes the sum of l |sum of a_i u(w_i) exp(i theta_i)|^2 over few components u.

The table that compiled laws read has the number of groups, the lowest frequency [rad/s], the
distance of frequencies [rad/s] and the numbers of frequencies and of headings around the hull. Then
follow for each group of four components their factors l in the six axes, and for each frequency
and heading the real and imaginary part of the four components.
"""

from functools import lru_cache
from math import atan2, pi
from typing import Any, NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from boatsim.physics.coefficients.excitation_grid import MIRROR, check_headings, cubic_weights
from boatsim.physics.coefficients.table import DriftPairs
from boatsim.physics.signals import Array

HEAD = 5  # numbers of the table before the groups
GROUP = 4  # components of a group
WEIGHTS = 6 * GROUP  # factors of a group
NO_PAIRS = (0.0,) * HEAD  # table without components
# Frequencies and headings of the grid, as many as that of the mean drift has
FREQUENCIES, HEADINGS = 96, 24
# Largest error of the components over the largest value of an axis. Computed quadratic transfer
# functions differ by some per cent between meshes.
TOLERANCE = 0.002

Complex = NDArray[np.complex128]


@lru_cache(maxsize=8)
def pair_table(pairs: DriftPairs, label: str) -> tuple[float, ...]:
    """Return the table of the components, as compiled laws read it.

    The drift of waves of two directions is not in the table. Newman's part is (D_i + D_k) / 2 with
    the mean drift of each wave in its own direction; what the table adds to it is the mean of both
    directions.

    Args:
        pairs: The drift.
        label: Folder of the coefficients, for messages.

    Raises:
        BadInput: There are fewer than five headings, or they do not extend from 0 to pi.
    """
    heading = pairs.heading
    check_headings(heading, f"{label}: the headings of the pairs of waves")
    frequency = np.linspace(pairs.frequency[0], pairs.frequency[-1], FREQUENCIES)
    weights, functions = [], []
    for axis in range(6):
        values = _on_grid(pairs, frequency, axis)
        size = np.abs(values).max()
        if size == 0.0:
            continue
        for factor, function in _components(values, TOLERANCE * size):
            row = np.zeros(6)
            row[axis] = factor
            weights.append(row)
            functions.append(function)
    while len(weights) % GROUP:
        weights.append(np.zeros(6))
        functions.append(np.zeros((FREQUENCIES, HEADINGS), dtype=complex))
    step = frequency[1] - frequency[0]
    groups = len(weights) // GROUP
    parts = [np.array([groups, frequency[0], step, FREQUENCIES, HEADINGS])]
    for first in range(0, len(weights), GROUP):
        own = slice(first, first + GROUP)
        together = np.stack(functions[own], axis=-1)
        parts.append(np.array(weights[own]).T.ravel())
        parts.append(np.stack([together.real, together.imag], axis=-1).ravel())
    return tuple(np.concatenate(parts).tolist())


def _on_grid(pairs: DriftPairs, frequency: Array, axis: int) -> Complex:
    """Return the drift of an axis (F, F, G) at frequencies and at headings around the hull."""
    heading, values = pairs.heading, pairs.values[..., axis]
    around = np.concatenate([heading, 2.0 * pi - heading[-2:0:-1], [2.0 * pi]])
    around[0], around[len(heading) - 1] = 0.0, pi
    other = values[:, :, -2:0:-1] * MIRROR[axis]
    whole = np.concatenate([values, other, values[:, :, :1]], axis=2)
    angles = 2.0 * pi / HEADINGS * np.arange(HEADINGS)
    turned = CubicSpline(around, whole, axis=2, bc_type="periodic")(angles)
    first = CubicSpline(pairs.frequency, turned, axis=0)(frequency)
    return np.asarray(CubicSpline(pairs.frequency, first, axis=1)(frequency))


def _components(values: Complex, error: float) -> list[tuple[float, Complex]]:
    """Return factors and functions (F, G) whose products are the drift within an error.

    Args:
        values: Drift of an axis (F, F, G), Hermitian in both frequencies.
        error: Largest error of an entry.
    """
    mean = np.einsum("kkg->kg", values).real
    rest = values - 0.5 * (mean[:, None] + mean[None, :])
    # Newman's part: (d + d') / 2 = ((s + d) (s + d') - (s - d) (s - d')) / (4 s)
    size = np.abs(mean).max()
    found: list[tuple[float, Complex]] = []
    if size > 0.0:
        for sign in (1.0, -1.0):
            found.append((sign / (4.0 * size), (size + sign * mean).astype(complex)))
    if np.abs(rest).max() <= error:
        return found
    # the functions of the frequency that all headings have in common
    columns = rest.transpose(0, 2, 1).reshape(len(values), -1)
    left, singular, _ = np.linalg.svd(columns, full_matrices=False)
    basis = left[:, singular > 0.1 * error]
    inner = np.einsum("ka,klg,lb->gab", np.conj(basis), rest, basis, optimize=True)
    r, count = basis.shape[1], values.shape[2]
    pairs = 0.5 * (inner[:, None] + inner[None, :])  # of two headings: (G, G, r, r)
    matrix = pairs.transpose(0, 2, 1, 3).reshape(count * r, count * r)
    factors, vectors = np.linalg.eigh(0.5 * (matrix + np.conj(matrix.T)))
    order = np.argsort(-np.abs(factors))
    reached = np.zeros_like(rest)
    for place in order:
        function = basis @ vectors[:, place].reshape(count, r).T
        found.append((float(factors[place]), function))
        reached += factors[place] * np.einsum("kg,lg->klg", function, np.conj(function))
        if np.abs(rest - reached).max() <= error:
            break
    return found


class PairAmplitudes(NamedTuple):
    """Complex values of the four components of a group for one wave."""

    real_1: float
    imaginary_1: float
    real_2: float
    imaginary_2: float
    real_3: float
    imaginary_3: float
    real_4: float
    imaginary_4: float


@njit
def pair_amplitudes(
    frequency: float, ahead: float, across: float, p: Array, table: Any, group: Any
) -> PairAmplitudes:
    """Return the components of a group for one wave of unit amplitude.

    Frequencies outside the grid have the value at its end.

    Args:
        frequency: Frequency of the wave [rad/s].
        ahead: Cosine of the direction to which the wave runs, relative to the hull.
        across: Sine of it, to starboard.
        p: Parameters and tables.
        table: Index of the table of the pairs.
        group: Number of the group, from 0.
    """
    count, headings = int(p[table + 3]), int(p[table + 4])
    along = min(max((frequency - p[table + 1]) / p[table + 2], 0.0), count - 1.0)
    low = min(int(along), count - 2)
    part = along - low
    bearing = (atan2(across, ahead) / (2.0 * pi) + 1.0) * headings
    left = int(bearing)
    weights = cubic_weights(bearing - left)
    begin = table + HEAD + group * (WEIGHTS + 2 * GROUP * count * headings) + WEIGHTS
    a = b = c = d = e = f = g = h = 0.0
    for j in range(4):
        place = left - 1 + j
        if place >= headings:
            place -= headings
        if place >= headings:
            place -= headings
        for i in range(2):
            share = weights[j] * (1.0 - part)
            if i == 1:
                share = weights[j] * part
            at = begin + ((low + i) * headings + place) * 2 * GROUP
            a += share * p[at]
            b += share * p[at + 1]
            c += share * p[at + 2]
            d += share * p[at + 3]
            e += share * p[at + 4]
            f += share * p[at + 5]
            g += share * p[at + 6]
            h += share * p[at + 7]
    return PairAmplitudes(a, b, c, d, e, f, g, h)


@njit(inline="always")
def pair_weight(p: Array, table: Any, group: Any) -> Any:
    """Return the index of the first factor of a group.

    Args:
        p: Parameters and tables.
        table: Index of the table of the pairs.
        group: Number of the group, from 0.
    """
    size = int(p[table + 3]) * int(p[table + 4]) * 2 * GROUP
    return table + HEAD + group * (WEIGHTS + size)


@njit(inline="always")
def end_of_pairs(p: Array, table: Any) -> Any:
    """Return the index after the table of the pairs.

    Args:
        p: Parameters and tables.
        table: Index of the table of the pairs.
    """
    return pair_weight(p, table, int(p[table]))
