"""The trial boat as it might really be, integrated by scipy from equations that share no code with
the tool.

Nor do they share its formulas: where an entry of the library has a dead band, this boat has
friction that fades in; where an entry has a constant, here it varies with load, speed or place.
`Real` says how strong a cause is in the words of the simple law, which this boat's own law meets in
the middle of what the recordings show.
"""

from dataclasses import dataclass
from functools import cache
from math import cos, hypot, pi, sin

import numpy as np
from scipy.integrate import solve_ivp

from boatsim.physics.base import Array
from boatsim.recordings.table import Notes, Recording

MASS, INERTIA, WATER = (
    4.6,
    0.6,
    (0.3, 9.0, 0.7),
)  # [kg], [kg m^2], [kg, kg, kg m^2] of the water that moves along
DAMPING = np.array([3.0, 10.0, 1.0])  # [N s/m, N s/m, N m s]
STERN, ASIDE = -0.6, 0.19  # [m] of the thrusters, from the mass centre
LENGTH, DRAUGHT = 1.2, 0.07  # [m]
WALLS = np.array([[-4.0, -3.0], [4.0, 3.0]])  # [m] of the tank: low and high, along x and y
SECTION = LENGTH / 60  # [m] length of a section of the hull
PLACES = SECTION * (np.arange(60) + 0.5) - 0.5 * LENGTH  # [m] of the sections, ahead of the middle
ANGLES = np.linspace(0.0, 2.0 * pi, 73)[:-1]  # around a hull that is fuller than an ellipse
OUTLINE = np.array([[0.6], [0.22]]) * [
    np.sign(trace(ANGLES)) * abs(trace(ANGLES)) ** 0.9 for trace in (np.cos, np.sin)
]
MAST = 0.5  # [m] height of an antenna
USUAL = np.array(
    [0.25, 0.05, 0.35]
)  # [m/s, m/s, rad/s] speeds at which damping has the value a `Real` states
FURTHER = (  # entries tried beyond the vessel's own list, in every test of this boat the same
    "heading_offset",
    "position_frame_error",
    "quadratic_damping",
    "cubic_damping",
    "forward_speed_damping",
    "sway_yaw_coupling",
)
COMMANDS = ("thrust_port_N", "thrust_starboard_N", "steer_port_rad", "steer_starboard_rad")


@dataclass(frozen=True)
class Real:
    """What the trial boat really has, in the words of this file."""

    late: float = 0.0  # [s] commands, by a quarter more or less each
    play: float = 0.0  # [rad] steering
    bent: tuple[float, float] = (
        0.0,
        0.0,
    )  # [rad] by which port and starboard thruster point further to starboard
    # [s] until thrust is at 63 % of a step: a quarter more from rest, less of a small one
    lag: float = 0.0
    dead: float = 0.0  # [N] of command that friction takes
    throttle: bool = False  # commands set the revolutions, whose square is the thrust
    power: tuple[float, float] = (1.0, 1.0)  # thrust per stated thrust, port and starboard
    # share of full thrust, ahead as astern, at which a motor controller limits the current
    most: float = 1.0
    fade: float = 0.0  # [1/s] share of the thrust that an emptying battery loses, about 20 s
    # power of the supply's voltage with which thrust grows; its share of the nominal one at the
    # begin of a run and at its end
    supply: float = 0.0
    charge: tuple[float, float] = (1.0, 1.0)
    # share of the thrust lost at the nominal current of the battery, by its inner resistance
    resistance: float = 0.0
    walk: float = 0.0  # side force per thrust astern
    cargo: tuple[float, float] = (0.0, 0.0)  # [kg], [m] ahead
    trim: float = 0.0  # [m] by which the hull's own mass is ahead
    munk: float = 0.0  # share of the water's Coriolis force
    linear: tuple[float, float, float] = (
        1.0,
        1.0,
        1.0,
    )  # damping per stated damping at usual speeds, by axis
    square: tuple[float, float, float] = (
        0.0,
        0.0,
        0.0,
    )  # [N s^2/m^2, N s^2/m^2, N m s^2] damping by axis
    cube: tuple[float, float, float] = (
        0.0,
        0.0,
        0.0,
    )  # [N s^3/m^3, N s^3/m^3, N m s^3] damping by axis
    lift: tuple[float, float] = (
        0.0,
        0.0,
    )  # [N s^2/m^2, N s^2] damping of sway and yaw per speed ahead or astern
    way: tuple[float, float] = (
        0.0,
        0.0,
    )  # [kg, kg] side force to port per u r, moment to port per u v
    skeg: float = 0.0  # [m] by which the sideways damping acts ahead
    strips: tuple[float, float] = (
        0.0,
        0.0,
    )  # mean drag coefficient of the sections, [N s^2/m^2] surge drag
    line: tuple[float, float, float, float] = (
        0.0,
        0.0,
        0.0,
        0.0,
    )  # [N/m], [m] length, [m] anchor north, east
    quay: tuple[float, float] = (0.0, 0.0)  # [N/m] of a fender, [m] its place to the east
    walls: tuple[float, float] = (
        0.0,
        0.0,
    )  # rise of damping at a wall, [N] towards it; half of both at 0.48 m
    stream: tuple[float, float] = (
        0.0,
        0.0,
    )  # [m/s] water to north and east; walls and line are not for this case
    sea: tuple[float, float, float] = (0.0, 0.0, 0.0)  # [N], [N], [N m] rms of irregular waves
    scale: tuple[float, float] = (1.0, 1.0)  # recorded per true length, along x and y
    compass: tuple[float, float, float] = (
        0.0,
        0.0,
        0.0,
    )  # [rad] constant error, heading north, heading east
    antenna: tuple[float, float] = (0.0, 0.0)  # [m] ahead, to starboard of the mass centre
    clock: float = 0.0  # [s] by which the camera's clock is ahead: its rows show an earlier boat


