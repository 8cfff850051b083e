"""Water-jet craft at low speed and astern: figures of its specification, closed forms, and loops
written out here."""

from dataclasses import replace
from functools import cache
from math import atan, cos, degrees, exp, log, pi, radians, sqrt
from typing import Any

import numpy as np
import pytest
from alike import few, long
from runs import mean_of
from scipy.signal import cont2discrete

from benchmarks.low_speed_margins import LAWS, control_loop, margins
from boatsim.control.adaptive import zero_order_hold
from boatsim.metrics.crossing import Crossing
from boatsim.metrics.heading_hold import HeadingHold
from boatsim.metrics.step_response import StepResponse
from boatsim.physics import vessel
from boatsim.physics.base import Array, Wrench, make_motion
from boatsim.physics.content import load_class, shipped_content_names
from boatsim.physics.effects.astern_time_constant import AsternTimeConstant
from boatsim.physics.effects.reversing_jet import JetLeak, ReversingJet
from boatsim.physics.effects.yaw_rate_waves import WAVES, YawRateWaves, wave_component
from boatsim.recordings.table import Notes, Recording
from boatsim.simulate import scenario
from boatsim.simulate.engine import Engine, State
from boatsim.simulate.evaluation import Metric, requested_metrics
from boatsim.simulate.run import Run, run

Heading = load_class("controller", "l1_heading_discrete")
ASTERN = 0.9599  # [rad] bucket at 55 deg
T_N, T_S = 1.67, 0.1  # [s]
F22 = exp(-T_S / T_N)
SHIPPED = [n for n in shipped_content_names("scenario") if n.startswith("jet_ski/low_")]


@cache
def finished(name: str) -> Run:
    """A shipped scenario, run once."""
    return run(scenario.load(name), 0)


def done(name: str) -> Recording:
    """Its log."""
    return finished(f"jet_ski/low_{name}").recording


def judged(name: str) -> dict[str, Metric]:
    """Its norms."""
    return requested_metrics(finished(name))


def value(name: str, norm: str) -> float:
    found = judged(f"jet_ski/low_{name}")[norm].value
    assert found is not None
    return found


# ---- the craft


def craft(**settings: dict[str, float]) -> Engine:
    return Engine(vessel.load_vessel("jet_ski", ["low_speed"], settings=settings), step=0.01)


@pytest.mark.parametrize("bucket", [0.0, 0.4, pi / 4, ASTERN])
def test_surge_and_yaw_follow_the_identified_first_order_models(bucket: float) -> None:
    engine = craft(servo={"rate": 1e3}, elevator_servo={"rate": 1e3})
    engine.reset(None, {"elevator_rad": bucket})
    engine.command({"elevator_rad": bucket, "jet_rad": 0.2})
    engine.advance(700)
    s, share = engine.state, cos(2.0 * bucket)
    assert s.u == pytest.approx(2.46 * share * (1.0 - exp(-7.0 / 5.58)), rel=1e-3, abs=1e-9)
    assert s.r == pytest.approx(1.00 * share * 0.2 * (1.0 - exp(-7.0 / T_N)), rel=1e-3, abs=1e-9)
    assert (s.v, s.phi) == pytest.approx((0.0, 0.0), abs=1e-9)  # no drift, however it turns


def test_limits_of_speed_and_turn_ahead_and_astern() -> None:
    found = []
    for bucket in (0.0, ASTERN):
        engine = craft()
        engine.reset(None, {"elevator_rad": bucket, "jet_rad": 0.2618})
        engine.advance(5000)
        found += [engine.state.u, degrees(engine.state.r)]
    assert found == pytest.approx([2.46, 15.0, -0.841, -5.1], abs=0.05)


def test_nozzle_and_bucket_turn_with_30_deg_per_second() -> None:
    engine = craft()
    engine.command({"elevator_rad": ASTERN, "jet_rad": 0.2618})
    engine.advance(40)
    assert engine.actuators["jet_rad"] == pytest.approx(
        radians(30.0) * 0.395, rel=1e-3
    )  # mean over the last step
    assert engine.actuators["elevator_rad"] == pytest.approx(radians(30.0) * 0.395, rel=1e-3)


