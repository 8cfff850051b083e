"""Pilots: open-loop step commands, and a track keeper whose feedback conceals effects."""

from dataclasses import dataclass, field

import numpy as np

from validation.practice.cause import Rng
from validation.practice.motion import RUNS, Array, Boat, Motion
from validation.practice.sail import Grid

HELM = np.radians([5.0, 10.0, 20.0, 30.0])  # rudder angles of a ship's zig-zags
# [s] shortest and longest time for which an open-loop pilot holds a ship's rudder
HELM_TIMES = {"eastward_ho": (8.0, 28.0), "mariner": (20.0, 65.0)}
COURSE_TIMES = {"eastward_ho": 25.0, "mariner": 60.0}  # [s] for which a ship keeps a course
RELEASES = (
    0.32,
    0.12,
    0.22,
)  # [rad] heel at which the tank model is released; the last lies between the others


@dataclass
class OpenLoopPilot:
    """Commands of several levels, held for random times."""

    boat: Boat
    table: Array  # (rows, C, RUNS)
    start: tuple[Array, Array]

    def begin(self) -> tuple[Array, Array]:
        """Return the sampled start."""
        return self.start

    def command(self, row: int, pose: Array) -> Array:
        """Return the command of a row, independent of the boat."""
        return np.asarray(self.table[row])


def sample_open_loop_pilot(boat: Boat, grid: Grid, rng: Rng) -> OpenLoopPilot:
    """Sample an open-loop pilot.

    The ship runs zig-zags at several rudder angles; the tank model is released from several heels.
    """
    table = np.zeros((grid.rows, len(boat.channels), RUNS))
    usual = (1.5 * boat.scale, 4.0 * boat.scale)
    shortest, longest = HELM_TIMES.get(boat.name, usual)
    for run in range(RUNS):
        row = 0
        while row < grid.rows and len(boat.channels):
            until = row + max(round(rng.uniform(shortest, longest) / grid.row), 1)
            table[row:until, :, run] = sample_level(boat, rng)
            row = until
    q, nu = np.zeros((6, RUNS)), np.zeros((6, RUNS))
    q[:2] = rng.uniform(-boat.length, boat.length, (2, RUNS)) if 0 in boat.free else 0.0
    q[5] = rng.uniform(-np.pi, np.pi, RUNS) if 5 in boat.free else 0.0
    nu[0] = boat.cruise
    if not boat.channels:
        q[3] = np.array(RELEASES) * rng.uniform(0.9, 1.1, RUNS)
    return OpenLoopPilot(boat, table, (q, nu))


def sample_level(boat: Boat, rng: Rng) -> Array:
    """Sample the commands of one level."""
    if boat.name == "catamaran":
        return np.array(
            [rng.choice([0.0, 1.5, 3.0, 6.0, 9.0]), rng.choice([0.0, *rng.uniform(-1.2, 1.2, 4)])]
        )
    if boat.name == "joystick_boat":
        port, starboard = rng.choice([-200, -120, -60, 0, 60, 120, 200], 2)
        angle, toe = rng.uniform(-0.6, 0.6), rng.choice([0.0, 0.0, 0.15])
        return np.array([0.0, 0.0, angle + toe, angle - toe, port, starboard])
    if boat.name == "otter":
        both = rng.choice([-50.0, 0.0, 40.0, 60.0, 78.0])
        turn = rng.choice([-25.0, -10.0, 0.0, 10.0, 25.0])
        return np.array([both + turn, both - turn])
    if boat.name == "blueboat":
        both = rng.choice([-12.0, 0.0, 8.0, 16.0, 28.0])
        turn = rng.choice([-9.0, -4.0, 0.0, 4.0, 9.0])
        return np.array([both + turn, both - turn])
    helm = rng.choice([*HELM, 0.0])
    return np.array([helm if rng.integers(2) else -helm])


