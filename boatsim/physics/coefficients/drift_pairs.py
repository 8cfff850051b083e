"""Slowly varying drift of pairs of waves: quadratic transfer functions of difference frequencies.

For waves of amplitudes a, phases theta and one direction beta the slow force is the real part of
the sum over i and k of a_i a_k D(w_i, w_k, beta) exp(i (theta_i - theta_k)). D is a sum of products
b(w_i) conj(u(w_k, beta)), by which the double sum becomes the sum over few products of
S conj(T), with the single sums S of a_i b(w_i) exp(i theta_i) and T of
a_k u(w_k, beta_k) exp(i theta_k).

The first product of an axis has b = 1. Its u is the mean drift, so that it is Newman's
approximation (D(w_i, w_i) + D(w_k, w_k)) / 2. The other products are a singular value decomposition
of what the table adds to it.

The table that compiled laws read has the number of groups and the numbers of the grid
(`wave_grid`). Then follow for each group of four products the sign of u in the mirror at the plane
of symmetry, the factors of the products in the six axes, for each frequency the real and imaginary
part of the four b, and for each frequency and heading those of the four u.
"""

from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline, PchipInterpolator

from boatsim.physics.coefficients.table import DriftPairs
from boatsim.physics.coefficients.wave_grid import (
    ERROR,
    MIRROR,
    check_headings,
    folded,
    grid_frequencies,
    grid_headings,
    grid_place,
    largest_values,
    over_headings,
)
from boatsim.physics.signals import Array

HEAD = 5  # numbers of the table before the groups
GROUP = 4  # products of a group
WEIGHTS = 6 * GROUP  # factors of a group
NO_PAIRS = (0.0,) * HEAD  # table without products
# The errors of the grid in both frequencies and in the heading, and that of the products add up
SHARE = 0.25 * ERROR

Complex = NDArray[np.complex128]


class Product(NamedTuple):
    """Product of functions of both waves, part of the drift of an axis."""

    axis: int
    first: Complex  # b (F,), function of the frequency of the first wave
    second: Complex  # u (F, H), function of frequency and heading of the second wave


@lru_cache(maxsize=8)
def pair_table(pairs: DriftPairs, label: str) -> tuple[float, ...]:
    """Return the table of the products, as compiled laws read it.

    The drift of waves of two directions is not in the table. Newman's part is (D_i + D_k) / 2 with
    the mean drift of each wave in its own direction; what the table adds to it is the mean of both
    directions.

    Args:
        pairs: The drift.
        label: Folder of the coefficients, for messages.

    Raises:
        BadInput: There are fewer than five headings, or they do not extend from 0 to pi.
    """
    check_headings(pairs.heading, f"{label}: the headings of the pairs of waves")
    largest = largest_values(pairs.values)
    frequency, heading = _grid(pairs, largest)
    groups = []
    for sign in (1.0, -1.0):
        products = []
        for axis in np.flatnonzero(sign == MIRROR):
            if pairs.values[..., axis].any():
                error = SHARE * float(largest[axis])
                products += _products(pairs, int(axis), frequency, heading, error)
        for place in range(0, len(products), GROUP):
            groups.append(_group_table(sign, products[place : place + GROUP]))
    step = frequency[1] - frequency[0]
    head = np.array([len(groups), frequency[0], step, len(frequency), len(heading)])
    return tuple(np.concatenate([head, *groups]).tolist())


def _grid(pairs: DriftPairs, largest: Array) -> tuple[Array, Array]:
    """Return frequencies and headings of the grid that all axes have in common."""
    frequency, heading = np.zeros(0), np.zeros(0)
    for axis in range(6):
        values, size = pairs.values[..., axis], largest[[axis]]
        spline = CubicSpline(pairs.frequency, values)
        own = grid_frequencies(pairs.frequency, spline, size, SHARE)
        together = values.reshape(-1, len(pairs.heading), 1)
        angles = grid_headings(pairs.heading, together, MIRROR[[axis]], size, SHARE)
        frequency = max(frequency, own, key=len)
        heading = max(heading, angles, key=len)
    return frequency, heading


