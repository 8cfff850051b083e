"""Textbook L1 blocks against closed forms, published loops, and two adaptive examples integrated
here by RK4."""

from collections.abc import Callable, Sequence
from math import cos, exp, pi, sin, sqrt, tanh
from types import FunctionType
from typing import Any, NamedTuple

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numba import njit
from numpy.typing import ArrayLike

from boatsim.control import adaptive
from boatsim.control.adaptive import (
    Gradient,
    LinearSystem,
    PiecewiseConstant,
    Predictor,
    l1_condition_value,
    l1_norm,
    l1_norm_of_outputs,
    loop_margins,
    project_interval,
    solve_lyapunov,
    step_response,
    uncertainty_to_state_system,
)
from boatsim.errors import BadInput

AM = [[0.0, 1.0], [-1.0, -1.4]]
P = solve_lyapunov(AM)
PB = (float(P[0, 1]), float(P[1, 1]))  # P b with b = (0, 1)


def project_ball(
    theta: Sequence[float], rate: Sequence[float], radius: float, tolerance: float
) -> list[float]:
    """Projection operator: the rate, slowed down outwards so that theta never leaves the ball of
    this radius."""
    square = sum(t * t for t in theta)
    along = sum(t * y for t, y in zip(theta, rate, strict=True))
    share = adaptive.projection_factor(square, along, radius, tolerance)
    return [y - share * t for t, y in zip(theta, rate, strict=True)]


# The blocks themselves


def test_lyapunov_matrix_of_the_example() -> None:
    assert pytest.approx(np.array([[1.41428571, 0.5], [0.5, 0.71428571]]), abs=1e-8) == P


def test_lyapunov_equation_holds_for_any_weight() -> None:
    a, q = (
        np.array([[-1.0, 3.0, 0.2], [0.0, -2.0, 1.0], [-0.5, 0.0, -0.7]]),
        np.diag([1.0, 2.0, 5.0]),
    )
    p = solve_lyapunov(a, q)
    assert a.T @ p + p @ a == pytest.approx(-q, abs=1e-12)


vectors = st.lists(st.floats(-10.0, 10.0), min_size=3, max_size=3)


@given(theta=vectors, rate=vectors, true=vectors)
def test_projection_never_works_against_the_truth(
    theta: list[float], rate: list[float], true: list[float]
) -> None:
    radius, tolerance = 12.0, 0.1
    inner = radius / sqrt(1.0 + tolerance)
    wanted = np.array(true) * min(1.0, inner / max(float(np.linalg.norm(true)), 1e-9))
    change = np.array(project_ball(theta, rate, radius, tolerance)) - rate
    assert (np.array(theta) - wanted) @ change <= 1e-9
    if np.linalg.norm(theta) <= inner:
        assert not change.any()


@given(rate=vectors, direction=vectors)
def test_projection_lets_nothing_out_of_the_ball(rate: list[float], direction: list[float]) -> None:
    size = float(np.linalg.norm(direction))
    theta = [2.0, 0.0, 0.0] if size < 1e-6 else [2.0 * d / size for d in direction]
    assert np.dot(theta, project_ball(theta, rate, 2.0, 0.1)) <= 1e-9


def test_estimate_under_a_lasting_push_ends_on_the_bound_itself() -> None:
    """Without the factor (1 + tolerance) it would end on sqrt(1 + tolerance) times the bound."""
    ball, interval = np.zeros(2), Gradient(1.0, low=0.25, high=5.0, gain=10.0)
    for _ in range(4000):
        ball += 1e-3 * 10.0 * np.array(project_ball(list(ball), [3.0, 4.0], 5.0, 0.1))
        interval.step(1.0, error=1.0, dt=1e-3)
    assert ball == pytest.approx([3.0, 4.0], abs=1e-6)
    assert interval.value == pytest.approx(0.25, abs=1e-6)


