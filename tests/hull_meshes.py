"""Meshes of bodies with closed forms, in SNAME axes."""

from pathlib import Path

import numpy as np
from scipy.spatial import ConvexHull

from boatsim.physics.base import Array
from boatsim.physics.hull.mesh import ClosedMesh, closed_mesh


def convex(points: Array, name: str = "body") -> ClosedMesh:
    """Mesh of the convex hull of points (n, 3)."""
    hull = ConvexHull(points)
    corners = points[hull.simplices]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    inward = np.einsum("ni,ni->n", normal, hull.equations[:, :3]) < 0.0
    corners[inward] = corners[inward][:, ::-1]
    return closed_mesh(corners, name)


def box(length: float, beam: float, depth: float) -> ClosedMesh:
    """Box with its middle over the origin, which lies in its bottom."""
    x, y, z = np.meshgrid([-length / 2, length / 2], [-beam / 2, beam / 2], [-depth, 0.0])
    return convex(np.column_stack([x.ravel(), y.ravel(), z.ravel()]), "box")


def prism(section: Array, length: float) -> ClosedMesh:
    """Prism along x with a convex section (n, 2) of y and z."""
    ends = []
    for x in (-length / 2, length / 2):
        ends.append(np.column_stack([np.full(len(section), x), section]))
    return convex(np.concatenate(ends), "prism")


def circle(radius: float, corners: int) -> Array:
    """Regular polygon (n, 2) around the origin with a corner at the bottom."""
    angle = 2.0 * np.pi * np.arange(corners) / corners
    return radius * np.column_stack([np.sin(angle), np.cos(angle)])


def sphere(radius: float, parts: int) -> ClosedMesh:
    """Sphere around the origin of 2 parts meridians and parts circles."""
    theta = np.pi * np.arange(parts + 1) / parts
    phi = np.pi * np.arange(2 * parts) / parts
    a, b = np.meshgrid(theta, phi, indexing="ij")
    points = np.stack([np.sin(a) * np.cos(b), np.sin(a) * np.sin(b), np.cos(a)], axis=-1)
    return convex(radius * np.unique(np.round(points.reshape(-1, 3), 12), axis=0), "sphere")


def wigley(length: float, beam: float, draught: float, parts: int) -> ClosedMesh:
    """Wigley's hull with vertical sides above the waterline, which is at z = 0."""
    x = np.linspace(-length / 2, length / 2, 2 * parts + 1)
    z = np.append(np.linspace(draught, 0.0, parts + 1), -0.5 * draught)
    stations, lines = np.meshgrid(x, z, indexing="ij")
    below = 1.0 - (np.maximum(lines, 0.0) / draught) ** 2
    y = 0.5 * beam * (1.0 - (2.0 * stations / length) ** 2) * below
    found = []
    for side in (1.0, -1.0):
        points = np.stack([stations, side * y, lines], axis=-1)
        a, b, c, d = points[:-1, :-1], points[1:, :-1], points[1:, 1:], points[:-1, 1:]
        for triangle in ((a, b, c), (a, c, d)):
            found.append(np.stack(triangle[:: int(side)], axis=2).reshape(-1, 3, 3))
    port, starboard = (np.stack([x, s * y[:, -1], lines[:, -1]], axis=1) for s in (-1.0, 1.0))
    for deck in (
        (port[:-1], starboard[1:], port[1:]),
        (port[:-1], starboard[:-1], starboard[1:]),
    ):
        found.append(np.stack(deck, axis=1))
    return closed_mesh(np.concatenate(found), "wigley")


def catamaran(hull: ClosedMesh, spacing: float) -> ClosedMesh:
    """Two equal hulls whose centre planes are a distance apart."""
    sides = [hull.moved(0.0, side * 0.5 * spacing, 0.0).corners for side in (-1.0, 1.0)]
    return closed_mesh(np.concatenate(sides), "catamaran")


def written(mesh: ClosedMesh, path: Path) -> Path:
    """A mesh as an OBJ file."""
    lines = [f"v {x:.12g} {-y:.12g} {-z:.12g}" for x, y, z in mesh.points]
    lines += ["f {} {} {}".format(*face) for face in mesh.faces + 1]
    path.write_text("\n".join(lines) + "\n")
    return path
