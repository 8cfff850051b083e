"""Sections of a floating hull: breadth and area of its strips, cut from its closed mesh."""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from boatsim.errors import BadInput
from boatsim.physics.hull.mesh import ClosedMesh, mesh_of_file
from boatsim.physics.hull.submerged import Submerged, submerged_part, wetted_triangles
from boatsim.physics.signals import Array

# Share of the beam: triangles that reach less far across the centre plane lie on one side of it,
# because the corners of a file are rounded
ASIDE = 1e-6


@dataclass(frozen=True, eq=False)
class HullSections:
    """The submerged part of a hull in strips of equal length.

    Attributes:
        breadth: Area of the waterplane over the length of each strip (N,) from the stern, of all
            hulls [m].
        area: Volume over the length of each strip (N,), of all hulls [m^2].
        stern: Aft end of the submerged part, ahead of the origin of motion [m].
        bow: Forward end [m].
        depth: Depth of the lowest point below the waterline [m].
        spacing: Distance between the centres of the two hulls of a catamaran [m]; 0: one hull.
        whole: The whole submerged part.
    """

    breadth: Array
    area: Array
    stern: float
    bow: float
    depth: float
    spacing: float
    whole: Submerged

    def particulars(self) -> dict[str, float]:
        """Return the particulars of the hull, named as the parameters of strip wave loads.

        Lengths are in m and coefficients without unit. Breadth and coefficients are those of one
        hull of a catamaran. A coefficient is at most 1, also for a hull that is wider below the
        waterline than on it: its sections have their area all the same.
        """
        hulls = 2.0 if self.spacing > 0.0 else 1.0
        length, beam = self.bow - self.stern, float(self.breadth.max()) / hulls
        box = hulls * length * beam
        return {
            "length": length,
            "centre": 0.5 * (self.bow + self.stern),
            "hull_spacing": self.spacing,
            "hull_beam": beam,
            "block_coefficient": min(1.0, self.whole.volume / (box * self.depth)),
            "waterplane_coefficient": min(1.0, self.whole.area / box),
            "waterplane_gyradius": float(np.sqrt(self.whole.second[0, 0] / self.whole.area)),
            "flotation": float(self.whole.flotation[0]),
            "buoyancy": float(self.whole.centre[0]),
        }


def hull_sections(mesh: ClosedMesh, strips: int, label: str) -> HullSections:
    """Return the submerged part of a hull in strips of equal length.

    The pressure of still water on the surface of a strip gives its volume, and a constant pressure
    its waterplane; cuts across the hull contribute nothing to either. Breadth and area therefore
    add up to waterplane and volume of the mesh, exact but for rounding.

    Args:
        mesh: The hull with the waterline at z = 0.
        strips: Number of strips.
        label: Name of the mesh in messages.

    Raises:
        BadInput: The hull is not in the water, its waterplane has no area, or it lies on one side
            of the centre plane.
    """
    whole = submerged_part(mesh, 0.0)
    if not (whole.volume > 0.0 and whole.area > 0.0):
        raise BadInput(
            f"{label}: the hull does not float: {whole.volume:.4g} m^3 and a waterplane of "
            f"{whole.area:.4g} m^2 at this draught; allowed is a draught below its height"
        )
    wet = wetted_triangles(mesh.corners)
    port, starboard = float(wet[:, :, 1].min()), float(wet[:, :, 1].max())
    near = ASIDE * (starboard - port)
    if port > -near or starboard < near:
        side = "starboard" if port > -near else "port"
        nearest, farthest = sorted((abs(port), abs(starboard)))
        raise BadInput(
            f"{label}: the hull lies to {side} of the centre plane, from {nearest:.4g} to "
            f"{farthest:.4g} m; allowed is a whole hull about y = 0, or two hulls"
        )
    stern, bow = float(wet[:, :, 0].min()), float(wet[:, :, 0].max())
    edges = np.linspace(stern, bow, strips + 1)
    plane, volume = [0.0], [0.0]
    for edge in edges[1:-1]:
        areas = downward_areas(part_astern(wet, float(edge)))
        plane.append(float(areas.plane.sum()))
        volume.append(float(areas.volume.sum()))
    width = (bow - stern) / strips
    breadth = np.diff([*plane, whole.area]) / width
    area = np.diff([*volume, whole.volume]) / width
    depth = float(wet[:, :, 2].max())
    # Rounding leaves a strip without a waterplane with some 1e-16 of the largest
    return HullSections(
        np.where(breadth > ASIDE * breadth.max(), breadth, 0.0),
        np.where(area > ASIDE * area.max(), area, 0.0),
        stern,
        bow,
        depth,
        hull_spacing(wet),
        whole,
    )


@dataclass(frozen=True, eq=False)
class DownwardAreas:
    """Triangles seen from below.

    Attributes:
        plane: Area of each (N,) seen from below [m^2], negative if it faces upward.
        volume: Volume between each and the waterline (N,) [m^3], likewise.
    """

    plane: Array
    volume: Array


def downward_areas(corners: Array) -> DownwardAreas:
    """Return the areas of triangles seen from below, and the volumes above them.

    Args:
        corners: Corners (N, 3, 3) [m], z down from the waterline.
    """
    a, b, c = np.moveaxis(corners, 1, 0)
    plane = 0.5 * np.cross(b - a, c - a)[:, 2]
    return DownwardAreas(plane, plane * corners[:, :, 2].mean(axis=1))


def part_astern(corners: Array, edge: float) -> Array:
    """Return the parts of triangles astern of a place, as triangles (M, 3, 3).

    Args:
        corners: Corners (N, 3, 3) [m].
        edge: The place, along x [m].
    """
    # The hull is turned by a quarter about y, so that the cut takes the place of the surface
    turned = np.stack([corners[:, :, 2], corners[:, :, 1], edge - corners[:, :, 0]], axis=2)
    cut = wetted_triangles(turned)
    return np.stack([edge - cut[:, :, 2], cut[:, :, 1], cut[:, :, 0]], axis=2)


def hull_spacing(wet: Array) -> float:
    """Return the distance between the centres of two hulls' waterplanes [m]; 0 for one hull.

    There are two hulls if the submerged surface nowhere meets the centre plane.

    Args:
        wet: Corners (N, 3, 3) of the submerged surface [m].
    """
    y = wet[:, :, 1]
    near = ASIDE * float(np.ptp(y))
    starboard = y.min(axis=1) > near
    port = y.max(axis=1) < -near
    if not (starboard.any() and port.any() and np.all(starboard | port)):
        return 0.0
    centres = []
    for side in (starboard, port):
        plane = downward_areas(wet[side]).plane
        centres.append(float(plane @ y[side].mean(axis=1)) / float(plane.sum()))
    return centres[0] - centres[1]


@lru_cache(maxsize=16)
def sections_of_file(
    path: str, changed: int, scale: float, origin: float, draught: float, strips: int
) -> HullSections:
    """Return the sections of the mesh in a file.

    Args:
        path: STL or OBJ file.
        changed: Time of the file's last change, by which it is read again.
        scale: Length of a unit of the file [m].
        origin: Place of the origin of motion in the mesh [m].
        draught: Height of the waterline above the lowest point [m].
        strips: Number of strips.

    Raises:
        BadInput: It cannot be read, is not closed, does not float, or lies on one side of the
            centre plane.
    """
    mesh = mesh_of_file(path, scale).moved(-origin, 0.0, draught)
    return hull_sections(mesh, strips, path)