@pytest.mark.parametrize("beta", [0.0, 0.5, pi / 4, 0.9])
def test_leak_and_time_constant_astern_are_the_nomoto_model_with_another_gain_or_time(
    beta: float,
) -> None:
    own = ReversingJet(thrust=185.0, yaw=275.0)
    m, seen = make_motion(u=-0.5, r=0.1), {"angle": 0.2, "bucket": beta}
    boat = vessel.load_vessel("jet_ski", ["low_speed"])
    leaking: Any = (
        replace(boat, effects=(own,)).with_completed_effect(JetLeak(fraction=0.25)).effects[0]
    )
    share = cos(2 * beta) + 0.25
    assert leaking.wrench(m, **seen) == pytest.approx(
        Wrench(X=185.0 * share, N=275.0 * share * 0.2)
    )
    moment = own.wrench(m, **seen).N - 270.0 * 0.1
    law: Any = AsternTimeConstant.law.py_func
    others = AsternTimeConstant(factor=0.7, yaw=270.0).values(), own.signals(**seen), own.values()
    assert moment + law(m, *others).N == pytest.approx(moment / 0.7)
    assert law(m._replace(ur=0.1), *others).N == 0.0


# ---- waves


def components(sea: YawRateWaves) -> Array:
    """Frequencies [rad/s], amplitudes [rad/s] and phases [rad] of the realisation."""
    return np.array([wave_component.py_func(k, sea) for k in range(WAVES)]).T  # type: ignore[attr-defined]


@pytest.mark.parametrize("frequency", [1.5, 2.5, 4.5])
def test_waves_have_the_autocorrelation_of_the_filter(frequency: float) -> None:
    """White noise through s/(s^2 + 2 l w s + w^2): variance x e^{-l w t} (cos v t - l w / v sin v t), v damped."""
    rms, damping = 0.06, 0.1
    w, size, _ = components(YawRateWaves(rms=rms, frequency=frequency, damping=damping))
    lag = np.linspace(0.0, 8.0 / frequency, 50)
    damped, slope = frequency * sqrt(1.0 - damping**2), damping * frequency
    wanted = np.exp(-slope * lag) * (np.cos(damped * lag) - slope / damped * np.sin(damped * lag))
    found = 0.5 * size**2 @ np.cos(np.outer(w, lag)) / rms**2
    assert found[0] == pytest.approx(1.0)
    assert found == pytest.approx(
        wanted, abs=0.08
    )  # 64 components; white noise has infinitely many


@pytest.mark.parametrize("seed", [0, 7])
def test_hull_in_waves_turns_with_their_yaw_rate(seed: int) -> None:
    waves = {"rms": 0.06, "frequency": 4.5, "damping": 0.1}
    boat = vessel.load_vessel("jet_ski", ["low_speed"], settings={"yaw_rate_waves": waves})
    boat = replace(boat, effects=tuple(e.with_seed(seed) for e in boat.effects))
    sea = boat.effect("yaw_rate_waves")
    assert isinstance(sea, YawRateWaves) and (sea.inertia, sea.drag) == (460.0, 275.45)
    w, size, phases = components(sea)

    def r_w(t: Array) -> Array:
        return np.asarray(np.cos(np.multiply.outer(t, w) + phases) @ size)

    engine = Engine(boat, step=0.01)
    engine.reset(State(r=float(r_w(np.array(0.0)))))
    found = []
    for _ in range(40):
        engine.advance(50)
        found.append(engine.state.r)
    assert found == pytest.approx(r_w(0.5 * np.arange(1, 41)), abs=2e-3 * 0.06)
    assert float(np.std(r_w(np.arange(0.0, 300.0, 0.05)))) == pytest.approx(0.06, rel=0.03)


