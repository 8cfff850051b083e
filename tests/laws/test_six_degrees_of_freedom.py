"""Any of the six freedoms: the Otter against its published run, every set against Lagrange's
equations, energy kept."""

from collections.abc import Callable
from functools import cache
from pathlib import Path

import boats
import numpy as np
import pytest
from alike import few
from scipy.integrate import quad, solve_ivp

from boatsim.physics import vessel
from boatsim.physics.base import Array
from boatsim.physics.kernel.equations import has_hull_fixed_axes
from boatsim.physics.signals import AXES, motion_signals
from boatsim.physics.vessel import Vessel
from boatsim.simulate.batch import Batch
from boatsim.simulate.engine import Engine, State

# ---- the Otter (Fossen's toolbox)

# order u v w p q r, about the origin midships [kg, kg m, kg m^2]
OTTER_MASS = np.diag([60.28152101, 137.5, 110.0, 14.517184, 29.15, 39.325])
for (i, j), value in {
    (0, 4): -11.0,
    (1, 3): 11.0,
    (1, 5): 11.0,
    (2, 4): -11.0,
    (3, 5): 2.2,
}.items():
    OTTER_MASS[i, j] = OTTER_MASS[j, i] = value
OTTER_ADDED = np.diag([5.28152101, 82.5, 55.0, 2.052864, 11.0, 23.375])
OTTER_DAMPING = np.array([77.55443235, 137.5, 546.48048913, 50.02366181, 218.18785613, 39.325])
OTTER_DRAUGHT = 0.134146341463  # [m]
# x y z phi theta psi, u v w p q r after 20 s, port 80, starboard 60 rad/s: printed to eight
# decimals
TURN = (
    0.23809611, 16.65627828, -0.00001107, -0.00244617, 0.00007436, 3.24853616,
    1.40535943, -0.09073613, -0.00011745, -0.00001268, -0.00041727, 0.17057993,
)  # fmt: skip


def skew(a: Array) -> Array:
    return np.array([[0, -a[2], a[1]], [a[2], 0, -a[0]], [-a[1], a[0], 0]])


def coriolis_matrix(M: Array, nu: Array) -> Array:
    """Fossen 2021, eq.

    3.46.
    """
    a = M @ nu
    return np.block([[np.zeros((3, 3)), -skew(a[:3])], [-skew(a[:3]), -skew(a[3:])]])


def restoring() -> Array:
    """Hydrostatics of the two pontoons, moved from the centre of flotation to the origin."""
    rho_g, b, length, c, V, T = 1025 * 9.81, 0.25, 2.0, 0.75, 55 / 1025, OTTER_DRAUGHT
    plane = c * length * b
    across = 2 / 12 * length * b**3 * 6 * c**3 / ((1 + c) * (1 + 2 * c)) + 2 * plane * 0.395**2
    along = 0.8 * 2 / 12 * b * length**3
    KB, KG = (5 * T / 2 - V / (2 * length * b)) / 3, T + 0.2
    stiffness = [
        0,
        0,
        rho_g * 2 * plane,
        rho_g * V * (KB + across / V - KG),
        rho_g * V * (KB + along / V - KG),
        0,
    ]
    H = np.eye(6)
    H[:3, 3:] = skew(np.array([-0.2, 0.0, 0.0])).T
    return np.asarray(H.T @ np.diag(stiffness) @ H)


def cross_flow(v: float, r: float) -> tuple[float, float]:
    """The integrals in closed form: of w = v + x r the antiderivatives are |w|^3 / 3 and |w| w^3 / 4."""
    if abs(r) < 1e-4:  # where the differences below lose their digits
        points = [-v / r] if r and abs(v / r) < 1.0 else None
        one, two = (
            quad(
                lambda x, k=k: abs(v + x * r) * (v + x * r) * x**k,
                -1,
                1,
                points=points,
                epsabs=1e-15,
            )[0]
            for k in (0, 1)
        )
        return float(one), float(two)
    low, high = v - r, v + r
    cube, fourth = (
        (abs(high) ** 3 - abs(low) ** 3) / 3,
        (high**3 * abs(high) - low**3 * abs(low)) / 4,
    )
    return cube / r, (fourth - v * cube) / r**2