@dataclass
class TrackKeeper:
    """Track keeper on a polygon at two speeds.

    It has PI control of the speed and PID control of the heading to the next corner. It uses
    recorded poses only and estimates rates by its own filter. The ship keeps courses instead.
    """

    boat: Boat
    grid: Grid
    rng: Rng
    # (J, 2, RUNS) corners [m], or for the ship (J, 1, RUNS) courses [rad]
    legs: Array = field(init=False)
    speeds: Array = field(init=False)  # (J, RUNS) m/s

    def __post_init__(self) -> None:
        b, count = self.boat, 12
        usual = [0.25, 0.45]
        if b.name == "blueboat":  # its thrusters are strong for its length
            usual = [0.7, 1.2]
        self.speeds = self.rng.choice(usual, (count, RUNS)) * b.scale
        if b.cruise:
            self.legs = self.rng.uniform(-0.5, 0.5, (count, 1, RUNS))
        else:
            turns = self.rng.uniform(0.9, 1.9, (count, RUNS)) * self.rng.choice([-1.0, 1.0], RUNS)
            along = np.cumsum(turns, axis=0)
            self.legs = np.cumsum(
                4.0 * b.length * np.stack([np.cos(along), np.sin(along)], 1), axis=0
            )
        self.leg = np.zeros(RUNS, dtype=np.int64)
        self.filtered = np.zeros((6, RUNS))  # x y psi and their rates
        self.sums = np.zeros((2, RUNS))  # integrals of speed and heading errors

    def begin(self) -> tuple[Array, Array]:
        """Return the start with the heading to the first corner."""
        q, nu = np.zeros((6, RUNS)), np.zeros((6, RUNS))
        q[5] = (
            self.wanted(0)[0] if self.boat.cruise else np.arctan2(self.legs[0, 1], self.legs[0, 0])
        )
        nu[0] = self.boat.cruise or self.speeds[0]
        c, s = np.cos(q[5]), np.sin(q[5])
        self.filtered = np.array([q[0], q[1], q[5], nu[0] * c, nu[0] * s, 0.0 * c])
        return q, nu

    def wanted(self, row: int) -> tuple[Array, Array]:
        """Return desired heading [rad] and speed [m/s] (RUNS,)."""
        runs = np.arange(RUNS)
        if self.boat.cruise:
            leg = int(row * self.grid.row / COURSE_TIMES[self.boat.name])
            return np.asarray(self.legs[min(leg, len(self.legs) - 1), 0]), np.full(
                RUNS, self.boat.cruise
            )
        ahead = self.legs[self.leg, :, runs].T - self.filtered[:2]
        self.leg = np.minimum(
            self.leg + (np.hypot(*ahead) < 0.8 * self.boat.length), len(self.legs) - 1
        )
        ahead = self.legs[self.leg, :, runs].T - self.filtered[:2]
        return np.arctan2(ahead[1], ahead[0]), self.speeds[self.leg, runs]

    def command(self, row: int, pose: Array) -> Array:
        """Return the command for the recorded pose."""
        b, h = self.boat, self.grid.row
        if row:
            self.filtered[:3] += h * self.filtered[3:]
            quick = 3.0 * h / b.scale
            off = pose[[0, 1, 5]] - self.filtered[:3]
            self.filtered[:3] += min(quick, 0.8) * off
            self.filtered[3:] += min(quick, 0.8) ** 2 / 2.5 / h * off
        psi, r = self.filtered[2], self.filtered[5]
        u = np.cos(psi) * self.filtered[3] + np.sin(psi) * self.filtered[4]
        heading, speed = self.wanted(row)
        turn = np.remainder(heading - psi + np.pi, 2 * np.pi) - np.pi
        errors = np.array([speed - u, np.clip(turn, -0.6, 0.6)])
        w = np.array([[0.5], [0.9]]) / b.scale  # [rad/s] of the two loops
        self.sums += h * errors * (np.abs(turn) < 0.5)
        mass = b.hull + b.water
        X = mass[0, 0] * (2 * w[0] * errors[0] + 0.5 * w[0] ** 2 * self.sums[0])
        N = mass[5, 5] * (w[1] ** 2 * errors[1] - 1.6 * w[1] * r + 0.25 * w[1] ** 3 * self.sums[1])
        return allocate_commands(b, X, N)


def rudder_moment(boat: Boat) -> float:
    """Return the yaw moment of a ship's rudder at cruising speed [N m/rad]."""
    angle = 0.01  # [rad]
    none = np.zeros(2)
    nu = np.zeros((6, 2))
    nu[0] = boat.cruise
    act = np.array([[0.0, angle]])
    motion = Motion(none, np.zeros(2, dtype=np.int64), np.zeros((6, 2)), nu, nu, act)
    N = boat.law(boat.c, motion)[5]
    return float(N[1] - N[0]) / angle


def allocate_commands(boat: Boat, X: Array, N: Array) -> Array:
    """Return commands (C, RUNS) for X [N] ahead and N [N m], within the limits."""
    if boat.name == "eastward_ho":
        return np.clip(N / (-12.997 * boat.c["steer"]), -0.5, 0.5)[None]
    if boat.name == "mariner":
        return np.clip(N / rudder_moment(boat), -0.5, 0.5)[None]
    if boat.name == "blueboat":
        thrust = np.array([X / 2 + N / 0.57, X / 2 - N / 0.57])
        return np.asarray(np.clip(thrust, -27.7, 55.3))
    if boat.name == "catamaran":
        side = N / 0.4
        ahead = np.maximum(X, 0.3)
        return np.array(
            [np.minimum(np.hypot(ahead, side), 15.0), np.clip(np.arctan2(side, ahead), -1.3, 1.3)]
        )
    if boat.name == "otter":
        thrust = np.array([X / 2 + N / 0.79, X / 2 - N / 0.79])
        k = np.where(thrust > 0.0, 0.01108, 0.006445)
        return np.asarray(np.clip(np.sign(thrust) * np.sqrt(np.abs(thrust) / k), -95.0, 95.0))
    T = np.where(np.abs(X) < 0.1, 0.1, X) / 2  # of one outboard
    angle = np.clip(-N / T, -0.5, 0.5)
    rest = (N + T * np.sin(angle)) / 0.38
    pwm = np.clip(np.array([T + rest, T - rest]) * 150.0 / 0.617, -230, 230)
    return np.concatenate([0.0 * pwm, [angle, angle], pwm])
