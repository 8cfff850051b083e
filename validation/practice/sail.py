"""Simulation of three runs: actuators, ambient forces, Runge-Kutta steps and instruments."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple, Protocol

import numpy as np
from scipy.signal import lfilter

from validation.practice.cause import (
    Cause,
    Rng,
    apply_number_changes,
    instrument_pose,
    sum_of_forces,
    water_velocity,
)
from validation.practice.motion import RUNS, Array, Boat, runge_kutta_step

LEAD = 1.0  # [s at 1.2 m] duration of the first commands before the first row


@dataclass(frozen=True)
class Grid:
    """Fine steps and rows."""

    dt: float  # [s]
    every: int  # steps per row
    rows: int
    lead: int  # steps before the first row

    @property
    def row(self) -> float:
        """Interval of the rows [s]."""
        return self.dt * self.every

    @property
    def steps(self) -> int:
        """Number of steps from the first row to the last."""
        return self.every * (self.rows - 1)


class Pilot(Protocol):
    """Interface of a pilot."""

    def begin(self) -> tuple[Array, Array]:
        """Return pose and rates (6, RUNS) at the start."""

    def command(self, row: int, pose: Array) -> Array:
        """Return the commands (C, RUNS) of a row for the recorded pose (6, RUNS)."""


class ActuatorHistory(NamedTuple):
    """Actuators at begin, middle and end of every step, each (K, A, RUNS)."""

    begin: Array
    middle: Array
    end: Array


class Actuators:
    """Actuators of a boat, settled at the first commands."""

    def __init__(self, boat: Boat, causes: Sequence[Cause], dt: float) -> None:
        self.boat, self.dt = boat, dt
        self.causes = [c.drive(boat, dt) for c in causes if c.drive]
        self.quick = (boat.drive.lag == 0.0)[:, None]
        self.y: Array | None = None

    def step(self, commands: Array, k: int) -> tuple[Array, Array, Array]:
        """Advance over step k from the first row on, with commands (C, RUNS)."""
        goal = self.boat.drive.goals(commands)
        for cause in self.causes:
            goal = cause(goal, k)
        y = goal if self.y is None else self.y
        if self.quick.all():
            self.y = goal
            return goal, goal, goal
        half, end = (self.boat.drive.follow(y, goal, s) for s in (self.dt / 2, self.dt))
        self.y = end
        return np.where(self.quick, goal, y), half, end


@dataclass(frozen=True)
class Voyage:
    """Runs on the fine grid, K steps; the first `grid.lead` come before the first row."""

    grid: Grid
    q: Array  # (K, 6, RUNS)
    nu: Array  # (K, 6, RUNS)
    push: Array  # (K, 6, RUNS) ambient force held over each step
    commands: Array  # (rows, C, RUNS)
    recorded: Array  # (rows, 6, RUNS) with noise

    def row_of(self, k: int) -> int:
        """Return the row of commands of step k, which may lie before the first row."""
        return min(max(k, 0) // self.grid.every, self.grid.rows - 1)

    def actuators(self, boat: Boat, causes: Sequence[Cause]) -> ActuatorHistory:
        """Return the actuators of another boat under the same commands."""
        chain = Actuators(boat, causes, self.grid.dt)
        found = []
        for i in range(len(self.q)):
            found.append(
                chain.step(self.commands[self.row_of(i - self.grid.lead)], i - self.grid.lead)
            )
        return ActuatorHistory(*(np.array(part) for part in zip(*found, strict=True)))


def ambient_forces(boat: Boat, n: int, dt: float, rng: Rng) -> Array:
    """Return Ornstein-Uhlenbeck forces (n, 6, RUNS) in body axes, 1 s Froude-scaled."""
    keep = np.exp(-dt / boat.scale)
    white = rng.standard_normal((n, 6, RUNS))
    white[1:] *= np.sqrt(1.0 - keep * keep)
    return np.asarray(lfilter([1.0], [1.0, -keep], white, axis=0) * boat.ambient()[:, None])


def simulate_voyage(
    boat: Boat, causes: Sequence[Cause], pilot: Pilot, grid: Grid, noise: Array, rng: Rng
) -> Voyage:
    """Simulate the real boat; `noise` (6,) is that of its instruments."""
    real = apply_number_changes(boat, causes)
    count = grid.lead + grid.steps + 1
    push = ambient_forces(boat, count, grid.dt, rng)
    errors = noise[:, None] * rng.standard_normal((grid.rows, 6, RUNS))
    late = round(max((c.late for c in causes), key=abs, default=0.0) / grid.dt)
    chain = Actuators(real, causes, grid.dt)
    force = sum_of_forces(real, causes)
    flow = water_velocity(causes)
    inverse = real.inverse()
    q, nu = pilot.begin()
    u = pilot.command(0, instrument_pose(causes, q))
    Q, NU, commands, recorded = [], [], [], []
    run = np.arange(RUNS)
    for i in range(count):
        k = i - grid.lead
        Q.append(q)
        NU.append(nu)
        if k >= 0 and k % grid.every == 0:
            recorded.append(instrument_pose(causes, Q[max(i - late, 0)]) + errors[k // grid.every])
            u = pilot.command(k // grid.every, recorded[-1]) if k else u
            commands.append(u)
        q, nu = runge_kutta_step(
            real,
            np.full(RUNS, k * grid.dt),
            run,
            q,
            nu,
            chain.step(u, k),
            grid.dt,
            push[i],
            force,
            flow,
            inverse,
        )
    return Voyage(grid, np.array(Q), np.array(NU), push, np.array(commands), np.array(recorded))