def slopes(t: float, y: Array, command: Array, real: Real) -> Array:
    """Kirchhoff's equations of the trial boat: both momenta from kinetic energies.

    y: pose, velocity, shafts.
    """
    psi, nu = y[2], y[3:6]
    c, s = cos(psi), sin(psi)
    solid, water = inertias(real)
    thrust, builds_up = turned(y[6:], wanted(command[:2], real), real)
    if real.fade:  # it sinks faster at first
        thrust = thrust * (1.0 - 1.1 * real.fade * t / (1.0 + 0.005 * t))
    if real.supply:  # a part of the voltage is lost in the leads
        thrust = thrust * (1.1 * voltage(t, real) - 0.1) ** (0.9 * real.supply)
    if real.resistance:  # thrust is a power of the voltage, which falls with the current
        sag = 0.65 * real.resistance * drawn(t, command[:2])
        thrust = thrust * (1.0 - sag) ** 1.6
    steer = command[2:] + np.array(real.bent) * np.cos(command[2:])  # a rod of the wrong length
    force = pushed(thrust, steer, real) + damped(nu, real) + held(y, c, s, real)
    separated = 1.1 - 0.3 * nu[1] ** 2 / (
        nu[0] ** 2 + nu[1] ** 2 + 1e-12
    )  # less of it in a large drift
    for momentum in (solid @ nu, real.munk * separated * (water @ nu)):
        force += [
            nu[2] * momentum[1],
            -nu[2] * momentum[0],
            nu[1] * momentum[0] - nu[0] * momentum[1],
        ]
    if any(real.sea):
        force += np.array(real.sea) * waves(t)
    u, v, r = nu
    return np.concatenate(
        [[u * c - v * s, u * s + v * c, r], np.linalg.solve(solid + water, force), builds_up]
    )


def voltage(t: float, real: Real) -> float:
    """Voltage of the supply over the nominal one: other consumers come and go."""
    full, empty = real.charge
    return full + (empty - full) * t / 40.0 + 0.03 * sin(0.5 * t) * cos(0.13 * t)


def drawn(t: float, command: Array) -> float:
    """Current over the nominal one: of the drives, and of consumers that are switched on and off."""
    others = 0.25 + 0.2 * (sin(0.37 * t) > 0.2) + 0.15 * (cos(0.71 * t) > 0.5)
    return float(others + 0.3 * np.sum(abs(command) ** 1.5))


def stowed(real: Real) -> tuple[tuple[float, float], ...]:
    """Masses and where they lie: most of the hull's own has slid, the cargo is as long as a
    crate."""
    mass, x = real.cargo
    return (
        (0.2 * MASS, 0.0),
        (0.8 * MASS, 1.25 * real.trim),
        (0.5 * mass, x - 0.1),
        (0.5 * mass, x + 0.1),
    )


@cache
def inertias(real: Real) -> tuple[Array, Array]:
    """Inertia (3, 3) of the boat and of the water that moves along."""
    solid = sum((body(*part) for part in stowed(real)), np.diag([0.0, 0.0, INERTIA]))
    return np.asarray(solid), np.diag(WATER)


def body(mass: float, x: float) -> Array:
    """Inertia (3, 3) of a point mass x ahead."""
    return mass * np.array([[1.0, 0.0, 0.0], [0.0, 1.0, x], [0.0, x, x * x]])


def at(x: float, X: float, Y: float) -> Array:
    """Force and moment (3,) of a force that acts x ahead."""
    return np.array([X, Y, x * Y])


