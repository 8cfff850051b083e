"""Hold a position and a heading in wind and current."""

from dataclasses import dataclass
from math import pi, radians
from typing import ClassVar

import numpy as np

from boatsim.learn.hull import Hulls, Motion, Scale
from boatsim.learn.tasks.base import Outcome, Signal, Task, wrap_angle
from boatsim.physics.base import param
from boatsim.physics.signals import Array

# Columns of the memory: time [s] after `settle`, and integrals of the squared distance [L^2 s] and
# of the squared heading error [rad^2 s].
TIME, SQUARED_DISTANCE, SQUARED_HEADING = range(3)
LOST = 10.0  # penalty for leaving; larger than the reward of several seconds


@dataclass(frozen=True)
class HoldStation(Task):
    """Stay within `place` (rms) of a station and within `heading` (rms) of its heading.

    Both count after `settle` seconds. The reward of a control step is (1 - e) times its duration in
    seconds, with e = 2 tanh(distance [L]) + |heading error| [rad] / 2 + 0.2 (speed / full speed)^2.
    An episode ends when the time is over, or, with a penalty of 10, when the boat is `reach` away.
    """

    words: ClassVar[str] = "hold a position and a heading in wind and current"
    random_numbers: ClassVar[int] = 3
    memory: ClassVar[int] = 3

    place: float = param(
        0.2, low=0.01, high=2.0, unit="L", words="largest rms distance of a success"
    )
    heading: float = param(
        radians(10.0),
        low=0.01,
        high=1.0,
        unit="rad",
        words="largest rms heading error of a success",
    )
    settle: float = param(20.0, low=0.0, high=1e4, unit="s", words="time after which errors count")
    start_within: float = param(
        0.5,
        low=0.0,
        high=5.0,
        unit="L",
        words="largest distance from the station at the start, along each axis",
    )
    reach: float = param(
        4.0,
        low=0.5,
        high=20.0,
        unit="L",
        words="distance from the station at which an episode ends",
    )

    def signals(self, scale: Scale) -> tuple[Signal, ...]:
        """Return the observations of station keeping; see `Task`.

        They are the position of the station, the heading error and the velocity.
        """
        far = self.reach * scale.length
        near = 0.5 * scale.length
        return (
            Signal("ahead_m", far, "distance of the station ahead of the boat"),
            Signal("starboard_m", far, "distance of the station to starboard of the boat"),
            Signal("ahead_near_m", near, "the same with a bound of half a length"),
            Signal("starboard_near_m", near, "the same with a bound of half a length"),
            Signal("sin_heading", 1.0, "sine of the heading relative to the station's"),
            Signal("cos_heading", 1.0, "cosine of it"),
            Signal("u_mps", 0.5 * scale.speed, "surge velocity over ground"),
            Signal("v_mps", 0.5 * scale.speed, "sway velocity over ground"),
            Signal("r_radps", scale.speed / scale.length, "yaw rate"),
        )

    def sample_episodes(self, uniforms: Array, scale: Scale) -> tuple[Array, Array]:
        """Sample initial states at rest near the station and its heading; see `Task`."""
        offset = 2.0 * uniforms - 1.0
        place = self.start_within * scale.length * offset[:, :2]
        at_rest = np.zeros((len(offset), 3))
        starts = np.column_stack([place, 0.5 * offset[:, 2], at_rest])
        return starts, np.empty((len(offset), 0))

    def observe(
        self, m: Motion, t: Array, goal: Array, hulls: Hulls, scale: Scale
    ) -> tuple[Array, ...]:
        """Compute the observations, distance [L], heading error [rad] and time [s]; see `Task`.

        Distance and heading error are those from the station to be kept.
        """
        c = np.cos(m.psi)
        s = np.sin(m.psi)
        ahead = -c * m.x - s * m.y
        starboard = s * m.x - c * m.y
        distance = np.sqrt(m.x * m.x + m.y * m.y) / scale.length
        signals = (ahead, starboard, ahead, starboard, s, c, m.u, m.v, m.r)
        return (*signals, distance, np.abs(wrap_angle(m.psi)), t)

    def outcome(
        self, observed: tuple[Array, ...], memory: Array, period: float, scale: Scale
    ) -> Outcome:
        """Return the reward for nearness to the station, its heading and low speed; see `Task`."""
        u, v, _, distance, heading_error, t = observed[-6:]
        counts = period * (t > self.settle)
        memory[:, TIME] += counts
        memory[:, SQUARED_DISTANCE] += counts * distance * distance
        memory[:, SQUARED_HEADING] += counts * heading_error * heading_error
        lost = ~(distance < self.reach)
        speed_squared = (u * u + v * v) / scale.speed**2
        rate = 1.0 - 2.0 * np.tanh(distance) - heading_error / 2.0 - 0.2 * speed_squared
        reward = period * rate
        return Outcome(np.where(lost, -LOST, reward), lost)

    def metrics(
        self, observed: tuple[Array, ...], memory: Array, t: Array, scale: Scale
    ) -> dict[str, Array]:
        """Return rms distance and heading error after settling at the station; see `Task`."""
        _, _, _, distance, _, _ = observed[-6:]
        time = np.maximum(memory[:, TIME], 1e-9)
        place = np.sqrt(memory[:, SQUARED_DISTANCE] / time)
        turn = np.sqrt(memory[:, SQUARED_HEADING] / time)
        held = (memory[:, TIME] > 0.0) & (distance < self.reach)
        return {
            "is_success": held & (place < self.place) & (turn < self.heading),
            "distance_rms_L": np.where(held, place, self.reach),
            "heading_rms_rad": np.where(held, turn, pi),
            "time_s": t,
        }
