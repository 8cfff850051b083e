"""The trial boat as it might really be, integrated by scipy from equations that share no code with the tool."""

from dataclasses import dataclass
from math import cos, hypot, pi, sin

import numpy as np
from scipy.integrate import solve_ivp

from boatsim.physics.base import Array
from boatsim.recordings.table import Notes, Recording

MASS, INERTIA, WATER = 4.6, 0.6, (0.3, 9.0, 0.7)  # [kg], [kg m^2], [kg, kg, kg m^2] of the water that moves along
DAMPING = np.array([3.0, 10.0, 1.0])  # [N s/m, N s/m, N m s]
STERN, ASIDE = -0.6, 0.19  # [m] of the thrusters, from the mass centre
LENGTH, DRAUGHT = 1.2, 0.07  # [m]
WALLS = np.array([[-4.0, -3.0], [4.0, 3.0]])  # [m] of the tank: low and high, along x and y
FURTHER = (  # entries beyond the vessel's own list that tests ask for: one selection, so one composition
    "heading_offset", "position_frame_error", "quadratic_damping", "cubic_damping", "forward_speed_damping",
    "sway_yaw_coupling",
)  # fmt: skip
COMMANDS = ("thrust_port_N", "thrust_starboard_N", "steer_port_rad", "steer_starboard_rad")


@dataclass(frozen=True)
class Real:
    """What the trial boat really has, in the words of this file."""

    late: float = 0.0  # [s] commands
    play: float = 0.0  # [rad] steering
    bent: tuple[float, float] = (0.0, 0.0)  # [rad] by which port and starboard thruster point further to starboard
    lag: float = 0.0  # [s] until thrust is at 63 % of a step
    dead: float = 0.0  # [N] of command that no thruster answers
    power: tuple[float, float] = (1.0, 1.0)  # thrust per stated thrust, port and starboard
    walk: float = 0.0  # side force per thrust astern
    cargo: tuple[float, float] = (0.0, 0.0)  # [kg], [m] ahead
    trim: float = 0.0  # [m] by which the hull's own mass is ahead
    munk: float = 0.0  # share of the water's Coriolis force
    linear: tuple[float, float, float] = (1.0, 1.0, 1.0)  # damping per stated damping, by axis
    square: tuple[float, float, float] = (0.0, 0.0, 0.0)  # [N s^2/m^2, N s^2/m^2, N m s^2] damping by axis
    cube: tuple[float, float, float] = (0.0, 0.0, 0.0)  # [N s^3/m^3, N s^3/m^3, N m s^3] damping by axis
    lift: tuple[float, float] = (0.0, 0.0)  # [N s^2/m^2, N s^2] damping of sway and yaw per speed ahead or astern
    way: tuple[float, float] = (0.0, 0.0)  # [kg, kg] side force to port per u r, moment to port per u v
    skeg: float = 0.0  # [m] by which the sideways damping acts ahead
    strips: tuple[float, float] = (0.0, 0.0)  # drag coefficient of the hull's sections, [N s^2/m^2] surge drag
    line: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 0.0)  # [N/m], [m] length, [m] anchor north, east
    walls: tuple[float, float] = (0.0, 0.0)  # rise of damping at a wall, [N] towards it; both halve every 0.4 m
    stream: tuple[float, float] = (0.0, 0.0)  # [m/s] water to north and east; walls and line are not for this case
    sea: tuple[float, float, float] = (0.0, 0.0, 0.0)  # [N], [N], [N m] rms of irregular waves
    scale: tuple[float, float] = (1.0, 1.0)  # recorded per true length, along x and y
    compass: tuple[float, float, float] = (0.0, 0.0, 0.0)  # [rad] constant error, heading north, heading east
    antenna: tuple[float, float] = (0.0, 0.0)  # [m] ahead, to starboard of the mass centre
    clock: float = 0.0  # [s] by which the camera's clock is ahead: its rows show an earlier boat


def slopes(t: float, y: Array, command: Array, real: Real) -> Array:
    """Kirchhoff's equations of the trial boat: both momenta from kinetic energies. y: pose, velocity, thrusts."""
    psi, nu = y[2], y[3:6]
    c, s = cos(psi), sin(psi)
    solid = sum((body(*part) for part in ((MASS, real.trim), real.cargo)), np.diag([0.0, 0.0, INERTIA]))
    water = np.diag(WATER)
    wanted = np.array(real.power) * (command[:2] - np.clip(command[:2], -real.dead, real.dead))
    thrust, builds_up = (y[6:], (wanted - y[6:]) / real.lag) if real.lag else (wanted, np.zeros(2))
    force = pushed(thrust, command[2:] + real.bent, real) + damped(nu, real) + held(y, c, s, real)
    for momentum in (solid @ nu, real.munk * (water @ nu)):
        force += [nu[2] * momentum[1], -nu[2] * momentum[0], nu[1] * momentum[0] - nu[0] * momentum[1]]
    force += np.array(real.sea) * waves(t)
    u, v, r = nu
    return np.concatenate([[u * c - v * s, u * s + v * c, r], np.linalg.solve(solid + water, force), builds_up])


def body(mass: float, x: float) -> Array:
    """Inertia (3, 3) of a point mass x ahead."""
    return mass * np.array([[1.0, 0.0, 0.0], [0.0, 1.0, x], [0.0, x, x * x]])