def test_a_step_too_long_for_the_gain_stays_inside_the_bounds() -> None:
    interval = Gradient(1.0, low=0.25, high=5.0, gain=1e6)
    assert interval.step(1.0, error=-1.0, dt=0.1) == 5.0


def test_interval_is_a_ball_about_its_middle() -> None:
    for value in (0.25, 0.4, 2.0, 4.9, 5.0):
        expected = project_ball([value - 2.625], [7.0], 2.375, 0.1)[0]
        assert project_interval(value, 7.0, 0.25, 5.0, 0.1) == pytest.approx(expected)


def test_predictor_is_exact_for_a_held_drive() -> None:
    predictor = Predictor(a=1.4, b0=0.5, period=0.3, xh=0.2)
    predictor.predict(3.0)
    assert predictor.xh == pytest.approx(0.2 * exp(-0.42) + 1.5 / 1.4 * (1.0 - exp(-0.42)))


def test_piecewise_constant_constants_of_the_water_jet_paper() -> None:
    """Theisen, Galeazzi, Blanke, eq 12: T_n 1.67 s, 0.1 s gives f22 0.9418773, g2 0.0970649."""
    law = PiecewiseConstant(a=1.0 / 1.67, b0=1.0, period=0.1)
    assert (law.decay, law.gain) == pytest.approx((0.9418773, 0.0970649), abs=5e-8)


def test_sigma_reads_a_lasting_disturbance_after_one_period() -> None:
    """Deadbeat: sigma = e^{-aT} d from the first sample on, whatever is applied; with d = 0 it stays 0."""
    for disturbance in (0.0, 0.7):
        boat, law = Predictor(1.4, 0.5, 0.08), PiecewiseConstant(1.4, 0.5, 0.08)
        for applied in (0.0, 2.0, -1.0, 0.3):
            law.predict(applied)
            assert law.adapt(boat.predict(applied + disturbance)) == pytest.approx(
                exp(-0.112) * disturbance, abs=1e-12
            )


# L1 norm


@pytest.mark.parametrize(("sigma", "omega"), [(0.7, 0.714), (0.05, 3.0), (20.0, 1.0)])
def test_l1_norm_of_a_damped_oscillation(sigma: float, omega: float) -> None:
    """Integral of |e^{-sigma t} sin(omega t)| / omega = coth(pi sigma / 2 omega) / (sigma^2 + omega^2)."""
    a = np.array([[0.0, 1.0], [-(sigma**2) - omega**2, -2.0 * sigma]])
    system = LinearSystem(a, np.array([[0.0], [1.0]]), np.array([[1.0, 0.0]]))
    closed = 1.0 / tanh(pi * sigma / (2.0 * omega)) / (sigma**2 + omega**2)
    assert l1_norm(system) == pytest.approx(closed, rel=1e-9)


def test_l1_norm_adds_inputs_and_takes_the_largest_output() -> None:
    system = LinearSystem(np.diag([-2.0, -5.0]), np.array([[1.0, 3.0], [0.0, -1.0]]), np.eye(2))
    assert l1_norm_of_outputs(system) == pytest.approx([4.0 / 2.0, 1.0 / 5.0])
    assert l1_norm(system) == pytest.approx(2.0)


def test_l1_norm_of_a_double_pole() -> None:
    """The low-pass as fast as the model: s/(s + 2)^2, integral of |1 - 2 t| e^{-2t} = 1/e."""
    assert l1_norm(uncertainty_to_state_system([[-2.0]], [1.0], 2.0)) == pytest.approx(
        exp(-1.0), rel=1e-6
    )


def test_l1_norm_of_an_unstable_system_is_refused() -> None:
    with pytest.raises(BadInput, match="stable"):
        l1_norm(uncertainty_to_state_system([[0.1]], [1.0], 2.0))


