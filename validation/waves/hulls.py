"""Meshes of hulls from particulars, as STL files."""

from collections.abc import Callable
from pathlib import Path

import numpy as np

from boatsim.physics.base import Array

Surface = Callable[[Array, Array], Array]


def pontoon_half_breadth(length: float, beam: float, draught: float) -> Surface:
    """Return the half-breadth of a pontoon with the coefficients of the Otter's.

    It is beam / 2 (1 - |2 x / L|^3) (1 - (z / T)^q) with the waterplane coefficient 3 / 4 and, by q
    = 8 / 7, the block coefficient 0.4 (T. I. Fossen, MSS toolbox, otter.m).

    Args:
        length: Length [m].
        beam: Beam [m].
        draught: Draught [m].
    """

    def half_breadth(x: Array, z: Array) -> Array:
        below = np.clip(-z / draught, 0.0, 1.0)
        along = 1.0 - np.abs(2.0 * x / length) ** 3
        return np.asarray(0.5 * beam * along * (1.0 - below ** (8.0 / 7.0)))

    return half_breadth


def shell(x: Array, z: Array, half_breadth: Surface, centre: float) -> Array:
    """Return the triangles (N, 3, 3) of both sides of a hull between stations and waterlines.

    Args:
        x: Stations (N,) [m], increasing.
        z: Waterlines (M,) [m], increasing, 0 at the surface.
        half_breadth: Half-breadth at places x and z.
        centre: Place of the centre plane to port [m].
    """
    stations, lines = np.meshgrid(x, z, indexing="ij")
    y = half_breadth(stations, lines)
    found = []
    for side in (1.0, -1.0):
        triangles = grid_triangles(np.stack([stations, centre + side * y, lines], axis=-1))
        if side < 0.0:
            triangles = triangles[:, ::-1]
        found.append(triangles)
    return np.concatenate(found)


def grid_triangles(points: Array) -> Array:
    """Return the triangles (N, 3, 3) between points of a grid.

    They are counter-clockwise seen from port if the first index increases forward and the second
    one upward.

    Args:
        points: Points (I, J, 3) [m].
    """
    a, b = points[:-1, :-1], points[1:, :-1]
    c, d = points[1:, 1:], points[:-1, 1:]
    first, second = np.stack([a, c, b], axis=2), np.stack([a, d, c], axis=2)
    return np.concatenate([first.reshape(-1, 3, 3), second.reshape(-1, 3, 3)])


def closed_hull(x: Array, z: Array, half_breadth: Surface, centre: float = 0.0) -> Array:
    """Return the triangles (N, 3, 3) of a hull with a flat deck on its highest waterline.

    The hull and its triangles are symmetric to its centre plane and to its middle.

    Args:
        x: Stations of the forward half (N,) [m], increasing from 0.
        z: Waterlines (M,) [m], increasing, 0 at the surface; the last is the deck.
        half_breadth: Half-breadth at places x and z, 0 at the lowest waterline and at the end.
        centre: Place of the centre plane to port [m].
    """
    y = half_breadth(x, np.full_like(x, z[-1]))
    top = np.full_like(x, z[-1])
    middle = np.column_stack([x, np.full_like(x, centre), top])
    halves = [shell(x, z, half_breadth, centre)]
    for side in (1.0, -1.0):
        edge = np.column_stack([x, centre + side * y, top])
        a, b, c, d = middle[:-1], middle[1:], edge[1:], edge[:-1]
        for corners in ((a, b, c), (a, c, d)):
            halves.append(np.stack(corners[:: int(side)], axis=1))
    forward = np.concatenate(halves)
    aft = (forward * np.array([-1.0, 1.0, 1.0]))[:, ::-1]
    return np.concatenate([forward, aft])


def revolved(profile: Array, meridians: int) -> Array:
    """Return the triangles (N, 3, 3) of a surface of revolution about the vertical axis.

    Args:
        profile: Radius and height of the circles (M, 2) [m], from the waterline to the keel.
        meridians: Number of panels around it.
    """
    around = np.linspace(0.0, 2.0 * np.pi, meridians + 1)
    radius, height = profile.T
    points = np.stack(
        [
            np.outer(radius, np.cos(around)),
            np.outer(radius, np.sin(around)),
            np.outer(height, np.ones(meridians + 1)),
        ],
        axis=-1,
    )
    a, b = points[:-1, :-1], points[:-1, 1:]
    c, d = points[1:, 1:], points[1:, :-1]
    first, second = np.stack([a, d, c], axis=2), np.stack([a, c, b], axis=2)
    return np.concatenate([first.reshape(-1, 3, 3), second.reshape(-1, 3, 3)])


def write_stl(path: Path, triangles: Array) -> None:
    """Write triangles to an STL file as text; those without area are left out.

    Args:
        path: The file.
        triangles: Corners (N, 3, 3) [m], counter-clockwise seen from the water.
    """
    lines = ["solid hull"]
    for corners in triangles:
        normal = np.cross(corners[1] - corners[0], corners[2] - corners[0])
        size = float(np.linalg.norm(normal))
        if size < 1e-12:
            continue
        lines.append("facet normal {:.9g} {:.9g} {:.9g}".format(*(normal / size)))
        lines.append("outer loop")
        lines += ["vertex {:.9g} {:.9g} {:.9g}".format(*corner) for corner in corners]
        lines += ["endloop", "endfacet"]
    lines.append("endsolid hull")
    path.write_text("\n".join(lines) + "\n", encoding="ascii")


