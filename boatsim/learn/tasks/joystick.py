"""Joystick: move sideways and turn as a stick asks that is moved now and then."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from boatsim.learn.hull import Hulls, Motion, Scale
from boatsim.learn.tasks.base import Judged, Signal, Task
from boatsim.physics.base import param
from boatsim.physics.signals import Array

MOVES = 16  # of the stick in an episode, at most
TIME, SWAY, YAW, SURGE = range(4)  # what is remembered: seconds and integrals of squared errors


@dataclass(frozen=True)
class Joystick(Task):
    """Follow a stick that asks for sway and yaw rate, without going ahead or astern; it moves every `moves` seconds.

    The reward of a control step is minus its share of a second times the squared error of velocity over the square of
    what the stick asks for at most, yaw as the speed of bow and stern: -((u^2 + (v - v*)^2) / sway^2 + (r - r*)^2 /
    yaw^2), no less than -5. Episodes end with time only.
    """

    words: ClassVar[str] = "move sideways and turn as a stick asks"
    least_actions: ClassVar[int] = 3
    shares: ClassVar[int] = 3 * MOVES
    goals: ClassVar[int] = 2 * MOVES
    memory: ClassVar[int] = 4

    sway: float = param(
        0.08, low=0.005, high=1.0, unit="full speed", words="the fastest sway that is asked for"
    )
    yaw: float = param(
        0.2,
        low=0.01,
        high=2.0,
        unit="full speed / L",
        words="the fastest yaw rate that is asked for",
    )
    moves: float = param(
        10.0, low=0.5, high=1e4, unit="s", words="how long the stick stays as it is"
    )
    within: float = param(
        0.5,
        low=0.05,
        high=1.0,
        unit="",
        words="rms error over what is asked for at most, that will do",
    )

    def signals(self, scale: Scale) -> tuple[Signal, ...]:
        """The boat's velocity and the stick's."""
        sway, yaw = 2.0 * self.sway * scale.speed, 2.0 * self.yaw * scale.speed / scale.length
        return (
            Signal("u_mps", 2.0 * sway, "surge velocity over ground"),
            Signal("v_mps", sway, "sway velocity over ground"),
            Signal("r_radps", yaw, "yaw rate"),
            Signal("goal_sway_mps", sway, "the stick's"),
            Signal("goal_yaw_radps", yaw, "the stick's"),
        )

    def begin(self, shares: Array, scale: Scale) -> tuple[Array, Array]:
        """At rest; each move asks for sway, for yaw, for both or for none of them, one time in four each."""
        kind, rows = shares[:, :MOVES], len(shares)
        sway = self.sway * scale.speed * (2.0 * shares[:, MOVES : 2 * MOVES] - 1.0) * (kind < 0.5)
        yaw = self.yaw * scale.speed / scale.length * (2.0 * shares[:, 2 * MOVES :] - 1.0)
        return np.zeros((rows, 6)), np.concatenate(
            [sway, yaw * ((kind > 0.25) & (kind < 0.75))], axis=1
        )

    def look(
        self, m: Motion, t: Array, goal: Array, hulls: Hulls, scale: Scale
    ) -> tuple[Array, ...]:
        """Signals, then the bound of each error."""
        at = (t / self.moves + 1e-9).astype(np.int64) % MOVES
        boats = np.arange(len(at))
        return (m.u, m.v, m.r, goal[boats, at], goal[boats, MOVES + at])

    def judge(self, seen: tuple[Array, ...], memory: Array, period: float, scale: Scale) -> Judged:
        """Squared errors."""
        u, v, r, sway, yaw = seen
        surge_error = (u / (self.sway * scale.speed)) ** 2
        sway_error = ((v - sway) / (self.sway * scale.speed)) ** 2
        yaw_error = ((r - yaw) / (self.yaw * scale.speed / scale.length)) ** 2
        for k, error in ((SWAY, sway_error), (YAW, yaw_error), (SURGE, surge_error)):
            memory[:, k] += period * error
        memory[:, TIME] += period
        error = surge_error + sway_error + yaw_error
        lost = ~np.isfinite(error)
        return Judged(-period * np.minimum(np.where(lost, 5.0, error), 5.0), lost)

    def norms(
        self, seen: tuple[Array, ...], memory: Array, t: Array, scale: Scale
    ) -> dict[str, Array]:
        """Root mean square errors over what is asked for at most."""
        time = np.maximum(memory[:, TIME], 1e-9)
        surge, sway, yaw = (np.sqrt(memory[:, k] / time) for k in (SURGE, SWAY, YAW))
        return {
            "is_success": (surge < self.within) & (sway < self.within) & (yaw < self.within),
            "surge_error_rms": surge,
            "sway_error_rms": sway,
            "yaw_error_rms": yaw,
            "time_s": t,
        }
