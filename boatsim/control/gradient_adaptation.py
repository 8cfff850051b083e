"""Gradient adaptation with projection for a model with the states sway velocity and yaw rate.

The laws of an L1 adaptive controller (N. Hovakimyan and C. Cao, L1 Adaptive Control Theory, SIAM
2010, section 2.2) for one input per state. The state predictor of each state is

    xh' = A_m xh + omega input + theta_v v + theta_r r + sigma

A model with one state uses v for it and r = 0.
"""

from typing import Any, NamedTuple

from boatsim.control.adaptive_loop import project_rate
from boatsim.control.allocation import limit
from boatsim.control.compiled import merged, record_type

# Adaptive estimates of one state equation, and the input applied to it [m/s^2 or rad/s^2]
STATE_ESTIMATES = record_type("omega", "theta_v", "theta_r", "sigma", "given")


class EstimateBounds(NamedTuple):
    """Bounds within which the adaptive estimates of a state equation are projected.

    A record with these fields may be used too.
    """

    omega_low: float
    omega_high: float
    theta_low: float  # [1/s]
    theta_high: float
    sigma_low: float  # [m/s^2 or rad/s^2]
    sigma_high: float


@merged
def start_estimates(row: Any, bounds: Any) -> None:
    """Set the adaptive estimates to those of the nominal model: input gain 1 and nothing unknown.

    Args:
        row: `STATE_ESTIMATES` of one state equation, changed in place.
        bounds: `EstimateBounds`; a value outside is moved to the nearest bound.
    """
    row.omega = limit(1.0, bounds.omega_low, bounds.omega_high)
    row.theta_v = row.theta_r = limit(0.0, bounds.theta_low, bounds.theta_high)
    row.sigma = limit(0.0, bounds.sigma_low, bounds.sigma_high)
    row.given = 0.0


@merged
def estimated_acceleration(row: Any, v: float, r: float) -> float:
    """Return the acceleration that the adaptive estimates predict from input and states.

    Args:
        row: `STATE_ESTIMATES` of one state equation.
        v: Sway velocity [m/s].
        r: Yaw rate [rad/s].
    """
    return row.omega * row.given + row.theta_v * v + row.theta_r * r + row.sigma


@merged
def step_estimate(
    value: float, regressor: float, error: float, low: float, high: float, gain: float, dt: float
) -> float:
    """Return an adaptive estimate after one Euler step of the projected gradient law.

    Args:
        value: Estimate.
        regressor: State, input or 1.
        error: Entry of (xh - x)' P.
        low: Lower bound.
        high: Upper bound.
        gain: Adaptation gain.
        dt: Length of the step [s].
    """
    rate = gain * project_rate(value, -regressor * error, low, high)
    return limit(value + dt * rate, low, high)


@merged
def adapt_state_estimates(
    row: Any, error: float, v: float, r: float, bounds: Any, gain: float, dt: float
) -> None:
    """Update the adaptive estimates of one state equation by one Euler step.

    Args:
        row: `STATE_ESTIMATES` of the state equation, changed in place.
        error: Entry of (xh - x)' P of the state; P solves the Lyapunov equation of A_m.
        v: Sway velocity [m/s].
        r: Yaw rate [rad/s].
        bounds: `EstimateBounds`.
        gain: Adaptation gain.
        dt: Length of the step [s].
    """
    omega, theta = (bounds.omega_low, bounds.omega_high), (bounds.theta_low, bounds.theta_high)
    row.omega = step_estimate(row.omega, row.given, error, omega[0], omega[1], gain, dt)
    row.theta_v = step_estimate(row.theta_v, v, error, theta[0], theta[1], gain, dt)
    row.theta_r = step_estimate(row.theta_r, r, error, theta[0], theta[1], gain, dt)
    row.sigma = step_estimate(row.sigma, 1.0, error, bounds.sigma_low, bounds.sigma_high, gain, dt)
