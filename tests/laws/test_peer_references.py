"""Published and independently computed motions, on MuJoCo and on the twin.

The equations here are body-axes matrices (Fossen 2021) integrated by scipy; they share nothing with
the compiled laws.
"""

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial
from math import exp, pi
from pathlib import Path
from typing import Any, NamedTuple

import boats
import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp

from boatsim.physics.base import Array, make_motion
from boatsim.physics.effects.cross_flow_drag import FRESH_WATER, CrossFlowDrag
from boatsim.simulate.batch import Batch
from boatsim.simulate.engine import Engine, State

MASS, YAW_INERTIA = 6.0, 0.5  # [kg], [kg m^2]
ADDED = np.diag([0.6, 3.0, 0.3])  # [kg], [kg], [kg m^2]
LINEAR = np.diag([3.0, 10.0, 0.8])  # [N s/m], [N s/m], [N m s]
QUADRATIC = np.diag([8.0, 30.0, 1.0])  # [N s^2/m^2], [N s^2/m^2], [N m s^2]
STEP = 0.01  # [s]
CLOSE = 1e-6  # relative; absolute where the value is 0

AHEAD = boats.push(2.0, 0.1)
SIDEWAYS = {
    "thrust_port_N": 2.5,
    "thrust_starboard_N": 2.5,
    "steer_port_rad": pi / 2,
    "steer_starboard_rad": pi / 2,
}


class Case(NamedTuple):
    start: tuple[float, ...]  # x, y, psi, u, v, r
    tau: tuple[float, float, float]  # X, Y, N
    commands: Mapping[str, float]  # that give tau
    current: tuple[float, float]  # north, east [m/s]
    drag: bool


P1 = Case((0, 0, 0, 0, 0, 0), (2.0, 0.0, 0.1), AHEAD, (0.0, 0.0), True)
P2 = Case((0, 0, 0, 0, 0, 0), (2.0, 0.0, 0.1), AHEAD, (0.10, -0.05), True)
P3 = Case((0, 0, 0, 1.0, 0.1, 0.2), (0.0, 0.0, 0.0), {}, (0.0, 0.0), False)
P4 = Case((0, 0, 0, 0.5, 0, 0), (0.0, 5.0, 0.0), SIDEWAYS, (0.0, 0.0), True)

# case, t [s], (x, y, psi, u, v, r) as computed by an eighth-order method at relative tolerance
# 1e-10
PUBLISHED = [
    (P1, 5, (1.36802276, 0.26871470, 0.50017718, 0.34251017, -0.02591332, 0.12860991)),
    (P1, 20, (2.09216194, 4.56990722, 2.47066042, 0.34267416, -0.02749835, 0.13161558)),
    (P1, 60, (2.87035734, 2.14477887, 7.73528423, 0.34267416, -0.02749836, 0.13161560)),
    (P2, 20, (4.04146411, 3.59093010, 2.45528842, 0.23363071, -0.05218694, 0.13161558)),
    (P3, 5, (4.91374226, 0.47816785, -1.04324581, 0.38559438, 0.68397321, -1.38307532)),
    (P3, 20, (19.00079967, 2.43884279, -2.22315593, -0.71542502, 0.52203964, -1.05544659)),
    (P4, 20, (1.88262459, 5.16796842, -0.28151354, 0.0, 0.27429189, 0.0)),
]
NAMES = ["P1-5s", "P1-20s", "P1-60s", "P2-20s", "P3-5s", "P3-20s", "P4-20s"]

Runner = Callable[..., Array]  # case, until [s], further settings -> states (n, 6)


def sampled(
    how: str, folder: Path, case: Case, until: float, more: Mapping[str, Any] = {}
) -> Array:
    """States (n, 6) of our simulator, ten a second."""
    settings = {"current": {"north": case.current[0], "east": case.current[1]}} | dict(more)
    vessel = boats.planar(folder, settings if case.drag else boats.WITHOUT_DRAG | settings)
    if how == "twin":
        compiled_engine = Batch(vessel, step=STEP)
        rows = np.tile(compiled_engine.program.command_array(case.commands), (round(10 * until), 1))
        return compiled_engine.rollout(case.start, rows, 0.1)
    engine = Engine(vessel, step=STEP)
    x, y, psi, u, v, r = case.start
    engine.reset(State(x=x, y=y, psi=psi, u=u, v=v, r=r), case.commands)
    out = [list(case.start)]
    for _ in range(round(10 * until)):
        engine.advance(10)
        s = engine.state
        out.append([s.x, s.y, s.psi, s.u, s.v, s.r])
    return np.array(out)


