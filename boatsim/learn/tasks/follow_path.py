"""Follow a winding path at a steady speed."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import pi
from typing import ClassVar

import numpy as np

from boatsim.learn.actions import Use
from boatsim.learn.hull import Hulls, Motion, Scale
from boatsim.learn.tasks.base import Outcome, Signal, Task, wrap_angle
from boatsim.physics.base import param
from boatsim.physics.signals import Array

# Columns of the memory: distance made good [m], time [s], and the integral of the squared distance
# from the path [L^2 s].
DISTANCE, TIME, SQUARED_ERROR = range(3)
LOST = 5.0  # penalty for leaving the path; larger than the reward of several seconds


@dataclass(frozen=True)
class FollowPath(Task):
    """Follow the path y = a sin(k x + phase) at `cruise` in the direction of x.

    The radius of its bends is at least `tightest`. The reward of a control step is its duration in
    seconds times the ratio of the speed made good along the path to the required one, at most 1,
    times exp(-(distance / `near`)^2). An episode ends when the time is over, or, with a penalty of
    5, when the boat is `reach` away from the path.
    """

    words: ClassVar[str] = "follow a winding path at a steady speed"
    use: ClassVar[Use] = "underway"
    random_numbers: ClassVar[int] = 6
    goals: ClassVar[int] = 3
    memory: ClassVar[int] = 3

    cruise: float = param(0.4, low=0.05, high=1.0, unit="full speed", words="required speed")
    tightest: float = param(4.0, low=1.0, high=100.0, unit="L", words="smallest radius of the path")
    near: float = param(
        0.5,
        low=0.05,
        high=10.0,
        unit="L",
        words="distance from the path at which the reward is 1/e",
    )
    within: float = param(
        0.3, low=0.02, high=10.0, unit="L", words="largest rms distance from the path of a success"
    )
    steady: float = param(
        0.8,
        low=0.0,
        high=1.0,
        unit="",
        words="lowest ratio of the speed made good to the required one of a success",
    )
    reach: float = param(
        3.0, low=0.5, high=20.0, unit="L", words="distance from the path at which an episode ends"
    )

    def signals(self, scale: Scale) -> tuple[Signal, ...]:
        """Return the observations of path following; see `Task`.

        They are the distance from the path, its course here and ahead, and the velocity.
        """
        return (
            Signal(
                "aside_m",
                self.reach * scale.length,
                "distance of the boat to starboard of the path",
            ),
            Signal("aside_near_m", self.near * scale.length, "the same with a smaller bound"),
            Signal("sin_course", 1.0, "sine of the path's course here relative to the heading"),
            Signal("cos_course", 1.0, "cosine of it"),
            Signal(
                "course_1_rad", pi, "the path's course one length ahead, relative to the heading"
            ),
            Signal(
                "course_2_rad", pi, "the path's course two lengths ahead, relative to the heading"
            ),
            Signal("u_mps", scale.speed, "surge velocity over ground"),
            Signal("v_mps", 0.5 * scale.speed, "sway velocity over ground"),
            Signal("r_radps", scale.speed / scale.length, "yaw rate"),
        )

    def sample_episodes(self, uniforms: Array, scale: Scale) -> tuple[Array, Array]:
        """Sample initial states within half a length and half a radian of the path; see `Task`."""
        length = scale.length
        wave = 2.0 * pi / (length * (8.0 + 16.0 * uniforms[:, 0]))
        steepest = np.minimum(0.7 / wave, 1.0 / (self.tightest * length * wave**2))
        amplitude = steepest * uniforms[:, 1]
        phase = 2.0 * pi * uniforms[:, 2]
        goal = np.column_stack([amplitude, wave, phase])
        at_start = np.zeros(len(goal))
        y, course = self._path(at_start, goal)
        offset = uniforms[:, 3:5] - 0.5
        speed = self.cruise * scale.speed * uniforms[:, 5]
        others = np.zeros((len(goal), 2))
        starts = [at_start, y + length * offset[:, 0], course + offset[:, 1], speed, others]
        return np.column_stack(starts), goal

    def observe(
        self, m: Motion, t: Array, goal: Array, hulls: Hulls, scale: Scale
    ) -> tuple[Array, ...]:
        """Compute the observations, then the speed along the path [m/s]; see `Task`."""
        y, course = self._path(m.x, goal)
        aside = (m.y - y) * np.cos(course)
        _, course_1 = self._path(m.x + 1.0 * scale.length, goal)
        _, course_2 = self._path(m.x + 2.0 * scale.length, goal)
        return self.observe_path(m, aside, (course, course_1, course_2))

    def observe_path(self, m: Motion, aside: Array, courses: Sequence[Array]) -> tuple[Array, ...]:
        """Compute the observations from the distances and courses of any path.

        Args:
            m: True motion.
            aside: Distances (n,) of the boats to starboard of the path [m].
            courses: Courses (n,) of the path here, one and two lengths ahead [rad].

        Returns:
            The observations, then the speed along the path [m/s].
        """
        course, course_1, course_2 = courses
        turn = m.psi - course  # heading of the boat relative to the path
        c = np.cos(turn)
        s = np.sin(turn)
        ahead = (wrap_angle(course_1 - m.psi), wrap_angle(course_2 - m.psi))
        along = m.u * c - m.v * s
        return (aside, aside, -s, c, *ahead, m.u, m.v, m.r, along)

    def _path(self, x: Array, goal: Array) -> tuple[Array, Array]:
        """Lateral position y [m] and course [rad] of the path at x [m]."""
        amplitude, wave, phase = goal.T
        angle = wave * x + phase
        return amplitude * np.sin(angle), np.arctan(amplitude * wave * np.cos(angle))

    def outcome(
        self, observed: tuple[Array, ...], memory: Array, period: float, scale: Scale
    ) -> Outcome:
        """Return the reward for speed along the path and nearness to it; see `Task`."""
        aside = observed[0] / scale.length
        along = observed[-1]
        memory[:, TIME] += period
        memory[:, DISTANCE] += period * along
        memory[:, SQUARED_ERROR] += period * aside * aside
        lost = ~(np.abs(aside) < self.reach)
        progress = np.minimum(along / (self.cruise * scale.speed), 1.0)
        reward = period * progress * np.exp(-((aside / self.near) ** 2))
        return Outcome(np.where(lost, -LOST, reward), lost)

    def metrics(
        self, observed: tuple[Array, ...], memory: Array, t: Array, scale: Scale
    ) -> dict[str, Array]:
        """Return the distance from the path and the speed made good along it; see `Task`."""
        time = np.maximum(memory[:, TIME], 1e-9)
        rms = np.sqrt(memory[:, SQUARED_ERROR] / time)
        speed = memory[:, DISTANCE] / time
        near = np.abs(observed[0]) < self.reach * scale.length
        fast = speed > self.steady * self.cruise * scale.speed
        return {
            "is_success": near & (rms < self.within) & fast,
            "aside_rms_L": rms,
            "speed_made_good_mps": speed,
            "time_s": t,
        }
