"""An L1 loop with gradient adaptation, stepped far more finely than its controller is called: compiled.

The form is that of Hovakimyan and Cao, L1 Adaptive Control Theory (SIAM 2010): a state predictor with the input's gain,
the state's coefficients and a disturbance unknown, projected gradient laws, and an input that a low-pass follows.
"""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from boatsim.control.adaptive import lyapunov
from boatsim.control.compiled import Records, lean, merged
from boatsim.physics.base import Array

# of the projection: it begins to brake at 1 / sqrt(1 + tolerance) of the way to a bound
TOLERANCE = 0.1


@lean
def projected(value: float, rate: float, low: float, high: float) -> float:
    """`boatsim.control.adaptive.project_interval`, compiled."""
    off, radius = value - 0.5 * (low + high), 0.5 * (high - low)
    excess = ((1.0 + TOLERANCE) * off * off - radius * radius) / (TOLERANCE * radius * radius)
    if excess <= 0.0 or off * rate <= 0.0:
        return rate
    return rate * (1.0 - excess)


@lean
def adapt(
    predicted: Array,
    estimates: Array,
    low: Array,
    high: Array,
    gain: float,
    am: Array,
    pb: Array,
    drift: Array,
    by: Array,
    before: Array,
    after: Array,
    applied: float,
    period: float,
    steps: int,
    regressors: Array,
    slope: Array,
) -> None:
    """Predictor and estimates over one period in which the measured state went from `before` to `after`, in place.

    The input acts on the last state. Estimates belong to the regressors (x1 ... xn, 1, input); `by` says whose
    regressor drives each of them. The predictor steps first, then the estimates (semi-implicit). `regressors` (n + 2,)
    and `slope` (n,) are there to be worked in.
    """
    n, dt = len(predicted), period / steps
    regressors[n], regressors[n + 1] = 1.0, applied
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


@lean
def filtered(
    value: float,
    known: float,
    gain: float,
    bandwidth: float,
    low: float,
    high: float,
    rate: float,
    period: float,
    steps: int,
) -> tuple[float, float]:
    """Low-pass input' = -bandwidth (gain input + known), kept in its limits: mean over the period, value at its end."""
    total, dt = 0.0, period / steps
    for _ in range(steps):
        speed = min(max(-bandwidth * (gain * value + known), -rate), rate)
        later = min(max(value + dt * speed, low), high)
        total += 0.5 * (value + later)
        value = later
    return total / steps, value


def loop_memory(n: int) -> np.dtype[np.void]:
    """Record of what a loop over n states remembers."""
    states, all_ = (n,), (n + 2,)
    return np.dtype(
        [
            ("estimates", "f8", all_),
            ("predicted", "f8", states),
            ("before", "f8", states),
            ("after", "f8", states),
            ("drift", "f8", states),
            ("regressors", "f8", all_),
            ("slope", "f8", states),
            ("value", "f8"),
        ]
    )


def loop_design(n: int) -> np.dtype[np.void]:
    """Record of how a loop over n states is laid out."""
    states, all_ = (n,), (n + 2,)
    return np.dtype(
        [
            ("am", "f8", (n, n)),
            ("pb", "f8", states),
            ("low", "f8", all_),
            ("high", "f8", all_),
            ("first", "f8", all_),
            ("by", "i8", all_),
            ("gain", "f8"),
            ("bandwidth", "f8"),
            ("period", "f8"),
            ("steps", "i8"),
        ]
    )


def designed(
    am: ArrayLike,
    low: ArrayLike,
    high: ArrayLike,
    first: ArrayLike,
    *,
    gain: float,
    bandwidth: float,
    period: float,
    step: float,
) -> Records:
    """A `loop_design` (1,) for a loop of such poles, bounds and first estimates, each driven by its own regressor.

    `am` (n, n) [1/s] is the predictor's, `low`, `high`, `first` (n + 2,) belong to x1 ... xn, the disturbance and the
    input's gain; `bandwidth` [rad/s] of the low-pass, `period` and inner `step` in s.
    """
    a = np.asarray(am, dtype=float)
    d = np.zeros(1, loop_design(len(a)))
    d["am"], d["pb"], d["low"], d["high"], d["first"] = a, lyapunov(a)[:, -1], low, high, first
    d["by"], d["gain"], d["bandwidth"] = np.arange(len(a) + 2), gain, bandwidth
    d["period"], d["steps"] = period, max(1, round(period / step))
    return d


@merged
def begin_loop(a: Any, d: Any, value: float) -> None:
    """Begin at the state in `a.after` with the input settled at a value."""
    for i in range(len(d.first)):
        a.estimates[i] = d.first[i]
    for i in range(len(d.pb)):
        a.predicted[i] = a.before[i] = a.after[i]
    a.value = value


@merged
def observe_loop(a: Any, d: Any, applied: float) -> None:
    """Adapt over the period that ends with the state in `a.after`, through which the input was `applied`."""
    adapt(
        a.predicted,
        a.estimates,
        d.low,
        d.high,
        d.gain,
        d.am,
        d.pb,
        a.drift,
        d.by,
        a.before,
        a.after,
        applied,
        d.period,
        d.steps,
        a.regressors,
        a.slope,
    )
    for i in range(len(d.pb)):
        a.before[i] = a.after[i]


@merged
def shift_loop(a: Any, jump: float, known: float) -> None:
    """The first state jumps as what it is measured against does; the prediction too as far as that is `known`."""
    a.predicted[0] += known * jump
    a.before[0] += jump


@merged
def act_loop(a: Any, d: Any, wanted: float, low: float, high: float, rate: float) -> float:
    """Mean input of the next period; `wanted` is what theta'x + sigma + omega input is to be."""
    n = len(d.pb)
    known = a.estimates[n] - wanted
    for i in range(n):
        known += a.estimates[i] * a.before[i]
    mean, a.value = filtered(
        a.value, known, a.estimates[n + 1], d.bandwidth, low, high, rate, d.period, d.steps
    )
    return mean
