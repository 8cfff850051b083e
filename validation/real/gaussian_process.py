"""Gaussian-process regression of a vector on a few inputs, with one length per input.

C. E. Rasmussen and C. K. I. Williams, Gaussian Processes for Machine Learning (2006), equations
2.25, 5.1 and 5.8.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import cho_factor, cho_solve
from scipy.optimize import minimize

Array = NDArray[np.float64]

TUNED_ROWS = 300  # of the data, evenly chosen: the likelihood costs the cube of their number
KEPT_ROWS = 1500  # of the data that predict
BOUNDS = (-5.0, 5.0)  # of the logarithms of all settings, for data of unit variance
JITTER = 1e-8  # added to the diagonal, relative to the variance, against rounding


@dataclass(frozen=True)
class GaussianProcess:
    """Regression of one number, with data that are scaled to zero mean and unit variance.

    Attributes:
        inputs: Scaled inputs of the data, divided by their lengths (N, D).
        weights: (N,) of the kernel functions at the data.
        lengths: (D,) of the kernel, in standard deviations of the inputs.
        variance: Of the regressed function, relative to that of the data.
        middle: Mean of the inputs (D,).
        spread: Standard deviation of the inputs (D,).
        size: Standard deviation of the output.
    """

    inputs: Array
    weights: Array
    lengths: Array
    variance: float
    middle: Array
    spread: Array
    size: float

    def predict(self, x: Array) -> float:
        """Return the expected output; far from all data it tends to zero.

        Args:
            x: Inputs (D,).
        """
        scaled = (x - self.middle) / (self.spread * self.lengths)
        squares = np.sum((self.inputs - scaled) ** 2, axis=1)
        return float(self.size * self.variance * (np.exp(-0.5 * squares) @ self.weights))


def fit_gaussian_process(X: Array, y: Array, smoothing: float = 1.0) -> GaussianProcess:
    """Fit a Gaussian process with a squared-exponential kernel, its settings by their likelihood.

    Args:
        X: Inputs (N, D).
        y: Outputs (N,); far from all data they are expected to be zero.
        smoothing: Factor of the lengths that are most likely.
    """
    middle, spread, size = X.mean(axis=0), X.std(axis=0), float(np.sqrt(np.mean(y**2)))
    spread = np.where(spread > 0.0, spread, 1.0)
    size = size or 1.0
    Z, t = (X - middle) / spread, y / size
    few = _evenly(len(Z), TUNED_ROWS)
    dimension = Z.shape[1]

    def loss(log_settings: Array) -> float:
        """Negative logarithm of the marginal likelihood."""
        lengths, variance, noise = _settings(log_settings)
        K = _kernel(Z[few] / lengths, variance) + (noise + JITTER) * np.eye(len(few))
        factor = cho_factor(K, lower=True)
        half_log_determinant = float(np.sum(np.log(np.diag(factor[0]))))
        return float(0.5 * t[few] @ cho_solve(factor, t[few])) + half_log_determinant

    start = np.append(np.zeros(dimension), [0.0, np.log(0.1)])
    found = minimize(loss, start, method="L-BFGS-B", bounds=[BOUNDS] * len(start)).x
    lengths, variance, noise = _settings(found)
    lengths = lengths * smoothing
    kept = _evenly(len(Z), KEPT_ROWS)
    inputs = Z[kept] / lengths
    K = _kernel(inputs, variance) + (noise + JITTER) * np.eye(len(kept))
    weights = cho_solve(cho_factor(K, lower=True), t[kept])
    return GaussianProcess(inputs, weights, lengths, variance, middle, spread, size)


def _settings(logs: Array) -> tuple[Array, float, float]:
    """Lengths, variance of the function and variance of the noise, from their logarithms."""
    return np.exp(logs[:-2]), float(np.exp(logs[-2])), float(np.exp(logs[-1]))


def _kernel(inputs: Array, variance: float) -> Array:
    """Covariance of the function at inputs that are divided by their lengths."""
    squares = np.sum(inputs**2, axis=1)
    apart = squares[:, None] + squares[None, :] - 2.0 * inputs @ inputs.T
    return np.asarray(variance * np.exp(-0.5 * np.maximum(apart, 0.0)))


def _evenly(count: int, most: int) -> NDArray[np.int64]:
    """Numbers of at most so many rows, evenly chosen."""
    return np.unique(np.linspace(0, count - 1, min(count, most)).astype(np.int64))
