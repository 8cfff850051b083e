"""Linear-quadratic regulator with integral action for one velocity of a boat with actuator lag.

B. D. O. Anderson, J. B. Moore, Optimal Control: Linear Quadratic Methods, Prentice Hall 1990.
"""

from typing import NamedTuple

import numpy as np

from boatsim.errors import BadInput
from boatsim.physics.base import Array

# [s] a shorter actuator lag has no effect on a control period and is taken as this one
SHORTEST_LAG = 1e-3


class IntegralGains(NamedTuple):
    """Feedback u = integral x (integral of the error) - velocity x (velocity) - force x (force)."""

    integral: float  # [N/m or N m/rad]
    velocity: float  # [N s/m or N m s/rad]
    force: float  # dimensionless


def sampled_axis_model(inertia: float, damping: float, lag: float, period: float) -> Array:
    """Return the transition matrix (4, 4) of velocity, its integral, actuator force and command.

    I x' = F - d x,  T F' = u - F, and the command u is held over the period.

    Args:
        inertia: Mass or inertia [kg or kg m^2].
        damping: Linear damping [N s/m or N m s].
        lag: Time constant T of the actuators [s].
        period: Sample time [s].
    """
    from scipy.linalg import expm

    rates = np.zeros((4, 4))
    rates[0, 0], rates[0, 2] = -damping / inertia, 1.0 / inertia
    rates[1, 0] = 1.0
    rates[2, 2], rates[2, 3] = -1.0 / max(lag, SHORTEST_LAG), 1.0 / max(lag, SHORTEST_LAG)
    return np.asarray(expm(rates * period))


def integral_gains(
    inertia: float, damping: float, lag: float, period: float, frequency: float
) -> IntegralGains:
    """Return the gains that minimise the integral of the squared error integral and of the command.

    The weight of the command is such that a boat without damping and lag gets the natural frequency
    given and a damping ratio of 0.71: its closed loop is s^2 + sqrt(2) w s + w^2.

    Args:
        inertia: Mass or inertia [kg or kg m^2].
        damping: Linear damping [N s/m or N m s].
        lag: Time constant of the actuators [s].
        period: Sample time [s].
        frequency: Natural frequency w [rad/s].

    Raises:
        BadInput: A number is not positive, or the damping is negative.
    """
    if not (inertia > 0.0 and frequency > 0.0 and period > 0.0 and damping >= 0.0 and lag >= 0.0):
        raise BadInput(
            f"LQI: inertia {inertia:g}, damping {damping:g}, lag {lag:g} s, period {period:g} s, "
            f"frequency {frequency:g} rad/s; allowed are numbers above 0, damping and lag 0 or more"
        )
    from scipy.linalg import solve_discrete_are

    whole = sampled_axis_model(inertia, damping, lag, period)
    # in units of the inertia, so that the equation is well scaled
    a, b = whole[:3, :3].copy(), whole[:3, 3:].copy() * inertia
    a[:2, 2] *= inertia
    b[2] /= inertia
    state, command = np.diag([0.0, 1.0, 0.0]), np.array([[frequency**-4.0]])
    cost = solve_discrete_are(a, b, state, command)
    gains = np.linalg.solve(command + b.T @ cost @ b, b.T @ cost @ a)[0] * inertia
    return IntegralGains(float(gains[1]), float(gains[0]), float(gains[2]) / inertia)


def closed_loop_poles(
    inertia: float, damping: float, lag: float, period: float, gains: IntegralGains
) -> Array:
    """Return the poles of the sampled closed loop (3,); it is stable if all are within 1.

    Args:
        inertia: Mass or inertia [kg or kg m^2].
        damping: Linear damping [N s/m or N m s].
        lag: Time constant of the actuators [s].
        period: Sample time [s].
        gains: Feedback gains.
    """
    whole = sampled_axis_model(inertia, damping, lag, period)
    feedback = np.array([[gains.velocity, gains.integral, gains.force]])
    return np.asarray(np.linalg.eigvals(whole[:3, :3] - whole[:3, 3:] @ feedback))