def wanted(command: Array, real: Real) -> Array:
    """Thrusts that motors aim at: friction fades in, and what one has more or less than stated
    grows with its load."""
    free = command - real.dead * np.tanh(command / real.dead) if real.dead else command
    if real.throttle:
        free = free * abs(free)  # full thrust is 1 N
    if real.most != 1.0:  # the limit sets in gradually
        free = free / (1.0 + (abs(free) / real.most) ** 12) ** (1 / 12)
    return np.asarray(free * (1.0 + (np.array(real.power) - 1.0) * (0.6 + 0.6 * abs(command))))


def turned(shaft: Array, thrust: Array, real: Real) -> tuple[Array, Array]:
    """Thrusts and slopes of the shafts: their rate lags, thrust is its square and takes 1 to 1.58
    times as long."""
    if not real.lag:
        return thrust, np.zeros(2)
    return shaft * abs(shaft), (np.sign(thrust) * np.sqrt(abs(thrust)) - shaft) / (real.lag / 1.25)


def pushed(thrust: Array, steer: Array, real: Real) -> Array:
    """Both thrusters, and their side forces, of which ahead is left a third: more than in
    proportion to their load."""
    X, Y = thrust * np.cos(steer), thrust * np.sin(steer)
    side = real.walk * sum(
        float(T) * (0.7 + 0.45 * abs(T)) * (1.0 if T < 0.0 else 0.33) for T in thrust
    )
    return at(STERN, X.sum(), Y.sum() + side) + [0.0, 0.0, ASIDE * (X[0] - X[1])]


def damped(nu: Array, real: Real) -> Array:
    """The water's resistance: axis by axis, at the skeg, and section by section."""
    u, v, r = nu
    part = abs(nu) / USUAL
    each = DAMPING * (1.0 + (np.array(real.linear) - 1.0) * (0.8 + 0.2 * part))
    each += USUAL * np.array(real.square) * part**0.85 + USUAL**2 * np.array(real.cube) * part**1.8
    speed = hypot(u, v)
    force = -(each + [0.0, real.lift[0] * speed, real.lift[1] * speed]) * nu
    along = u * abs(u) / max(speed, 1e-9)  # a hull in a large drift lifts less
    force -= [0.0, real.way[0] * along * r, real.way[1] * along * v]
    x, section = PLACES, SECTION
    across = v + x * r
    if real.skeg:
        keel = (
            -DAMPING[1] * real.linear[1] * real.skeg * 12.0 / LENGTH**3 * x * across * section
        )  # fuller at one end
        force += [0.0, keel.sum(), (x * keel).sum()]
    if any(real.strips):
        fullness = 1.15 - 0.45 * (2.0 * x / LENGTH) ** 2  # bow and stern are fined
        drag = -0.5 * 1000.0 * real.strips[0] * DRAUGHT * section * fullness * across * abs(across)
        force += [-real.strips[1] * u * abs(u), drag.sum(), (x * drag).sum()]
    return np.asarray(force)


def held(y: Array, c: float, s: float, real: Real) -> Array:
    """What is fixed to the ground: a line from the stern to its anchor, a quay with a fender, and
    walls that brake and draw the boat."""
    force = np.zeros(3)
    fender, place = real.quay
    if fender:
        east = y[1] + OUTLINE[0] * s + OUTLINE[1] * c
        i = int(np.argmax(east))
        px, py = OUTLINE[:, i]
        depth = max(float(east[i]) - place, 0.0)
        into = s * (y[3] - y[5] * py) + c * (y[4] + y[5] * px)
        push = -fender * depth * (0.9 + depth) * (1.0 + max(into, -0.5))
        force += [s * push, c * push, px * c * push - py * s * push]
    stiffness, length, north, east = real.line
    if stiffness:
        reach = np.array([north - y[0] - STERN * c, east - y[1] - STERN * s])
        beyond = max(hypot(*reach) - length, 0.0)
        pull = (
            stiffness * beyond * (0.8 + 0.5 * beyond) / hypot(*reach) * reach
        )  # a rope that stiffens
        force += at(STERN, c * pull[0] + s * pull[1], c * pull[1] - s * pull[0])
    if any(real.walls):
        low, high = 1.0 / (
            1.0 + (abs(WALLS - y[:2]) / 0.48) ** 2
        )  # as far as a wall's mirror image is felt
        draw = real.walls[1] * (high - low)
        force += [c * draw[0] + s * draw[1], c * draw[1] - s * draw[0], 0.0]
        force -= real.walls[0] * (low + high).sum() * DAMPING * y[3:6]
    return force


def waves(t: float) -> Array:
    """Irregular seas about 2.4 rad/s, rms 1 on each of three axes: sixty components with random
    phases."""
    return np.sqrt(2.0 / len(SEA)) * np.cos(np.outer(SEA, np.full(3, t)) + PHASES).sum(axis=0)