def write_catamaran(path: Path, stations: int = 18, lines: int = 4) -> None:
    """Write the mesh of a catamaran with the particulars of the Otter.

    Args:
        path: The STL file.
        stations: Number of panels along the hull.
        lines: Number of panels over the draught.
    """
    length, beam, draught, spacing = 2.0, 0.25, 0.134146341463, 0.79  # [m], of `models/otter`
    x = -0.5 * length * np.cos(np.linspace(0.0, np.pi, stations + 1))
    z = np.append(np.linspace(-draught, 0.0, lines + 1), 0.5 * draught)
    half_breadth = pontoon_half_breadth(length, beam, draught)
    hulls = [shell(x, z, half_breadth, side * 0.5 * spacing) for side in (1.0, -1.0)]
    write_stl(path, np.concatenate(hulls))


def write_obj(path: Path, triangles: Array, about: str) -> None:
    """Write triangles to an OBJ file; those without area are left out.

    Args:
        path: The file.
        triangles: Corners (N, 3, 3) [m], counter-clockwise seen from the water.
        about: First line of the file.
    """
    rounded = np.round(triangles, 6) + 0.0
    points, place = np.unique(rounded.reshape(-1, 3), axis=0, return_inverse=True)
    lines = [f"# {about}"]
    lines += ["v {:.6f} {:.6f} {:.6f}".format(*point) for point in points]
    for a, b, c in place.reshape(-1, 3) + 1:
        if len({a, b, c}) == 3:
            lines.append(f"f {a} {b} {c}")
    path.write_text("\n".join(lines) + "\n", encoding="ascii")


def write_closed_catamaran(path: Path, stations: int = 5, lines: int = 2) -> None:
    """Write the closed mesh of a catamaran with the particulars of the Otter, with decks.

    The pontoons are as high above the waterline as below it, which is no published number.

    Args:
        path: The OBJ file.
        stations: Number of panels along each half of the hull.
        lines: Number of panels over the draught; there is one above the waterline.
    """
    length, beam, draught, spacing = 2.0, 0.25, 0.134146341463, 0.79  # [m], of `models/otter`
    x = 0.5 * length * np.sin(np.linspace(0.0, 0.5 * np.pi, stations + 1))
    z = np.append(np.linspace(-draught, 0.0, lines + 1), draught)
    half_breadth = pontoon_half_breadth(length, beam, draught)
    hulls = [closed_hull(x, z, half_breadth, side * 0.5 * spacing) for side in (1.0, -1.0)]
    about = "two pontoons of the Otter, z = 0 at the waterline: validation.waves.hulls"
    write_obj(path, np.concatenate(hulls), about)


def write_section(path: Path, section: "Section", length: float, along: int) -> None:
    """Write the mesh of a long body with the ship section of a flume.

    Args:
        path: The STL file.
        section: Dimensions of the section.
        length: Length of the body [m].
        along: Number of panels along it.
    """
    points = section.outline()
    x = np.linspace(-0.5 * length, 0.5 * length, along + 1)
    found = []
    for (y0, z0), (y1, z1) in zip(points[:-1], points[1:], strict=True):
        for x0, x1 in zip(x[:-1], x[1:], strict=True):
            a, b, c, d = (x0, y0, z0), (x1, y0, z0), (x1, y1, z1), (x0, y1, z1)
            found += [(a, b, c), (a, c, d)]
    for end, order in ((x[0], 1), (x[-1], -1)):
        ring = [(end, y, z) for y, z in points][::order]
        middle = (end, 0.0, float(np.mean([z for _, z in points])))
        for first, second in zip(ring[:-1], ring[1:], strict=True):
            found.append((middle, first, second))
        found.append((middle, ring[-1], ring[0]))
    write_stl(path, np.array(found))


class Section:
    """A box section with round bilges.

    Attributes:
        beam: Beam [m].
        draught: Draught [m].
        bilge: Radius of the bilges [m].
        panels: Numbers of panels on a side and on half of the bottom.
    """

    def __init__(
        self, beam: float, draught: float, bilge: float, panels: tuple[int, int] = (2, 2)
    ) -> None:
        """Set the dimensions.

        Args:
            beam: Beam [m].
            draught: Draught [m].
            bilge: Radius of the bilges [m].
            panels: Numbers of panels on a side and on half of the bottom.
        """
        self.beam, self.draught, self.bilge, self.panels = beam, draught, bilge, panels

    def outline(self) -> list[tuple[float, float]]:
        """Return points (y to port, z up) from the port side above water to starboard [m]."""
        half, depth, r = 0.5 * self.beam, self.draught, self.bilge
        freeboard = 0.25 * depth
        side, bottom = self.panels
        right = [(half, freeboard)]
        right += [(half, float(z)) for z in np.linspace(0.0, r - depth, side + 1)]
        for angle in np.linspace(0.0, 0.5 * np.pi, 4)[1:]:
            right.append((half - r + r * np.cos(angle), r - depth - r * np.sin(angle)))
        right += [(float(y), -depth) for y in np.linspace(half - r, 0.0, bottom + 1)[1:]]
        left = [(-y, z) for y, z in right[-2::-1]]
        return [(float(y), float(z)) for y, z in right + left]
