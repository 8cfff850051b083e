"""Laws of the weights of free runs by Student's t distribution."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from boatsim.diagnosis.free_runs import FreeRun
from boatsim.diagnosis.output_error.weights import (
    RunErrors,
    log_likelihood_gain,
    run_errors,
    typical_error_ratio,
)
from boatsim.physics.base import Array

FAMILY = "position_rms_m"
NU = 4.0


def errors_of(distances: Array) -> RunErrors:
    """Errors of runs with two recorded coordinates."""
    return RunErrors({FAMILY: distances**2}, {FAMILY: np.full(len(distances), 2.0)})


def run(error: Array, recorded: Array) -> FreeRun:
    channels = {"recorded": {"x_m": recorded}, "it": {"x_m": recorded + error}}
    return FreeRun("a", 0.0, np.arange(float(len(error))), channels)


@given(st.integers(0, 10**6), st.floats(1e-3, 1e3))
def test_the_scale_is_that_of_maximum_likelihood_and_follows_the_unit(
    seed: int, unit: float
) -> None:
    rng = np.random.default_rng(seed)
    distances = np.linalg.norm(rng.standard_t(NU, (60, 2)), axis=1)
    scale = errors_of(distances).scale()[FAMILY]

    def log_likelihood(s: float) -> float:
        inner = np.log1p(distances**2 / (NU * s**2))
        return float(-len(distances) * 2.0 * np.log(s) - 0.5 * (NU + 2.0) * np.sum(inner))

    best = log_likelihood(scale)
    assert best >= max(log_likelihood(0.98 * scale), log_likelihood(1.02 * scale))
    assert errors_of(unit * distances).scale()[FAMILY] == pytest.approx(unit * scale, rel=1e-3)


def test_single_runs_far_off_do_not_move_the_scale_and_lose_their_weight() -> None:
    usual = np.linalg.norm(np.random.default_rng(1).standard_normal((40, 2)), axis=1)
    alone = errors_of(usual).scale()[FAMILY]
    for far in (20.0, 2000.0, np.inf):
        errors = errors_of(np.append(usual, far))
        scale = errors.scale()
        assert scale[FAMILY] == pytest.approx(alone, rel=0.1)
        weights = errors.weights(scale)
        assert weights[-1] < 0.05 and np.median(weights[:-1]) > 0.7


@given(st.lists(st.floats(1e-3, 1e3), min_size=3, max_size=12), st.floats(1.01, 10.0))
def test_the_typical_ratio_is_one_for_equal_errors_and_falls_with_them(
    sizes: list[float], factor: float
) -> None:
    distances = np.array(sizes)
    before, after = errors_of(factor * distances), errors_of(distances)
    scale = before.scale()
    ratio = typical_error_ratio(after, before, scale)
    assert 1.0 / factor <= ratio < 1.0
    assert typical_error_ratio(before, after, scale) == pytest.approx(1.0 / ratio)
    assert typical_error_ratio(before, before, scale) == 1.0


def test_a_run_that_diverges_only_with_the_judged_model_is_an_infinite_ratio() -> None:
    finite, diverging = errors_of(np.array([1.0, 1.0])), errors_of(np.array([1.0, np.inf]))
    scale = finite.scale()
    assert typical_error_ratio(diverging, finite, scale) == np.inf
    assert typical_error_ratio(diverging, diverging, scale) == 1.0


def test_a_run_that_diverges_only_with_the_reference_does_not_hide_worse_runs() -> None:
    reference = errors_of(np.array([1.0, 2.0, 1.0, np.inf]))
    scale = {FAMILY: 1.0}
    cured = errors_of(np.array([1.0, 2.0, 1.0, 1.0]))
    assert 0.0 < typical_error_ratio(cured, reference, scale) < 1.0
    assert 0.0 < log_likelihood_gain(cured, reference, scale) < np.inf
    worse = errors_of(np.array([50.0, 100.0, 50.0, 1.0]))
    assert typical_error_ratio(worse, reference, scale) > 5.0
    assert log_likelihood_gain(worse, reference, scale) < 0.0
    nothing = errors_of(np.array([np.inf, np.inf]))
    assert typical_error_ratio(errors_of(np.array([1.0, 9.0])), nothing, scale) == 0.0


def test_a_signal_that_only_diverging_runs_have_is_no_unit() -> None:
    other = "heading_rms_rad"
    squares = {FAMILY: np.array([1.0, 1.0, 1.0, np.inf]), other: np.array([0.0, 0.0, 0.0, 4.0])}
    signals = {FAMILY: np.array([2.0, 2.0, 2.0, 2.0]), other: np.array([0.0, 0.0, 0.0, 1.0])}
    scale = RunErrors(squares, signals).scale()
    assert list(scale) == [FAMILY] and np.isfinite(scale[FAMILY])


def test_values_that_were_not_recorded_do_not_count_and_missing_simulations_diverge() -> None:
    recorded = np.array([0.0, 1.0, np.nan, 3.0])
    known = run(np.array([0.1, 0.1, 9.0, 0.1]), recorded)
    diverging = run(np.array([0.1, np.nan, 0.1, 0.1]), recorded)
    found = run_errors([known, diverging], "it")
    assert found.squares[FAMILY][0] == pytest.approx(0.01)
    assert found.squares[FAMILY][1] == np.inf
    assert list(found.signals[FAMILY]) == [1.0, 1.0]
    assert list(found.signals["heading_rms_rad"]) == [0.0, 0.0]


@given(st.integers(0, 10**6))
def test_the_gain_is_the_difference_of_log_densities_of_student_s_t(seed: int) -> None:
    """Density of the t distribution in two dimensions, without its constant factor."""
    rng = np.random.default_rng(seed)
    before, after = rng.uniform(0.1, 9.0, 8), rng.uniform(0.1, 9.0, 8)
    unit = 1.7

    def log_density(distances: Array) -> float:
        return float(np.sum(-0.5 * (NU + 2.0) * np.log1p(distances**2 / (NU * unit**2))))

    gain = log_likelihood_gain(errors_of(after), errors_of(before), {FAMILY: unit})
    assert gain == pytest.approx(log_density(after) - log_density(before), rel=1e-9, abs=1e-9)
    after[0] = np.inf
    lost = log_likelihood_gain(errors_of(after), errors_of(before), {FAMILY: unit})
    assert lost == -np.inf
    before[1] = np.inf  # which another run no longer does
    lost = log_likelihood_gain(errors_of(after), errors_of(before), {FAMILY: unit})
    assert lost == -np.inf
    assert typical_error_ratio(errors_of(after), errors_of(before), {FAMILY: unit}) == np.inf
    before[0] = np.inf
    kept = log_likelihood_gain(errors_of(after), errors_of(before), {FAMILY: unit})
    assert np.isfinite(kept)  # the other runs count, too
