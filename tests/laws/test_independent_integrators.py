"""Vessels of the literature against their published numbers and against their own equations,
integrated by scipy.

The equations here are written from the sources and share nothing with the compiled laws.
"""

from collections.abc import Callable
from itertools import product
from math import atan2, cos, degrees, exp, hypot, pi, radians, sin, sqrt
from typing import Any

import numpy as np
import pytest
from alike import few, slow
from runs import found
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from boatsim.physics import vessel
from boatsim.physics.base import Array, Force, Wrench, make_motion
from boatsim.simulate import scenario
from boatsim.simulate.batch import Batch
from boatsim.simulate.engine import Engine, State
from boatsim.simulate.evaluation import requested_metrics
from boatsim.simulate.run import run

Rates = Callable[[Array, float], Array]  # (x, y, psi, u, v, r), rudder [rad] -> their derivatives


def sailed(rates: Rates, start: list[float], rudder: float, until: float) -> Array:
    """State (6,) with the rudder held."""
    found = solve_ivp(
        lambda t, s: rates(s, rudder), (0.0, until), start, "DOP853", rtol=1e-10, atol=1e-10
    )
    return np.asarray(found.y[:, -1])


def on_engine(
    name: str, start: list[float], commands: dict[str, float], until: float, step: float
) -> Array:
    """The same on MuJoCo, its actuators settled from the start."""
    engine = Engine(vessel.load_vessel(name), step=step)
    x, y, psi, u, v, r = start
    engine.reset(State(x=x, y=y, psi=psi, u=u, v=v, r=r), commands)
    engine.advance(round(until / step))
    s = engine.state
    return np.array([s.x, s.y, s.psi, s.u, s.v, s.r])


def earth(s: Array) -> list[float]:
    """X', y', psi'."""
    _, _, psi, u, v, r = s
    return [u * cos(psi) - v * sin(psi), u * sin(psi) + v * cos(psi), r]


# KVLCC2, 7 m model, MMG standard method (Yasukawa and Yoshimura 2015), origin midship

L, D, RHO = 7.0, 0.46, 1000.0  # [m], [m], [kg/m^3]
MASS, X_G = 3270.0, 0.25  # [kg], [m]
M_X, M_Y, J_Z = (
    0.022 * 0.5 * RHO * L**2 * D,
    0.223 * 0.5 * RHO * L**2 * D,
    0.011 * 0.5 * RHO * L**4 * D,
)
HULL_X = {"R": 0.022, "vv": -0.040, "vr": 0.002, "rr": 0.011, "vvvv": 0.771}
HULL_Y = (-0.315, 0.083, -1.607, 0.379, -0.391, 0.008)  # v, r, vvv, vvr, vrr, rrr
HULL_N = (-0.137, -0.049, -0.030, -0.294, 0.055, -0.013)
D_P, T_P, W_P0, X_P = 0.216, 0.22, 0.40, -0.48
H_R, A_R, F_A, T_R, A_H, X_H = 0.345, 0.0539, 2.747, 0.387, 0.312, -0.464 * L
L_R, EPSILON, KAPPA = -0.71, 1.09, 0.50
BALANCED = 11.8516  # [1/s]
U0 = 1.179  # [m/s]


def mmg_forces(u: float, v: float, r: float, delta: float, n: float) -> tuple[float, float, float]:
    """X, Y, N of hull, propeller and rudder."""
    U = hypot(u, v)
    beta, v_, r_ = atan2(-v, u), v / U, r * L / U
    beta_P = beta - X_P * r_
    C2 = 1.6 if beta_P > 0 else 1.1
    w = (1 - W_P0) * (1 + (1 - exp(-2.0 * abs(beta_P))) * (C2 - 1))
    J = u * w / (n * D_P)
    K_T = 0.2931 - 0.2753 * J - 0.1385 * J**2
    eta = D_P / H_R
    u_R = (
        EPSILON
        * u
        * w
        * sqrt(eta * (1 + KAPPA * (sqrt(1 + 8 * K_T / (pi * J**2)) - 1)) ** 2 + 1 - eta)
    )
    beta_R = beta - L_R * r_
    v_R = U * (0.640 if beta_R > 0 else 0.395) * beta_R
    F_N = 0.5 * RHO * A_R * (u_R**2 + v_R**2) * F_A * sin(delta - atan2(v_R, u_R))
    k = 0.5 * RHO * L * D * U**2
    terms = (v_, r_, v_**3, v_**2 * r_, v_ * r_**2, r_**3)
    q = HULL_X
    X = k * (-q["R"] + q["vv"] * v_**2 + q["vr"] * v_ * r_ + q["rr"] * r_**2 + q["vvvv"] * v_**4)
    X += (1 - T_P) * RHO * n**2 * D_P**4 * K_T - (1 - T_R) * F_N * sin(delta)
    Y = k * float(np.dot(HULL_Y, terms)) - (1 + A_H) * F_N * cos(delta)
    N = k * L * float(np.dot(HULL_N, terms)) - (-0.5 * L + A_H * X_H) * F_N * cos(delta)
    return X, Y, N


