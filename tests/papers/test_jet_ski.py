"""The high-speed water-jet craft of Svendsen et al.

against its printed equations and checked numbers of its loops.
"""

from itertools import pairwise
from math import exp, radians, sqrt

import numpy as np
import pytest
from jet_craft import STEERING, Craft, power, solved

from boatsim.control.adaptive import l1_norm, project_interval, uncertainty_to_state_system
from boatsim.control.adaptive_loop import (
    adapt_estimates,
    adapt_loop,
    compute_loop_input,
    initialise_loop,
    loop_memory_type,
    low_pass_control_input,
    make_loop_design,
    project_rate,
)
from boatsim.control.jet import JET_Q2, power_at_throttle, throttle_for_power
from boatsim.physics import vessel
from boatsim.physics.base import Force, SignalSegment, Wrench, make_motion, segment_mean
from boatsim.physics.content import load_class, shipped_content_names
from boatsim.physics.effects.jet_steering import JetSteering
from boatsim.physics.effects.nomoto_yaw import NomotoYaw
from boatsim.physics.effects.push import Push
from boatsim.physics.effects.rate_limit import RateLimit
from boatsim.physics.effects.roll_coupling import RollCoupling
from boatsim.physics.effects.steering_offset import SteeringAsymmetry
from boatsim.physics.effects.water_jet import WaterJet
from boatsim.physics.signals import motion_signals
from boatsim.simulate import scenario
from boatsim.simulate.batch import Batch
from boatsim.simulate.engine import Engine, State
from boatsim.simulate.evaluation import requested_metrics
from boatsim.simulate.run import run

CRAFT = vessel.load_vessel(
    "jet_ski", settings={"throttle_rate_limit": {"rate": 1e6}, "servo": {"rate": 1e3}}
)
MASS, ROLL, YAW = CRAFT.body.mass, CRAFT.body.roll_inertia, CRAFT.body.yaw_inertia


# ---- effects


@pytest.mark.parametrize(
    ("throttle", "wanted"), [(1.0, 0.80), (2.0, 12.90), (4.0, 194.9), (7.0, 224.9)]
)
def test_power_curve_has_the_published_corners(throttle: float, wanted: float) -> None:
    jet = WaterJet(mass=1.0)
    for h in (throttle - 1e-9, throttle):  # both sides
        assert jet.wrench(make_motion(u=2.0), throttle=h).X * 2.0 == pytest.approx(wanted, abs=1e-6)


def test_power_rises_with_the_throttle_and_its_inverse_gives_the_throttle_back() -> None:
    throttles = np.linspace(1.0, 7.0, 601).tolist()
    powers = [power_at_throttle(h, JET_Q2) for h in throttles]
    assert all(a < b for a, b in pairwise(powers))
    assert [throttle_for_power(x, JET_Q2) for x in powers] == pytest.approx(throttles)
    assert powers == pytest.approx([power(h) for h in throttles])
    assert (throttle_for_power(-5.0, JET_Q2), throttle_for_power(1e3, JET_Q2)) == (1.0, 7.0)


def test_printed_q2_makes_the_power_jump_at_4() -> None:
    jump = [
        WaterJet(mass=1.0, q2=164.5).wrench(make_motion(u=1.0), throttle=h).X
        for h in (4.0 - 1e-9, 4.0)
    ]
    assert jump[1] - jump[0] == pytest.approx(9.6, abs=1e-5)


def test_thrust_rises_no_more_below_half_a_metre_a_second() -> None:
    slow = [
        WaterJet(mass=1.0).wrench(make_motion(u=u), throttle=1.0).X for u in (-1.0, 0.0, 0.5, 1.0)
    ]
    assert slow == pytest.approx([1.6, 1.6, 1.6, 0.8])