def at(x: float, X: float, Y: float) -> Array:
    """Force and moment (3,) of a force that acts x ahead."""
    return np.array([X, Y, x * Y])


def pushed(thrust: Array, steer: Array, real: Real) -> Array:
    """Both thrusters, and their side forces: astern they push the stern to port, ahead a third as much to starboard."""
    X, Y = thrust * np.cos(steer), thrust * np.sin(steer)
    side = real.walk * sum(float(T) if T < 0.0 else float(T) / 3.0 for T in thrust)
    return at(STERN, X.sum(), Y.sum() + side) + [0.0, 0.0, ASIDE * (X[0] - X[1])]


def damped(nu: Array, real: Real) -> Array:
    """The water's resistance: axis by axis, at the skeg, and section by section."""
    u, v, r = nu
    each = np.array(real.linear) * DAMPING + np.array(real.square) * abs(nu) + np.array(real.cube) * nu**2
    force = -(each + [0.0, real.lift[0] * abs(u), real.lift[1] * abs(u)]) * nu
    force -= [0.0, real.way[0] * u * r, real.way[1] * u * v]
    whole = DAMPING[1] * real.linear[1]
    force += at(real.skeg, 0.0, -whole * (v + real.skeg * r)) - at(0.0, 0.0, -whole * v)
    if any(real.strips):
        x = LENGTH * ((np.arange(60) + 0.5) / 60 - 0.5)
        across = v + x * r
        drag = -0.5 * 1000.0 * real.strips[0] * DRAUGHT * LENGTH / 60 * across * abs(across)
        force += [-real.strips[1] * u * abs(u), drag.sum(), (x * drag).sum()]
    return np.asarray(force)


def held(y: Array, c: float, s: float, real: Real) -> Array:
    """What is fixed to the ground: a line from the stern to its anchor, and walls that brake and draw the boat."""
    force = np.zeros(3)
    stiffness, length, north, east = real.line
    if stiffness:
        reach = np.array([north - y[0] - STERN * c, east - y[1] - STERN * s])
        pull = stiffness * max(hypot(*reach) - length, 0.0) / hypot(*reach) * reach
        force += at(STERN, c * pull[0] + s * pull[1], c * pull[1] - s * pull[0])
    if any(real.walls):
        low, high = np.exp(-abs(WALLS - y[:2]) / 0.6)
        draw = real.walls[1] * (high - low)
        force += [c * draw[0] + s * draw[1], c * draw[1] - s * draw[0], 0.0]
        force -= real.walls[0] * (low + high).sum() * DAMPING * y[3:6]
    return force


def waves(t: float) -> Array:
    """Irregular seas about 2.4 rad/s, rms 1 on each of three axes: sixty components with random phases."""
    return np.sqrt(2.0 / len(SEA)) * np.cos(np.outer(SEA, np.full(3, t)) + PHASES).sum(axis=0)


SEA = 2.4 + 0.25 * np.random.default_rng(11).standard_normal(60)  # [rad/s]
PHASES = np.random.default_rng(12).uniform(0.0, 2 * pi, (60, 3))


def seen(t: float, y: Array, real: Real) -> Array:
    """What camera and compass make of a pose in the water, which drifts with the stream."""
    x, north, psi = y
    ahead, starboard = real.antenna
    place = np.array([x + cos(psi) * ahead - sin(psi) * starboard, north + sin(psi) * ahead + cos(psi) * starboard])
    place += t * np.array(real.stream)
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


def recorded(real: Real, seed: int, hold: int = 5, start: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> Recording:
    """40 s at 6 Hz from a pose at rest, of random steps held for some rows, seen by a camera with noise."""
    rng = np.random.default_rng(seed)
    dt, n = 1 / 6, 240
    steps = n // hold
    raw = np.column_stack([rng.uniform(-0.9, 0.9, (steps, 2)), rng.uniform(-0.6, 0.6, (steps, 2))])
    raw = np.repeat(raw, hold, axis=0)
    acts = np.column_stack([raw[:, :2], played(raw[:, 2:], real.play)])
    moments = dt * np.arange(n) - real.clock  # at which the rows are true
    first = min(0.0, -real.clock)
    ends = np.concatenate([[first], dt * np.arange(n + 1), moments, dt * np.arange(0, n, hold) + real.late])
    ends = np.unique(np.round(np.append(ends[ends >= first], dt * n + 1), 9))
    y, poses = np.array([*start, 0.0, 0.0, 0.0, 0.0, 0.0]), {}
    for a, b in zip(ends[:-1], ends[1:], strict=True):
        poses[round(a, 6)] = seen(a, y[:3], real)
        row = min(max(int((0.5 * (a + b) - real.late) // dt), 0), n - 1)
        y = solve_ivp(slopes, (a, b), y, args=(acts[row], real), rtol=1e-6, atol=1e-8).y[:, -1]
    t: Array = dt * np.arange(n, dtype=float)
    pose = np.array([poses[round(a, 6)] for a in moments]) + rng.standard_normal((n, 3)) * [0.003, 0.003, 0.012]
    signals = dict(zip(("x_m", "y_m", "psi_rad"), pose.T, strict=True)) | dict(zip(COMMANDS, raw.T, strict=True))
    return Recording(f"{seed}", t, signals, Notes(vessel="trial_boat"))