def mmg(s: Array, delta: float) -> Array:
    u, v, r = s[3:]
    X, Y, N = mmg_forces(u, v, r, delta, BALANCED)
    du = (X + (MASS + M_Y) * v * r + X_G * MASS * r**2) / (MASS + M_X)
    inertia = MASS * (0.25 * L) ** 2 + X_G**2 * MASS + J_Z
    sway_yaw = [[MASS + M_Y, X_G * MASS], [X_G * MASS, inertia]]
    dv, dr = np.linalg.solve(sway_yaw, [Y - (MASS + M_X) * u * r, N - X_G * MASS * u * r])
    return np.array([*earth(s), du, dv, dr])


def mmg_wrench(angle: float, shaft: float, **given: float) -> Array:
    """X, Y, N of the three effects together, without the Coriolis force of the added mass."""
    boat, m = vessel.load_vessel("kvlcc2_mmg"), make_motion(**given)
    hull, propeller, rudder = (
        boat.effect(f"mmg_{part}") for part in ("hull", "propeller", "rudder")
    )
    assert isinstance(hull, Force) and isinstance(propeller, Force) and isinstance(rudder, Force)
    forces = (
        hull.wrench(m),
        propeller.wrench(m, shaft=shaft),
        rudder.wrench(m, angle=angle, shaft=shaft),
    )
    total = np.sum(forces, axis=0)[[0, 1, 5]]
    return np.asarray(total - (M_Y * m.v * m.r, -M_X * m.u * m.r, 0.0))


@pytest.mark.parametrize("seed", range(6))
def test_mmg_effects_are_the_published_formulas(seed: int) -> None:
    rng = np.random.default_rng(seed)
    u, v, r = rng.uniform(0.3, 1.5), rng.uniform(-0.3, 0.3), rng.uniform(-0.1, 0.1)
    delta, n = rng.uniform(-0.6, 0.6), rng.uniform(2.0, 15.0)
    assert mmg_wrench(delta, n, u=u, v=v, r=r) == pytest.approx(
        mmg_forces(u, v, r, delta, n), rel=1e-5
    )


def test_mmg_propeller_that_stands_still_drags_and_a_ship_at_rest_feels_its_race() -> None:
    boat = vessel.load_vessel("kvlcc2_mmg")
    propeller, rudder, hull = (
        boat.effect(f"mmg_{part}") for part in ("propeller", "rudder", "hull")
    )
    assert propeller is not None and rudder is not None and hull is not None
    stopped = propeller.wrench(make_motion(u=1.0), shaft=0.0).X  # type: ignore[attr-defined]
    assert stopped == pytest.approx(0.78 * RHO * D_P**2 * -0.1385 * 0.6**2, rel=1e-9)
    assert rudder.wrench(make_motion(), angle=0.3, shaft=10.0).N > 0.0  # type: ignore[attr-defined]
    spun = hull.wrench(make_motion(r=0.2)), hull.wrench(make_motion(r=0.4))  # type: ignore[attr-defined]
    assert spun[0].N < 0.0 and spun[1].N == pytest.approx(4.0 * spun[0].N)


def test_mmg_resistance_is_against_the_way_through_the_water() -> None:
    hull = vessel.load_vessel("kvlcc2_mmg").effect("mmg_hull")
    ahead, astern = (hull.wrench(make_motion(u=u)).X for u in (0.8, -0.8))  # type: ignore[union-attr]
    assert ahead == pytest.approx(-0.5 * RHO * L * D * 0.022 * 0.8**2) and astern == pytest.approx(
        -ahead
    )
    drifting = [hull.wrench(make_motion(u=u, v=0.5)).X for u in (-1e-9, 1e-9)]  # type: ignore[union-attr]
    assert drifting[0] == pytest.approx(drifting[1], rel=1e-6)  # it turns round without a jump
    still, flowing = (
        make_motion(u=-0.5),
        make_motion(current=(0.5, 0.0)),
    )  # at rest over ground, the water comes from astern
    assert hull.wrench(flowing).X == hull.wrench(still).X > 0.0  # type: ignore[union-attr]


