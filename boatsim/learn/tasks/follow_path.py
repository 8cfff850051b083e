"""Follow path: along a winding path at a steady speed."""

from dataclasses import dataclass
from math import pi
from typing import ClassVar

import numpy as np

from boatsim.learn.actions import Use
from boatsim.learn.hull import Hulls, Motion, Scale
from boatsim.learn.tasks.base import Judged, Signal, Task, wrapped
from boatsim.physics.base import param
from boatsim.physics.signals import Array

AMPLITUDE, WAVE, PHASE = range(3)  # of a goal: [m], [1/m], [rad]
GONE, TIME, ASIDE = range(
    3
)  # what is remembered: x [m], seconds, integral of the squared distance [L^2 s]
LOST = 5.0  # off for losing the path


@dataclass(frozen=True)
class FollowPath(Task):
    """Keep to the path y = a sin(k x + phase) at `cruise`, along x; its bends are wider than `tightest`.

    The reward of a control step is the share of a second times the speed made good along the path over the one that is
    wanted, no more than 1, times exp(-(distance / `near`)^2). An episode ends with time, or, with 5 off, when the boat
    is `reach` beside the path.
    """

    words: ClassVar[str] = "along a winding path at a steady speed"
    use: ClassVar[Use] = "underway"
    shares: ClassVar[int] = 6
    goals: ClassVar[int] = 3
    memory: ClassVar[int] = 3

    cruise: float = param(0.4, low=0.05, high=1.0, unit="full speed", words="speed that is wanted")
    tightest: float = param(4.0, low=1.0, high=100.0, unit="L", words="smallest radius of the path")
    near: float = param(
        0.5, low=0.05, high=10.0, unit="L", words="beside the path, where the reward is 1/e"
    )
    within: float = param(
        0.3, low=0.02, high=10.0, unit="L", words="rms distance from the path that will do"
    )
    steady: float = param(
        0.8, low=0.0, high=1.0, unit="", words="mean speed made good over the wanted, that will do"
    )
    reach: float = param(
        3.0, low=0.5, high=20.0, unit="L", words="beside the path, where it is lost"
    )

    def signals(self, scale: Scale) -> tuple[Signal, ...]:
        """Where the path is, its course here and one and two lengths ahead, speed."""
        return (
            Signal("aside_m", self.reach * scale.length, "the boat, to starboard of the path"),
            Signal("aside_near_m", self.near * scale.length, "the same with a nearer bound"),
            Signal("sin_course", 1.0, "of the path's course here, off the heading"),
            Signal("cos_course", 1.0, "the same"),
            Signal("course_1_rad", pi, "the path's course a length ahead, off the heading"),
            Signal("course_2_rad", pi, "the same two lengths ahead"),
            Signal("u_mps", scale.speed, "surge velocity over ground"),
            Signal("v_mps", 0.5 * scale.speed, "sway velocity over ground"),
            Signal("r_radps", scale.speed / scale.length, "yaw rate"),
        )

    def begin(self, shares: Array, scale: Scale) -> tuple[Array, Array]:
        """At half the speed, beside the path by up to half a length, half a radian off its course."""
        length = scale.length
        wave = 2.0 * pi / (length * (8.0 + 16.0 * shares[:, 0]))
        steepest = np.minimum(0.7 / wave, 1.0 / (self.tightest * length * wave**2))
        amplitude, phase = steepest * shares[:, 1], 2.0 * pi * shares[:, 2]
        goal = np.column_stack([amplitude, wave, phase])
        y, course = self._path(np.zeros(len(goal)), goal)
        off = shares[:, 3:5] - 0.5
        speed = self.cruise * scale.speed * shares[:, 5]
        rest = np.zeros((len(goal), 2))
        return np.column_stack(
            [np.zeros(len(goal)), y + length * off[:, 0], course + off[:, 1], speed, rest]
        ), goal

    def look(
        self, m: Motion, t: Array, goal: Array, hulls: Hulls, scale: Scale
    ) -> tuple[Array, ...]:
        """Signals, then speed along the path [m/s]."""
        y, course = self._path(m.x, goal)
        turn = m.psi - course  # of the boat, off the path
        c, s = np.cos(turn), np.sin(turn)
        aside = (m.y - y) * np.cos(course)
        bends = [wrapped(self._path(m.x + k * scale.length, goal)[1] - m.psi) for k in (1.0, 2.0)]
        along = m.u * c - m.v * s
        return (aside, aside, -s, c, *bends, m.u, m.v, m.r, along)

    def _path(self, x: Array, goal: Array) -> tuple[Array, Array]:
        """Its y [m] and course [rad] at x."""
        amplitude, wave, phase = goal.T
        angle = wave * x + phase
        return amplitude * np.sin(angle), np.arctan(amplitude * wave * np.cos(angle))

    def judge(self, seen: tuple[Array, ...], memory: Array, period: float, scale: Scale) -> Judged:
        """How fast along, how near."""
        aside, along = seen[0] / scale.length, seen[-1]
        memory[:, TIME] += period
        memory[:, GONE] += period * along
        memory[:, ASIDE] += period * aside * aside
        lost = ~(np.abs(aside) < self.reach)
        made = np.minimum(along / (self.cruise * scale.speed), 1.0)
        reward = period * made * np.exp(-((aside / self.near) ** 2))
        return Judged(np.where(lost, -LOST, reward), lost)

    def norms(
        self, seen: tuple[Array, ...], memory: Array, t: Array, scale: Scale
    ) -> dict[str, Array]:
        """Distance from the path and speed made good along it."""
        time = np.maximum(memory[:, TIME], 1e-9)
        rms, speed = np.sqrt(memory[:, ASIDE] / time), memory[:, GONE] / time
        there = np.abs(seen[0]) < self.reach * scale.length
        kept = there & (rms < self.within) & (speed > self.steady * self.cruise * scale.speed)
        return {"is_success": kept, "aside_rms_L": rms, "speed_made_good_mps": speed, "time_s": t}
