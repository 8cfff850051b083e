"""An L1 loop with gradient adaptation, stepped far more finely than its controller is called: compiled.

The form is that of Hovakimyan and Cao, L1 Adaptive Control Theory (SIAM 2010): a state predictor with the input's gain,
the state's coefficients and a disturbance unknown, projected gradient laws, and an input that a low-pass follows.
"""

from math import isnan, nan

import numpy as np
from numba import njit
from numpy.typing import ArrayLike

from boatsim.control.adaptive import lyapunov
from boatsim.physics.base import Array

TOLERANCE = 0.1  # of the projection: it begins to brake at 1 / sqrt(1 + tolerance) of the way to a bound


@njit(cache=True)
def projected(value: float, rate: float, low: float, high: float) -> float:
    """`boatsim.control.adaptive.project_interval`, compiled."""
    off, radius = value - 0.5 * (low + high), 0.5 * (high - low)
    excess = ((1.0 + TOLERANCE) * off * off - radius * radius) / (TOLERANCE * radius * radius)
    if excess <= 0.0 or off * rate <= 0.0:
        return rate
    return rate * (1.0 - excess)


@njit(cache=True)
def adapt(
    predicted: Array, estimates: Array, low: Array, high: Array, gain: float, am: Array, pb: Array, drift: Array,
    by: Array, before: Array, after: Array, applied: float, period: float, steps: int,
) -> None:  # fmt: skip
    """Predictor and estimates over one period in which the measured state went from `before` to `after`, in place.

    The input acts on the last state. Estimates belong to the regressors (x1 ... xn, 1, input); `by` says whose
    regressor drives each of them. The predictor steps first, then the estimates (semi-implicit).
    """
    n, dt = len(predicted), period / steps
    regressors, slope = np.ones(n + 2), np.zeros(n)
    regressors[n + 1] = applied
    for i in range(steps):
        for j in range(n):
            regressors[j] = before[j] + (after[j] - before[j]) * i / steps
        drive = 0.0
        for j in range(n + 2):
            drive += estimates[j] * regressors[j]
        for j in range(n):
            slope[j] = drift[j]
            for m in range(n):
                slope[j] += am[j, m] * predicted[m]
        slope[n - 1] += drive
        error = 0.0
        for j in range(n):
            predicted[j] += dt * slope[j]
            regressors[j] = before[j] + (after[j] - before[j]) * (i + 1) / steps
            error += (predicted[j] - regressors[j]) * pb[j]
        for j in range(n + 2):
            rate = gain * projected(estimates[j], -regressors[by[j]] * error, low[j], high[j])
            estimates[j] = min(max(estimates[j] + dt * rate, low[j]), high[j])


@njit(cache=True)
def filtered(
    value: float, known: float, gain: float, bandwidth: float, low: float, high: float, rate: float, period: float,
    steps: int,
) -> tuple[float, float]:  # fmt: skip
    """Low-pass input' = -bandwidth (gain input + known), kept in its limits: mean over the period, value at its end."""
    total, dt = 0.0, period / steps
    for _ in range(steps):
        speed = min(max(-bandwidth * (gain * value + known), -rate), rate)
        later = min(max(value + dt * speed, low), high)
        total += 0.5 * (value + later)
        value = later
    return total / steps, value


class AdaptiveLoop:
    """x' = Am x + b (omega input + theta'x + sigma), b = (0 ... 0, 1), all but Am unknown: one input is found for it.

    The controller calls `observe` with what was measured and applied, then `act`; both work through one period.
    """

    def __init__(
        self, am: ArrayLike, low: ArrayLike, high: ArrayLike, start: ArrayLike, *, gain: float, bandwidth: float,
        period: float, step: float,
    ) -> None:  # fmt: skip
        """Am (n, n) [1/s]; bounds and start (n + 2,) of theta, sigma, omega; bandwidth k of the filter; times [s]."""
        self.am = np.asarray(am, dtype=float)
        self.low, self.high = np.asarray(low, dtype=float), np.asarray(high, dtype=float)
        self.estimates: Array = np.array(start, dtype=float)
        self.gain, self.bandwidth, self.period, self.steps = gain, bandwidth, period, max(1, round(period / step))
        n = len(self.am)
        self.pb = np.ascontiguousarray(lyapunov(self.am)[:, -1])
        self.by = np.arange(n + 2)
        self.value = nan  # of the input's filter; not yet started
        self.predicted: Array = np.full(n, nan)
        self.drift: Array = np.zeros(n)
        self._before: Array = np.zeros(n)
        self._after: Array = np.zeros(n)

    @property
    def started(self) -> bool:
        """Whether it has observed anything yet."""
        return not isnan(self.predicted[0])

    def start(self, measured: ArrayLike, value: float) -> None:
        """Begin at a measured state (n,) with the input settled at a value."""
        self.predicted[:] = self._before[:] = measured
        self.value = value

    def observe(self, measured: ArrayLike, applied: float) -> None:
        """Adapt over the period that ends with this measured state (n,), through which the input was `applied`."""
        self._after[:] = measured
        adapt(
            self.predicted, self.estimates, self.low, self.high, self.gain, self.am, self.pb, self.drift, self.by,
            self._before, self._after, applied, self.period, self.steps,
        )  # fmt: skip
        self._before[:] = self._after

    def shift(self, jump: float, known: float = 1.0) -> None:
        """The first state jumps as what it is measured against does; the prediction too as far as that is `known`."""
        self.predicted[0] += known * jump
        self._before[0] += jump

    def act(self, wanted: float, low: float, high: float, rate: float = 1e9) -> float:
        """Mean input of the next period; `wanted` is what theta'x + sigma + omega input is to be."""
        n = len(self.am)
        known = float(self.estimates[:n] @ self._before) + float(self.estimates[n]) - wanted
        mean, self.value = filtered(
            self.value, known, float(self.estimates[n + 1]), self.bandwidth, low, high, rate, self.period, self.steps
        )
        return float(mean)
