"""Offset-free model predictive control of one velocity with actuator lag and disturbance estimate.

The disturbance is part of the predicted motion, so that a constant one leaves no offset. J. M.
Maciejowski, Predictive Control with Constraints, Prentice Hall 2002; U. Maeder, F. Borrelli,
M. Morari, Linear offset-free model predictive control, Automatica 45, 2009.
"""

from math import exp
from typing import NamedTuple

import numpy as np

from boatsim.errors import BadInput
from boatsim.physics.base import Array

# Moves of the horizon. With 6 or 12 the first move differs by up to a tenth, less than the
# uncertainty of the inertia (tests/control/test_rival_controllers.py).
MOVES = 8
# Horizon in time constants of the response to a set point, of which a seventh is then left
HORIZON = 2.0
# Cost of a squared change of the command, relative to the force that accelerates the boat by one
# unit per time constant; the error is counted in the same unit. A tenth of the error's cost halves
# the reaction to noise and changes the response by less than the model's uncertainty.
MOVE_COST = 0.1


class CondensedProblem(NamedTuple):
    """Quadratic program of the commands over the horizon: 0.5 u' H u + u' G s.

    s is (velocity - set point, disturbance, actuator output, present command), each as an
    acceleration or a velocity.
    """

    hessian: Array  # H (n, n)
    gradient: Array  # G (n, 4)


class PredictiveGains(NamedTuple):
    """Gains of the first move of the unconstrained problem, for forces divided by the inertia.

    command = -velocity (x - x_ref) - disturbance d - force f - before u
    """

    velocity: float  # [1/s]
    disturbance: float
    force: float
    before: float


def condensed_problem(pole: float, lag: float, moves: int = MOVES) -> CondensedProblem:
    """Return the quadratic program of a predictive controller without its limits.

    Forces are divided by the inertia: x' = f + d, lag f' = command - f. The reference approaches
    the set point exponentially with the pole. Commands are constant between the points of the
    horizon.

    Args:
        pole: Pole of the response to a set point [1/s].
        lag: Time constant of the actuators [s].
        moves: Number of commands over the horizon.

    Raises:
        BadInput: The pole is not positive, the lag is negative, or there is no move.
    """
    if not (pole > 0.0 and lag >= 0.0 and moves > 0):
        raise BadInput(
            f"MPC: pole {pole:g} 1/s, lag {lag:g} s, {moves} moves; allowed are a pole above 0, a "
            "lag of 0 or more and at least 1 move"
        )
    h = HORIZON / (pole * moves)
    keep = exp(-h / lag) if lag > 0.0 else 0.0
    free, response = np.zeros((moves, 4)), np.zeros(moves)
    unit_x, unit_f = 0.0, 0.0
    for k in range(moves):
        pulse = 1.0 if k == 0 else 0.0
        unit_x += lag * (1.0 - keep) * (unit_f - pulse) + h * pulse
        unit_f = keep * unit_f + (1.0 - keep) * pulse
        response[k] = unit_x
        time = h * (k + 1)
        free[k] = 1.0 - exp(-pole * time), time, lag * (1.0 - keep ** (k + 1)), 0.0
    effect = np.zeros((moves, moves))
    for k in range(moves):
        effect[k, : k + 1] = response[k::-1]
    change = np.eye(moves) - np.eye(moves, k=-1)
    first = np.zeros((moves, 4))
    first[0, 3] = -1.0
    weight = MOVE_COST / (pole * pole)
    hessian = 2.0 * (effect.T @ effect + weight * change.T @ change)
    return CondensedProblem(hessian, 2.0 * (effect.T @ free + weight * change.T @ first))


def predictive_gains(pole: float, lag: float, moves: int = MOVES) -> PredictiveGains:
    """Return the gains of the first move of the problem without limits.

    A controller limits the first move to what the motors give. In a closed loop that is at its
    limits the error is then the same as with the limits inside of the quadratic program, within
    1 % (tests/control/test_rival_controllers.py): with one input the first move reaches its limit
    in both cases.

    Args:
        pole: Pole of the response to a set point [1/s].
        lag: Time constant of the actuators [s].
        moves: Number of commands over the horizon.

    Raises:
        BadInput: The pole is not positive, the lag is negative, or there is no move.
    """
    problem = condensed_problem(pole, lag, moves)
    gains = np.linalg.solve(problem.hessian, problem.gradient)[0].tolist()
    return PredictiveGains(*gains)