def rotation(phi: float, theta: float, psi: float) -> Array:
    """Body axes to earth axes, roll first."""
    about_z = np.array([[np.cos(psi), -np.sin(psi), 0], [np.sin(psi), np.cos(psi), 0], [0, 0, 1]])
    about_y = np.array(
        [[np.cos(theta), 0, np.sin(theta)], [0, 1, 0], [-np.sin(theta), 0, np.cos(theta)]]
    )
    about_x = np.array([[1, 0, 0], [0, np.cos(phi), -np.sin(phi)], [0, np.sin(phi), np.cos(phi)]])
    return np.asarray(about_z @ about_y @ about_x)


def euler_rates(phi: float, theta: float) -> Array:
    """Body rates p, q, r per rate of roll, pitch and yaw."""
    return np.array(
        [
            [1, 0, -np.sin(theta)],
            [0, np.cos(phi), np.cos(theta) * np.sin(phi)],
            [0, -np.sin(phi), np.cos(theta) * np.cos(phi)],
        ]
    )


def otter_rates(t: float, s: Array, G: Array) -> Array:
    eta, nu, n = s[:6], s[6:12], s[12:]
    port, starboard = 0.01108 * n * np.abs(n)
    tau = (
        np.array([port + starboard, 0, 0, 0, 0, 0.395 * (port - starboard)])
        - OTTER_DAMPING * nu
        - G @ eta
    )
    tau[5] -= 10 * abs(nu[5]) * OTTER_DAMPING[5] * nu[5]
    k = 0.5 * 1025 * OTTER_DRAUGHT * 0.847030
    Y, N = cross_flow(nu[1], nu[5])
    Z, M = cross_flow(nu[2], -nu[4])
    tau -= k * np.array([0, Y, Z, 0, -M, N])
    rigid = OTTER_MASS - OTTER_ADDED
    tau -= (coriolis_matrix(rigid, nu) + coriolis_matrix(OTTER_ADDED, nu)) @ nu
    place, turn = rotation(*eta[3:]) @ nu[:3], np.linalg.solve(euler_rates(*eta[3:5]), nu[3:])
    return np.concatenate(
        [place, turn, np.linalg.solve(OTTER_MASS, tau), (np.array([80.0, 60.0]) - n) / 0.1]
    )


def whole(state: State) -> Array:
    return np.array(state[1:])


@cache
def otter(stations: int) -> Engine:
    return Engine(vessel.load_vessel("otter", settings={"cross_flow_drag": {"stations": stations}}))


def sailed(stations: int, port: float, starboard: float, seconds: float) -> Array:
    engine = otter(stations)
    engine.reset()
    engine.command({"n_port_radps": port, "n_starboard_radps": starboard})
    engine.advance(round(seconds / engine.step))
    return whole(engine.state)


def test_otter_has_the_published_mass_matrix_and_restoring_force() -> None:
    engine = otter(0)
    k = engine._k
    body = engine.vessel.body
    mass = engine.vessel.effect("added_mass")
    water = mass.matrix()  # type: ignore[union-attr]
    c = skew(np.array([body.centre[0], 0.0, body.centre[1]]))
    inertia = np.diag([body.roll_inertia, body.effective_pitch_inertia(), body.yaw_inertia])
    rigid = np.block(
        [[body.mass * np.eye(3), -body.mass * c], [body.mass * c, inertia - body.mass * c @ c]]
    )
    assert rigid + water == pytest.approx(OTTER_MASS, abs=1e-8)
    inverse = np.linalg.inv(OTTER_MASS)
    assert [k[30], k[31], k[35], k[40]] == pytest.approx(
        [inverse[0, 0], inverse[1, 1], inverse[5, 5], inverse[1, 5]], rel=1e-9
    )
    G = restoring()
    for i, axis in ((2, "z"), (3, "phi"), (4, "theta")):
        engine.reset(State(**{axis: 0.01}))
        assert np.array(engine.wrench()) == pytest.approx(-0.01 * G[:, i], rel=1e-9, abs=1e-9)