def test_seed_draws_the_waves_and_still_water_stays_still() -> None:
    sea = YawRateWaves(rms=0.05, inertia=460.0, drag=275.0)
    first, again, other = (sea.with_seed(n).wrench(make_motion(t=3.0)).N for n in (1, 1, 2))
    assert first == again != other
    assert (
        YawRateWaves(rms=0.05, inertia=460.0, realisation=0.0)
        .with_seed(3)
        .wrench(make_motion(t=3.0))
        .N
        == 0.0
    )


# ---- the controller


def test_wave_filter_and_low_pass_are_the_reconstructed_ones() -> None:
    h, c = Heading().make_wave_filter(), Heading().make_low_pass()
    assert h.numerator[1] == pytest.approx(0.2754, abs=1e-4)
    assert [float(f.evaluate(np.array(1.0))) for f in (h, c)] == pytest.approx([1.0, 1.0], abs=1e-3)
    assert np.sort(np.roots(h.denominator)) == pytest.approx([0.22313, 0.49659, 0.87372], abs=1e-5)
    assert np.polymul([0.27545, -0.27545 * 1.55748], [1.0]) == pytest.approx(
        h.numerator[1:3], abs=1e-4
    )
    assert h.numerator[3] == pytest.approx(0.27545 * 0.73678, abs=1e-4)
    assert c.numerator[1:] == pytest.approx([7.830e-4, 7.830e-4 * 0.9789], abs=1e-6)
    assert c.denominator == pytest.approx([1.0, -1.93722, 0.93877], abs=1e-5)


def test_printed_low_pass_is_the_held_integrator_with_a_lag() -> None:
    d = zero_order_hold([1.0], [1.0, 0.640, 0.0], T_S)
    assert d.numerator[1] == pytest.approx(4.894e-3, abs=2e-6)
    assert d.numerator[2] / d.numerator[1] == pytest.approx(
        0.9789, abs=1e-4
    )  # z_1, which the table leaves out
    assert np.roots(d.denominator) == pytest.approx([1.0, 0.938], abs=1e-4)


def test_printed_zeros_of_the_wave_filter_give_a_gain_of_134() -> None:
    h = Heading(filter_as_published=1.0).make_wave_filter()
    assert np.roots(h.numerator[1:]) == pytest.approx([-1.35 + 4.29j, -1.35 - 4.29j], abs=0.01)
    assert float(h.evaluate(np.array(1.0))) == pytest.approx(134.0, abs=1.0)


def test_held_filters_are_those_of_scipy_and_step_as_their_difference_equation() -> None:
    top, bottom = [2.0, 1.0, 3.0], [2.0, 3.0, 4.0, 1.0]
    ours = zero_order_hold(top, bottom, 0.3)
    numerator, denominator, _ = cont2discrete((top, bottom), 0.3)
    assert ours.numerator == pytest.approx(numerator.ravel(), abs=1e-12)
    assert ours.denominator == pytest.approx(denominator, abs=1e-12)
    x, y = [1.0, -0.5, 0.25, 2.0, 0.0, 0.0], [0.0] * 6
    for i in range(6):
        y[i] = sum(ours.numerator[j] * x[i - j] for j in range(4) if i >= j)
        y[i] -= sum(ours.denominator[j] * y[i - j] for j in range(1, 4) if i >= j)
    assert [ours.step(v) for v in x] == pytest.approx(y, abs=1e-12)