@pytest.fixture(params=["engine", "twin"])
def run(request: pytest.FixtureRequest, tmp_path: Path) -> Runner:
    return partial(sampled, request.param, tmp_path)


def turned(psi: float) -> Array:
    """Body axes to earth axes (Fossen 2021, eq.

    2.34).
    """
    return np.array(
        [[np.cos(psi), -np.sin(psi), 0.0], [np.sin(psi), np.cos(psi), 0.0], [0.0, 0.0, 1.0]]
    )


def coriolis(momentum: Array) -> Array:
    """C(nu) nu of the momentum (a1, a2, a6) = M nu (Fossen 2021, eq. 3.46)."""
    a1, a2, _ = momentum
    return np.array([[0.0, 0.0, -a2], [0.0, 0.0, a1], [a2, -a1, 0.0]])


def rigid_mass() -> Array:
    return np.diag([MASS, MASS, YAW_INERTIA])


def fossen(t: float, state: Array, case: Case, added: Array) -> Array:
    """eta' and nu' of M nu' = tau - C_RB(nu) nu - C_A(nr) nr - (Dl + Dq|nr|) nr + M_A nc'."""
    nu = state[3:]
    current = turned(state[2]).T @ np.array([*case.current, 0.0])
    nr = nu - current
    turning = np.array([nu[2] * current[1], -nu[2] * current[0], 0.0])
    force = (
        np.array(case.tau)
        - coriolis(rigid_mass() @ nu) @ nu
        - coriolis(added @ nr) @ nr
        + added @ turning
    )
    if case.drag:
        force = force - (LINEAR + QUADRATIC * np.abs(nr)) @ nr
    return np.concatenate([turned(state[2]) @ nu, np.linalg.solve(rigid_mass() + added, force)])


def reference(case: Case, until: float, added: Array = ADDED) -> Array:
    """The same motion by scipy, ten a second."""
    times = np.linspace(0.0, until, round(10 * until) + 1)
    start = np.array(case.start, dtype=float)
    found = solve_ivp(
        fossen, (0.0, until), start, "DOP853", times, args=(case, added), rtol=1e-12, atol=1e-12
    )
    return np.asarray(found.y.T)


def assert_same_run(found: Array, expected: Array) -> None:
    """Within 1e-6 of each state's largest value, so that a state may pass through 0."""
    assert np.all(np.abs(found - expected) <= CLOSE * np.abs(expected).max(axis=0) + 1e-12)


@pytest.mark.parametrize(("case", "t", "published"), PUBLISHED, ids=NAMES)
def test_published_cases(run: Runner, case: Case, t: int, published: tuple[float, ...]) -> None:
    expected = [
        pytest.approx(value, rel=CLOSE, abs=None if value else CLOSE) for value in published
    ]
    assert list(run(case, t)[-1]) == expected


@pytest.mark.parametrize("case", [P1, P2, P3, P4], ids=["P1", "P2", "P3", "P4"])
def test_every_tenth_of_a_second_as_by_an_independent_integrator(run: Runner, case: Case) -> None:
    assert_same_run(run(case, 20.0), reference(case, 20.0))


def test_added_mass_that_acts_ahead_couples_sway_and_yaw(run: Runner) -> None:
    at = 0.15  # [m]
    added = ADDED + 3.0 * np.array([[0, 0, 0], [0, 0, at], [0, at, at * at]])
    assert_same_run(run(P2, 20.0, {"added_mass": {"sway_at": at}}), reference(P2, 20.0, added))


def test_a_uniform_current_does_not_change_the_yaw_rate_a_boat_settles_at(run: Runner) -> None:
    assert run(P2, 60.0)[-1, 5] == pytest.approx(run(P1, 60.0)[-1, 5], rel=CLOSE)


def test_energy_and_momentum_last(run: Runner) -> None:
    found = run(P3, 60.0)
    momentum = found[:, 3:] @ (rigid_mass() + ADDED)
    energy = 0.5 * np.sum(momentum * found[:, 3:], axis=1)
    earth = np.array([turned(psi) @ m for psi, m in zip(found[:, 2], momentum, strict=True)])[:, :2]
    assert energy == pytest.approx(3.361, rel=1e-6)  # [J]
    assert earth == pytest.approx(np.tile([6.6, 0.9], (len(found), 1)), rel=1e-6)  # [N s]


