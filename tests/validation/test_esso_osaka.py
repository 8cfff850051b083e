"""The MMG laws for low speed against the published equations, written out anew; the Esso Osaka
where its data are.

The equations here are those of the captive tests' README and papers and share nothing with the
compiled laws.
"""

import json
from itertools import product
from math import atan2, copysign, cos, hypot, pi, radians, sin, sqrt
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp

from boatsim.physics import vessel
from boatsim.physics.base import Array, Force, Wrench, make_motion
from boatsim.physics.effects.mmg_low_speed_hull import MmgLowSpeedHull
from boatsim.physics.effects.mmg_low_speed_propeller import MmgLowSpeedPropeller
from boatsim.physics.effects.mmg_low_speed_rudder import MmgLowSpeedRudder
from boatsim.physics.vessel import Vessel
from boatsim.simulate import scenario
from boatsim.simulate.engine import Engine, State
from boatsim.simulate.run import run
from validation.real import esso_osaka_vessel as esso

there = pytest.mark.skipif(not esso.SOURCE.is_file(), reason="no ../shared/recordings/esso_osaka")
QUADRANTS = list(
    product((0.4, 0.05, -0.3), (12.0, 2.0, -3.0, -15.0), (0.5, -0.3))
)  # u [m/s], n [1/s], delta [rad]

# A ship that there is not: round numbers of the right kind
SHIP: dict[str, Any] = {
    "L": 4.0, "d": 0.3, "rho": 1000.0, "D": 0.1, "P": 0.07, "A_R": 0.02, "A": 1.5,
    "X_0F": -0.02, "X_0A": -0.04, "X_vr": -0.01, "Y_v": -0.4, "Y_r": 0.1, "N_v": -0.15, "N_r": -0.05, "C_D": 0.9,
    "C_rY": 2.0, "C_rN": 0.7, "w0": 0.5, "tau": 0.8, "C_P": -0.3, "x_P": -0.52, "t": 0.2, "k": (0.3, -0.3, -0.15),
    "C": (-0.24, -0.18, 0.3, -0.2), "a": (-1e-4, 8e-3, -5e-3, -6e-3, -5e-4, 5e-3, 2e-3, 1e-3),
    "b": (4e-5, -3e-3, 2e-3, 2e-3, 2e-4, -2e-3, 6e-5, 5e-5), "J_low": -0.35, "J_high": -0.06,
    "t_R": 0.2, "a_H": 0.4, "x_H": -0.45, "x_R": -0.5, "l_R": -1.1, "k_x": 0.3, "k_a": 0.15, "eps": 1.4,
    "c_pr": -0.2, "g_p": 0.35, "g_n": 0.45,
}  # fmt: skip


def hull(c: dict[str, Any], u: float, v: float, r: float) -> Array:
    """Hull forces X, Y, N without the Coriolis force of the added mass."""
    L, U, beta = c["L"], hypot(u, v), abs(atan2(v, u))

    def crossing(C_r: float, power: int) -> float:
        def at(xi: float) -> float:
            w = v + C_r * L * xi * r
            return abs(w) * w * xi**power

        turn = -v / (C_r * L * r) if r else 0.0
        return float(quad(at, -0.5, 0.5, points=[turn] if abs(turn) < 0.5 else None)[0])

    X = (c["X_0F"] + (c["X_0A"] - c["X_0F"]) * beta / pi) * u * U + c["X_vr"] * L * v * r
    Y = c["Y_v"] * v * abs(u) + c["Y_r"] * L * r * u - c["C_D"] * crossing(c["C_rY"], 0)
    N = c["N_v"] * v * u + c["N_r"] * L * r * abs(u) - c["C_D"] * crossing(c["C_rN"], 1)
    return np.array([X, Y, L * N]) * 0.5 * c["rho"] * L * c["d"]


def wake(c: dict[str, Any], u: float, v: float, r: float) -> float:
    """1 - w."""
    if u <= 0:
        return 1.0
    s = (v + c["x_P"] * c["L"] * r) / hypot(u, v)
    return min(max(1 - c["w0"] + c["tau"] * abs(s) + c["C_P"] * s**2, 0.0), 1.0)


def thrust(c: dict[str, Any], u: float, v: float, r: float, n: float) -> tuple[float, float]:
    """X_P and K_T of a shaft that turns."""
    D, J_s = c["D"], u / (n * c["D"])
    if n > 0:
        J = wake(c, u, v, r) * J_s
        K_T = (
            c["k"][0] + c["k"][1] * J + c["k"][2] * J * abs(J)
        )  # ahead J^2; see mmg_propeller.open_water
        return (1 - c["t"]) * c["rho"] * D**4 * n**2 * K_T, K_T
    C = c["C"]
    X = c["rho"] * D**4 * n**2 * (C[1] + C[2] * J_s if J_s >= C[3] else C[0])
    return X, X / (c["rho"] * D**4 * n**2)