def _products(
    pairs: DriftPairs, axis: int, frequency: Array, heading: Array, error: float
) -> list[Product]:
    """Return the products whose sum is the drift of an axis within an error.

    The mean drift at frequencies between those of the table is that of the first product together
    with the others, which have a mean drift of their own there.

    Args:
        pairs: The drift.
        axis: Number of the axis.
        frequency: Frequencies of the grid (F,) [rad/s].
        heading: Headings of the grid (H,) [rad].
        error: Largest error of the drift at the frequencies of the table.
    """
    count = len(pairs.frequency)
    together = pairs.values[..., axis].reshape(count * count, -1, 1)
    turned = over_headings(pairs.heading, together, MIRROR[[axis]])(heading)
    values = turned.reshape(count, count, len(heading))
    mean = np.einsum("kkh->kh", values).real
    rest = values - 0.5 * (mean[:, None] + mean[None, :])
    left, _, _ = np.linalg.svd(rest.reshape(count, -1), full_matrices=False)
    # a narrow peak of the mean drift is at a resonance, next to which a spline would oscillate
    diagonal = PchipInterpolator(pairs.frequency, mean)(frequency).astype(complex)
    products = []
    for basis in left.T:
        if np.abs(rest).max() <= error:
            break
        other = np.einsum("k,klh->lh", np.conj(basis), rest)
        rest = rest - basis[:, None, None] * other
        first = CubicSpline(pairs.frequency, basis)(frequency)
        second = CubicSpline(pairs.frequency, np.conj(other))(frequency)
        diagonal -= (first[:, None] * np.conj(second)).real
        products.append(Product(axis, first, second))
    return [Product(axis, np.ones(len(frequency), dtype=complex), diagonal), *products]


def _group_table(sign: float, products: list[Product]) -> Array:
    """Return the numbers of a group, in which products that it lacks are zero.

    Args:
        sign: Sign of the products in the mirror.
        products: Up to four products.
    """
    weights = np.zeros((6, GROUP))
    first = np.zeros((*products[0].first.shape, GROUP), dtype=complex)
    second = np.zeros((*products[0].second.shape, GROUP), dtype=complex)
    for k, product in enumerate(products):
        weights[product.axis, k] = 1.0
        first[..., k], second[..., k] = product.first, product.second
    parts = [np.array([sign]), weights.ravel()]
    for values in (first, second):
        parts.append(np.stack([values.real, values.imag], axis=-1).ravel())
    return np.concatenate(parts)


class PairSums(NamedTuple):
    """Sums over waves of the functions of four products: real and imaginary parts."""

    first_real_1: float
    first_imaginary_1: float
    first_real_2: float
    first_imaginary_2: float
    first_real_3: float
    first_imaginary_3: float
    first_real_4: float
    first_imaginary_4: float
    second_real_1: float
    second_imaginary_1: float
    second_real_2: float
    second_imaginary_2: float
    second_real_3: float
    second_imaginary_3: float
    second_real_4: float
    second_imaginary_4: float


@njit
def pair_amplitudes(
    frequency: float, ahead: float, across: float, p: Array, table: Any, group: Any
) -> PairSums:
    """Return the functions of the products of a group for one wave of unit amplitude.

    Frequencies outside the grid have the value at its end.

    Args:
        frequency: Frequency of the wave [rad/s].
        ahead: Cosine of the direction to which the wave runs, relative to the hull.
        across: Sine of it, to starboard.
        p: Parameters and tables.
        table: Index of the table of the pairs.
        group: Number of the group, from 0.
    """
    place, weights = grid_place(frequency, ahead, across, p, table + 1)
    count, headings = int(p[table + 3]), int(p[table + 4])
    begin = pair_weight(p, table, group) + WEIGHTS
    mirror = p[begin - WEIGHTS - 1]
    firsts = begin + place.low * 2 * GROUP
    low, high = 1.0 - place.part, place.part
    seconds = begin + count * 2 * GROUP
    a = b = c = d = e = f = g = h = 0.0
    for j in range(4):
        heading, sign = folded(place.left - 1 + j, headings - 1)
        own = weights[j]
        if place.side * sign < 0.0:
            own *= mirror
        for i in range(2):
            share = own * low
            if i == 1:
                share = own * high
            at = seconds + ((place.low + i) * headings + heading) * 2 * GROUP
            a += share * p[at]
            b += share * p[at + 1]
            c += share * p[at + 2]
            d += share * p[at + 3]
            e += share * p[at + 4]
            f += share * p[at + 5]
            g += share * p[at + 6]
            h += share * p[at + 7]
    return PairSums(
        low * p[firsts] + high * p[firsts + 8],
        low * p[firsts + 1] + high * p[firsts + 9],
        low * p[firsts + 2] + high * p[firsts + 10],
        low * p[firsts + 3] + high * p[firsts + 11],
        low * p[firsts + 4] + high * p[firsts + 12],
        low * p[firsts + 5] + high * p[firsts + 13],
        low * p[firsts + 6] + high * p[firsts + 14],
        low * p[firsts + 7] + high * p[firsts + 15],
        a,
        b,
        c,
        d,
        e,
        f,
        g,
        h,
    )


