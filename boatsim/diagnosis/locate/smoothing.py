"""What a smoothed force says: its average over time with the uncertainty, and how well it fits a force of known shape.

Errors of smoothed states hang together in time: those of rows i < j covary by G_i ... G_j-1 P_j (P the covariances, G
the gains of the Rauch-Tung-Striebel smoother).
"""

import numpy as np
from numpy.typing import NDArray

from boatsim.physics.base import Array


def averaged_rows(times: Array, span: float) -> int:
    """How many rows an average over `span` s takes, at least one."""
    return max(1, min(len(times), round(span / float(np.median(np.diff(times))))))


def running_average(values: Array, rows: int) -> Array:
    """(N, ...) average over `rows` rows about each row; the first and last rows share the first and last average."""
    sums = np.cumsum(np.concatenate([np.zeros_like(values[:1]), values]), axis=0)
    return np.asarray(((sums[rows:] - sums[:-rows]) / rows)[_first(len(values), rows)])


def variance_of_average(covariances: Array, gains: Array, part: slice, rows: int) -> Array:
    """(N, k) variance of the `running_average` of a part of the smoothed state.

    With D_w(i) = cov(z_i, z_i + ... + z_i+w-1): D_w(i) = P_i + G_i D_w-1(i + 1).
    """
    own = covariances[:, :, part]
    single = np.diagonal(covariances, axis1=1, axis2=2)[:, part]
    with_sum, variance = own, single
    for _ in range(rows - 1):
        n = len(variance) - 1
        with_sum = own[:n] + gains[:n] @ with_sum[1:]
        variance = (
            variance[1:] + 2.0 * np.diagonal(with_sum[:, part], axis1=1, axis2=2) - single[:n]
        )
    return np.asarray(np.maximum(variance, 0.0)[_first(len(single), rows)]) / rows**2


def variance_of_mean(covariances: Array, gains: Array, part: slice) -> Array:
    """(k,) variance of the mean over all rows of a part of the smoothed state: that of their sum, row by row."""
    own = covariances[:, :, part]
    with_later, total = own[-1], np.diagonal(covariances[-1])[part].copy()
    for i in range(len(own) - 2, -1, -1):
        with_later = own[i] + gains[i] @ with_later
        total += 2.0 * np.diagonal(with_later[part]) - np.diagonal(own[i][part])
    return np.asarray(np.maximum(total, 0.0) / len(own) ** 2)


def _first(n: int, rows: int) -> NDArray[np.int64]:
    """(n,) first row of the average about each row."""
    return np.clip(np.arange(n) - (rows - 1) // 2, 0, n - rows)


def information(
    shapes: Array,
    found: Array,
    times: Array,
    covariances: Array,
    gains: Array,
    part: slice,
    rms: Array,
    first: Array,
    time_constant: float,
) -> tuple[Array, Array]:
    """Fisher information (S, S) and score (S,) of the factors of forces `shapes` (N, k, S) in the recording.

    The latent force `found` (N, k) was smoothed without them. Its prior covariance C is Ornstein-Uhlenbeck's with `rms`
    (k,), that of the first row `first` (k,), so C^-1 is tridiagonal; P are the smoothed covariances. Of a force s that
    was there, the smoother finds K s, K = 1 - P C^-1, and what it finds by chance has covariance K C. So the likelihood
    of a force S b is that of a linear model with score S' C^-1 found and information S' C^-1 K S: generalised least
    squares without inverting.
    """
    weights, seen = _weighed(shapes, times, covariances, gains, part, rms, first, time_constant)
    return np.einsum("nka,nkb->ab", weights, seen), np.einsum("nka,nk->a", weights, found)


def information_alone(
    shapes: Array,
    found: Array,
    times: Array,
    covariances: Array,
    gains: Array,
    part: slice,
    rms: Array,
    first: Array,
    time_constant: float,
) -> tuple[Array, Array]:
    """Information (S,) on and score (S,) of each factor of `information` as if it were the only one."""
    weights, seen = _weighed(shapes, times, covariances, gains, part, rms, first, time_constant)
    return np.einsum("nka,nka->a", weights, seen), np.einsum("nka,nk->a", weights, found)


def _weighed(
    shapes: Array,
    times: Array,
    covariances: Array,
    gains: Array,
    part: slice,
    rms: Array,
    first: Array,
    time_constant: float,
) -> tuple[Array, Array]:
    """C^-1 S and K S (N, k, S) of `information`."""
    weights = np.zeros((len(times), covariances.shape[1], shapes.shape[2]))
    weights[:, part] = (
        _precision(shapes, times, time_constant, (rms / first) ** 2) / (rms**2)[:, None]
    )
    ahead = weights.copy()  # P_i w_i + G_i (the same of all later rows)
    before = np.zeros_like(weights)  # G_i-1' ... of all earlier rows
    ahead[-1] = covariances[-1] @ weights[-1]
    for i in range(len(times) - 2, -1, -1):
        ahead[i] = covariances[i] @ weights[i] + gains[i] @ ahead[i + 1]
    for i in range(1, len(times)):
        before[i] = gains[i - 1].T @ (before[i - 1] + weights[i - 1])
    seen = shapes - (ahead + covariances @ before)[:, part]
    return weights[:, part], seen


def _precision(values: Array, times: Array, time_constant: float, first: Array) -> Array:
    """Inverse correlation matrix of an Ornstein-Uhlenbeck process times values (N, k, ...).

    `first` (k,) is the usual variance over that of the first row.
    """
    decay = np.exp(-np.diff(times) / time_constant).reshape(-1, *([1] * (values.ndim - 1)))
    fresh = (values[1:] - decay * values[:-1]) / (1.0 - decay**2)
    out = np.concatenate([values[:1] * first.reshape(-1, *([1] * (values.ndim - 2))), fresh])
    out[:-1] -= decay * fresh
    return out