def propeller(c: dict[str, Any], u: float, v: float, r: float, n: float) -> Array:
    """Propeller forces X, Y, N."""
    D, J, side = c["D"], u / (n * c["D"]), np.zeros(2)
    if n < 0:
        for i, a in enumerate((c["a"], c["b"])):
            at = a[2] + a[3] * J if J < c["J_low"] else a[4] if J > c["J_high"] else a[0] + a[1] * J
            side[i] = (n * D) ** 2 * at
    elif u < 0:
        side[:] = [(n * c["P"]) ** 2 * (a[5] * J**2 + a[6] * J + a[7]) for a in (c["a"], c["b"])]
    k = 0.5 * c["rho"] * c["L"] * c["d"]
    return np.array([thrust(c, u, v, r, n)[0], k * side[0], k * c["L"] * side[1]])


def rudder(c: dict[str, Any], u: float, v: float, r: float, n: float, delta: float) -> Array:
    """Rudder forces X, Y, N."""
    D, u_P = c["D"], wake(c, u, v, r) * u
    eta, kappa = D / sqrt(c["A_R"] * c["A"]), c["k_x"] / c["eps"]
    X_P, K_T = thrust(c, u, v, r, n)
    if n >= 0 and K_T > 0:
        race = u_P + kappa * (sqrt(u_P**2 + 8 * K_T * n**2 * D**2 / pi) - u_P)
        u_R = c["eps"] * sqrt(eta * race**2 + (1 - eta) * u_P**2)
    elif u >= 0:
        K = X_P / (c["rho"] * D**4 * n**2)
        a = c["eps"] * u_P + n * D * c["k_a"] * sqrt(8 * abs(K) / pi)
        q = eta * copysign(a**2, a) + (1 - eta) * (c["eps"] * u_P) ** 2 + c["c_pr"] * u**2
        u_R = copysign(sqrt(abs(q)), q)
    else:
        u_R = u
    v_R = -(c["g_p"] if v + c["x_R"] * c["L"] * r >= 0 else c["g_n"]) * (v + c["l_R"] * c["L"] * r)
    f = 6.13 * c["A"] / (c["A"] + 2.25)
    F = 0.5 * c["rho"] * c["A_R"] * (u_R**2 + v_R**2) * f * sin(delta - atan2(v_R, u_R))
    lever = (c["x_R"] + c["a_H"] * c["x_H"]) * c["L"]
    return (
        np.array([-(1 - c["t_R"]) * sin(delta), -(1 + c["a_H"]) * cos(delta), -lever * cos(delta)])
        * F
    )


def effects(c: dict[str, Any]) -> tuple[Force, Force, Force]:
    """The shelf's laws with those numbers."""
    water = {"length": c["L"], "density": c["rho"]}
    names = ("X_0F", "X_0A", "X_vr", "Y_v", "Y_r", "N_v", "N_r", "C_D", "C_rY", "C_rN")
    of_hull = MmgLowSpeedHull(**water, draught=c["d"], m_x=0.0, m_y=0.0, **{n: c[n] for n in names})
    k, C, forms = (
        c["k"],
        c["C"],
        ("mid", "mid_J", "low", "low_J", "high", "braked_JJ", "braked_J", "braked"),
    )
    shaft = {
        "diameter": c["D"],
        "thrust_deduction": c["t"],
        "wake": c["w0"],
        "wake_tau": c["tau"],
        "wake_C_P": c["C_P"],
        "propeller_at": c["x_P"],
        "k0": k[0],
        "k1": k[1],
        "k2": k[2],
        "astern_stop": C[0],
        "astern_C1": C[1],
        "astern_C2": C[2],
        "astern_from": C[3],
    }
    aside = {
        f"{axis}_{form}": x
        for axis, xs in (("Y", c["a"]), ("N", c["b"]))
        for form, x in zip(forms, xs, strict=True)
    }
    of_propeller = MmgLowSpeedPropeller(
        **water,
        **shaft,
        **aside,
        draught=c["d"],
        pitch_ratio=c["P"] / c["D"],
        aside_low=c["J_low"],
        aside_high=c["J_high"],
    )
    of_rudder = MmgLowSpeedRudder(
        **water,
        **shaft,
        area=c["A_R"],
        span=sqrt(c["A_R"] * c["A"]),
        slope=6.13 * c["A"] / (c["A"] + 2.25),
        steering_deduction=c["t_R"],
        hull_share=c["a_H"],
        hull_at=c["x_H"],
        rudder_at=c["x_R"],
        flow_at=c["l_R"],
        straightening_starboard=c["g_p"],
        straightening_port=c["g_n"],
        epsilon=c["eps"],
        k_x=c["k_x"],
        k_x_astern=c["k_a"],
        c_pr=c["c_pr"],
    )
    return of_hull, of_propeller, of_rudder


