"""The trial boat as it might really be, integrated by scipy from equations that share no code with the tool."""

from dataclasses import dataclass
from math import cos, hypot, pi, sin

import numpy as np
from scipy.integrate import solve_ivp

from boatsim.base import Array
from boatsim.recording import Notes, Recording


@dataclass(frozen=True)
class Real:
    """What the trial boat really has, in the words of this file."""

    late: float = 0.0  # [s] commands
    play: float = 0.0  # [rad] steering
    cargo: tuple[float, float] = (0.0, 0.0)  # [kg], [m] ahead
    munk: float = 0.0  # share of the water's Coriolis force
    line: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 0.0)  # [N/m], [m] length, [m] anchor north, east
    sea: tuple[float, float, float] = (0.0, 0.0, 0.0)  # [N], [N], [N m] rms of irregular waves
    scale: tuple[float, float] = (1.0, 1.0)  # recorded per true length, along x and y
    compass: tuple[float, float, float] = (0.0, 0.0, 0.0)  # [rad] constant error, heading north, heading east
    antenna: tuple[float, float] = (0.0, 0.0)  # [m] ahead, to starboard of the mass centre
    clock: float = 0.0  # [s] by which the camera's clock is ahead: its rows show an earlier boat


def slopes(t: float, y: Array, thrust: Array, steer: Array, real: Real) -> Array:
    """Kirchhoff's equations of the trial boat: both momenta from kinetic energies, thrusters and damping as stated."""
    psi, nu = y[2], y[3:]
    c, s = cos(psi), sin(psi)
    m, x = real.cargo
    solid = np.array([[4.6 + m, 0, 0], [0, 4.6 + m, m * x], [0, m * x, 0.6 + m * x * x]])
    water = np.diag([0.3, 9.0, 0.7])
    force = -np.array([3.0, 10.0, 1.0]) * nu
    for momentum in (solid @ nu, real.munk * (water @ nu)):
        force += [nu[2] * momentum[1], -nu[2] * momentum[0], nu[1] * momentum[0] - nu[0] * momentum[1]]
    push = thrust * np.array([np.cos(steer), np.sin(steer)])
    force += [push[0].sum(), push[1].sum(), -0.6 * push[1].sum() + 0.19 * (push[0, 0] - push[0, 1])]
    stiffness, length, north, east = real.line
    reach = np.array([north - y[0] + 0.6 * c, east - y[1] + 0.6 * s])
    pull = stiffness * max(hypot(*reach) - length, 0.0) / hypot(*reach) * reach
    X, Y = c * pull[0] + s * pull[1], c * pull[1] - s * pull[0]
    force += [X, Y, -0.6 * Y]
    force += np.array(real.sea) * waves(t)
    u, v, r = nu
    return np.concatenate([[u * c - v * s, u * s + v * c, r], np.linalg.solve(solid + water, force)])


def waves(t: float) -> Array:
    """Irregular seas about 2.4 rad/s, rms 1 on each of three axes: sixty components with random phases."""
    return np.sqrt(2.0 / len(SEA)) * np.cos(np.outer(SEA, np.full(3, t)) + PHASES).sum(axis=0)


SEA = 2.4 + 0.25 * np.random.default_rng(11).standard_normal(60)  # [rad/s]
PHASES = np.random.default_rng(12).uniform(0.0, 2 * pi, (60, 3))


def seen(y: Array, real: Real) -> Array:
    """What camera and compass make of a pose."""
    x, north, psi = y
    ahead, starboard = real.antenna
    place = np.array([x + cos(psi) * ahead - sin(psi) * starboard, north + sin(psi) * ahead + cos(psi) * starboard])
    constant, at_north, at_east = real.compass
    return np.array([*(place * real.scale), psi + constant + at_north * cos(psi) + at_east * sin(psi)])


def played(steer: Array, play: float) -> Array:
    """Angles behind commands (N, 2) with the given total play."""
    out = np.zeros_like(steer)
    at: Array = np.zeros(2)
    for i, command in enumerate(steer):
        at = np.minimum(np.maximum(at, command - play / 2), command + play / 2)
        out[i] = at
    return out


def recorded(real: Real, seed: int) -> Recording:
    """40 s at 6 Hz of random steps, seen by a camera with noise."""
    rng = np.random.default_rng(seed)
    dt, n = 1 / 6, 240
    raw = np.repeat(np.column_stack([rng.uniform(-0.9, 0.9, (48, 2)), rng.uniform(-0.6, 0.6, (48, 2))]), 5, axis=0)
    acts = np.column_stack([raw[:, :2], played(raw[:, 2:], real.play)])
    moments = dt * np.arange(n) - real.clock  # at which the rows are true
    first = min(0.0, -real.clock)
    ends = np.concatenate([[first], dt * np.arange(n + 1), moments, dt * np.arange(0, n, 5) + real.late, [dt * n + 1]])
    ends = np.unique(np.round(ends[ends >= first], 9))
    y, poses = np.zeros(6), {}
    for a, b in zip(ends[:-1], ends[1:], strict=True):
        poses[round(a, 6)] = seen(y[:3], real)
        row = min(max(int((0.5 * (a + b) - real.late) // dt), 0), n - 1)
        args = (acts[row, :2], acts[row, 2:], real)
        y = solve_ivp(slopes, (a, b), y, args=args, rtol=1e-6, atol=1e-8).y[:, -1]
    t: Array = dt * np.arange(n, dtype=float)
    pose = np.array([poses[round(a, 6)] for a in moments]) + rng.standard_normal((n, 3)) * [0.003, 0.003, 0.012]
    names = ("thrust_port_N", "thrust_starboard_N", "steer_port_rad", "steer_starboard_rad")
    signals = dict(zip(("x_m", "y_m", "psi_rad"), pose.T, strict=True)) | dict(zip(names, raw.T, strict=True))
    return Recording(f"{seed}", t, signals, Notes(vessel="trial_boat"))