def test_otter_turns_as_published() -> None:
    assert sailed(21, 80.0, 60.0, 20.0) == pytest.approx(
        np.array(TURN), rel=1e-4, abs=5e-9
    )  # half of the last digit


def test_otter_goes_straight_as_published() -> None:
    state = sailed(0, 60.0, 60.0, 40.0)
    assert state[6] == pytest.approx(1.02864527, rel=1e-8)
    assert state[0] == pytest.approx(40.19200, abs=5e-6)


def test_otter_turns_as_by_an_independent_integrator_with_the_exact_integral() -> None:
    found = solve_ivp(
        otter_rates, (0, 20), np.zeros(14), "DOP853", args=(restoring(),), rtol=1e-9, atol=1e-11
    ).y[:, -1]
    state = sailed(0, 80.0, 60.0, 20.0)
    assert state[6:] == pytest.approx(found[6:12], rel=1e-6, abs=1e-9)
    assert state[:6] == pytest.approx(found[:6], rel=1e-5, abs=1e-9)


def test_a_heavier_otter_floats_deeper_by_her_weight() -> None:
    boat = vessel.load_vessel("otter", extra=[{"use": "payload", "mass": 5.5}])
    engine = Engine(boat)
    engine.advance(2000)
    assert engine.state.z == pytest.approx(
        5.5 * 9.81 / 7541.4375 * (1 + 0.04 * 7541.4375 / 2551.7764024), rel=1e-3
    )


@pytest.mark.slow
def test_a_mass_ahead_sinks_and_trims_the_otter_by_its_weight() -> None:
    mass, x, stiff, trimming, flotation = 4.0, 0.5, 7541.4375, 2551.776402439025, -0.2
    engine = Engine(
        vessel.load_vessel("otter", extra=[{"use": "extra_mass", "mass": mass, "x": x}])
    )
    engine.advance(2000)
    theta = (flotation - x) * mass * 9.81 / trimming  # bow down, about the centre of flotation
    assert engine.state.theta == pytest.approx(theta, rel=1e-3)
    assert engine.state.z == pytest.approx(mass * 9.81 / stiff + flotation * theta, rel=1e-3)


def test_a_point_mass_is_the_body_that_has_it_in_its_inertia() -> None:
    """Otter and mass as one body by Steiner's theorem; both at one height, so that roll and yaw
    stay principal axes."""
    mass, x, level = 4.0, 0.5, {"centre": [0.2, 0.0]}
    body = vessel.load_vessel("otter", settings={"body": level}).body
    ahead = (body.mass * body.centre[0] + mass * x) / (body.mass + mass)
    steiner = body.mass * (body.centre[0] - ahead) ** 2 + mass * (x - ahead) ** 2
    one = {
        "mass": body.mass + mass,
        "centre": [ahead, 0.0],
        "yaw_inertia": body.yaw_inertia + steiner,
        "pitch_inertia": float(body.pitch_inertia or 0.0) + steiner,
    }
    gained = []
    at_rest = State(z=0.01, phi=0.1, theta=-0.05)
    moving = at_rest._replace(u=1.0, v=0.3, w=0.1, p=0.2, q=-0.1, r=0.4)
    for laden in (
        vessel.load_vessel(
            "otter", settings={"body": level}, extra=[{"use": "extra_mass", "mass": mass, "x": x}]
        ),
        vessel.load_vessel(
            "otter", settings={"body": one, "hydrostatics": {"displacement": body.mass + mass}}
        ),
    ):
        engine, rates = Engine(laden, step=1e-4), []
        for start in (
            moving,
            at_rest,
        ):  # their difference knows no weight, which trims the one boat alone
            engine.reset(start)
            engine.advance(1)
            rates.append((np.array(engine.state[7:]) - np.array(start[7:])) / 1e-4)
        gained.append(rates[0] - rates[1])
    assert gained[0] == pytest.approx(gained[1], rel=1e-3, abs=1e-4)
    assert np.abs(gained[0]).max() > 0.5  # [m/s^2], [rad/s^2]