def test_l1_norms_of_example_a() -> None:
    """A box of +-10 for both unknowns has |th1| + |th2| up to 20."""
    assert l1_norm_of_outputs(uncertainty_to_state_system(AM, (0.0, 1.0), 160.0)) == pytest.approx(
        [0.006008, 0.014740], abs=5e-7
    )
    for bandwidth, value, digit in (
        (160.0, 0.2948, 5e-5),
        (60.0, 0.756, 5e-4),
        (30.0, 1.437, 5e-4),
    ):
        found = l1_condition_value(
            l1_norm(uncertainty_to_state_system(AM, (0.0, 1.0), bandwidth)), 20.0
        )
        assert found == pytest.approx(value, abs=digit)


def test_l1_condition_of_the_water_jet_cruise_control() -> None:
    """Svendsen, Holck, Galeazzi, Blanke, Fig 8: slope 1.7716 1/s, input gain 0.1: k > 12.1 (12.2 in
    print)."""

    def condition(k: float) -> float:
        return l1_condition_value(
            l1_norm(uncertainty_to_state_system([[-1.4]], [1.0], 0.1 * k)), 1.7716
        )

    assert condition(12.04) > 1.0 > condition(12.14)
    assert condition(35.0) == pytest.approx(0.55, abs=5e-3)


# Loop margins


@pytest.mark.parametrize(("k", "delay"), [(2.0, 0.1), (0.5, 1.0), (10.0, 0.0)])
def test_margins_of_an_integrator_with_delay(k: float, delay: float) -> None:
    found = loop_margins(lambda s: k * np.exp(-delay * s) / s)
    assert (found.crossover, found.phase) == pytest.approx((k, pi / 2.0 - k * delay), rel=1e-9)
    assert found.stable
    assert found.delay == pytest.approx(pi / 2.0 / k - delay, rel=1e-9)


def test_a_loop_past_its_margin_is_called_unstable() -> None:
    def resonant(
        s: Any, delay: float
    ) -> Any:  # crosses 1 three times; the last crossover is the tight one
        return 0.4 * np.exp(-delay * s) * (1.0 + 0.3 * s**2 / (s**2 + 0.1 * s + 9.0)) / s

    margin = loop_margins(lambda s: resonant(s, 0.0))
    assert margin.stable and margin.crossover > 2.9
    assert loop_margins(lambda s: resonant(s, 0.99 * margin.delay)).stable
    past = loop_margins(lambda s: resonant(s, 1.01 * margin.delay))
    assert not past.stable and past.delay == 0.0


def jet_loops() -> dict[str, Callable[[Any], Any]]:
    """Loops of the sampled water-jet heading control, cut at the yaw acceleration (Theisen, eq 12,
    Table B.1)."""
    f, g, f12, g1 = 0.9418773, 0.0970649, -0.0970649, -0.0049017

    def pd(z: Any) -> Any:
        return -(0.5 * (f12 * g / (z - f) + g1) / (z - 1.0) - 0.7 * g / (z - f))

    def l1(z: Any) -> Any:
        c = 7.830e-4 * (z + 0.9789) / (z**2 - 1.93722 * z + 0.93877)
        return (pd(z) + c * f / g * (1.0 - f / z) * g / (z - f)) / (1.0 - c * f / z)

    return {"pd": lambda s: pd(np.exp(0.1 * s)), "l1": lambda s: l1(np.exp(0.1 * s))}


@pytest.mark.parametrize(
    ("name", "crossover", "phase_deg", "delay"),
    [("pd", 0.755, 82.8, 1.92), ("l1", 0.759, 67.6, 1.56)],
)
def test_margins_of_sampled_loops(
    name: str, crossover: float, phase_deg: float, delay: float
) -> None:
    found = loop_margins(jet_loops()[name], high=pi / 0.1)
    assert found.crossover == pytest.approx(crossover, abs=5e-4)
    assert np.degrees(found.phase) == pytest.approx(phase_deg, abs=0.05)
    assert found.delay == pytest.approx(delay, abs=6e-3)


# Examples A and B: state = plant (2), predictor (2), reference system (2), ideal model (2), u,
# reference u, estimates


