"""Joystick controllers designed by one rule: gains, and closed loops on a boat with actuator lag."""

from math import exp, pi

import numpy as np
import pytest

from boatsim.control.base import Sense
from boatsim.control.compiled import CompiledController
from boatsim.control.lag_design import RESERVE
from boatsim.control.linear_quadratic import (
    IntegralGains,
    closed_loop_poles,
    integral_gains,
    sampled_axis_model,
)
from boatsim.control.quadratic_program import solve_quadratic_program
from boatsim.control.receding_horizon import condensed_problem, predictive_gains
from boatsim.errors import BadInput
from boatsim.physics.content import load_class

RIVALS = ("adrc", "indi", "lqi", "mpc")
LAG = 0.15  # [s]


def controller(name: str, **settings: object) -> CompiledController:
    """A controller with settings."""
    made: CompiledController = load_class("controller", name).from_settings(settings)
    return made


def turn(
    made: CompiledController,
    wanted: float,
    moment: float = 0.0,
    inertia: float = 2.0,
    seconds: float = 60.0,
    lag: float = LAG,
) -> np.ndarray:
    """Yaw rates (n,) of a boat that only turns, under a constant disturbing moment [N m].

    The motors follow with a lag and have the nominal thrust.
    """
    rate, heading, applied, rows = 0.0, 0.0, 0.0, []
    keep = exp(-0.2 * made.period / lag)
    for k in range(round(seconds / made.period)):
        sense = Sense(k * made.period, heading, rate, 0, 0, 0.0, 0.0, 0, 0)
        sent = made.step(sense, {"yaw_radps": wanted})
        spread = made.thrust_at_pwm(sent["pwm_port"]) - made.thrust_at_pwm(sent["pwm_starboard"])
        for _ in range(5):
            applied = keep * applied + (1.0 - keep) * made.half_spacing * spread
            rate += 0.2 * made.period * (applied + moment) / inertia
            heading += 0.2 * made.period * rate
        rows.append(rate)
    return np.array(rows)


@pytest.mark.parametrize("name", RIVALS)
def test_the_gains_follow_from_the_known_lag(name: str) -> None:
    made = controller(name, motor_lag=0.15, command_delay=0.0)
    theta = 0.5 * made.period + 0.15 + RESERVE
    assert made.bandwidth == pytest.approx(0.5 / theta)
    assert made.pole == pytest.approx(0.5 * made.bandwidth)
    slower = controller(name, motor_lag=0.15, command_delay=0.4)
    assert slower.bandwidth == pytest.approx(0.5 / (theta + 0.4))
    assert controller(name, pole=0.9).pole == 0.9


@pytest.mark.slow
@pytest.mark.parametrize("name", RIVALS)
def test_a_constant_moment_leaves_no_error(name: str) -> None:
    # rounding to whole values of PWM leaves a limit cycle of less than 0.2 deg/s
    rates = turn(controller(name), 0.08, moment=0.03)
    assert rates[-200:].mean() == pytest.approx(0.08, abs=1e-3)
    assert np.abs(rates[-200:] - 0.08).max() < 0.2 * pi / 180.0


@pytest.mark.slow
@pytest.mark.parametrize("name", RIVALS)
def test_loops_survive_another_inertia_and_lag(name: str) -> None:
    for inertia in (1.2, 3.6):
        rates = turn(controller(name), 0.08, inertia=inertia, lag=0.4, seconds=80.0)
        assert np.abs(rates[-200:] - 0.08).max() < 0.01


def test_lqi_without_lag_has_butterworth_poles() -> None:
    period, w = 0.01, 0.8
    gains = integral_gains(2.0, 0.0, 0.0, period, w)
    poles = np.log(closed_loop_poles(2.0, 0.0, 0.0, period, gains)) / period
    slow = poles[np.argsort(np.abs(poles))[:2]]
    assert np.abs(slow) == pytest.approx([w, w], rel=0.02)
    assert -slow.real / np.abs(slow) == pytest.approx([0.5**0.5] * 2, rel=0.02)


