"""Smoothed latent force: averages with their variance, and its information about force shapes.

The errors of smoothed states are correlated in time: rows i < j have the covariance
G_i ... G_j-1 P_j, where P are the covariances and G the gains of the Rauch-Tung-Striebel smoother.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from boatsim.diagnosis.filter import MappedRecording, NoiseLevels
from boatsim.diagnosis.problem import Fit, Problem
from boatsim.physics.base import Array


@dataclass(frozen=True)
class LatentForce:
    """Smoothed latent (unmodelled) force of a recording, and the parameters of its prior.

    The force is part of the smoothed state. The prior is an Ornstein-Uhlenbeck process for each of
    the k axes.
    """

    times: Array  # (N,) s
    means: Array  # (N, n) smoothed states
    covariances: Array  # (N, n, n)
    gains: Array  # (N, n, n) of the smoother
    part: slice  # of the state that is the force; positions and rates precede it
    rms: Array  # (k,) prior rms [N, N m]
    first_rms: Array  # (k,) prior rms of the first row
    time_constant: float  # [s]

    @property
    def mean(self) -> Array:
        """Smoothed latent (unmodelled) force (N, k) [N, N m]."""
        return self.means[:, self.part]

    @property
    def states(self) -> Array:
        """Smoothed positions and rates (N, 2 k) of the hull."""
        return self.means[:, : self.part.start]


def latent_force(
    problem: Problem, fit: Fit, mapped: MappedRecording, levels: NoiseLevels
) -> LatentForce:
    """Return the latent (unmodelled) force that a fitted model's smoother finds in a recording.

    Args:
        problem: The estimation problem.
        fit: Fit of the vessel model.
        mapped: The mapped recording.
        levels: Levels of sensor noise and latent force that the filter uses.
    """
    nq = problem.program.module.NQ
    on = problem.program.effect_switches(fit.effects)
    values = problem.parameter_vector(mapped, fit.free, fit.theta)
    means, covariances, gains = mapped.smooth(values, on, levels)
    rms, first_rms = mapped.latent_force_rms(values, on, levels)
    part = slice(2 * nq, 3 * nq)
    return LatentForce(
        mapped.times, means, covariances, gains, part, rms, first_rms, levels.time_constant
    )


def averaging_window_length(times: Array, span: float) -> int:
    """Return how many rows a running average over a given duration contains, at least 1.

    Args:
        times: Times (N,) of the rows [s].
        span: Duration of the average [s].
    """
    return max(1, min(len(times), round(span / float(np.median(np.diff(times))))))


def running_average(values: Array, rows: int) -> Array:
    """Return the running average of signals over a number of rows around each row.

    Args:
        values: Values (N, ...).
        rows: Number of rows.

    Returns:
        Averages (N, ...); the first and last rows share the first and the last average.
    """
    sums = np.cumsum(np.concatenate([np.zeros_like(values[:1]), values]), axis=0)
    return np.asarray(((sums[rows:] - sums[:-rows]) / rows)[_first_rows(len(values), rows)])


def variance_of_average(covariances: Array, gains: Array, part: slice, rows: int) -> Array:
    """Return the variance of the running average of components of a smoothed state.

    The correlation of the errors of neighbouring rows is included. With D_w(i) = cov(z_i, z_i + ...
    + z_i+w-1), D_w(i) = P_i + G_i D_w-1(i + 1).

    Args:
        covariances: Covariances (N, n, n) of the smoothed states.
        gains: Gains (N, n, n) of the smoother.
        part: Components of the state that are averaged, k of them.
        rows: Number of rows of the average.

    Returns:
        Variances (N, k).
    """
    own = covariances[:, :, part]
    single = np.diagonal(covariances, axis1=1, axis2=2)[:, part]
    with_sum = own
    variance = single
    for _ in range(rows - 1):
        n = len(variance) - 1
        with_sum = own[:n] + gains[:n] @ with_sum[1:]
        covariance = np.diagonal(with_sum[:, part], axis1=1, axis2=2)
        variance = variance[1:] + 2.0 * covariance - single[:n]
    return np.asarray(np.maximum(variance, 0.0)[_first_rows(len(single), rows)]) / rows**2


def variance_of_mean(covariances: Array, gains: Array, part: slice) -> Array:
    """Return the variance (k,) of the mean over all rows of components of a smoothed state.

    The correlation of the errors of different rows is included.

    Args:
        covariances: Covariances (N, n, n) of the smoothed states.
        gains: Gains (N, n, n) of the smoother.
        part: Components of the state that are averaged, k of them.
    """
    own = covariances[:, :, part]
    with_later = own[-1]
    total = np.diagonal(covariances[-1])[part].copy()
    for i in range(len(own) - 2, -1, -1):
        with_later = own[i] + gains[i] @ with_later
        total += 2.0 * np.diagonal(with_later[part]) - np.diagonal(own[i][part])
    return np.asarray(np.maximum(total, 0.0) / len(own) ** 2)


def _first_rows(n: int, rows: int) -> NDArray[np.int64]:
    """(n,) first row of the average around each row."""
    return np.clip(np.arange(n) - (rows - 1) // 2, 0, n - rows)


def joint_information(shapes: Array, force: LatentForce) -> tuple[Array, Array]:
    """Return Fisher information and score of the factors of given shapes of a missing force.

    The latent force was smoothed without these shapes. Its prior covariance C is that of an
    Ornstein-Uhlenbeck process, so C^-1 is tridiagonal. If a force s acts, the smoothed force is K s
    with K = 1 - P C^-1, where P is the covariance of the smoothed states; without it, the smoothed
    force has the covariance K C. The likelihood of a force S b is therefore that of a linear model
    with score S' C^-1 f, f the smoothed force, and information S' C^-1 K S. These are generalised
    least squares without the inverse of a matrix.

    Args:
        shapes: Shapes (N, k, S).
        force: Smoothed latent force.

    Returns:
        Information (S, S) and score (S,).
    """
    weights, seen = _weighted(shapes, force)
    score = np.einsum("nka,nk->a", weights, force.mean)
    return np.einsum("nka,nkb->ab", weights, seen), score


def separate_information(shapes: Array, force: LatentForce) -> tuple[Array, Array]:
    """Return Fisher information and score of each shape of a missing force, taken alone.

    Each factor is treated as if it were the only one.

    Args:
        shapes: Shapes (N, k, S).
        force: Smoothed latent force.

    Returns:
        Information (S,) and score (S,); see `joint_information`.
    """
    weights, seen = _weighted(shapes, force)
    score = np.einsum("nka,nk->a", weights, force.mean)
    return np.einsum("nka,nka->a", weights, seen), score


class SharedInformation(NamedTuple):
    """Fisher information and score of shapes of a missing force, and of others beside them."""

    own: Array  # (S,) information of each shape alone
    score: Array  # (S,)
    shared: Array  # (S, F) information that they share with the others
    others: Array  # (F, F) information of the others
    others_score: Array  # (F,)


def information_with_cross_terms(
    shapes: Array, others: Array, force: LatentForce
) -> SharedInformation:
    """Return the information about shapes of a missing force, each alone, beside other shapes.

    Args:
        shapes: Shapes (N, k, S), each of which is tested alone.
        others: Shapes (N, k, F) that act at the same time, for example of fitted parameters.
        force: Smoothed latent force.

    Returns:
        Information and scores; see `joint_information`.
    """
    weights, seen = _weighted(shapes, force)
    other_weights, other_seen = _weighted(others, force)
    return SharedInformation(
        np.einsum("nka,nka->a", weights, seen),
        np.einsum("nka,nk->a", weights, force.mean),
        np.einsum("nka,nkb->ab", weights, other_seen),
        np.einsum("nka,nkb->ab", other_weights, other_seen),
        np.einsum("nka,nk->a", other_weights, force.mean),
    )


def _weighted(shapes: Array, force: LatentForce) -> tuple[Array, Array]:
    """C^-1 S and K S (N, k, S) of `joint_information`."""
    part, gains = force.part, force.gains
    n = len(force.times)
    weights = _times_precision(shapes, force) / (force.rms**2)[:, None]
    # P_i w_i + G_i (the same sum of all later rows); the weights of motions are zero
    sums = np.ascontiguousarray(force.covariances[:, :, part]) @ weights
    for i in range(n - 2, -1, -1):
        sums[i] += gains[i] @ sums[i + 1]
    smoothed = sums[:, part].copy()
    # plus P_i G'_i-1 (w_i-1 + the same sum of all earlier rows)
    earlier = np.zeros_like(sums)
    before = np.zeros_like(sums[0])
    for i in range(1, n):
        before[part] += weights[i - 1]
        before = gains[i - 1].T @ before
        earlier[i] = before
    smoothed += np.ascontiguousarray(force.covariances[:, part]) @ earlier
    return weights, shapes - smoothed


def _times_precision(values: Array, force: LatentForce) -> Array:
    """Inverse correlation matrix of the prior times values (N, k, S)."""
    decay = np.exp(-np.diff(force.times) / force.time_constant)[:, None, None]
    increments = (values[1:] - decay * values[:-1]) / (1.0 - decay**2)
    first = (force.rms / force.first_rms) ** 2
    product = np.concatenate([values[:1] * first[:, None], increments])
    product[:-1] -= decay * increments
    return product
