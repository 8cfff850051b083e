"""The linear boat with which Bayless simulated: its state space on MuJoCo, and the L1 law that
sways it."""

from functools import cache
from math import atan, cos, degrees, pi, radians, sin
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from alike import few
from scipy.linalg import expm

from boatsim.cli import diagnosis as commands
from boatsim.metrics.sway_hold import SwayHold
from boatsim.physics import vessel
from boatsim.physics.base import Array, Wrench
from boatsim.physics.content import shipped_content_names
from boatsim.recordings.table import Recording
from boatsim.simulate import scenario
from boatsim.simulate.engine import Engine, State
from boatsim.simulate.evaluation import requested_metrics
from boatsim.simulate.run import Run, run
from boatsim.simulate.run_files import run_into_folder

SHIPPED = [
    name.removeprefix("thesis_linear/")
    for name in shipped_content_names("scenario")
    if name.startswith("thesis_linear/")
]
A = {  # T10 to T14, states v and r
    "light": np.array([[-0.003884, 0.002266], [-0.001476, -0.001107]]),
    "heavy": np.array([[-0.003501, 0.001915], [-0.001247, -0.000599]]),
}
LEVERS = {
    "light": 0.60,
    "heavy": 0.64,
    "narrow": 0.19,
    "wide": 0.28,
}  # [m] L of the load, B of the motors
INERTIA = {"light": (10.4, 1.98), "heavy": (12.8, 2.5)}  # [kg], [kg m^2]
LOADS = [(load, motors) for load in ("light", "heavy") for motors in ("narrow", "wide")]


@cache
def sailed(name: str) -> Run:
    return run(scenario.load(f"thesis_linear/{name}"))


def peak(name: str, **controller: Any) -> float:
    """Largest yaw rate [deg/s] in the first 3 s, which the turn of the motors makes."""
    told = scenario.load(f"thesis_linear/{name}").file
    lag = {"set": {"servo": {"lag": controller["servo_lag"]}}} if "servo_lag" in controller else {}
    changed = {"duration": 3.0, "controller": told.controller | controller, **lag}
    return (
        requested_metrics(run(scenario.load(f"thesis_linear/{name}", changed)))[
            "peak_yaw_rate"
        ].value
        or 0.0
    )


def sideways(F: float, d: float) -> dict[str, float]:
    """Commands of both motors turned inward by d [rad], port ahead and starboard astern, F [N]
    together."""
    return {
        "thrust_port_N": F / 2,
        "thrust_starboard_N": -F / 2,
        "steer_port_rad": d,
        "steer_starboard_rad": -d,
    }


# The state space


@pytest.mark.parametrize("loads", LOADS)
def test_engine_is_the_state_space_of_the_thesis(loads: tuple[str, str]) -> None:
    load, motors = loads
    (m, inertia), L, B, d, F = INERTIA[load], LEVERS[load], LEVERS[motors], 0.3, 0.5
    engine = Engine(vessel.load_vessel("thesis_linear", loads), step=0.01)
    engine.reset(State(psi=0.4, v=0.02, r=-0.01), sideways(F, d))
    engine.advance(2000)
    push = np.array([F * sin(d) / m, F * (B * cos(d) - L * sin(d)) / inertia])
    whole = np.block([[A[load], push[:, None]], [np.zeros((1, 3))]])
    v, r, _ = expm(20.0 * whole) @ [0.02, -0.01, 1.0]
    s = engine.state
    assert (s.v, s.r) == pytest.approx((v, r), rel=1e-9)
    assert abs(s.u) < 1e-9


@pytest.mark.parametrize("load", A)
def test_boat_is_practically_undamped(load: str) -> None:
    """Time constants of the printed matrices: they are no damping of a real hull."""
    assert np.all(1.0 / -np.linalg.eigvals(A[load]).real > 400.0)