@njit(inline="always")
def no_waves() -> PairSums:
    """Return the sums over no wave."""
    return PairSums(
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
    )


@njit(inline="always")
def added_wave(sums: PairSums, wave: PairSums, c: float, s: float) -> PairSums:
    """Return the sums with one more wave.

    Args:
        sums: Sums over the waves before it.
        wave: Functions of the products for the wave.
        c: Amplitude of the wave times the cosine of its phase.
        s: Amplitude times the sine of the phase.
    """
    return PairSums(
        sums.first_real_1 + wave.first_real_1 * c - wave.first_imaginary_1 * s,
        sums.first_imaginary_1 + wave.first_real_1 * s + wave.first_imaginary_1 * c,
        sums.first_real_2 + wave.first_real_2 * c - wave.first_imaginary_2 * s,
        sums.first_imaginary_2 + wave.first_real_2 * s + wave.first_imaginary_2 * c,
        sums.first_real_3 + wave.first_real_3 * c - wave.first_imaginary_3 * s,
        sums.first_imaginary_3 + wave.first_real_3 * s + wave.first_imaginary_3 * c,
        sums.first_real_4 + wave.first_real_4 * c - wave.first_imaginary_4 * s,
        sums.first_imaginary_4 + wave.first_real_4 * s + wave.first_imaginary_4 * c,
        sums.second_real_1 + wave.second_real_1 * c - wave.second_imaginary_1 * s,
        sums.second_imaginary_1 + wave.second_real_1 * s + wave.second_imaginary_1 * c,
        sums.second_real_2 + wave.second_real_2 * c - wave.second_imaginary_2 * s,
        sums.second_imaginary_2 + wave.second_real_2 * s + wave.second_imaginary_2 * c,
        sums.second_real_3 + wave.second_real_3 * c - wave.second_imaginary_3 * s,
        sums.second_imaginary_3 + wave.second_real_3 * s + wave.second_imaginary_3 * c,
        sums.second_real_4 + wave.second_real_4 * c - wave.second_imaginary_4 * s,
        sums.second_imaginary_4 + wave.second_real_4 * s + wave.second_imaginary_4 * c,
    )


@njit(inline="always")
def pair_products(sums: PairSums) -> tuple[float, float, float, float]:
    """Return the four products: the real part of each first sum times the conjugate second one.

    Args:
        sums: Sums over all waves.
    """
    return (
        sums.first_real_1 * sums.second_real_1 + sums.first_imaginary_1 * sums.second_imaginary_1,
        sums.first_real_2 * sums.second_real_2 + sums.first_imaginary_2 * sums.second_imaginary_2,
        sums.first_real_3 * sums.second_real_3 + sums.first_imaginary_3 * sums.second_imaginary_3,
        sums.first_real_4 * sums.second_real_4 + sums.first_imaginary_4 * sums.second_imaginary_4,
    )


@njit(inline="always")
def pair_weight(p: Array, table: Any, group: Any) -> Any:
    """Return the index of the first factor of a group.

    Args:
        p: Parameters and tables.
        table: Index of the table of the pairs.
        group: Number of the group, from 0.
    """
    count, headings = int(p[table + 3]), int(p[table + 4])
    size = 1 + WEIGHTS + 2 * GROUP * count * (1 + headings)
    return table + HEAD + group * size + 1


@njit(inline="always")
def end_of_pairs(p: Array, table: Any) -> Any:
    """Return the index after the table of the pairs.

    Args:
        p: Parameters and tables.
        table: Index of the table of the pairs.
    """
    return pair_weight(p, table, int(p[table])) - 1