def test_sway_roll_and_yaw_of_the_craft_are_the_printed_matrix() -> None:
    jet, m = 0.15, make_motion(u=20.0, v=-0.7, p=0.3, r=0.5, phi=0.2)
    seen = {"angle": jet, "throttle": 3.0, "bucket": 0.0}
    forces = [e for e in CRAFT.effects if isinstance(e, Force)]
    total = np.sum(
        [e.wrench(m, **{role: seen[role] for role in type(e).roles}) for e in forces], axis=0
    )
    accelerations = total[1] / MASS - m.u * m.r, total[3] / ROLL, total[5] / YAW
    assert accelerations == pytest.approx(STEERING @ [m.v, m.p, m.r, m.phi, jet], rel=1e-9)


def test_roll_coupling_and_jet_are_linear() -> None:
    coupling = RollCoupling(sway_by_roll=2.0, yaw_by_roll=-3.0, roll_by_sway=4.0, roll_by_yaw=5.0)
    felt = coupling.wrench(make_motion(v=0.1, p=0.2, r=-0.3))
    assert felt == pytest.approx(Wrench(Y=-0.4, K=-0.4 + 1.5, N=0.6))
    jet = JetSteering(sway=-2.0, roll=3.0, yaw=4.0)
    assert jet.wrench(make_motion(), angle=-0.1) == pytest.approx(Wrench(Y=0.2, K=-0.3, N=-0.4))


def test_first_order_yaw_changes_in_a_straight_line() -> None:
    law = NomotoYaw(
        gain=1.0,
        gain_later=4.0,
        time_constant=1.5,
        time_constant_later=0.5,
        duration=40.0,
        inertia=2.0,
    )
    for t, gain, lag in ((0.0, 1.0, 1.5), (20.0, 2.5, 1.0), (50.0, 4.0, 0.5)):
        assert law.wrench(make_motion(t=t, r=0.2), angle=0.1).N == pytest.approx(
            2.0 * (gain * 0.1 - 0.2) / lag
        )


def test_a_push_begins_and_ends() -> None:
    push, there = (
        Push(surge=1.0, sway=2.0, yaw=3.0, begin=5.0, end=15.0),
        Wrench(X=1.0, Y=2.0, N=3.0),
    )
    assert [push.wrench(make_motion(t=t)) for t in (4.9, 5.0, 14.9, 15.0)] == [
        Wrench(),
        there,
        there,
        Wrench(),
    ]


def test_throttle_follows_a_ramp_and_its_mean_is_exact() -> None:
    memory, limit, full = np.zeros(1), RateLimit(rate=3.0).values(), SignalSegment(1.0, 1.0, 1.0)
    courses = [RateLimit.transform_signal(full, 0.0, 0.0, memory, 0, 0.2, limit) for _ in range(3)]
    assert [segment_mean(c) for c in courses] == pytest.approx(
        [0.3, 1.0 - 0.5 * 0.4 * (0.4 / 3.0) / 0.2, 1.0]
    )
    assert [(c.begin, c.end) for c in courses] == [
        (0.0, pytest.approx(0.6)),
        (pytest.approx(0.6), 1.0),
        (1.0, 1.0),
    ]


def test_asymmetric_steering_is_even_in_the_angle() -> None:
    values = SteeringAsymmetry(gain=0.05).values()
    held = [SignalSegment(x, x, x) for x in (0.2, -0.2)]
    right, left = (
        SteeringAsymmetry.transform_signal(x, 0.0, 0.0, np.zeros(1), 0, 0.1, values) for x in held
    )
    assert right == pytest.approx([0.21] * 3) and left == pytest.approx([-0.19] * 3)


@pytest.mark.parametrize(("u", "kappa"), [(2.0, 0.2), (14.0, 0.5), (35.0, 1.0)])
def test_kappa_scales_the_whole_surge_acceleration(u: float, kappa: float) -> None:
    lag = CRAFT.effect("planing_lag")
    assert lag is not None
    m = make_motion(u=u, v=-0.4, r=0.5)
    others = Wrench(X=1000.0, Y=20.0, K=3.0, N=4.0)
    answer = type(lag).reaction(m, others, lag.values())  # type: ignore[attr-defined]
    before = others.X / MASS + m.v * m.r
    assert (others.X + answer.X) / MASS + m.v * m.r == pytest.approx(kappa * before)
    assert answer == Wrench(X=answer.X)


