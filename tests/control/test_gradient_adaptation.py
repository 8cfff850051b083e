"""Gradient adaptation with projection: bounds, the prediction error's law, and its limit.

The bound is that of N. Hovakimyan and C. Cao, L1 Adaptive Control Theory (SIAM 2010), sections 2.1
and 2.2: with V = xt'P xt + sum (estimate - truth)^2 / Gamma, xt = xh - x, projection and constant
truths give V' <= -xt'Q xt, so that from xt = 0

    |xt|^2 <= V(0) / lambda_min(P) <= theta_m / (lambda_min(P) Gamma)

where theta_m is the sum of the squared widths of all intervals of the estimates.
"""

from math import degrees, exp, sin, sqrt
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numba import njit

from boatsim.control.adaptive import PiecewiseConstant, solve_lyapunov
from boatsim.control.gradient_adaptation import (
    STATE_ESTIMATES,
    EstimateBounds,
    adapt_state_estimates,
    estimated_acceleration,
    start_estimates,
)

MODEL = np.array([[0.0, -1.0], [1.0, -1.4]])
P = solve_lyapunov(MODEL)
BOUNDS = EstimateBounds(0.5, 2.0, -2.0, 2.0, -1.0, 1.0)
# squared widths of omega, theta_v, theta_r and sigma, of two state equations
THETA_M = 2.0 * (1.5**2 + 2.0 * 4.0**2 + 2.0**2)
STEP = 1e-4  # [s] short against 1 / sqrt(Gamma lambda_max(P)), so that Euler steps are the continuous law


def rows(count: int) -> Any:
    found = np.zeros(count, STATE_ESTIMATES)
    return found


@njit
def largest_prediction_error(
    truth: Any, rows: Any, model: Any, p: Any, gain: float, seconds: float, dt: float
) -> tuple[float, float]:
    """Largest prediction error of two states, and the largest excess of an estimate over its bounds.

    The boat is x' = A_m x + omega input + theta'x + sigma with two sinusoidal inputs.
    """
    v = r = vh = rh = largest = 0.0
    excess = -1e9
    start_estimates(rows[0], BOUNDS)
    start_estimates(rows[1], BOUNDS)
    for i in range(round(seconds / dt)):
        rows[0].given, rows[1].given = 0.5 * sin(2.0 * i * dt), 0.5 * sin(3.0 * i * dt + 1.0)
        truth[0].given, truth[1].given = rows[0].given, rows[1].given
        dv = model[0, 0] * v + model[0, 1] * r + estimated_acceleration(truth[0], v, r)
        dr = model[1, 0] * v + model[1, 1] * r + estimated_acceleration(truth[1], v, r)
        dvh = model[0, 0] * vh + model[0, 1] * rh + estimated_acceleration(rows[0], v, r)
        drh = model[1, 0] * vh + model[1, 1] * rh + estimated_acceleration(rows[1], v, r)
        v, r, vh, rh = v + dt * dv, r + dt * dr, vh + dt * dvh, rh + dt * drh
        ev, er = vh - v, rh - r
        adapt_state_estimates(rows[0], p[0, 0] * ev + p[0, 1] * er, v, r, BOUNDS, gain, dt)
        adapt_state_estimates(rows[1], p[0, 1] * ev + p[1, 1] * er, v, r, BOUNDS, gain, dt)
        largest = max(largest, sqrt(ev * ev + er * er))
        for k in range(2):
            row = rows[k]
            excess = max(excess, row.omega - BOUNDS.omega_high, BOUNDS.omega_low - row.omega)
            excess = max(excess, abs(row.theta_v) - 2.0, abs(row.theta_r) - 2.0)
            excess = max(excess, abs(row.sigma) - 1.0)
    return largest, excess


def boat(omega: float, theta: float, sigma: float) -> Any:
    truth = rows(2)
    for row, sign in zip(truth, (1.0, -1.0), strict=True):
        row["omega"], row["theta_v"], row["theta_r"] = omega, -abs(theta), sign * 0.5 * theta
        row["sigma"] = sign * sigma
    truth[1]["theta_v"], truth[1]["theta_r"] = 0.5 * theta, -abs(theta)
    return truth


def test_lyapunov_equation_of_the_model_holds() -> None:
    assert MODEL.T @ P + P @ MODEL == pytest.approx(-np.eye(2), abs=1e-12)
    assert pytest.approx(np.array([[99 / 70, -1 / 2], [-1 / 2, 5 / 7]])) == P