def planar(wrench: Wrench) -> Array:
    return np.array(wrench)[[0, 1, 5]]


# ---- laws


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize(("u", "n", "delta"), QUADRANTS)
def test_low_speed_laws_are_the_published_formulas_in_every_quadrant(
    u: float, n: float, delta: float, seed: int
) -> None:
    v, r = np.random.default_rng(seed).uniform(-0.2, 0.2, 2)
    of_hull, of_propeller, of_rudder = effects(SHIP)
    m = make_motion(u=u, v=v, r=r)
    assert planar(of_hull.wrench(m)) == pytest.approx(hull(SHIP, u, v, r), rel=1e-6)
    assert planar(of_propeller.wrench(m, shaft=n)) == pytest.approx(
        propeller(SHIP, u, v, r, n), rel=1e-9
    )
    found = planar(of_rudder.wrench(m, angle=delta, shaft=n))
    assert found == pytest.approx(rudder(SHIP, u, v, r, n, delta), rel=1e-9)


def test_a_hull_that_turns_on_the_spot_is_held_by_its_sections_alone() -> None:
    of_hull, r = effects(SHIP)[0], 0.1
    L, k = SHIP["L"], 0.5 * SHIP["rho"] * SHIP["d"] * SHIP["C_D"]
    turned = planar(of_hull.wrench(make_motion(r=r)))
    assert turned == pytest.approx([0.0, 0.0, -k * SHIP["C_rN"] ** 2 * L**4 / 32 * r**2], abs=1e-9)
    assert planar(of_hull.wrench(make_motion(v=0.2))) == pytest.approx(
        [0.0, -k * L * 0.04, 0.0], abs=1e-9
    )
    assert not any(of_hull.wrench(make_motion()))


def test_resistance_astern_is_its_own() -> None:
    ahead, astern = (effects(SHIP)[0].wrench(make_motion(u=u)).X for u in (0.3, -0.3))
    assert astern / -ahead == pytest.approx(SHIP["X_0A"] / SHIP["X_0F"])


def test_a_shaft_that_stands_still_or_turns_ahead_on_a_ship_ahead_pushes_nothing_aside() -> None:
    of_propeller = effects(SHIP)[1]
    assert not any(of_propeller.wrench(make_motion(), shaft=0.0))
    assert of_propeller.wrench(make_motion(u=0.3), shaft=10.0).Y == 0.0
    assert (
        of_propeller.wrench(make_motion(u=0.3), shaft=0.0).X
        < 0.0
        < of_propeller.wrench(make_motion(u=-0.3), shaft=0.0).X
    )
    assert of_propeller.wrench(make_motion(), shaft=-10.0).Y != 0.0


def test_the_blade_of_a_ship_that_drifts_astern_leads_and_steers_the_other_way() -> None:
    of_rudder = effects(SHIP)[2]
    ahead, astern = (
        of_rudder.wrench(make_motion(u=u), angle=0.3, shaft=-1e-9).N for u in (0.3, -0.3)
    )
    assert ahead > 0.0 > astern
    assert of_rudder.wrench(make_motion(), angle=0.3, shaft=10.0).N > 0.0  # at rest, in the race


# ---- the vessel, from numbers that are not part of the project


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return esso.write_vessel(tmp_path_factory.mktemp("vessels") / esso.NAME).parent


@pytest.fixture(scope="module")
def ship(folder: Path) -> Vessel:
    return vessel.load_vessel(str(folder / "vessel.toml"))


@pytest.fixture(scope="module")
def published() -> dict[str, Any]:
    """The captive tests' numbers under the names of the equations above."""
    p = json.loads(esso.SOURCE.read_text(encoding="utf-8"))
    h, s, b = (p["mmg"][part] for part in ("hull", "propeller", "rudder"))
    D = p["propeller"]["D_m"]
    return {
        "L": p["Lpp_m"],
        "d": p["draught_m"],
        "rho": p["density_water_kgm3"],
        "D": D,
        "P": D * p["propeller"]["P_over_D"],
        "A_R": p["rudder"]["area_m2"],
        "A": p["rudder"]["aspect_ratio"],
        **h,
        "w0": s["wake_w0"],
        "tau": s["wake_tau"],
        "C_P": s["wake_C_P"],
        "x_P": s["x_P"],
        "t": s["thrust_deduction"],
        "k": (s["k0"], s["k1_later_version"], s["k2"]),
        "C": s["astern_thrust_C"],
        "a": s["side_force_A"],
        "b": s["yaw_moment_B"],
        "J_low": s["J_syn"],
        "J_high": s["J_syn0"],
        "t_R": b["t_R"],
        "a_H": b["a_H"],
        "x_H": b["x_H"],
        "x_R": b["x_R"],
        "l_R": b["l_R"],
        "k_x": b["k_x"],
        "k_a": b["k_x_astern"],
        "eps": b["epsilon"],
        "c_pr": b["c_pr"],
        "g_p": b["gamma_v_plus_xr_positive"],
        "g_n": b["gamma_v_plus_xr_negative"],
        "mass": p["mass_kg"],
        "x_G": p["x_G_m"],
        **p["mmg"]["added_mass"],
    }