def alone(adaptive: bool, pushed: float, steps: int, late: int = 0) -> Array:
    """Headings [rad] of the sampled loop on equations of its own, F and g written out: a step of 20
    deg."""
    f12, g1, g2 = T_N * (1.0 - F22), T_N**2 * (T_S / T_N - 1.0 + F22), T_N * (1.0 - F22)
    h_top, h_bottom = (
        0.2754465 * np.array([0.0, 1.0, -1.557476, 0.736779]),
        np.poly([0.8737159, 0.4965853, 0.2231302]),
    )
    g = 0.16 * 4.894e-3
    c_top, c_bottom = np.array([0.0, g, g * 0.9789]), np.array([1.0, g - 1.938, 0.938 + g * 0.9789])
    psi, r, r_hat, seen = 0.0, 0.0, 0.0, []
    raw, smooth, sigma, low = ([0.0] * 4 for _ in range(4))
    waiting = [0.0] * late
    for _ in range(steps):
        seen.append(psi)
        raw = [0.5 * (radians(20.0) - psi) - 0.7 * r, *raw[:3]]
        smooth = [float(h_top @ raw - h_bottom[1:] @ smooth[:3]), *smooth[:3]]
        sigma = [-(F22 / g2) * (r_hat - r), *sigma[:3]]
        low = [float(c_top @ sigma[:3] - c_bottom[1:] @ low[:2]), *low[:3]]
        u = smooth[0] - (low[0] if adaptive else 0.0)
        u = 0.599 * min(max(u / 0.599, -radians(15.0)), radians(15.0))
        r_hat = F22 * r_hat + g2 * (u + sigma[0])
        waiting.append(u)
        acting = waiting.pop(0) + pushed
        psi, r = psi + f12 * r + g1 * acting, F22 * r + g2 * acting
    return np.array(seen)


@pytest.mark.parametrize(("name", "adaptive"), [("step_pd", False), ("step_l1", True)])
def test_engine_and_a_loop_written_out_here_agree(name: str, adaptive: bool) -> None:
    full = scenario.load(f"jet_ski/low_{name}", {"set": {"servo": {"rate": 1e3}}})
    assert (
        degrees(abs(run(full).recording["psi_rad"] - alone(adaptive, 0.0, 251)).max()) < 0.05
    )  # the engine's nozzle is half a step late


@pytest.mark.parametrize(
    ("name", "largest"),
    [("step_pd", 10.8), ("step_l1", 10.8), ("step_unfiltered", 14.6), ("step_astern", 15.0)],
)
def test_nozzle_angle_of_a_step(name: str, largest: float) -> None:
    assert degrees(abs(done(name)["actual_jet_rad"]).max()) == pytest.approx(largest, abs=0.3)


def test_printed_sign_of_the_pd_runs_to_the_opposite_heading() -> None:
    off = degrees(abs(done("step_pd_as_published")["psi_rad"] - radians(20.0)).max())
    assert off > 160.0


@pytest.mark.parametrize(
    ("begin", "to", "time_90"), [(30, 30, 4.1), (60, 0, 10.4), (90, -30, 10.4), (120, 0, 4.1)]
)
def test_heading_steps_while_the_bucket_goes_up_and_down(
    begin: float, to: float, time_90: float
) -> None:
    log_ = done("turns_l1")
    found = StepResponse(target=radians(to), since=begin, until=begin + 30.0).values(log_)
    assert found["time_90"] == pytest.approx(time_90, abs=0.2)
    assert (log_["u_mps"].min(), log_["u_mps"].max()) == pytest.approx((-0.84, 2.46), abs=0.005)


def test_constant_push_leaves_the_pd_its_offset_and_l1_what_its_adaptation_forgets() -> None:
    left = {n: degrees(done(f"turns_{n}")["psi_rad"][-1]) - 30.0 for n in ("pd", "l1")}
    assert left["pd"] == pytest.approx(degrees(0.02 / 0.5), abs=0.02)
    assert left["l1"] / left["pd"] == pytest.approx(1.0 - F22, abs=0.01)
    assert 1.0 - F22 == pytest.approx(0.058, abs=0.001)


@pytest.mark.slow
@pytest.mark.parametrize(("sea", "seeds"), [("4p5", 2), long("2p5", 2), long("1p5", 6)])
def test_l1_takes_the_mean_error_out_in_waves_and_no_rms(sea: str, seeds: int) -> None:
    """The mean error in the slowest waves, 1.5 rad/s, varies most between seeds."""
    pd, filtered, l1 = (f"waves_{sea}_{n}" for n in ("pd", "filter", "l1"))
    means = [mean_of(f"jet_ski/low_{name}", seeds)["psi_mean"] for name in (l1, filtered)]
    assert means[0] / means[1] < 0.1
    assert 0.95 < value(l1, "psi_rms") / value(filtered, "psi_rms") < 1.2
    assert 1.05 < value(l1, "steering_rms") / value(filtered, "steering_rms") < 1.35
    assert value(filtered, "steering_rms") < value(pd, "steering_rms")


