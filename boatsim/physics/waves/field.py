"""The elevation of the sea at any place and time, as a sum of plane waves."""

from dataclasses import dataclass
from typing import Self

import numpy as np

from boatsim.physics.signals import Array
from boatsim.physics.waves.water_path import WaterPath

MOST_TERMS = 100_000  # waves times places that are summed at once, which needs a few megabytes


@dataclass(frozen=True)
class WaveField:
    """Waves of a sea, whose sum is its elevation.

    The waves travel on the water, which may move over the ground. Coordinates are those of a run: x
    north or ahead at the start, y east or to starboard.

    Attributes:
        amplitude: Amplitudes (N,) [m].
        frequency: Angular frequencies (N,) seen by an observer that drifts with the water [rad/s].
        wave_number: Wave numbers (N,) [rad/m].
        direction: Directions (N,) to which the waves run, clockwise from x [rad].
        phase: Phases (N,) at the origin at t = 0 [rad]; a wave has a crest at phase 0.
        water_velocity: Velocity of the water over the ground along x and y [m/s], the part that is
            steady.
        water_paths: Motions of the water in addition, of which the velocity varies with time.
    """

    amplitude: Array
    frequency: Array
    wave_number: Array
    direction: Array
    phase: Array
    water_velocity: tuple[float, float] = (0.0, 0.0)
    water_paths: tuple[WaterPath, ...] = ()

    @classmethod
    def calm(cls) -> Self:
        """Return a field without waves."""
        return cls(*np.zeros((5, 0)))

    def __len__(self) -> int:
        """Number of waves."""
        return len(self.amplitude)

    def __repr__(self) -> str:
        """Number of waves and significant height; all numbers would fill pages."""
        return f"<WaveField, {len(self)} waves, significant height {self.significant_height:.4g} m>"

    @property
    def significant_height(self) -> float:
        """Four times the rms of the elevation over all times [m]."""
        return float(4.0 * np.sqrt(0.5 * np.sum(self.amplitude**2)))

    def elevation(self, x: float | Array, y: float | Array, t: float | Array) -> np.float64 | Array:
        """Return the elevation of the surface above the still water.

        That of one place and time does not depend on the others, to the last bit.

        Args:
            x: Place along x [m], a number or an array.
            y: Place along y [m], a number or an array.
            t: Time since the begin of the run [s], a number or an array.

        Returns:
            Elevation [m], positive upward, of the shape to which x, y and t broadcast.
        """
        east, north, time = np.broadcast_arrays(y, x, t)
        ahead = self.wave_number * np.cos(self.direction)
        aside = self.wave_number * np.sin(self.direction)
        north = north - self.water_velocity[0] * time
        east = east - self.water_velocity[1] * time
        for path in self.water_paths:
            moved = path.displacement(time)
            north, east = north - moved[0], east - moved[1]
        flat = [np.reshape(values, (-1, 1)) for values in (time, north, east)]
        total = np.empty(len(flat[0]))
        most = max(MOST_TERMS // max(len(self), 1), 1)
        for first in range(0, len(total), most):
            when, up, right = (values[first : first + most] for values in flat)
            angle = self.frequency * when - ahead * up - aside * right + self.phase
            total[first : first + most] = np.sum(self.amplitude * np.cos(angle), axis=1)
        if np.ndim(time) == 0:
            return np.float64(total[0])
        return total.reshape(np.shape(time))

    def joined_with(self, other: "WaveField") -> "WaveField":
        """Return the field of the waves of two seas on the same water.

        Args:
            other: The other sea; its velocity of the water does not count.
        """
        return WaveField(
            np.append(self.amplitude, other.amplitude),
            np.append(self.frequency, other.frequency),
            np.append(self.wave_number, other.wave_number),
            np.append(self.direction, other.direction),
            np.append(self.phase, other.phase),
            self.water_velocity,
            self.water_paths,
        )
