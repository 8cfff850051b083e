"""A mean force that stays in a fitted vessel is told with its size; one that comes and goes, or is
small, is not."""

from collections.abc import Callable

import numpy as np
import pytest
from pushed_boat import laid, sail

from boatsim.diagnosis.locate.mean_force import MeanForce, mean_residual_force
from boatsim.diagnosis.locate.smoothing import variance_of_average, variance_of_mean
from boatsim.physics.base import Array

FULL_THRUST = 2.0  # [N] of the two thrusters


def left(force: Callable[[float], tuple[float, float, float]]) -> dict[str, MeanForce]:
    problem, best = laid(
        *(sail(f"run_{seed}", seed, lambda t, y, c: np.array(force(t)))[0] for seed in (1, 2))
    )
    return mean_residual_force(problem, best, problem.recordings)


@pytest.mark.parametrize("sway", [0.2, -0.2])
def test_a_steady_push_is_told_with_its_size_side_and_share(sway: float) -> None:
    found = left(lambda t: (0.0, sway, 0.0))
    assert set(found) == {"sway"} and found["sway"].unit == "N"
    assert (
        found["sway"].mean == pytest.approx(sway, abs=3 * found["sway"].sd)
        and found["sway"].sd < 0.06
    )
    assert found["sway"].share_of_full_thrust == pytest.approx(0.1, rel=0.3)


def test_a_moment_has_no_share_of_a_thrust() -> None:
    found = left(lambda t: (0.0, 0.0, 0.08))
    assert set(found) == {"yaw"} and found["yaw"].share_of_full_thrust is None
    assert found["yaw"].mean == pytest.approx(0.08, rel=0.2)


@pytest.mark.parametrize(
    "force",
    [
        lambda t: (0.0, 0.0, 0.0),
        lambda t: (0.0, 0.2 * np.sin(0.8 * t), 0.0),
        lambda t: (0.003, -0.003, 0.0),
    ],
    ids=["nothing", "comes and goes", "less than is tolerated"],
)
def test_what_has_no_mean_worth_the_name_is_not_told(
    force: Callable[[float], tuple[float, float, float]],
) -> None:
    assert left(force) == {}


def test_the_variance_of_a_mean_is_that_of_the_average_over_all_rows() -> None:
    rng, n, dim = np.random.default_rng(3), 40, 6
    gains = 0.3 * rng.normal(size=(n, dim, dim)) / np.sqrt(dim)
    roots: Array = rng.normal(size=(n, dim, dim))
    covariances = roots @ roots.transpose(0, 2, 1)
    whole = variance_of_average(covariances, gains, slice(4, 6), n)
    assert variance_of_mean(covariances, gains, slice(4, 6)) == pytest.approx(whole[0])