# ---- the craft


@pytest.mark.parametrize(
    ("throttle", "jet"), [(1.0, 0.0), (4.0, radians(15.0)), (7.0, radians(-8.0))]
)
def test_engine_and_twin_follow_an_integration_of_the_printed_equations(
    throttle: float, jet: float
) -> None:
    names = ("x", "y", "psi", "phi", "u", "v", "p", "r")
    start = dict(zip(names, (0.0, 0.0, 0.3, 0.05, 20.0, 0.2, 0.1, -0.1), strict=True))
    truth = solved(Craft(), throttle, jet, np.array(list(start.values())), np.array([0.0, 10.0]))[
        -1
    ]
    engine = Engine(CRAFT, step=0.01)
    engine.reset(State(**start), {"throttle": throttle, "jet_rad": jet})
    engine.advance(1000)
    s = engine.state
    assert [getattr(s, n) for n in names] == pytest.approx(truth.tolist(), abs=1e-6)
    compiled = Batch(CRAFT, step=0.01)
    rows = np.tile(compiled.program.command_array({"throttle": throttle, "jet_rad": jet}), (100, 1))
    ours = [signal.symbol for signal in motion_signals(CRAFT.dof)]
    end = compiled.rollout([start[n] for n in ours], rows, 0.1)[-1]
    assert end == pytest.approx([getattr(s, n) for n in ours], abs=1e-8)


def test_eigenvalues_of_the_steering_are_the_published_ones() -> None:
    whole = np.vstack(
        [np.insert(STEERING[:, :4], 4, 0.0, axis=1), [0, 1, 0, 0, 0], [0, 0, 1, 0, 0]]
    )
    poles = sorted(np.linalg.eigvals(whole), key=lambda z: (z.real, z.imag))
    assert poles[0] == pytest.approx(-0.674 - 1.256j, abs=1e-3) and poles[2] == pytest.approx(
        -0.314 - 0.228j, abs=1e-3
    )


# ---- the loops


def test_compiled_projection_is_the_textbook_one() -> None:
    for value, rate in ((0.3, 2.0), (0.98, 2.0), (0.98, -2.0), (-0.99, -3.0), (1.0, 1.0)):
        assert project_rate(value, rate, -1.0, 1.0) == pytest.approx(
            project_interval(value, rate, -1.0, 1.0, 0.1)
        )