# ---- any set of freedoms: Lagrange's equations of the kinetic energy of hull and water, slopes by
# complex steps

HULL = """
about = "a hull for tests, free as they need it"
source = "none"
freedoms = {dof}
length = 1.0
beam = 0.4
draught = 0.1

[body]
mass = 6.0
centre = {centre}
roll_inertia = 0.3
pitch_inertia = {pitch}
yaw_inertia = 0.8

[[effect]]
use = "added_mass"
surge = 0.6
sway = 3.0
heave = 5.0
roll = 0.1
pitch = 0.4
yaw = 0.3
sway_at = 0.1
sway_below = {below}
"""
DAMPED = """
[[effect]]
use = "linear_damping"
surge = 1.0
sway = 3.0
heave = 8.0
roll = 0.2
pitch = 0.5
yaw = 0.4

[[effect]]
use = "hydrostatics"
heave = 90.0
roll = 4.0
pitch = 9.0
flotation = -0.05
"""
ADDED = np.diag([0.6, 3.0, 5.0, 0.1, 0.4, 0.3])
PULLS = np.array([1.0, 3.0, 8.0, 0.2, 0.5, 0.4])
STIFF = np.zeros((6, 6))
STIFF[2, 2], STIFF[3, 3], STIFF[4, 4] = 90.0, 4.0, 9.0 + 90.0 * 0.05**2
STIFF[2, 4] = STIFF[4, 2] = 90.0 * 0.05


def sway_lever(below: float) -> Array:
    """Added mass of sway acting ahead and below."""
    row = np.array([0.0, 1.0, 0.0, -below, 0.0, 0.1])
    return 3.0 * np.outer(row, row) - np.diag([0, 3.0, 0, 0, 0, 0])


def floating(folder: Path, dof: tuple[str, ...], damped: bool = True) -> tuple[Vessel, Array]:
    """The hull with those freedoms, and its whole mass matrix (6, 6)."""
    level = not has_hull_fixed_axes(frozenset(dof))
    centre, below = (
        (0.05, 0.0 if level else -0.08),
        0.0 if level and "roll" not in dof else 0.04,
    )
    pitch = (
        0.8 if level else 0.7
    )  # a level hull rolls about an axis through its mass centre, pitch as yaw
    text = HULL.format(dof=list(dof), centre=list(centre), pitch=pitch, below=below)
    boat = vessel.load_vessel(
        str(boats.written(folder, "floating", text + (DAMPED if damped else "")))
    )
    c = skew(np.array([centre[0], 0.0, centre[1]]))
    inertia = np.diag([0.3, pitch, 0.8])
    rigid = np.block([[6.0 * np.eye(3), -6.0 * c], [6.0 * c, inertia - 6.0 * c @ c]])
    return boat, rigid + ADDED + sway_lever(below)


def jacobian(q: Array, free: list[int], tilting: bool) -> Array:
    """Body rates (6, n) per joint rate at joint coordinates (6,), which may be complex."""
    phi, theta, psi = q[3:] if tilting else (0.0 * q[3], 0.0 * q[4], q[5])
    J = np.zeros((6, 6), dtype=q.dtype)
    J[:3, :3], J[3:, 3:] = rotation(phi, theta, psi).T, euler_rates(phi, theta)
    return J[:, free]


def lagrange(boat: Vessel, M: Array, damped: bool) -> Callable[[float, Array], Array]:
    """Rates of (q, generalised momentum)."""
    free = [AXES.index(a) for a in AXES if a in boat.dof]
    tilting, n = has_hull_fixed_axes(frozenset(boat.dof)), len(free)

    def at(q: Array) -> Array:
        full = np.zeros(6, dtype=q.dtype)
        full[free] = q
        return full

    def rates(t: float, s: Array) -> Array:
        q, momentum = s[:n], s[n:]
        J = jacobian(at(q), free, tilting)
        qd = np.linalg.solve(J.T @ M @ J, momentum)
        push = np.zeros(n)
        for i in range(n):
            beside = q.astype(complex)
            beside[i] += 1e-30j
            nu = jacobian(at(beside), free, tilting) @ qd
            push[i] = (0.5 * nu @ M @ nu).imag / 1e-30
        force = -PULLS * (J @ qd) - STIFF @ at(q) if damped else np.zeros(6)
        return np.concatenate([qd, push + J.T @ force])

    return rates