def compiled(block: Any, **replaced: Any) -> Any:
    """A block of boatsim.control.adaptive compiled as it stands, calling the compiled forms of the
    blocks it calls."""
    return njit(FunctionType(block.__code__, block.__globals__ | replaced))


ball_share = compiled(adaptive.projection_factor)
interval = compiled(adaptive.project_interval, projection_factor=ball_share)


class Figures(NamedTuple):
    """What a run is judged by."""

    prediction: float  # largest |xh - x|
    to_reference: float  # largest distance of the output to that of the reference system
    to_ideal: float
    to_ideal_rms: float
    u_low: float
    u_high: float
    estimate: float  # largest absolute estimate


@njit
def second_order(s: Any, i: int, drive: float, ds: Any) -> None:
    ds[i] = s[i + 1]
    ds[i + 1] = -s[i] - 1.4 * s[i + 1] + drive


@njit
def example_a(t: float, s: Any, p: Any, ds: Any) -> None:
    r, gain = p[0] * cos(p[1] * t), p[2]
    x1, x2, u, a, b = s[0], s[1], s[8], s[10], s[11]
    error = (s[2] - x1) * PB[0] + (s[3] - x2) * PB[1]
    share = ball_share(a * a + b * b, -(a * x1 + b * x2) * error, sqrt(200.0), 0.1)
    ds[10], ds[11] = gain * (-x1 * error - share * a), gain * (-x2 * error - share * b)
    second_order(s, 0, u + 4.0 * x1 - 4.5 * x2, ds)
    second_order(s, 2, u + a * x1 + b * x2, ds)
    second_order(s, 4, s[9] + 4.0 * s[4] - 4.5 * s[5], ds)
    second_order(s, 6, r, ds)
    ds[8] = 160.0 * (r - a * x1 - b * x2 - u)
    ds[9] = 160.0 * (r - 4.0 * s[4] + 4.5 * s[5] - s[9])


@njit
def example_b(t: float, s: Any, p: Any, ds: Any) -> None:
    r, gain = cos(2.0 * t / pi), p[2]
    th1, th2, sigma = 2.0 + cos(pi * t), 2.0 + 0.3 * sin(pi * t) + 0.2 * cos(2.0 * t), sin(pi * t)
    x1, x2, u, a, b, w, g = s[0], s[1], s[8], s[10], s[11], s[12], s[13]
    error = (s[2] - x1) * PB[0] + (s[3] - x2) * PB[1]
    ds[10] = gain * interval(a, -x1 * error, -10.0, 10.0, 0.1)
    ds[11] = gain * interval(b, -x2 * error, -10.0, 10.0, 0.1)
    ds[12] = gain * interval(w, -u * error, 0.25, 5.0, 0.1)
    ds[13] = gain * interval(g, -error, -10.0, 10.0, 0.1)
    believed, known = w * u + a * x1 + b * x2 + g, s[9] + th1 * s[4] + th2 * s[5] + sigma
    second_order(s, 0, u + th1 * x1 + th2 * x2 + sigma, ds)
    second_order(s, 2, believed, ds)
    second_order(s, 4, known, ds)
    second_order(s, 6, r, ds)
    ds[8] = -60.0 * (believed - r)
    ds[9] = -60.0 * (known - r)


@njit
def run(rates: Any, state: Any, p: Any, duration: float, dt: float) -> Any:
    """Classical RK4 of fixed step."""
    n, s, k = round(duration / dt), state.copy(), np.zeros((4, len(state)))
    prediction = far = ideal = square = low = high = estimate = 0.0
    for i in range(n):
        t = i * dt
        rates(t, s, p, k[0])
        rates(t + 0.5 * dt, s + 0.5 * dt * k[0], p, k[1])
        rates(t + 0.5 * dt, s + 0.5 * dt * k[1], p, k[2])
        rates(t + dt, s + dt * k[2], p, k[3])
        s += dt / 6.0 * (k[0] + 2.0 * k[1] + 2.0 * k[2] + k[3])
        prediction = max(prediction, sqrt((s[2] - s[0]) ** 2 + (s[3] - s[1]) ** 2))
        far, ideal = max(far, abs(s[0] - s[4])), max(ideal, abs(s[0] - s[6]))
        square += (s[0] - s[6]) ** 2
        low, high = min(low, s[8]), max(high, s[8])
        estimate = max(estimate, np.max(np.abs(s[10:])))
    return prediction, far, ideal, sqrt(square / n), low, high, estimate


