"""The size of a stochastic force on a part of the data follows from the filter's variances."""

from collections.abc import Callable

import numpy as np
import pytest
from pushed_boat import ROWS, Missing, laid, sail

from boatsim.diagnosis.fit import unfitted_hypothesis
from boatsim.diagnosis.open_set.consistency import effect_consistency
from boatsim.diagnosis.open_set.stochastic_size import VarianceScore
from boatsim.diagnosis.problem import Fit, Problem, free_parameter_values
from boatsim.physics.base import Array

NAME = "wave_forcing"
RMS, FREQUENCY, WIDTH = 0.15, 3.0, 0.1  # N m, rad/s, damping ratio
END = ROWS / 6.0  # [s]
PRIOR_SD = 100.0


def waves(seed: int, strength: Callable[[float], float]) -> Missing:
    """A narrow-band yaw moment of 60 waves about the frequency."""
    rng = np.random.default_rng(seed)
    w = FREQUENCY * (1.0 + WIDTH * rng.standard_cauchy(400))
    w = w[(w > 1.5) & (w < 6.0)][:60]
    phase = rng.uniform(0.0, 2.0 * np.pi, len(w))
    size = RMS * np.sqrt(2.0 / len(w))

    def moment(t: float, y: Array, command: Array) -> Array:
        return np.array([0.0, 0.0, strength(t) * size * np.sum(np.cos(w * t + phase))])

    return moment


def fitted(strength: Callable[[float], float]) -> tuple[Problem, Fit, Fit]:
    """The problem, its fit without waves, and one with waves of the true parameters."""
    problem, without = laid(*[sail(n, k, waves(k, strength))[0] for k, n in enumerate("abc", 1)])
    free = problem.free_parameters((NAME,))
    values = without.values() | {
        (NAME, "yaw"): RMS,
        (NAME, "frequency"): FREQUENCY,
        (NAME, "damping"): WIDTH,
    }
    theta = free_parameter_values(free, values)
    return problem, without, unfitted_hypothesis((NAME,), free, theta, problem.ambient)


@pytest.fixture(scope="module")
def steady() -> tuple[Problem, Fit, Fit]:
    return fitted(lambda t: 1.0)


def test_the_score_is_the_derivative_of_the_likelihood_by_the_variance(
    steady: tuple[Problem, Fit, Fit],
) -> None:
    problem, _, best = steady
    on = problem.program.effect_switches(best.effects)
    at = next(i for i, f in enumerate(best.free) if (f.effect, f.name) == (NAME, "yaw"))
    step = 0.01  # of the log of the variance
    likelihoods = []
    for sign in (-1.0, 1.0):
        theta = best.theta.copy()
        theta[at] *= np.exp(0.5 * sign * step)
        likelihoods.append(problem.log_likelihood(best.free, theta, on, best.levels))
    score = VarianceScore.of_effect(problem, best, NAME)
    slope = (likelihoods[1] - likelihoods[0]) / (2.0 * step)
    assert score.score.sum() == pytest.approx(slope, abs=0.02 * np.sqrt(score.information.sum()))


def test_steady_waves_have_one_size_and_waves_of_one_half_have_not(
    steady: tuple[Problem, Fit, Fit],
) -> None:
    def times(problem: Problem, without: Fit, best: Fit) -> float:
        signs = effect_consistency(problem, best, {NAME: without}, [])[NAME]
        assert signs.between_times.dof == 11  # four parts of each of three recordings
        return signs.between_times.ratio

    assert times(*steady) < 2.0
    assert times(*fitted(lambda t: 1.4 * (t > END / 2.0))) > 4.0


def test_a_size_is_that_of_its_group_of_rows() -> None:
    rng = np.random.default_rng(5)
    groups = np.repeat([0, 1, -1], 4000)
    white = rng.standard_normal(len(groups)) * np.array([1.0, 0.8, 3.0])[groups]
    # rows whose variance is that of the force alone
    score = VarianceScore(0.5 * (white**2 - 1.0), np.full(len(groups), 0.5))
    sizes, covariance = score.sizes(groups, PRIOR_SD)
    assert sizes == pytest.approx([1.0, 1.0 + 0.5 * (0.8**2 - 1.0)], abs=0.04)
    assert np.sqrt(np.diag(covariance)) == pytest.approx(0.5 / np.sqrt(2000.0), rel=1e-3)
    assert covariance[0, 1] == 0.0