def test_mmg_propeller_and_rudder_amidships_do_not_drive_a_ship_that_goes_straight_astern() -> None:
    boat, astern = vessel.load_vessel("kvlcc2_mmg"), make_motion(u=-0.8)
    stopped = boat.effect("mmg_propeller").wrench(astern, shaft=0.0).X  # type: ignore[union-attr]
    assert stopped == pytest.approx(
        0.78 * RHO * D_P**2 * 0.1385 * (0.6 * 0.8) ** 2
    )  # astern the wake is that of ahead
    assert boat.effect("mmg_rudder").wrench(astern, angle=0.0, shaft=0.0) == Wrench()  # type: ignore[union-attr]


@pytest.mark.parametrize("delta", [0.0, 0.6])
def test_mmg_ship_without_power_comes_to_rest_in_the_water_from_any_start(delta: float) -> None:
    """Its energy falls all the time, and with resistance in square of the speed as 1 / t^2 at
    last."""
    boat = vessel.load_vessel("kvlcc2_mmg")
    inertia = MASS * (0.25 * L) ** 2 + X_G**2 * MASS + J_Z
    whole = np.array([[MASS + M_X, 0, 0], [0, MASS + M_Y, X_G * MASS], [0, X_G * MASS, inertia]])
    rows = np.tile([delta, 0.0], (300, 1))
    for beta, r in product(np.radians([0, 30, 90, 150, 175, 180, -120]), (-0.15, 0.0, 0.15)):
        start = [0.0, 0.0, 0.0, U0 * cos(beta), -U0 * sin(beta), r]
        nu = Batch(boat, step=0.05).rollout(start, rows, 5.0)[:, 3:]
        energy = 0.5 * np.einsum("ti,ij,tj->t", nu, whole, nu)
        assert np.diff(energy).max() < 0.0 and energy[-1] < 0.005 * energy[0], (beta, r)


def test_propeller_balances_the_resistance_at_the_published_rate() -> None:
    found = brentq(lambda n: float(mmg_wrench(0.0, n, u=U0)[0]), 8.0, 15.0)
    assert found == pytest.approx(11.8516, abs=5e-5)


@pytest.mark.parametrize("rudder", [0.3, -0.5])
def test_kvlcc2_mmg_sails_as_by_an_independent_integrator(rudder: float) -> None:
    start = [0.0, 0.0, 0.3, 1.0, 0.05, -0.02]
    found = on_engine("kvlcc2_mmg", start, {"delta_rad": rudder, "n_rps": BALANCED}, 60.0, 0.05)
    assert found == pytest.approx(
        sailed(mmg, start, rudder, 60.0), rel=1e-5
    )  # data are rounded to six digits


MEASURED = {  # scenario -> published numbers its norms are held against
    "turning_circle_35": {
        "advance",
        "transfer",
        "tactical_diameter",
        "steady_speed",
        "steady_rate",
        "steady_drift",
    },
    "turning_circle_35_port": {"advance", "transfer", "tactical_diameter"},
    "turning_circle_35_614_rpm": {"advance", "tactical_diameter"},
    "zigzag_10": {"first_overshoot", "second_overshoot"},
    "zigzag_20": {"first_overshoot", "second_overshoot"},
}


@pytest.mark.parametrize("name", few(MEASURED, 1, 2))
def test_kvlcc2_mmg_gives_the_published_manoeuvres(name: str) -> None:
    made = run(scenario.load(f"kvlcc2_mmg/{name}"))
    metrics = requested_metrics(made)
    assert {n for n, metric in metrics.items() if metric.published is not None} == MEASURED[name]
    assert all(metric.ok for metric in metrics.values() if metric.ok is not None), metrics
    if name == "turning_circle_35":
        last = [made.recording[n][-1] for n in ("u_mps", "v_mps", "r_radps")]
        assert last == pytest.approx([0.427100, -0.146748, 0.055538], rel=1e-4)


# Mariner (Chislett and Stroem-Tejsen 1965), as the open toolbox has it: derivatives x 1e5 of
# Chislett's tables

MARINER_U0, MARINER_L = 7.7175, 160.93  # [m/s], [m]


