"""Motion over the ground of the water on which waves travel."""

from dataclasses import dataclass, replace
from typing import Self

import numpy as np

from boatsim.physics.signals import Array


@dataclass(frozen=True, eq=False)
class WaterPath:
    """Displacement of water whose velocity is linear in time between given times.

    Before the first and after the last time the velocity is constant.

    Attributes:
        time: Times (N,) [s], increasing.
        velocity: Velocity over the ground to north and east (N, 2) [m/s].
        distance: Displacement (N, 2) since the first time [m].
        start: Time at t = 0 [s].
    """

    time: Array
    velocity: Array
    distance: Array
    start: float = 0.0

    @classmethod
    def steady(cls, north: float, east: float) -> Self:
        """Return the path of water of constant velocity.

        Args:
            north: Velocity to north [m/s].
            east: Velocity to east [m/s].
        """
        return cls(np.zeros(1), np.array([[north, east]]), np.zeros((1, 2)))

    @classmethod
    def of_velocities(cls, time: Array, velocity: Array, start: float = 0.0) -> Self:
        """Return the path of water of which the velocity is known at some times.

        Args:
            time: Times (N,) [s], increasing.
            velocity: Velocity to north and east (N, 2) [m/s].
            start: Time at t = 0 [s].
        """
        steps = 0.5 * np.diff(time)[:, None] * (velocity[1:] + velocity[:-1])
        distance = np.concatenate([np.zeros((1, 2)), np.cumsum(steps, axis=0)])
        return cls(time, velocity, distance, start)

    def scaled(self, factor: float) -> Self:
        """Return the path of water that moves with a multiple of this velocity.

        Args:
            factor: The multiple.
        """
        return replace(self, velocity=factor * self.velocity, distance=factor * self.distance)

    def displacement(self, t: float | Array) -> tuple[Array, Array]:
        """Return how far the water has moved since t = 0.

        Args:
            t: Time [s], a number or an array.

        Returns:
            Distance to north and to east [m], each of the shape of t.
        """
        moved = self._since_first(np.asarray(t) + self.start)
        moved = moved - self._since_first(np.asarray(self.start))
        return moved[..., 0], moved[..., 1]

    def _since_first(self, time: Array) -> Array:
        """Displacement (..., 2) since the first time."""
        low = np.clip(np.searchsorted(self.time, time, side="right") - 1, 0, len(self.time) - 1)
        high = np.minimum(low + 1, len(self.time) - 1)
        since = (time - self.time[low])[..., None]
        width = (self.time[high] - self.time[low])[..., None]
        change = self.velocity[high] - self.velocity[low]
        inside = (since > 0.0) & (width > 0.0)
        share = np.where(inside, since / np.where(width > 0.0, width, 1.0), 0.0)
        return np.asarray(self.distance[low] + since * (self.velocity[low] + 0.5 * share * change))
