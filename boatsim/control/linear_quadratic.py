"""Linear-quadratic regulator with integral action for one velocity of a boat with actuator lag.

B. D. O. Anderson, J. B. Moore, Optimal Control: Linear Quadratic Methods, Prentice Hall 1990.
"""

from typing import NamedTuple

import numpy as np

from boatsim.control.linear_model import LinearModel, held_input_matrices
from boatsim.errors import BadInput
from boatsim.physics.base import Array

# [s] a shorter actuator lag has no effect on a control period and is taken as this one
SHORTEST_LAG = 1e-3

# Velocity, force and parameters of the two axes of a joystick controller
AXES_OF_MODEL = (("r", "N", "inertia", "yaw_damping"), ("u", "X", "mass", "surge_damping"))


class IntegralGains(NamedTuple):
    """Feedback u = integral x (integral of the error) - velocity x (velocity) - force x (force)."""

    integral: float  # [N/m or N m/rad]
    velocity: float  # [N s/m or N m s/rad]
    force: float  # dimensionless


def axis_parameters(model: LinearModel) -> dict[str, float]:
    """Return the numbers of a linear model of a vessel on which the design of two axes depends.

    Inertia and damping of an axis are those of a fast motion in it alone: the inverse of its entry
    in E and, multiplied by that, its entry on the diagonal of A. The lag is that of the slowest
    motor.

    Args:
        model: Model of the vessel.

    Returns:
        `inertia`, `yaw_damping`, `mass`, `surge_damping`, `motor_lag` and `command_delay`; a
        negative damping counts as none.

    Raises:
        BadInput: The model is discrete, or has no surge or yaw.
    """
    if model.dt:
        raise BadInput(
            f"{model.vessel}: the linear model is discrete; allowed is one without --discrete"
        )
    forces = [one.name for one in model.forces]
    values = {}
    for velocity, force, inertia, damping in AXES_OF_MODEL:
        i = model.state(velocity)
        values[inertia] = 1.0 / float(model.e[i, forces.index(force)])
        values[damping] = max(0.0, -float(model.a[i, i]) * values[inertia])
    lags: dict[str, float] = {}
    motors = [one.name for one in model.inputs if one.group in ("thrust", "shaft")]
    for i, state in enumerate(model.states):
        _, _, actuator = state.name.partition(".")
        if actuator in motors and model.a[i, i] < 0.0:
            lags[actuator] = lags.get(actuator, 0.0) - 1.0 / float(model.a[i, i])
    values["motor_lag"] = max(lags.values(), default=0.0)
    values["command_delay"] = model.delay
    return values


def sampled_axis_model(inertia: float, damping: float, lag: float, period: float) -> Array:
    """Return the transition matrix (4, 4) of velocity, its integral, actuator force and command.

    I x' = F - d x,  T F' = u - F, and the command u is held over the period.

    Args:
        inertia: Mass or inertia [kg or kg m^2].
        damping: Linear damping [N s/m or N m s].
        lag: Time constant T of the actuators [s].
        period: Sample time [s].
    """
    a, b = np.zeros((3, 3)), np.zeros((3, 1))
    a[0, 0], a[0, 2] = -damping / inertia, 1.0 / inertia
    a[1, 0] = 1.0
    a[2, 2], b[2, 0] = -1.0 / max(lag, SHORTEST_LAG), 1.0 / max(lag, SHORTEST_LAG)
    whole = np.eye(4)
    whole[:3, :3], whole[:3, 3:] = held_input_matrices(a, b, period)
    return whole


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
