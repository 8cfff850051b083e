"""Reference motion to a goal with limited speed and acceleration, for positions and headings."""

from dataclasses import dataclass
from math import hypot, sqrt

import numpy as np

from boatsim.control.base import wrap
from boatsim.physics.base import Array


@dataclass
class ReferenceMotion:
    """Reference point that moves straight to its goal and turns to its goal heading.

    Speed and acceleration are limited, so that the thrusters can follow. Near the goal the speed
    decreases such that the point arrives without overshoot.

    Attributes:
        approach: Time constant of the last part of the approach [s].
        position: x, y [m] and heading [rad] (3,).
        velocity: Their rates (3,), in earth axes.
        acceleration: The rates of these (3,).
    """

    approach: float

    def __post_init__(self) -> None:
        """Begin at the origin, at rest."""
        self.reset(np.zeros(3))

    def reset(self, position: Array) -> None:
        """Begin at a position, at rest.

        Args:
            position: x, y [m] and heading [rad] (3,).
        """
        self.position = np.array(position, float)
        self.velocity, self.acceleration = np.zeros(3), np.zeros(3)

    def step(self, goal: Array, speed: float, turn_rate: float, period: float) -> None:
        """Advance the reference by one period.

        Args:
            goal: x, y [m] and heading [rad] (3,); the heading is reached on the shorter side.
            speed: Largest speed [m/s].
            turn_rate: Largest rate of the heading [rad/s].
            period: Length of the period [s].
        """
        way = goal - self.position
        wanted = np.zeros(3)
        distance = hypot(way[0], way[1])
        if distance > 0.0:
            wanted[:2] = way[:2] / distance * self._speed_at(distance, speed, period)
        turn = wrap(way[2])
        wanted[2] = np.sign(turn) * self._speed_at(abs(turn), turn_rate, period)
        change = wanted - self.velocity
        room = speed / self.approach * period
        change[:2] *= min(1.0, room / max(hypot(change[0], change[1]), 1e-12))
        most = turn_rate / self.approach * period
        change[2] = min(max(change[2], -most), most)
        self.acceleration = change / period
        self.position += period * (self.velocity + 0.5 * change)
        self.velocity = self.velocity + change

    def _speed_at(self, distance: float, largest: float, period: float) -> float:
        """Speed at a distance from the goal.

        It is at most the largest one, then such that half the largest acceleration stops the
        reference, and proportional to the distance at the end.
        """
        braking = sqrt(largest / self.approach * distance)
        return min(largest, braking, distance / max(self.approach, period))