SETS = [
    ("surge", "sway", "heave", "roll", "pitch", "yaw"),
    ("heave", "pitch"),
    ("surge", "sway", "roll", "pitch", "yaw"),
]
MORE = [
    ("surge", "heave", "pitch"),
    ("heave", "roll", "pitch"),
    ("surge", "sway", "heave", "yaw"),
    ("surge", "yaw"),
    ("surge", "sway", "heave", "roll", "yaw"),
    ("pitch",),
    ("sway", "roll"),
    ("surge", "sway", "roll", "yaw"),
]


@pytest.mark.parametrize(
    "dof",
    [*SETS, *few([(s,) for s in MORE], 0, 4)],
    ids=lambda s: " ".join(s),
)
def test_engine_and_twin_follow_lagrange_in_any_set_of_freedoms(
    tmp_path: Path, dof: tuple[str, ...]
) -> None:
    boat, M = floating(tmp_path, dof)
    free = [AXES.index(a) for a in dof]
    pose = np.array([0.1, -0.2, 0.05, 0.3, -0.2, 0.7])
    rate = np.array([0.4, -0.3, 0.1, 0.5, -0.4, 0.6])
    engine, compiled = Engine(boat, step=0.01), Batch(boat, step=0.01)
    start = np.concatenate([pose[free], rate[free]])  # joint coordinates and rates
    tilting = has_hull_fixed_axes(frozenset(dof))
    full = np.zeros(6)
    full[free] = pose[free]
    J = jacobian(full, free, tilting)
    nu = J @ rate[free]
    moving = dict(
        zip((s.symbol for s in motion_signals(dof)), [*pose[free], *nu[free]], strict=True)
    )
    engine.reset(State(**moving))
    engine.advance(300)
    found = solve_ivp(
        lagrange(boat, M, True),
        (0, 3),
        np.concatenate([start[: len(free)], J.T @ M @ nu]),
        "DOP853",
        rtol=1e-10,
        atol=1e-12,
    ).y[:, -1]
    full[free] = found[: len(free)]
    J = jacobian(full, free, tilting)
    wanted = [*found[: len(free)], *(J @ np.linalg.solve(J.T @ M @ J, found[len(free) :]))[free]]
    at_end = [getattr(engine.state, s.symbol) for s in motion_signals(dof)]
    assert at_end == pytest.approx(wanted, rel=1e-6, abs=2e-6)
    rolled = compiled.rollout(list(moving.values()), np.zeros((30, 0)), 0.1)[-1]
    assert at_end == pytest.approx(rolled, rel=1e-10, abs=1e-10)


def test_a_hull_free_in_six_ways_keeps_energy_and_momentum(tmp_path: Path) -> None:
    boat, M = floating(tmp_path, AXES, damped=False)
    engine = Engine(boat, step=5e-3)

    def kept() -> Array:
        s = whole(engine.state)
        nu, turn = s[6:], rotation(*s[3:6])
        linear, angular = turn @ (M @ nu)[:3], turn @ (M @ nu)[3:]
        return np.array([0.5 * nu @ M @ nu, *linear, *(angular + np.cross(s[:3], linear))])

    engine.reset(State(0.0, 0.3, -0.2, 0.1, 0.2, -0.3, 1.0, 0.5, 0.2, -0.3, 0.6, -0.4, 0.8))
    begin, before = whole(engine.state), kept()
    engine.advance(1000)
    assert np.abs(whole(engine.state) - begin)[6:].max() > 0.1
    assert kept() == pytest.approx(before, rel=1e-6, abs=1e-6)