@settings(max_examples=10, deadline=None)
@given(
    omega=st.floats(0.5, 2.0),
    theta=st.floats(-1.2, 1.2),
    sigma=st.floats(-1.0, 1.0),
    gain=st.sampled_from([1e2, 1e3, 1e4]),
)
def test_prediction_error_keeps_the_bound_of_the_theory(
    omega: float, theta: float, sigma: float, gain: float
) -> None:
    truth = boat(omega, theta, sigma)
    error, excess = largest_prediction_error(truth, rows(2), MODEL, P, gain, 3.0, STEP)
    least = float(np.linalg.eigvalsh(P)[0])
    assert error <= sqrt(THETA_M / (least * gain))
    assert excess <= 0.0


def test_prediction_error_falls_with_the_root_of_the_gain() -> None:
    errors = []
    for gain in (1e3, 1e4, 1e5):
        found, _ = largest_prediction_error(boat(1.6, 1.0, 0.8), rows(2), MODEL, P, gain, 3.0, STEP)
        errors.append(found)
    assert errors[1] / errors[0] == pytest.approx(sqrt(0.1), rel=0.15)
    assert errors[2] / errors[1] == pytest.approx(sqrt(0.1), rel=0.15)


@settings(max_examples=50, deadline=None)
@given(
    error=st.floats(-1e3, 1e3),
    v=st.floats(-5.0, 5.0),
    r=st.floats(-5.0, 5.0),
    gain=st.floats(0.0, 1e7),
    dt=st.floats(1e-5, 0.1),
)
def test_estimates_never_leave_their_bounds(
    error: float, v: float, r: float, gain: float, dt: float
) -> None:
    """Nor in steps that are much too long for the gain."""
    row = rows(1)
    start_estimates(row[0], BOUNDS)
    for sign in (1.0, 1.0, -1.0):
        row[0]["given"] = 3.0
        adapt_state_estimates(row[0], sign * error, v, r, BOUNDS, gain, dt)
        assert BOUNDS.omega_low <= row[0]["omega"] <= BOUNDS.omega_high
        assert abs(row[0]["theta_v"]) <= 2.0 and abs(row[0]["theta_r"]) <= 2.0
        assert abs(row[0]["sigma"]) <= 1.0


@njit
def disturbed_by_gradient(gain: float, dt: float, seconds: float) -> Any:
    """States every `dt` of x' = -1.4 x + u + disturbance under the gradient law and C = 2/(s + 2)."""
    row, p = np.zeros(1, STATE_ESTIMATES)[0], 1.0 / 2.8
    start_estimates(row, BOUNDS)
    x, xh, u = 0.0, 0.0, 0.0
    states = np.zeros(round(seconds / dt))
    for i in range(len(states)):
        row.given = u
        x, xh = (
            x + dt * (-1.4 * x + u + 0.5 * sin(1.5 * i * dt)),
            xh + dt * (-1.4 * xh + estimated_acceleration(row, x, 0.0)),
        )
        adapt_state_estimates(row, p * (xh - x), x, 0.0, BOUNDS, gain, dt)
        u -= dt * 2.0 * estimated_acceleration(row, x, 0.0)
        states[i] = x
    return states


def disturbed_by_piecewise_constant(period: float, seconds: float) -> Any:
    """The same plant and filter under piecewise-constant adaptation."""
    law, x, u = PiecewiseConstant(1.4, 1.0, period), 0.0, 0.0
    states = np.zeros(round(seconds / period))
    for i in range(len(states)):
        law.predict(u)
        x += period * (-1.4 * x + u + 0.5 * sin(1.5 * i * period))
        u += (1.0 - exp(-2.0 * period)) * (-law.adapt(x) / law.decay - u)
        states[i] = x
    return states


def test_large_gain_and_short_period_give_the_motion_of_piecewise_constant_adaptation() -> None:
    """Both laws tend to the reference system, in which the filter alone limits the rejection."""
    wanted = disturbed_by_piecewise_constant(1e-3, 20.0)
    size = float(np.abs(wanted).max())
    far = []
    for gain in (1e2, 1e4, 1e6):
        found = disturbed_by_gradient(gain, 1e-4, 20.0)[::10]
        far.append(float(np.abs(found - wanted).max()) / size)
    assert far[0] > 4.0 * far[1] and far[2] < 0.01, far
    assert degrees(size) > 5.0
