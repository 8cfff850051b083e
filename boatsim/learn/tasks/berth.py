"""Berth alongside a quay, starting a few lengths away, and stay there."""

from dataclasses import dataclass
from math import radians
from typing import ClassVar

import numpy as np

from boatsim.learn.hull import Hulls, Motion, Scale
from boatsim.learn.tasks.base import Outcome, Signal, Task, wrap_angle
from boatsim.physics.base import param
from boatsim.physics.signals import Array
from boatsim.simulate.tank import Tank

# Columns of the memory: remaining distance and heading error [L], and time at the berth [s].
POTENTIAL, HELD = range(2)
# Weights of the reward; its unit is one boat length of progress.
BERTHED = 10.0  # reward for a completed berthing
LOST = 5.0  # penalty for touching the quay or leaving the harbour
TIME_COST = 0.02  # penalty for the time in which full speed covers one length
HEADING_WEIGHT = 0.5  # lengths per radian of heading error
CLOSENESS = 0.2  # reward per second at the berth; lower further away


@dataclass(frozen=True)
class Berth(Task):
    """Lie at a distance `gap` from a quay to port, on its heading, for `hold` seconds.

    The task is done, and the episode ends, when the origin of motion has been within `place` of the
    berth, the heading within `heading` and the speed of bow and stern below `speed` for `hold`
    seconds. The episode also ends, as a failure, when a corner of the hull touches the quay or the
    boat is `reach` away.

    The reward is the progress, which is the decrease of distance [L] + 0.5 |heading error| [rad],
    plus 0.2 per second times exp(-e / 2). Here e is the sum of squares of distance, heading error
    and speed, each divided by its tolerance: 0.1 L, 5 degrees and 0.03 L/s by default. Penalties
    are 0.02 for the time in which full speed covers one length, and 5 for touching the quay or
    leaving. A completed berthing adds 10.
    """

    words: ClassVar[str] = "berth alongside a quay, starting a few lengths away"
    random_numbers: ClassVar[int] = 6
    memory: ClassVar[int] = 2

    place: float = param(
        0.1, low=0.01, high=1.0, unit="L", words="largest distance from the berth of a success"
    )
    heading: float = param(
        radians(5.0), low=0.01, high=0.5, unit="rad", words="largest heading error of a success"
    )
    speed: float = param(
        0.03, low=0.005, high=0.5, unit="L/s", words="largest speed of bow and stern of a success"
    )
    hold: float = param(
        2.0, low=0.0, high=60.0, unit="s", words="time that the boat must stay at the berth"
    )
    gap: float = param(
        0.15, low=0.0, high=2.0, unit="L", words="between the quay and the boat's side at the berth"
    )
    near: float = param(
        1.5, low=0.3, high=10.0, unit="L", words="smallest distance from the berth at the start"
    )
    far: float = param(
        3.0, low=0.3, high=10.0, unit="L", words="largest distance from the berth at the start"
    )
    reach: float = param(
        6.0, low=1.0, high=20.0, unit="L", words="distance from the berth at which an episode ends"
    )

    def signals(self, scale: Scale) -> tuple[Signal, ...]:
        """Return the observations of berthing; see `Task`.

        They are the position of the berth, heading error, velocity and the room to the quay.
        """
        far = self.reach * scale.length
        near = 0.5 * scale.length
        return (
            Signal("ahead_m", far, "distance of the berth ahead of the boat"),
            Signal("starboard_m", far, "distance of the berth to starboard of the boat"),
            Signal("ahead_near_m", near, "the same with a bound of half a length"),
            Signal("starboard_near_m", near, "the same with a bound of half a length"),
            Signal("sin_heading", 1.0, "sine of the heading relative to the quay's"),
            Signal("cos_heading", 1.0, "cosine of it"),
            Signal("heading_near_rad", 0.3, "heading relative to the quay's, with a small bound"),
            Signal("u_mps", 0.5 * scale.speed, "surge velocity over ground"),
            Signal("v_mps", 0.5 * scale.speed, "sway velocity over ground"),
            Signal("r_radps", scale.speed / scale.length, "yaw rate"),
            Signal(
                "u_near_mps",
                0.1 * scale.speed,
                "surge velocity with a small bound",
            ),
            Signal("v_near_mps", 0.1 * scale.speed, "sway velocity with a small bound"),
            Signal("r_near_radps", 0.2 * scale.speed / scale.length, "yaw rate with a small bound"),
            Signal(
                "quay_m",
                scale.length,
                "distance between the quay and the nearest corner of the hull",
            ),
        )

    def basin(self, scale: Scale) -> Tank:
        """Return the basin of the berthing task, whose wall to port is the quay; see `Task`."""
        width = 2.0 * self.reach * scale.length
        quay = 0.5 * scale.beam + self.gap * scale.length
        return Tank(width, width, scale.length, centre=(0.0, 0.5 * width - quay))

    def sample_episodes(self, uniforms: Array, scale: Scale) -> tuple[Array, Array]:
        """Sample initial states for berthing, almost at rest and near the berth.

        The heading is within 90 degrees of the quay's and the bearing from the berth within 60
        degrees of the normal to the quay; see `Task`.
        """
        away = scale.length * (self.near + (self.far - self.near) * uniforms[:, 0])
        bearing = radians(60.0) * (2.0 * uniforms[:, 1] - 1.0)
        per_length = (1.0, 1.0, 1.0 / scale.length)
        velocity = 0.05 * scale.speed * (2.0 * uniforms[:, 3:6] - 1.0) * per_length
        psi = radians(90.0) * (2.0 * uniforms[:, 2] - 1.0)
        x = away * np.sin(bearing)
        y = away * np.cos(bearing)
        return np.column_stack([x, y, psi, velocity]), np.empty((len(psi), 0))

    def observe(
        self, m: Motion, t: Array, goal: Array, hulls: Hulls, scale: Scale
    ) -> tuple[Array, ...]:
        """Compute the observations, distance [L], heading error [rad] and speed [L/s]; see `Task`.

        Distance and heading error are those from the berth.
        """
        c = np.cos(m.psi)
        s = np.sin(m.psi)
        off = wrap_angle(m.psi)
        ahead = -c * m.x - s * m.y
        starboard = s * m.x - c * m.y
        quay = m.y + (0.5 * scale.beam + self.gap * scale.length)
        room = quay + hulls.middle * s - hulls.ahead * np.abs(s) - hulls.aside * np.abs(c)
        distance = np.sqrt(m.x * m.x + m.y * m.y) / scale.length
        aside = np.abs(m.v) + 0.5 * scale.length * np.abs(m.r)
        speed = np.sqrt(m.u * m.u + aside * aside) / scale.length
        place = (ahead, starboard, ahead, starboard)
        velocity = (m.u, m.v, m.r)
        return (*place, s, c, off, *velocity, *velocity, room, distance, off, speed)

    def initial_memory(self, observed: tuple[Array, ...], scale: Scale) -> Array:
        """Return the initial distance and heading error, and no time at the berth; see `Task`.

        The reward is computed from their decrease.
        """
        *_, distance, off, _ = observed
        potential = distance + HEADING_WEIGHT * np.abs(off)
        return np.column_stack([potential, np.zeros(len(off))])

    def outcome(
        self, observed: tuple[Array, ...], memory: Array, period: float, scale: Scale
    ) -> Outcome:
        """Return the reward of berthing: progress and nearness, less penalties; see `Task`.

        Time, touching the quay and leaving the area are penalised.
        """
        room, distance, off, speed = observed[-4:]
        heading_error = np.abs(off)
        potential = distance + HEADING_WEIGHT * heading_error
        placed = (distance < self.place) & (heading_error < self.heading)
        memory[:, HELD] = (memory[:, HELD] + period) * (placed & (speed < self.speed))
        squared_errors = (
            (distance / self.place) ** 2
            + (heading_error / self.heading) ** 2
            + (speed / self.speed) ** 2
        )
        done = memory[:, HELD] >= self.hold - 1e-9
        lost = ~((room > 0.0) & (distance < self.reach))
        time_cost = TIME_COST * period * scale.speed / scale.length
        reward = memory[:, POTENTIAL] - potential - time_cost + BERTHED * done
        reward += CLOSENESS * period * np.exp(-0.5 * squared_errors)
        memory[:, POTENTIAL] = potential
        return Outcome(np.where(lost, -LOST, reward), done | lost)

    def metrics(
        self, observed: tuple[Array, ...], memory: Array, t: Array, scale: Scale
    ) -> dict[str, Array]:
        """Return distance from the berth, heading error and speed at the end; see `Task`."""
        room, distance, off, speed = observed[-4:]
        touched = ~(room > 0.0)
        return {
            "is_success": (memory[:, HELD] >= self.hold - 1e-9) & ~touched,
            "touched": touched,
            "distance_L": distance,
            "heading_error_rad": np.abs(off),
            "speed_L": speed,
            "time_s": t,
        }