@pytest.mark.slow
def test_adaptive_loop_equals_the_textbook_example_with_a_known_reference_system() -> None:
    """theta (4, -4.5) unknown, C = 160/(s + 160), a step of 25: the known reference system gives y(1), y(2), y(5)."""
    am = [[0.0, 1.0], [-1.0, -1.4]]
    design = make_loop_design(
        am,
        (-10, -10, -1e-9, 1 - 1e-9),
        (10, 10, 1e-9, 1 + 1e-9),
        (0, 0, 0, 1),
        gain=1e4,
        bandwidth=160.0,
        period=2e-4,
        step=2e-5,
    )
    loop, of = np.zeros(1, loop_memory_type(2)).view(np.recarray)[0], design.view(np.recarray)[0]
    x, a, seen, u = np.zeros(2), np.array([[0.0, 1.0], [3.0, -5.9]]), {}, 0.0
    initialise_loop(loop, of, 0.0)
    for i in range(25001):
        if i in (5000, 10000, 25000):
            seen[i // 5000] = x[0] / 25.0
        if i:
            loop.after[:] = x
            adapt_loop(loop, of, u)
        u = compute_loop_input(loop, of, 25.0, -1e6, 1e6, 1e9)
        for _ in range(4):
            half = x + 2.5e-5 * (a @ x + [0.0, u])
            x = x + 5e-5 * (a @ half + [0.0, u])
    assert [seen[1], seen[2], seen[5]] == pytest.approx([0.300213, 0.725673, 1.046568], abs=3e-3)


def test_filter_of_the_input_is_the_first_order_low_pass() -> None:
    mean, end = low_pass_control_input(0.0, -3.0, 2.0, 5.0, -10.0, 10.0, 1e9, 0.1, 10000)
    assert end == pytest.approx(1.5 * (1.0 - exp(-1.0)), rel=1e-4)
    assert mean == pytest.approx(1.5 * (1.0 - (1.0 - exp(-1.0))), rel=1e-4)
    assert low_pass_control_input(0.0, -3.0, 2.0, 5.0, -10.0, 0.2, 1e9, 0.1, 100)[1] == 0.2
    assert low_pass_control_input(0.0, -3.0, 2.0, 5.0, -10.0, 10.0, 0.5, 0.1, 100)[
        1
    ] == pytest.approx(0.05)


def test_predictor_told_the_truth_learns_nothing() -> None:
    estimates, predicted = np.array([0.5, 0.2, 2.0]), np.array([1.0])
    x1 = 1.0 + 0.01 * (-1.4 + 0.5 + 0.2 + 2.0 * 0.3)  # one sub-step: exact
    adapt_estimates(
        predicted,
        estimates,
        np.full(3, -9.0),
        np.full(3, 9.0),
        1e4,
        np.array([[-1.4]]),
        np.array([0.357]),
        np.zeros(1),
        np.arange(3),
        np.array([1.0]),
        np.array([x1]),
        0.3,
        0.01,
        1,
        np.zeros(3),
        np.zeros(1),
    )
    assert estimates.tolist() == pytest.approx([0.5, 0.2, 2.0], abs=1e-9)


def condition(bandwidth: float) -> float:
    """L1-norm condition of the cruise control in closed form: twice the peak of the step response,
    times the slope."""
    p, q = 1.4, 0.1 * bandwidth
    t = np.log(p / q) / (p - q)
    return float(2.0 * (exp(-q * t) - exp(-p * t)) / (p - q) * 1.7716)


def test_l1_norm_condition_of_the_cruise_control() -> None:
    cruise = load_class("controller", "l1_cruise")
    at = {k: cruise(bandwidth=k).l1_condition() for k in (11.9, 12.3, 35.0)}
    assert at[11.9] > 1.0 > at[12.3]  # threshold 12.1 +- 0.2, published 12.2
    assert at[35.0] == pytest.approx(0.55, abs=0.01)
    assert [at[k] for k in at] == pytest.approx([condition(k) for k in at], rel=1e-6)
    assert l1_norm(uncertainty_to_state_system([[-1.4]], [1.0], 3.5)) * 1.7716 == pytest.approx(
        at[35.0]
    )


NAMES = [name for name in shipped_content_names("scenario") if name.startswith("jet_ski/")]


@pytest.mark.slow
def test_staircase_first_four_steps_are_alike_and_the_last_saturates() -> None:
    found = requested_metrics(run(scenario.load("jet_ski/staircase"), 0))
    times = [float(found[f"time_95_{i}"].value or 0.0) for i in range(1, 6)]
    assert max(times[:4]) < 2.2 and max(times[:4]) - min(times[:4]) < 0.15 * max(times[:4])
    assert times[4] > 1.3 * np.mean(times[:4]) and float(found["end_error"].value or 0.0) < 0.01


@pytest.mark.slow
def test_a_control_step_ten_times_finer_changes_no_time_of_the_staircase() -> None:
    found = []
    for period in (0.002, 0.0005):
        base = scenario.load("jet_ski/staircase").file
        overrides = {
            "controller": base.controller | {"period": period},
            "step": period,
            "duration": 20.0,
            "goal": [dict(g) for g in base.goal[:2]],
        }
        found.append(
            requested_metrics(run(scenario.load("jet_ski/staircase", overrides), 0))[
                "time_95_1"
            ].value
        )
    assert found[0] == pytest.approx(found[1], abs=0.01)


def test_overshoot_of_a_heading_step_is_that_of_the_motion_asked_for() -> None:
    found = requested_metrics(run(scenario.load("jet_ski/heading_step"), 0))
    ideal = 100.0 * exp(-0.7 / sqrt(1.0 - 0.49) * np.pi)
    assert found["overshoot"].value == pytest.approx(ideal, abs=0.5)