def figures_a(amplitude: float, omega: float, duration: float, dt: float) -> Figures:
    return Figures(*run(example_a, np.zeros(12), np.array([amplitude, omega, 1e4]), duration, dt))


def figures_b(gain: float, duration: float, dt: float) -> Figures:
    start = np.zeros(14)
    start[12] = 1.0  # the input gain is believed to be 1
    return Figures(*run(example_b, start, np.array([0.0, 0.0, gain]), duration, dt))


def test_compiled_rates_are_the_gradient_laws() -> None:
    """At a state beyond the inner ball and the inner intervals, where the projections act."""
    s, ds = np.zeros(14), np.zeros(14)
    s[:4], s[8], s[10:] = (1.0, -2.0, 1.5, -1.0), -3.0, (-9.9, 9.8, 4.95, -9.7)
    error = float((s[2:4] - s[:2]) @ PB)
    example_b(0.0, s, np.array([0.0, 0.0, 1e5]), ds)
    pairs = zip(
        s[10:],
        (1.0, -2.0, -3.0, 1.0),
        ((-10.0, 10.0), (-10.0, 10.0), (0.25, 5.0), (-10.0, 10.0)),
        strict=True,
    )
    laws = [
        Gradient(value, low, high, 1e5).projected_rate(regressor, error)
        for value, regressor, (low, high) in pairs
    ]
    assert ds[10:] == pytest.approx(laws)
    example_a(0.0, s, np.array([1.0, 0.0, 1e4]), ds)
    wanted = [-error, 2.0 * error]
    projected = project_ball([-9.9, 9.8], wanted, sqrt(200.0), 0.1)
    assert ds[10:12] == pytest.approx([1e4 * y for y in projected])
    assert projected != pytest.approx(wanted)


def reference_system(
    am: ArrayLike, b: ArrayLike, theta: ArrayLike, bandwidth: float
) -> LinearSystem:
    """The loop with every unknown known: x' = Am x + b (u + theta'x), u = C(s)(r - theta'x), from r to (x, u).

    Am (n, n) [1/s], b (n,), theta (n,), bandwidth [rad/s]: what the adaptive loop tends to as its gain grows.
    """
    a, column = np.asarray(am, dtype=float), np.asarray(b, dtype=float).reshape(-1, 1)
    row, n = np.asarray(theta, dtype=float).reshape(1, -1), len(a)
    whole = np.block([[a + column @ row, column], [-bandwidth * row, np.array([[-bandwidth]])]])
    return LinearSystem(whole, np.vstack([np.zeros((n, 1)), [[bandwidth]]]), np.eye(n + 1))


def test_reference_system_of_example_a() -> None:
    system, dt = reference_system(AM, (0.0, 1.0), (4.0, -4.5), 160.0), 1e-4
    poles = sorted(np.linalg.eigvals(system.a), key=lambda pole: (pole.real, pole.imag))
    assert poles == pytest.approx([-164.56296, -0.66852 - 0.72481j, -0.66852 + 0.72481j], abs=5e-6)
    y, _, u = step_response(system, dt, 200_000).T
    assert y[[10_000, 20_000, 50_000]] == pytest.approx([0.300213, 0.725673, 1.046568], abs=5e-7)
    assert (y.max(), y.argmax() * dt) == pytest.approx((1.055154, 4.3405), abs=1e-4)
    assert y.max() == pytest.approx(1.055154, abs=5e-7)
    assert (np.argmax(y >= 0.9) - np.argmax(y >= 0.1)) * dt == pytest.approx(2.0900, abs=1e-4)
    assert np.flatnonzero(abs(y - 1.0) > 0.02)[-1] * dt == pytest.approx(6.0983, abs=1.5e-4)
    assert u[-1] == pytest.approx(-3.0, abs=1e-4)


