"""Follow a joystick that requests sway velocity and yaw rate and moves at intervals."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from boatsim.learn.hull import Hulls, Motion, Scale
from boatsim.learn.tasks.base import Outcome, Signal, Task
from boatsim.physics.base import param
from boatsim.physics.signals import Array

MOVES = 16  # positions of the stick that are sampled for an episode; they repeat afterwards
# Columns of the memory: time [s] and integrals of squared errors.
TIME, SWAY, YAW, SURGE = range(4)


@dataclass(frozen=True)
class Joystick(Task):
    """Follow a stick that requests sway velocity and yaw rate, without surge.

    The stick moves every `moves` seconds. The reward of a control step is minus its duration in
    seconds times the squared error of the velocity, relative to the largest requests:
    ((u^2 + (v - v*)^2) / sway^2 + (r - r*)^2 / yaw^2), at most 5. An episode ends when the time is
    over.
    """

    words: ClassVar[str] = "move sideways and turn as a stick requests"
    least_actions: ClassVar[int] = 3
    random_numbers: ClassVar[int] = 3 * MOVES
    goals: ClassVar[int] = 2 * MOVES
    memory: ClassVar[int] = 4

    sway: float = param(
        0.08, low=0.005, high=1.0, unit="full speed", words="largest requested sway velocity"
    )
    yaw: float = param(
        0.2,
        low=0.01,
        high=2.0,
        unit="full speed / L",
        words="largest requested yaw rate",
    )
    moves: float = param(
        10.0, low=0.5, high=1e4, unit="s", words="time between two moves of the stick"
    )
    within: float = param(
        0.5,
        low=0.05,
        high=1.0,
        unit="",
        words="largest rms error of a success, relative to the largest request",
    )

    def signals(self, scale: Scale) -> tuple[Signal, ...]:
        """Return the observations: velocity of the boat and velocity requested by a stick.

        See `Task`.
        """
        sway = 2.0 * self.sway * scale.speed
        yaw = 2.0 * self.yaw * scale.speed / scale.length
        return (
            Signal("u_mps", 2.0 * sway, "surge velocity over ground"),
            Signal("v_mps", sway, "sway velocity over ground"),
            Signal("r_radps", yaw, "yaw rate"),
            Signal("goal_sway_mps", sway, "requested sway velocity"),
            Signal("goal_yaw_radps", yaw, "requested yaw rate"),
        )

    def sample_episodes(self, uniforms: Array, scale: Scale) -> tuple[Array, Array]:
        """Sample initial states at rest, and the sequence of velocities that the stick requests.

        A move requests sway, yaw, both or neither, each with probability 1/4; see `Task`.
        """
        kind = uniforms[:, :MOVES]
        sway_numbers = 2.0 * uniforms[:, MOVES : 2 * MOVES] - 1.0
        yaw_numbers = 2.0 * uniforms[:, 2 * MOVES :] - 1.0
        sway = self.sway * scale.speed * sway_numbers * (kind < 0.5)
        yaw = self.yaw * scale.speed / scale.length * yaw_numbers
        yaw_requested = (kind > 0.25) & (kind < 0.75)
        goals = np.concatenate([sway, yaw * yaw_requested], axis=1)
        return np.zeros((len(uniforms), 6)), goals

    def observe(
        self, m: Motion, t: Array, goal: Array, hulls: Hulls, scale: Scale
    ) -> tuple[Array, ...]:
        """Compute the observations, velocity and requested velocity of the boat; see `Task`."""
        move = (t / self.moves + 1e-9).astype(np.int64) % MOVES
        boats = np.arange(len(move))
        return (m.u, m.v, m.r, goal[boats, move], goal[boats, MOVES + move])

    def outcome(
        self, observed: tuple[Array, ...], memory: Array, period: float, scale: Scale
    ) -> Outcome:
        """Return the reward, minus the squared error from the requested velocity; see `Task`."""
        u, v, r, sway, yaw = observed
        surge_error = (u / (self.sway * scale.speed)) ** 2
        sway_error = ((v - sway) / (self.sway * scale.speed)) ** 2
        yaw_error = ((r - yaw) / (self.yaw * scale.speed / scale.length)) ** 2
        for k, error in ((SWAY, sway_error), (YAW, yaw_error), (SURGE, surge_error)):
            memory[:, k] += period * error
        memory[:, TIME] += period
        error = surge_error + sway_error + yaw_error
        lost = ~np.isfinite(error)
        return Outcome(-period * np.minimum(np.where(lost, 5.0, error), 5.0), lost)

    def metrics(
        self, observed: tuple[Array, ...], memory: Array, t: Array, scale: Scale
    ) -> dict[str, Array]:
        """Return rms velocity errors relative to the largest requests; see `Task`."""
        time = np.maximum(memory[:, TIME], 1e-9)
        surge = np.sqrt(memory[:, SURGE] / time)
        sway = np.sqrt(memory[:, SWAY] / time)
        yaw = np.sqrt(memory[:, YAW] / time)
        return {
            "is_success": (surge < self.within) & (sway < self.within) & (yaw < self.within),
            "surge_error_rms": surge,
            "sway_error_rms": sway,
            "yaw_error_rms": yaw,
            "time_s": t,
        }