@pytest.mark.slow
def test_boat_replays_a_recording_of_its_own(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    steps = {
        "controller": {"use": "open_loop", "period": 0.01},
        "measure": None,
        "norms": {},
        "step": 0.01,
        "goal": [{"from": t, **sideways(0.6, d)} for t, d in ((0.0, 0.0), (1.0, 0.6), (3.0, 0.3))],
    }
    run_into_folder(tmp_path / "run", scenario.load("thesis_linear/light_narrow", steps))
    assert commands.compare(tmp_path / "run" / "recording.csv", None, [], None, tmp_path) == 0
    errors = {
        line.split()[0]: float(line.split()[1])
        for line in capsys.readouterr().out.splitlines()[1:-1]
    }
    assert errors.keys() == {"x_m", "y_m", "psi_rad"} and max(errors.values()) < 1e-6


def test_wind_of_t12_is_a_force_and_a_moment_that_turn_with_the_boat() -> None:
    boat = vessel.load_vessel("thesis_linear", ["light", "wide"], {"gust": {"mean": 0.2}})
    engine = Engine(boat, step=0.01)
    for psi in (0.0, 1.0):
        engine.reset(State(psi=psi))
        assert engine.wrench() == pytest.approx(Wrench(Y=0.2, N=0.2), abs=1e-8)


# The controller


@pytest.mark.parametrize(("load", "motors"), few(LOADS, 1))
def test_steering_finds_the_neutral_angle(load: str, motors: str) -> None:
    found = requested_metrics(sailed(f"{load}_{motors}"))["steering"].value
    assert found == pytest.approx(degrees(atan(LEVERS[motors] / LEVERS[load])), abs=0.2)


@pytest.mark.parametrize("name", few(SHIPPED, 1))
def test_estimates_stay_inside_their_bounds(name: str) -> None:
    log = sailed(name).recording
    found = [
        n for n in log.signals if n.startswith("estimate_") and not n.endswith(("_low", "_high"))
    ]
    assert len(found) == 8
    for n in found:
        assert np.all((log[n] >= log[f"{n}_low"]) & (log[n] <= log[f"{n}_high"])), n


@pytest.mark.slow
@pytest.mark.parametrize("lag", [0.1, 0.2, 0.3])
@pytest.mark.parametrize("power", [0.5, 4.0])
def test_modulated_power_lowers_the_peak_yaw_rate_by_31_to_46_percent(
    power: float, lag: float
) -> None:
    fixed, modulated = (
        peak("heavy_wide", power=power, servo_lag=lag, modulated=m) for m in (False, True)
    )
    assert 0.31 <= 1.0 - modulated / fixed <= 0.46


@pytest.mark.slow
def test_the_wind_needs_more_moment_than_a_weak_motor_has() -> None:
    """No angle from 0 to 45 deg makes -0.2 N m of 0.5 N in T12's boat; 1.5 N do."""
    levers = 0.28 * np.cos(np.linspace(0, pi / 4)) - 0.60 * np.sin(np.linspace(0, pi / 4))
    assert 0.5 * levers.min() > -0.2 > 1.5 * levers.min()
    weak, strong = sailed("wind_weak").recording, sailed("wind").recording
    assert np.all(np.diff(weak["r_radps"][-500:]) > 0.0)
    assert abs(strong["r_radps"][-1]) < radians(0.01)


def test_the_published_feed_forward_turns_the_boat_with_its_sway() -> None:
    """A_m couples: without the moment -v in the feed-forward the model asks for r = v/1.4, 2.9 deg/s at 0.07 m/s."""
    assert degrees(0.07 / 1.4) == pytest.approx(2.9, abs=0.05)
    log = sailed("feed_forward_as_published").recording
    v, r = log["v_mps"][-1], log["r_radps"][-1]
    assert r > 0.0 and r == pytest.approx(v / 1.4, rel=0.3)  # v still rises, so r follows behind


def test_controller_is_the_law_written_out() -> None:
    """The loop in arrays: predictor, gradient laws away from their bounds, low-pass, servo, plant;
    all Euler steps."""
    log = sailed("light_narrow").recording
    v, r = written_out(3.0)
    n = round(3.0 / 0.01) + 1
    assert degrees(float(np.abs(r).max())) == pytest.approx(
        degrees(float(np.abs(log["r_radps"]).max())), rel=0.01
    )
    assert v[::20][:n] == pytest.approx(log["v_mps"][:n], rel=0.01, abs=1e-5)
    assert r[::20][:n] == pytest.approx(log["r_radps"][:n], abs=5e-5)


def written_out(seconds: float) -> tuple[Array, Array]:
    """Sway velocity and yaw rate every 0.5 ms of the light narrow boat at 0.5 N."""
    h, F, d, x, xh = 5e-4, 0.5, 0.0, np.zeros(2), np.zeros(2)
    model, P = np.array([[0.0, -1.0], [1.0, -1.4]]), np.array([[99 / 70, -1 / 2], [-1 / 2, 5 / 7]])
    omega, theta, sigma, u = np.ones(2), np.zeros((2, 2)), np.zeros(2), np.zeros(2)
    slow = fast = 0.0
    per_angle = 0.62 * F / 2.0
    out = []
    for _ in range(round(seconds / h) + 1):
        out.append(x)
        e = P @ (xh - x)
        omega, theta, sigma = (
            omega - h * 1e4 * e * u,
            theta - h * 1e4 * np.outer(e, x),
            sigma - h * 1e4 * e,
        )
        over = omega[1] * u[1] + theta[1] @ x + sigma[1] + x[0]
        # 4.5 x 1.07 (s + 17.7)/(s (s + 50)) in partial fractions
        slow -= h * 4.5 * 1.07 * 17.7 / 50 * over
        fast += h * (-50 * fast - 4.5 * 1.07 * 32.3 / 50 * over)
        wanted = min(max(0.3875 - (slow + fast) / per_angle, 0.0), pi / 4)
        u = np.array([F * sin(wanted) / 10.4, per_angle * (0.3875 - wanted)])
        xh = xh + h * (model @ xh + omega * u + theta @ x + sigma)
        before, d = d, d + (wanted - d) * (1 - np.exp(-h / 0.15))
        at = 0.5 * (before + d)
        push = np.array([F * sin(at) / 10.4, F * (0.19 * cos(at) - 0.60 * sin(at)) / 1.98])
        x = x + h * (A["light"] @ x + push)
    v, r = np.array(out).T
    return v, r


def test_sway_hold_measures_what_it_says() -> None:
    t = np.linspace(0.0, 10.0, 101)
    r = np.where(t < 5.0, 0.02, 0.01)
    signals = {
        "r_radps": r,
        "psi_rad": 0.1 + 0.01 * t,
        "steer_port_rad": np.where(t < 5.0, 0.0, 0.3),
    }
    found = SwayHold().values(Recording("x", t, signals))
    wanted = {"peak_yaw_rate": 0.02, "rest_yaw_rate": 0.01, "heading": 0.1, "steering": 0.3}
    assert found == pytest.approx({n: degrees(a) for n, a in wanted.items()})


# The joystick boat takes thrusts too


@pytest.mark.parametrize("side", ["port", "starboard"])
def test_joystick_boat_takes_thrusts_of_1_N_and_gives_less_of_them_astern(side: str) -> None:
    boat = scenario.load("joystick_boat/sway_1").vessel
    eta: Any = boat.effect("weak_reverse")
    engine = Engine(boat)
    for thrust, given in ((1.0, 1.0), (-1.0, -eta.astern_factor)):
        engine.reset(commands={f"thrust_{side}_N": thrust})
        assert engine.actuators[f"thrust_{side}_N"] == pytest.approx(given)
        assert engine.wrench()[0] == pytest.approx(given)