def mariner(s: Array, delta: float) -> Array:
    """In the toolbox a positive rudder angle turns to port, so its sign is turned."""
    U = hypot(s[3], s[4])
    u, v, r, d = (s[3] - MARINER_U0) / U, s[4] / U, s[5] * MARINER_L / U, -delta
    X = (
        -184 * u
        - 110 * u**2
        - 215 * u**3
        - 899 * v**2
        + 18 * r**2
        - 95 * d**2
        - 190 * u * d**2
        + 798 * r * v
        + 93 * v * d
        + 93 * u * v * d
    )
    Y = (
        -1160 * v
        - 499 * r
        - 8078 * v**3
        + 15356 * v**2 * r
        - 1160 * v * u
        - 499 * r * u
        + 278 * d
        - 90 * d**3
        + 556 * u * d
        + 278 * u**2 * d
        - 4 * v * d**2
        + 1190 * v**2 * d
        - 4
        - 8 * u
        - 4 * u**2
    )
    N = (
        -264 * v
        - 166 * r
        + 1636 * v**3
        - 5483 * v**2 * r
        - 264 * v * u
        - 166 * r * u
        - 139 * d
        + 45 * d**3
        - 278 * u * d
        - 139 * u**2 * d
        + 13 * v * d**2
        - 489 * v**2 * d
        + 3
        + 6 * u
        + 3 * u**2
    )
    m, x_G = 798.0, -0.023
    du = X / (m + 42.0) * U**2 / MARINER_L
    sway_yaw = [[m + 748.0, m * x_G + 9.354], [m * x_G - 4.646, 39.2 + 43.8]]
    dv, dr = np.linalg.solve(sway_yaw, [Y, N]) * U**2 / MARINER_L
    return np.array([*earth(s), du, dv, dr / MARINER_L])


@pytest.mark.parametrize("rudder", [radians(20.0), radians(-35.0)])
def test_mariner_sails_as_by_an_independent_integrator(rudder: float) -> None:
    start = [0.0, 0.0, 0.2, 7.0, 0.3, -0.002]
    found = on_engine("mariner", start, {"delta_rad": rudder}, 300.0, 0.25)
    assert found == pytest.approx(sailed(mariner, start, rudder, 300.0), rel=1e-6)


def overshoots(helm: float) -> list[float]:
    """Three of a zig-zag at one angle [deg], its rudder of 5 deg/s reversed at the very instant of
    the heading."""
    angle, rate, found = radians(helm), radians(5.0), []
    s = np.array([0.0, 0.0, 0.0, MARINER_U0, 0.0, 0.0, 0.0])  # with the rudder as its last

    def sail(turning: float, until: float, **events: Any) -> Any:
        def slopes(t: float, y: Array) -> Array:
            return np.append(mariner(y[:6], y[6]), turning)

        return solve_ivp(slopes, (0.0, until), s, "DOP853", rtol=1e-10, atol=1e-10, **events)

    def turned(t: float, y: Array) -> float:
        return float(y[5])

    s = sail(0.0, 10.0).y[:, -1]
    for side in (1.0, -1.0, 1.0, -1.0):

        def reached(t: float, y: Array, side: float = side) -> float:
            return side * y[2] - angle

        reached.terminal = True  # type: ignore[attr-defined]
        s = sail(side * rate, (angle - side * s[6]) / rate).y[:, -1]
        leg = sail(0.0, 400.0, events=(turned, reached))
        found += [
            degrees(-side * peak[2] - angle) for peak in leg.y_events[0][:1]
        ]  # none on the first leg
        s = leg.y[:, -1]
    return found


@pytest.mark.parametrize("helm", [10, slow(20)])
def test_mariner_swings_in_a_zigzag_as_by_an_independent_integrator(helm: int) -> None:
    metrics = found(f"mariner/zigzag_{helm}")[0]
    ours = [metrics[f"{which}_overshoot"].value for which in ("first", "second", "third")]
    assert ours == pytest.approx(overshoots(helm), abs=1e-3)


@pytest.mark.parametrize(
    "name", ["zigzag_10", slow("zigzag_20"), slow("turning_circle_35"), slow("pull_out_20")]
)
def test_mariner_does_as_the_toolbox(name: str) -> None:
    metrics = found(f"mariner/{name}")[0]
    assert sum(metric.ok is True for metric in metrics.values()) >= 4
    assert all(metric.ok is not False for metric in metrics.values()), metrics
