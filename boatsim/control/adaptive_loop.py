"""L1 adaptive loop with gradient adaptation and internal sub-steps, compiled.

After N. Hovakimyan and C. Cao, L1 Adaptive Control Theory (SIAM 2010): a state predictor with
unknown input gain omega, state coefficients theta and disturbance sigma, gradient laws with
projection, and a low-pass filter on the input.
"""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from boatsim.control.adaptive import solve_lyapunov
from boatsim.control.compiled import Records, lean, merged
from boatsim.physics.base import Array

# of the projection: it acts from 1 / sqrt(1 + tolerance) of the half range on
TOLERANCE = 0.1


@lean
def project_rate(value: float, rate: float, low: float, high: float) -> float:
    """Return the rate of an adaptive estimate after projection on [low, high], compiled.

    It is the compiled form of `project_interval`.

    Args:
        value: Estimate.
        rate: Rate of the estimate before projection [1/s].
        low: Lower bound.
        high: Upper bound.
    """
    off, radius = value - 0.5 * (low + high), 0.5 * (high - low)
    excess = ((1.0 + TOLERANCE) * off * off - radius * radius) / (TOLERANCE * radius * radius)
    if excess <= 0.0 or off * rate <= 0.0:
        return rate
    return rate * (1.0 - excess)


@lean
def adapt_estimates(
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
    """Advance state predictor and adaptive estimates over one period, in place.

    The period lies between two measured states. The input acts on the last state. Regressors are
    (x1 ... xn, 1, input). Each sub-step advances the predictor first and then the estimates
    (semi-implicit Euler).

    Args:
        predicted: Predicted state (n,).
        estimates: theta (n), sigma, omega (n + 2,).
        low: Lower bounds (n + 2,).
        high: Upper bounds (n + 2,).
        gain: Adaptation gain.
        am: A_m (n, n) [1/s].
        pb: P b (n,).
        drift: Known rate of each state (n,).
        by: Index of the regressor of each estimate (n + 2,).
        before: Measured state at the begin (n,).
        after: Measured state at the end (n,).
        applied: Mean input over the period.
        period: Length of the period [s].
        steps: Number of sub-steps.
        regressors: Work array (n + 2,).
        slope: Work array (n,).
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
            rate = gain * project_rate(estimates[j], -regressors[by[j]] * error, low[j], high[j])
            estimates[j] = min(max(estimates[j] + dt * rate, low[j]), high[j])


@lean
def low_pass_control_input(
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
    """Return mean and final value of a control input that is low-pass filtered over one period.

    The filter of the L1 adaptive law is input' = -bandwidth (gain input + known) within the limits
    of value and rate.

    Args:
        value: Input at the begin.
        known: theta'x + sigma less the wanted value.
        gain: Estimated input gain omega.
        bandwidth: Gain of the filter [1/s].
        low: Lower limit of the input.
        high: Upper limit of the input.
        rate: Largest rate of the input [1/s].
        period: Length of the period [s].
        steps: Number of sub-steps.
    """
    total, dt = 0.0, period / steps
    for _ in range(steps):
        speed = min(max(-bandwidth * (gain * value + known), -rate), rate)
        later = min(max(value + dt * speed, low), high)
        total += 0.5 * (value + later)
        value = later
    return total / steps, value


def loop_memory_type(n: int) -> np.dtype[np.void]:
    """Return the record type that holds the states of an L1 adaptive loop with n plant states.

    Args:
        n: Number of states of the plant.
    """
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


def loop_design_type(n: int) -> np.dtype[np.void]:
    """Return the record type that holds the design constants of an L1 loop with n plant states.

    Args:
        n: Number of states of the plant.
    """
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


def make_loop_design(
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
    """Return the design constants of an L1 adaptive loop as one record (1,).

    Each estimate is driven by its own regressor.

    Args:
        am: A_m of the predictor (n, n) [1/s].
        low: Lower bounds of theta (n), sigma, omega (n + 2,).
        high: Upper bounds (n + 2,).
        first: Initial estimates (n + 2,).
        gain: Adaptation gain.
        bandwidth: Gain of the low-pass filter [1/s].
        period: Sample time of the controller [s].
        step: Length of a sub-step [s].
    """
    a = np.asarray(am, dtype=float)
    d = np.zeros(1, loop_design_type(len(a)))
    d["am"], d["pb"], d["low"], d["high"], d["first"] = (
        a,
        solve_lyapunov(a)[:, -1],
        low,
        high,
        first,
    )
    d["by"], d["gain"], d["bandwidth"] = np.arange(len(a) + 2), gain, bandwidth
    d["period"], d["steps"] = period, max(1, round(period / step))
    return d


@merged
def initialise_loop(a: Any, d: Any, value: float) -> None:
    """Initialise an L1 adaptive loop at the measured state `a.after`, with a settled input.

    Args:
        a: Memory of the loop.
        d: Design of the loop.
        value: Control input.
    """
    for i in range(len(d.first)):
        a.estimates[i] = d.first[i]
    for i in range(len(d.pb)):
        a.predicted[i] = a.before[i] = a.after[i]
    a.value = value


@merged
def adapt_loop(a: Any, d: Any, applied: float) -> None:
    """Update predictor and estimates of an L1 adaptive loop over the last period.

    The period ends with the measured state in `a.after`.

    Args:
        a: Memory of the loop.
        d: Design of the loop.
        applied: Input applied over the period.
    """
    adapt_estimates(
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
def shift_loop_reference(a: Any, jump: float, known: float) -> None:
    """Shift the state of an L1 adaptive loop when its reference jumps.

    The first state is an error from the reference and so shifts by the jump; the prediction shifts
    by a part of it.

    Args:
        a: Memory of the loop.
        jump: Jump of the reference.
        known: Part of the jump that the prediction follows, 0 to 1.
    """
    a.predicted[0] += known * jump
    a.before[0] += jump


@merged
def compute_loop_input(
    a: Any, d: Any, wanted: float, low: float, high: float, rate: float
) -> float:
    """Return the mean control input of an L1 adaptive loop over the next period.

    Args:
        a: Memory of the loop.
        d: Design of the loop.
        wanted: Value that theta'x + sigma + omega input should have.
        low: Lower limit of the input.
        high: Upper limit of the input.
        rate: Largest rate of the input [1/s].
    """
    n = len(d.pb)
    known = a.estimates[n] - wanted
    for i in range(n):
        known += a.estimates[i] * a.before[i]
    mean, a.value = low_pass_control_input(
        a.value, known, a.estimates[n + 1], d.bandwidth, low, high, rate, d.period, d.steps
    )
    return mean