def test_the_project_holds_none_of_the_coefficients() -> None:
    """Their licence is non-commercial: blanks alone are in the project."""
    effects_only = (
        (esso.TEMPLATES / "vessel.toml.in").read_text(encoding="utf-8").split("[[effect]]", 1)[1]
    )
    numbers = [
        line
        for line in effects_only.split("[manoeuvring]")[0].splitlines()
        if "=" in line.split("#")[0]
    ]
    assert {
        n.split("#")[0].strip() for n in numbers if "$" not in n.split("#")[0] and '"' not in n
    } == {"coriolis = 0.0"}


@there
@pytest.mark.parametrize(("u", "n", "delta"), QUADRANTS)
def test_the_vessels_forces_are_those_of_the_captive_tests(
    ship: Vessel, published: dict[str, Any], u: float, n: float, delta: float
) -> None:
    c, v, r = published, 0.06, -0.03
    parts = [ship.effect(f"mmg_low_speed_{part}") for part in ("hull", "propeller", "rudder")]
    m = make_motion(u=u, v=v, r=r)
    k = 0.5 * c["rho"] * c["L"] ** 2 * c["d"]
    added = np.array([c["m_y"] * k * v * r, -c["m_x"] * k * u * r, 0.0])
    found = [
        e.wrench(m, **s)
        for e, s in zip(parts, ({}, {"shaft": n}, {"shaft": n, "angle": delta}), strict=True)
    ]  # type: ignore[union-attr]
    expected = [hull(c, u, v, r) + added, propeller(c, u, v, r, n), rudder(c, u, v, r, n, delta)]
    for seen, stated in zip(found, expected, strict=True):
        assert planar(seen) == pytest.approx(
            stated, rel=2e-3, abs=1e-4
        )  # the rudder's span is printed to 0.1 mm


def by_scipy(c: dict[str, Any], start: list[float], n: float, delta: float, until: float) -> Array:
    """State (6,) after the published equations of motion."""
    k, m, first = 0.5 * c["rho"] * c["L"] ** 2 * c["d"], c["mass"], c["x_G"] * c["mass"]
    turning = c["I_zz_plus_J_zz"] * k * c["L"] ** 2 + first * c["x_G"]
    sway_yaw = np.array([[m + c["m_y"] * k, first], [first, turning]])

    def rates(_: float, s: Array) -> Array:
        psi, u, v, r = s[2:]
        X, Y, N = hull(c, u, v, r) + propeller(c, u, v, r, n) + rudder(c, u, v, r, n, delta)
        du = (X + (m + c["m_y"] * k) * v * r + first * r * r) / (m + c["m_x"] * k)
        dv, dr = np.linalg.solve(sway_yaw, [Y - (m + c["m_x"] * k) * u * r, N - first * u * r])
        return np.array([u * cos(psi) - v * sin(psi), u * sin(psi) + v * cos(psi), r, du, dv, dr])

    return np.asarray(solve_ivp(rates, (0.0, until), start, "RK45", rtol=1e-7, atol=1e-8).y[:, -1])


@there
@pytest.mark.parametrize(("n", "delta"), [(10.0, 0.3), (-15.0, -0.4)])
def test_the_vessel_sails_as_by_an_independent_integrator(
    ship: Vessel, published: dict[str, Any], n: float, delta: float
) -> None:
    start = [0.0, 0.0, 0.3, 0.3, 0.02, -0.01]
    engine = Engine(ship, step=0.05)
    engine.reset(
        State(**dict(zip(("x", "y", "psi", "u", "v", "r"), start, strict=True))),
        {"delta_rad": delta, "n_rps": n},
    )
    engine.advance(800)
    s = engine.state
    found = np.array([s.x, s.y, s.psi, s.u, s.v, s.r])
    assert found == pytest.approx(by_scipy(published, start, n, delta, 40.0), rel=0.01, abs=0.003)


@there
def test_its_turning_circle_runs_and_ends_in_the_turn_of_the_published_equations(
    folder: Path, published: dict[str, Any]
) -> None:
    made = run(scenario.load(str(folder / "turn.toml")))
    turning = by_scipy(published, [0.0, 0.0, 0.0, 0.35, 0.0, 0.0], 10.0, radians(20.0), 240.0)[3:]
    assert [made.recording[n][-1] for n in ("u_mps", "v_mps", "r_radps")] == pytest.approx(
        turning, rel=0.01
    )
