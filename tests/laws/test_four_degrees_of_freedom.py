"""A hull free in surge, sway, yaw and roll, against an integrator that shares no code with it."""

from collections.abc import Callable
from pathlib import Path

import boats
import numpy as np
import pytest
from scipy.integrate import solve_ivp

from boatsim.physics import vessel
from boatsim.physics.base import Array
from boatsim.physics.vessel import Vessel
from boatsim.simulate.batch import Batch
from boatsim.simulate.engine import Engine, State

HEELING = boats.PLANAR.replace(
    'freedoms = ["surge", "sway", "yaw"]', 'freedoms = ["surge", "sway", "yaw", "roll"]'
)
RIGHTING = '\n[[effect]]\nuse = "righting_arm"\nstiffness = 2.0\n'
WATER = {"sway_at": 0.15, "sway_below": 0.08, "roll": 0.02}
NAMES = ("x", "y", "phi", "psi", "u", "v", "p", "r")
START = (0.0, 0.0, 0.15, 0.3, 0.4, -0.2, 0.1, 0.3)
MASS, IXX, IZZ = 6.0, 0.1, 0.5


def heeling(folder: Path, **settings: dict[str, float]) -> Vessel:
    settings["added_mass"] = {**WATER, **settings.get("added_mass", {})}
    place = boats.written(folder, "heeling_boat", HEELING + RIGHTING)
    return vessel.load_vessel(str(place), settings=settings)


def independent(
    damping: Callable[[Array], Array],
    current: tuple[float, float],
    tau: tuple[float, float],
    seconds: float,
) -> Array:
    """State after a run of the same boat: momentum of a rigid body and of a sway mass at a point,
    in earth axes.

    Unknowns are pose and the velocities (u, v, p, r) over ground; the water's momentum belongs to
    the velocity through the water and is carried along by the turning axes (Kirchhoff).
    """
    a_u, a_v, a_r, a_p, ahead, below = (
        0.6,
        3.0,
        0.3,
        WATER["roll"],
        WATER["sway_at"],
        WATER["sway_below"],
    )
    arm = np.array(
        [0.0, 1.0, -below, ahead]
    )  # velocity to starboard of the point at which the sway mass sits
    water = np.diag([a_u, 0.0, a_p, a_r]) + a_v * np.outer(arm, arm)
    rigid = np.diag([MASS, MASS, IXX, IZZ])

    def rates(_: float, s: Array) -> Array:
        phi, psi, (u, v, p, r) = s[2], s[3], s[4:]
        turn = np.array([[np.cos(psi), np.sin(psi)], [-np.sin(psi), np.cos(psi)]])
        through = s[4:] - np.array([*(turn @ current), 0.0, 0.0])
        px, py, *_ = water @ through + rigid @ s[4:] * [
            1,
            1,
            0,
            0,
        ]  # linear momentum, which turns with the axes
        wx, wy, *_ = water @ through
        force = damping(through) + [tau[0], 0.0, -2.0 * phi, tau[1]]
        force += [r * py, -r * px, 0.0, through[1] * wx - through[0] * wy]
        drift = np.array(
            [r * (turn @ current)[1], -r * (turn @ current)[0], 0.0, 0.0]
        )  # d/dt of the current's part
        nu_dot = np.linalg.solve(water + rigid, force + water @ drift)
        return np.array([*(turn.T @ [u, v]), p, r, *nu_dot])

    done = solve_ivp(rates, (0.0, seconds), START, method="DOP853", rtol=1e-11, atol=1e-12)
    return np.asarray(done.y[:, -1])


def damped(through: Array) -> Array:
    d, q = np.array([3.0, 10.0, 0.4, 0.8]), np.array([8.0, 30.0, 0.0, 1.0])
    return np.asarray(-(d + q * np.abs(through)) * through)


@pytest.mark.parametrize("current", [(0.0, 0.0), (0.1, -0.05)])
def test_engine_twin_and_an_independent_integrator_agree(
    tmp_path: Path, current: tuple[float, float]
) -> None:
    north, east = current
    boat = heeling(tmp_path, linear_damping={"roll": 0.4}, current={"north": north, "east": east})
    commands = boats.push(2.0, 0.3)
    engine = Engine(boat, step=0.01)
    engine.reset(State(**dict(zip(NAMES, START, strict=True))), commands)
    engine.advance(1000)
    s = engine.state
    compiled = Batch(boat, step=0.01)
    rows = np.tile(compiled.program.command_array(commands), (100, 1))
    end = compiled.rollout(START, rows, 0.1)[-1]
    truth = independent(damped, current, (2.0, 0.3), 10.0)
    assert [getattr(s, n) for n in NAMES] == pytest.approx(end.tolist(), abs=1e-10)
    assert end == pytest.approx(truth, abs=1e-6)


def test_without_damping_energy_and_momentum_stay(tmp_path: Path) -> None:
    boat = heeling(tmp_path, **boats.WITHOUT_DRAG)
    compiled = Batch(boat, step=0.01)
    states = compiled.rollout(START, np.zeros((200, len(boat.commands))), 0.1)
    mass = boat.effect("added_mass").matrix()[np.ix_([0, 1, 3, 5], [0, 1, 3, 5])]  # type: ignore[union-attr]
    mass = mass + np.diag([MASS, MASS, IXX, IZZ])
    nu, phi, psi = states[:, 4:], states[:, 2], states[:, 3]
    energy = 0.5 * np.einsum("ni,ij,nj->n", nu, mass, nu) + phi**2  # stiffness 2 N m
    momentum = nu @ mass
    north = np.cos(psi) * momentum[:, 0] - np.sin(psi) * momentum[:, 1]
    assert np.ptp(energy) < 1e-8 * energy[0]
    assert np.ptp(north) < 1e-7 * np.abs(north).max()
    assert np.ptp(phi) > 0.1  # it rolls
