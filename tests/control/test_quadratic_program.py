"""The active-set solver finds the minimum within the constraints."""

import numpy as np
import pytest
from scipy.optimize import minimize

from boatsim.control.quadratic_program import INFEASIBLE, SOLVED, solve_quadratic_program


@pytest.mark.parametrize("seed", range(20))
def test_the_minimum_is_that_of_another_solver(seed: int) -> None:
    rng = np.random.default_rng(seed)
    n, m = int(rng.integers(1, 7)), int(rng.integers(1, 20))
    root = rng.normal(size=(n + 2, n))
    hessian, gradient = root.T @ root + 1e-3 * np.eye(n), 3.0 * rng.normal(size=n)
    rows = rng.normal(size=(m, n))
    rows /= np.linalg.norm(rows, axis=1)[:, None]
    bounds = rng.uniform(0.0, 1.0, m)
    x, status = solve_quadratic_program(hessian, gradient, rows, bounds)
    assert status == SOLVED
    assert (rows @ x - bounds).max() < 1e-9
    other = minimize(
        lambda x: 0.5 * x @ hessian @ x + gradient @ x,
        np.zeros(n),
        jac=lambda x: hessian @ x + gradient,
        constraints={"type": "ineq", "fun": lambda x: bounds - rows @ x, "jac": lambda x: -rows},
        method="SLSQP",
        options={"ftol": 1e-14, "maxiter": 500},
    )
    value = 0.5 * x @ hessian @ x + gradient @ x
    assert value <= other.fun + 1e-7 * (1.0 + abs(other.fun))


def test_constraints_that_contradict_each_other_are_infeasible() -> None:
    rows, bounds = np.array([[1.0], [-1.0]]), np.array([-1.0, -1.0])
    assert solve_quadratic_program(np.eye(1), np.zeros(1), rows, bounds)[1] == INFEASIBLE


def test_a_constraint_given_twice_changes_nothing() -> None:
    rows, bounds = np.array([[1.0, 0.0], [1.0, 0.0], [0.6, 0.8]]), np.array([0.5, 0.5, 0.7])
    x, status = solve_quadratic_program(np.eye(2), np.array([-2.0, -1.0]), rows, bounds)
    assert status == SOLVED
    assert x == pytest.approx([0.5, 0.5])