def test_lqi_gains_minimise_the_cost() -> None:
    """A disturbed closed loop costs more with any other gain."""
    inertia, damping, lag, period, w = 2.0, 0.3, 0.4, 0.1, 0.7
    gains = integral_gains(inertia, damping, lag, period, w)

    def cost(found: IntegralGains) -> float:
        whole = sampled_axis_model(inertia, damping, lag, period)
        state, total = np.array([0.2, 0.5, 0.0]), 0.0
        for _ in range(600):
            u = -found.velocity * state[0] - found.integral * state[1] - found.force * state[2]
            total += state[1] ** 2 + (u / inertia) ** 2 / w**4
            state = whole[:3, :3] @ state + whole[:3, 3] * u
        return total

    best = cost(gains)
    for name in gains._fields:
        for factor in (0.95, 1.05):
            assert cost(gains._replace(**{name: factor * getattr(gains, name)})) > best
    assert np.abs(closed_loop_poles(inertia, damping, lag, period, gains)).max() < 1.0


def predicted_moves(pole: float, lag: float, state: np.ndarray, most: float) -> np.ndarray:
    """Optimal commands within limits, by the quadratic program."""
    problem = condensed_problem(pole, lag)
    size = len(problem.hessian)
    rows = np.vstack([np.eye(size), -np.eye(size)])
    found, _ = solve_quadratic_program(
        problem.hessian, problem.gradient @ state, rows, np.full(2 * size, most)
    )
    return np.asarray(found)


@pytest.mark.parametrize("limited_inside", [True, False])
def test_predictive_control_has_no_offset(limited_inside: bool) -> None:
    assert limited_error(limited_inside, 0.4, disturbance=-0.1)[1] == pytest.approx(0.0, abs=1e-6)


def limited_error(inside: bool, most: float, disturbance: float = 0.0) -> tuple[float, float]:
    """Rms error of a step of the set point to 1 with limited commands, and the final error."""
    pole, lag, period = 0.5, 0.15, 0.08
    gains = predictive_gains(pole, lag)
    x, f, u, errors = 0.0, 0.0, 0.0, []
    keep = exp(-period / lag)
    for _ in range(500):
        state = np.array([x - 1.0, disturbance, f, u])
        if inside:
            u = float(predicted_moves(pole, lag, state, most)[0])
        else:
            u = float(np.clip(-np.array(gains) @ state, -most, most))
        x += period * (disturbance + u) + lag * (1.0 - keep) * (f - u)
        f = keep * f + (1.0 - keep) * u
        errors.append(x - 1.0)
    return float(np.sqrt(np.mean(np.square(errors)))), errors[-1]


@pytest.mark.parametrize("most", [0.05, 0.15, 0.3])
def test_limits_inside_of_the_quadratic_program_change_little(most: float) -> None:
    """The reason why `mpc` limits the first move instead of solving the program on board."""
    inside, outside = limited_error(True, most)[0], limited_error(False, most)[0]
    assert outside == pytest.approx(inside, rel=0.01)


def test_the_number_of_moves_changes_the_gains_by_at_most_a_tenth() -> None:
    used = np.array(predictive_gains(0.5, LAG))
    for moves in (6, 12):
        assert np.abs(np.array(predictive_gains(0.5, LAG, moves)) - used).max() < 0.1


def test_wrong_settings_are_refused() -> None:
    with pytest.raises(BadInput, match="allowed are numbers above 0"):
        integral_gains(0.0, 0.0, 0.1, 0.1, 1.0)
    with pytest.raises(BadInput, match="pole above 0"):
        predictive_gains(0.0, 0.1)
    for name in RIVALS:
        with pytest.raises(BadInput, match="bandwidth"):
            controller(name, bandwidth=100.0)