@pytest.mark.slow
def test_filter_spares_the_nozzle_near_its_frequency_and_costs_accuracy_below() -> None:
    assert value("waves_4p5_filter", "steering_rms") < 0.3 * value("waves_4p5_pd", "steering_rms")
    assert value("waves_1p5_filter", "psi_rms") > 1.2 * value("waves_1p5_pd", "psi_rms")


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "grows"),
    few([("l1_0p8", False), ("l1_1p0", True), ("pd_1p2", False), ("pd_1p5", True)], 2, 0),
)
def test_delay_that_the_loop_bears(name: str, grows: bool) -> None:
    log_ = done(f"delay_{name}")
    off = degrees(1.0) * (log_["psi_rad"] - radians(20.0))
    early, late = (np.ptp(off[(log_.t >= a) & (log_.t < a + 30.0)]) for a in (30.0, 160.0))
    assert (late > early) == grows


def test_nozzle_rests_where_the_jet_can_not_turn() -> None:
    log_ = done("crossing_pushed")
    share = np.cos(2.0 * log_["actual_elevator_rad"])
    near = abs(share[1:]) < 0.1  # a row shows what acts over the step that ends at it
    assert near.sum() >= 2 and not log_["jet_rad"][:-1][near].any()
    before, after = (degrees(log_["jet_rad"][np.argmin(abs(log_.t - t))]) for t in (19.0, 40.0))
    assert (before, after) == pytest.approx((-1.9, 5.6), abs=0.05)
    steady = degrees(log_["psi_rad"][np.argmin(abs(log_.t - 19.0))])
    excursion = degrees(abs(log_["psi_rad"][log_.t > 20.0]).max()) - steady
    assert excursion == pytest.approx(0.47, abs=0.1)
    assert value("crossing", "psi_max") < 0.005


def test_reversing_stops_the_craft_when_the_surge_model_says() -> None:
    u0, u1 = 2.46, 2.46 * cos(2.0 * ASTERN)
    assert value("reverse_at_once", "time") == pytest.approx(5.58 * log((u0 - u1) / -u1), abs=0.02)


# ---- margins


@pytest.mark.parametrize(
    ("law", "crossover", "phase", "delay"),
    [
        ("PD, no filter", 0.755, 82.8, 1.92),
        ("PD + filter", 0.669, 51.8, 1.35),
        ("L1, no filter", 0.759, 67.6, 1.56),
        ("L1 + filter", 0.705, 40.0, 0.99),
    ],
)
def test_margins_of_the_sampled_loop(
    law: str, crossover: float, phase: float, delay: float
) -> None:
    m = margins(control_loop(**LAWS[law]))
    assert (m.crossover, degrees(m.phase), m.delay) == pytest.approx(
        (crossover, phase, delay), abs=0.06
    )
    assert m.crossover == pytest.approx(crossover, abs=1e-3) and m.stable


@pytest.mark.parametrize(
    ("case", "l1", "pd"),
    [
        ({"gain": 0.5}, 1.73, 3.01),
        ({"gain": 0.7}, 1.37, 2.05),
        ({"gain": 1.3}, 0.74, 0.99),
        ({"gain": 1.6}, 0.58, 0.77),
        ({"gain": 2.0}, 0.44, 0.58),
        ({"time_constant": 0.5}, 3.12, 6.02),
        ({"time_constant": 0.8}, 2.27, 3.37),
        ({"time_constant": 2.5}, 0.64, 0.91),
        ({"time_constant": 4.0}, 0.40, 0.63),
    ],
)
def test_delay_margin_of_another_craft_than_assumed(
    case: dict[str, float], l1: float, pd: float
) -> None:
    assert margins(control_loop(), **case).delay == pytest.approx(l1, abs=0.015)
    assert margins(control_loop(adaptive=0.0), **case).delay == pytest.approx(pd, abs=0.015)


