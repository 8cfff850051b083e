"""The part of a closed mesh below a plane surface of water: volume, centre and waterplane."""

from dataclasses import dataclass
from math import cos, sin

import numpy as np

from boatsim.physics.hull.mesh import ClosedMesh
from boatsim.physics.signals import Array


@dataclass(frozen=True)
class Submerged:
    """Submerged part of a hull in level axes: x forward, y starboard, z down, from the origin.

    The origin is that of the mesh. Level axes have the heading of the hull, but neither its heel
    nor its trim.

    Attributes:
        volume: Volume [m^3].
        centre: Centre of buoyancy (3,) [m].
        area: Area of the waterplane [m^2].
        flotation: Centroid of the waterplane along x and y (2,) [m].
        second: Second moments of the waterplane about its centroid (2, 2), integrals of x x, x y
            and y y [m^4].
        rotation: Rotation (3, 3) from the axes of the mesh to level axes.
    """

    volume: float
    centre: Array
    area: float
    flotation: Array
    second: Array
    rotation: Array

    @property
    def body_centre(self) -> Array:
        """Centre of buoyancy (3,) in the axes of the mesh [m]."""
        return np.asarray(self.rotation.T @ self.centre)


def attitude(heel: float, trim: float) -> Array:
    """Return the rotation (3, 3) from the axes of a hull to level axes of the same heading.

    Args:
        heel: Roll angle [rad], starboard down.
        trim: Pitch angle [rad], bow up.
    """
    cf, sf, ct, st = cos(heel), sin(heel), cos(trim), sin(trim)
    return np.array([[ct, st * sf, st * cf], [0.0, cf, -sf], [-st, ct * sf, ct * cf]])


def submerged_part(
    mesh: ClosedMesh, depth: float, heel: float = 0.0, trim: float = 0.0
) -> Submerged:
    """Return the part of a hull below still water, exact but for rounding.

    Triangles that cross the surface are cut there. The integrals over volume and waterplane follow
    from those over the wetted surface by the divergence theorem, for which the waterplane need not
    be meshed.

    Args:
        mesh: The hull.
        depth: Depth of the origin of the mesh below the surface [m]; negative above it.
        heel: Roll angle [rad], starboard down.
        trim: Pitch angle [rad], bow up.
    """
    rotation = attitude(heel, trim)
    points = mesh.points @ rotation.T
    points[:, 2] += depth
    wet = wetted_triangles(points[mesh.faces])
    a, b, c = wet[:, 0], wet[:, 1], wet[:, 2]
    down = 0.5 * np.cross(b - a, c - a)[:, 2]  # area times the downward part of the normal
    # The mean at the middles of the edges is exact for polynomials of second degree
    middles = 0.5 * np.stack([a + b, b + c, c + a], axis=1)
    x, y, z = np.moveaxis(middles, -1, 0)

    def integral(values: Array) -> float:
        return float(down @ values.mean(axis=1))

    volume, area = integral(z), float(down.sum())
    level = np.array([0.0, 0.0, -depth])  # from the surface to the origin
    first = np.array([integral(x * z), integral(y * z), 0.5 * integral(z * z)])
    centre = first / volume + level if volume > 0.0 else level
    flotation, second = np.zeros(2), np.zeros((2, 2))
    if area > 0.0:
        flotation = np.array([integral(x), integral(y)]) / area
        across = integral((x - flotation[0]) * (y - flotation[1]))
        ahead = integral((x - flotation[0]) ** 2)
        second = np.array([[ahead, across], [across, integral((y - flotation[1]) ** 2)]])
    return Submerged(volume, centre, area, flotation, second, rotation)


def wetted_triangles(corners: Array) -> Array:
    """Return the parts of triangles below the surface z = 0, as triangles (M, 3, 3).

    Args:
        corners: Corners (N, 3, 3) [m], z down.
    """
    below = corners[:, :, 2] > 0.0
    count = below.sum(axis=1)
    found = [corners[count == 3]]
    for wet in (1, 2):
        own, is_wet = corners[count == wet], below[count == wet]
        if not len(own):
            continue
        # the corner that is alone on its side comes first, in the order of the triangle
        alone = np.argmax(is_wet == (wet == 1), axis=1)
        turned = (alone[:, None] + np.arange(3)) % 3
        a, b, c = np.moveaxis(own[np.arange(len(own))[:, None], turned], 1, 0)
        ab, ac = _crossing(a, b), _crossing(a, c)
        if wet == 1:
            found.append(np.stack([a, ab, ac], axis=1))
        else:
            found += [np.stack([ab, b, c], axis=1), np.stack([ab, c, ac], axis=1)]
    return np.concatenate(found)


def _crossing(a: Array, b: Array) -> Array:
    """Return the points (N, 3) at which edges from a to b cross the surface z = 0."""
    share = a[:, 2] / (a[:, 2] - b[:, 2])
    found = a + share[:, None] * (b - a)
    found[:, 2] = 0.0
    return np.asarray(found)
