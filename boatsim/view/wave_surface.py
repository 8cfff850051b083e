"""The moving surface of the sea around a vessel, as a grid of points for a 3D log."""

from dataclasses import dataclass
from typing import Self

import numpy as np
from numpy.typing import NDArray

from boatsim.physics.base import Array
from boatsim.physics.waves.field import WaveField
from boatsim.view.scene import Scene

POINTS = 25  # along each side of the grid; a frame of as many takes 15 kB in a file
FRAMES = 12.0  # in the period of the highest waves: enough for a smooth motion
SHORTEST = 0.1  # [s] between two frames at least


@dataclass(frozen=True)
class WaveSurface:
    """Grid of points on the surface of the sea, around the vessel or over its tank.

    Attributes:
        waves: The waves.
        length: Length of the grid along x [m].
        width: Width of the grid along y [m].
        centre: Middle of the grid, x and y [m]; None: the grid follows the vessel.
        step: Time between two frames [s].
    """

    waves: WaveField
    length: float
    width: float
    centre: tuple[float, float] | None
    step: float

    @classmethod
    def for_scene(cls, waves: WaveField, scene: Scene) -> Self:
        """Return the surface of a scene: the area of its water, which follows a vessel in the open.

        Args:
            waves: The waves, at least one.
            scene: What is drawn.
        """
        length, width, x, y = scene.tank
        highest = waves.frequency[int(np.argmax(waves.amplitude))]
        step = max(2.0 * np.pi / float(highest) / FRAMES, SHORTEST)
        centre = None
        if not scene.open:
            centre = (x, y)
        return cls(waves, length, width, centre, step)

    def rows_of_frames(self, t: Array, after: float = -np.inf) -> NDArray[np.intp]:
        """Return the rows of a log that are drawn: the first one of each frame.

        Args:
            t: Times (N,) [s], increasing.
            after: Time of the last row drawn before [s].
        """
        due, first = np.unique(np.floor(t / self.step + 1e-6), return_index=True)
        return np.asarray(first[due > np.floor(after / self.step + 1e-6)])

    def vertices(self, x: float, y: float, t: float) -> tuple[Array, Array]:
        """Return points and normals of the surface in axes of the picture, z up and y to port.

        Args:
            x: Place of the vessel along x [m].
            y: Place of the vessel along y [m].
            t: Time [s].

        Returns:
            Points (POINTS^2, 3) [m] and unit normals (POINTS^2, 3).
        """
        along = self.length / (POINTS - 1) * (np.arange(POINTS) - POINTS // 2)
        across = self.width / (POINTS - 1) * (np.arange(POINTS) - POINTS // 2)
        if self.centre is not None:
            x, y = self.centre
        north, east = np.meshgrid(x + along, y + across, indexing="ij")
        up = np.asarray(self.waves.elevation(north, east, t))
        ahead, aside = np.gradient(up, along, across)
        normals = np.stack([-ahead, aside, np.ones_like(up)], axis=-1).reshape(-1, 3)
        normals /= np.linalg.norm(normals, axis=1, keepdims=True)
        return np.column_stack([north.ravel(), -east.ravel(), up.ravel()]), normals

    @staticmethod
    def triangles() -> NDArray[np.uint32]:
        """Return the triangles between the points, (T, 3) indices, with their fronts upward."""
        corner = np.arange(POINTS * POINTS, dtype=np.uint32).reshape(POINTS, POINTS)
        a, b, c, d = corner[:-1, :-1], corner[1:, :-1], corner[:-1, 1:], corner[1:, 1:]
        first = np.stack([a, c, b], axis=-1).reshape(-1, 3)
        second = np.stack([b, c, d], axis=-1).reshape(-1, 3)
        return np.concatenate([first, second])