@pytest.mark.parametrize("gain", [0.1, 0.3, 1.0, 3.0, 5.0])
def test_input_gain_alone_does_not_make_the_loop_unstable(gain: float) -> None:
    assert margins(control_loop(), gain).stable and margins(control_loop(adaptive=0.0), gain).stable


def test_closed_sampled_loop_has_its_poles_where_the_margins_say() -> None:
    """PD without filter: z^2 - ... of F and g, closed by (0.5, 0.7); stable up to the gain at which a pole is at -1."""
    f12, g1, g2 = T_N * (1.0 - F22), T_N**2 * (T_S / T_N - 1.0 + F22), T_N * (1.0 - F22)
    plant, into = np.array([[1.0, f12], [0.0, F22]]), np.array([[g1], [g2]])
    for gain in (1.0, 20.0, 28.0, 30.0, 40.0):
        radius = abs(np.linalg.eigvals(plant - gain * into @ [[0.5, 0.7]])).max()
        assert margins(control_loop(adaptive=0.0, wave_filter=0.0), gain).stable == (
            radius < 1.0
        ), gain


# ---- measures


def logged(t: Array, **signals: Array) -> Recording:
    return Recording("made", t, signals, Notes())


def test_step_response_of_a_second_order_system() -> None:
    t, zeta = np.arange(0.0, 40.0, 0.05), 0.5
    root = sqrt(1.0 - zeta**2)
    after = np.maximum(t - 5.0, 0.0)
    y = 1.0 - np.exp(-zeta * after) * (np.cos(root * after) + zeta / root * np.sin(root * after))
    found = StepResponse(signal="y", target=5.0, since=5.0).values(logged(t, y=2.0 + 3.0 * y))
    assert found["overshoot"] == pytest.approx(100.0 * exp(-pi * zeta / root), abs=0.05)
    first = (pi - atan(root / zeta)) / root  # where the response first is 1
    assert found["time_90"] < found["time_95"] < first
    assert np.interp(found["time_90"], after, y) == pytest.approx(0.9, abs=1e-3)
    assert found["end_error"] == pytest.approx(0.0, abs=1e-3)
    late = abs(np.interp(np.linspace(found["settle"] + 0.02, 30.0, 500), after, y) - 1.0)
    assert late.max() <= 0.05 < abs(np.interp(found["settle"] - 0.1, after, y) - 1.0)


def test_step_that_is_never_made_has_no_times() -> None:
    t = np.arange(0.0, 5.0, 0.1)
    found = StepResponse(signal="y", target=1.0).values(logged(t, y=0.1 * t))
    assert set(found) == {"overshoot", "end_error", "end"} and found["end_error"] == pytest.approx(
        51.0
    )


def test_holding_a_heading_is_measured_about_its_mean() -> None:
    t = np.arange(0.0, 100.0 * pi, 0.01)
    seen = HeadingHold(target=0.1, since=10.0 * pi).values(
        logged(t, psi_rad=0.3 + 0.2 * np.sin(t), delta_rad=np.cos(3.0 * t))
    )
    wanted = {"psi_mean": 0.2, "psi_rms": 0.2 / sqrt(2), "psi_max": 0.4, "steering_mean": 0.0}
    wanted |= {"steering_rms": 1.0 / sqrt(2), "steering_rate_rms": 3.0 / sqrt(2)}
    assert seen == pytest.approx({n: degrees(x) for n, x in wanted.items()}, abs=0.05)


def test_crossing_is_found_between_rows_or_not_at_all() -> None:
    t = np.arange(0.0, 10.0, 0.3)
    assert Crossing("u_mps", 2.0, 1.0).values(logged(t, u_mps=5.0 - t))["time"] == pytest.approx(
        2.0
    )
    assert Crossing("u_mps", 20.0).values(logged(t, u_mps=5.0 - t)) == {}