def test_ideal_model_of_example_a() -> None:
    ideal = LinearSystem(np.array(AM), np.array([[0.0], [1.0]]), np.array([[1.0, 0.0]]))
    y = step_response(ideal, 1e-4, 150_000)[:, 0]
    reference = step_response(reference_system(AM, (0.0, 1.0), (4.0, -4.5), 160.0), 1e-4, 150_000)[
        :, 0
    ]
    assert y.max() == pytest.approx(1.045988, abs=5e-7)
    assert y.argmax() * 1e-4 == pytest.approx(4.3991, abs=1e-4)
    assert abs(y - reference).max() <= 0.0100925


@pytest.mark.parametrize(
    ("step", "dt", "within", "prediction"),
    [(25.0, 5e-5, 5.7e-5, 0.0526), (100.0, 2e-5, 6.7e-6, 0.0529), (400.0, 5e-6, 8e-7, 0.0531)],
)
def test_steps_of_example_a_scale_uniformly(
    step: float, dt: float, within: float, prediction: float
) -> None:
    found = figures_a(step, 0.0, 12.0, dt)
    assert found.to_reference / step <= within
    assert found.prediction == pytest.approx(prediction, abs=5e-5)
    assert found.estimate < sqrt(200.0)


def test_step_of_one_in_example_a_is_worse() -> None:
    """The adaptation learns from the state alone, so a small step takes it longer."""
    assert figures_a(1.0, 0.0, 12.0, 1e-4).to_reference == pytest.approx(7.1e-3, abs=5e-5)


def test_cosine_of_example_a() -> None:
    found = figures_a(100.0, 0.2, 40.0, 2e-5)
    assert found.to_reference <= 6.7e-4
    assert found.to_ideal == pytest.approx(1.054, abs=5e-4)


@pytest.mark.parametrize(
    ("gain", "prediction", "within"), [(1e5, 1.0832e-4, 2.649e-5), (1e4, 1.1203e-3, 2.662e-4)]
)
def test_first_8_s_of_example_b(gain: float, prediction: float, within: float) -> None:
    found = figures_b(gain, 8.0, 2e-5)
    assert found.prediction == pytest.approx(prediction, rel=5e-5)
    assert found.to_reference == pytest.approx(within, rel=2.5e-4)


@pytest.mark.parametrize("dt", [1e-5, 2e-5, 5e-5])
def test_20_s_of_example_b(dt: float) -> None:
    found = figures_b(1e5, 20.0, dt)
    assert found.to_reference <= 2.7445e-5
    assert found.to_ideal <= 0.01975
    assert found.to_ideal_rms == pytest.approx(0.00987, abs=5e-6)
    assert (found.u_low, found.u_high) == pytest.approx((-2.6243, 2.7407), abs=5e-5)
    assert found.prediction <= 0.0028  # the late burst: bounded, different for every step
    assert found.estimate < 10.0


@pytest.mark.slow
def test_20_s_of_example_b_with_a_tenth_of_the_gain() -> None:
    found = figures_b(1e4, 20.0, 1e-5)
    assert found.prediction == pytest.approx(
        0.0067, abs=1e-4
    )  # a burst again: 0.00674 to 0.00684 by step
    assert found.to_reference <= 2.7495e-4
    assert found.to_ideal == pytest.approx(0.0199, abs=5e-5)
    assert found.to_reference / figures_b(1e5, 20.0, 2e-5).to_reference == pytest.approx(
        10.0, abs=0.1
    )