TIDE = 40.0 / (2.0 * pi)  # [s] a stream's ups and downs last as long as a run
SEA = 2.4 + 0.25 * np.random.default_rng(11).standard_normal(60)  # [rad/s]
PHASES = np.random.default_rng(12).uniform(0.0, 2 * pi, (60, 3))


def seen(t: float, y: Array, real: Real) -> Array:
    """What camera and compass make of a boat in the water, which drifts with a stream that swells
    and ebbs."""
    x, north, psi = y[:3]
    ahead, starboard = real.antenna
    starboard -= (
        MAST * y[3] * y[5] / 9.81 if any(real.antenna) else 0.0
    )  # the boat leans out of a turn
    place = np.array(
        [
            x + cos(psi) * ahead - sin(psi) * starboard,
            north + sin(psi) * ahead + cos(psi) * starboard,
        ]
    )
    place += (t + 0.3 * TIDE * (1.0 - cos(t / TIDE))) * np.array(real.stream)
    place *= 1.0 + (np.array(real.scale) - 1.0) * (
        0.8 + 0.2 * hypot(*place)
    )  # a lens errs most at its edge
    constant, at_north, at_east = real.compass
    quarter = 0.1 * hypot(at_north, at_east) * sin(2.0 * psi)  # iron lying athwart
    return np.array([*place, psi + constant + at_north * cos(psi) + at_east * sin(psi) + quarter])


def played(steer: Array, play: float) -> Array:
    """Angles behind commands (N, 2) with the given total play, in which friction carries a part
    along."""
    out = np.zeros_like(steer)
    at: Array = np.zeros(2)
    for i, command in enumerate(steer):
        at = np.minimum(np.maximum(at, command - play / 2), command + play / 2)
        out[i] = 0.9 * at + 0.1 * command
    return out


def recorded(
    real: Real,
    seed: int,
    hold: int = 5,
    start: tuple[float, float, float] = (0.0, 0.0, 0.0),
    gyro: float = 0.0,
    log: float = 0.0,
) -> Recording:
    """40 s at 6 Hz from a pose at rest, of random steps held for some rows, seen by a camera with
    noise; with a gyro of this noise [rad/s] the yaw rate too, with a speed log of this noise [m/s]
    the velocities."""
    rng = np.random.default_rng(seed)
    dt, n = 1 / 6, 240
    steps = n // hold
    raw = np.column_stack([rng.uniform(-0.9, 0.9, (steps, 2)), rng.uniform(-0.6, 0.6, (steps, 2))])
    raw = np.repeat(raw, hold, axis=0)
    acts = np.column_stack([raw[:, :2], played(raw[:, 2:], real.play)])
    moments = dt * np.arange(n) - real.clock * (
        0.85 + 0.3 * np.arange(n) / n
    )  # at which the rows are true: it drifts
    first = min(0.0, -real.clock)
    arrivals = dt * np.arange(0, n, hold) + real.late * rng.uniform(0.75, 1.25, steps)
    ends = np.concatenate([[first], dt * np.arange(n + 1), moments, arrivals])
    ends = np.unique(np.round(np.append(ends[ends >= first], dt * n + 1), 9))
    y, poses = np.array([*start, 0.0, 0.0, 0.0, 0.0, 0.0]), {}
    turning, moving = {}, {}
    for a, b in zip(ends[:-1], ends[1:], strict=True):
        poses[round(a, 6)] = seen(a, y, real)
        turning[round(a, 6)] = y[5]
        moving[round(a, 6)] = y[3:5]
        step = max(int(np.searchsorted(arrivals, 0.5 * (a + b))) - 1, 0)
        y = solve_ivp(slopes, (a, b), y, args=(acts[hold * step], real), rtol=1e-6, atol=1e-8).y[
            :, -1
        ]
    t: Array = dt * np.arange(n, dtype=float)
    pose = np.array([poses[round(a, 6)] for a in moments]) + rng.standard_normal((n, 3)) * [
        0.003,
        0.003,
        0.012,
    ]
    signals = dict(zip(("x_m", "y_m", "psi_rad"), pose.T, strict=True)) | dict(
        zip(COMMANDS, raw.T, strict=True)
    )
    if gyro:
        rates = np.array([turning[round(a, 6)] for a in moments])
        signals["r_radps"] = rates + gyro * rng.standard_normal(n)
    if log:
        velocities = np.array([moving[round(a, 6)] for a in moments])
        velocities += log * rng.standard_normal((n, 2))
        signals |= dict(zip(("u_mps", "v_mps"), velocities.T, strict=True))
    return Recording(f"{seed}", t, signals, Notes(vessel="trial_boat"))