def test_an_hour_loses_a_day_s_share_of_energy_at_most(tmp_path: Path) -> None:
    """A day at 10 ms is to lose less than a millionth; the integrator loses as much every hour."""
    compiled_engine, mass = (
        Batch(boats.planar(tmp_path, boats.WITHOUT_DRAG), step=STEP),
        np.diag(rigid_mass() + ADDED),
    )
    state = compiled_engine.hold_commands(P3.start, {}, round(3600.0 / STEP))
    assert 0.5 * np.sum(mass * state[3:] ** 2) == pytest.approx(3.361, rel=1e-6 / 24)  # [J]
    momentum = turned(state[2])[:2, :2] @ (mass * state[3:])[:2]
    assert momentum == pytest.approx([6.6, 0.9], abs=1e-6 / 24 * 6.6)  # [N s]


@pytest.mark.parametrize(
    ("effect", "law"),
    [
        ("quadratic_damping", lambda t: 1.0 / (1.0 + 8.0 * 1.0 * t / 6.6)),
        ("linear_damping", lambda t: exp(-8.0 * t / 6.6)),
    ],
)
def test_straight_coast(run: Runner, effect: str, law: Callable[[float], float]) -> None:
    case = Case((0, 0, 0, 1.0, 0, 0), (0.0, 0.0, 0.0), {}, (0.0, 0.0), False)
    found = run(case, 10.0, {effect: {"surge": 8.0}})
    assert found[:, 3] == pytest.approx(np.array([law(0.1 * i) for i in range(101)]), rel=CLOSE)
    assert found[:, [1, 2, 4, 5]] == pytest.approx(0.0, abs=1e-15)


# Cross-flow drag by strips

HULL = CrossFlowDrag(section_drag_coefficient=0.7, length=1.2, draught=0.06)
DRAG = 0.5 * FRESH_WATER * 0.7 * 0.06  # [kg/m^2]


def strips(v: float, r: float, centre: float = 0.0) -> tuple[float, float]:
    """Sway force and yaw moment: the integral by scipy, told where the cross flow changes sign."""
    ends = (centre - 0.6, centre + 0.6)
    turn = [-v / r] if r and ends[0] < -v / r < ends[1] else None

    def drag(x: float, arm: int) -> float:
        return float(-DRAG * abs(v + x * r) * (v + x * r) * x**arm)

    Y, N = (
        quad(drag, *ends, args=(arm,), points=turn, epsabs=1e-13, epsrel=1e-12)[0] for arm in (0, 1)
    )
    return Y, N


@pytest.mark.parametrize("v", [-0.7, 0.01, 0.3])
def test_cross_flow_in_pure_sway(v: float) -> None:
    force = HULL.wrench(make_motion(v=v))
    assert force.Y == pytest.approx(-DRAG * 1.2 * v * abs(v), rel=1e-12)
    assert force.N == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize("r", [-1.5, 0.02, 0.4])
def test_cross_flow_in_pure_yaw(r: float) -> None:
    force = HULL.wrench(make_motion(r=r))
    assert force.N == pytest.approx(-DRAG * r * abs(r) * 1.2**4 / 32, rel=1e-12)
    assert force.Y == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize("centre", [0.0, 0.1])
@pytest.mark.parametrize("v", [-0.5, -0.05, 0.0, 0.2])
@pytest.mark.parametrize("r", [-1.0, 0.1, 0.6])
def test_cross_flow_in_sway_and_yaw_together(v: float, r: float, centre: float) -> None:
    hull = CrossFlowDrag(section_drag_coefficient=0.7, length=1.2, draught=0.06, centre=centre)
    force = hull.wrench(make_motion(v=v, r=r))
    assert (force.Y, force.N) == pytest.approx(strips(v, r, centre), rel=1e-9, abs=1e-12)


@pytest.mark.parametrize(("v", "r"), [(0.3, 0.2), (-0.1, 0.4), (0.2, -0.5), (0.2, 0.0)])
def test_cross_flow_by_many_stations_comes_to_the_integral(v: float, r: float) -> None:
    force = replace(HULL, stations=1000.0).wrench(make_motion(v=v, r=r))
    # the law bends where the flow turns, inside a station: a few squares of a station's share of
    # the length
    assert (force.Y, force.N) == pytest.approx(strips(v, r), rel=5e-6, abs=1e-12)
