"""Closed triangle meshes of hulls, from STL and OBJ files."""

from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from boatsim.errors import BadInput
from boatsim.physics.signals import Array

Whole = NDArray[np.int64]
KINDS = (".stl", ".obj")
# Points closer than this share of the mesh's size are one vertex: STL files repeat each vertex in
# all triangles around it, often rounded to single precision, whose relative error is 6e-8
SAME_POINT = 1e-6
MOST_TRIANGLES = 200_000  # of a file; a submerged part of this many takes some 0.1 s
MOST_BYTES = 100_000_000  # of a file; text of that many triangles has some 60 MB
STL_HEAD, STL_TRIANGLE = 84, 50  # bytes of a binary STL file
ALLOWED = "allowed are closed surfaces of triangles in .stl or .obj files"


@dataclass(frozen=True, eq=False)
class ClosedMesh:
    """Closed surface of a hull in SNAME axes: x forward, y starboard, z down.

    Attributes:
        points: Vertices (V, 3) [m].
        faces: Vertices of each triangle (N, 3), clockwise seen from outside along its normal's
            opposite, so that (b - a) x (c - a) points to the water.
    """

    points: Array
    faces: Whole

    @property
    def corners(self) -> Array:
        """Corners (N, 3, 3) of all triangles [m]."""
        return np.asarray(self.points[self.faces])

    @property
    def volume(self) -> float:
        """Enclosed volume [m^3]."""
        return float(_signed_volumes(self.points - self.points.mean(axis=0), self.faces).sum())

    @property
    def length(self) -> float:
        """Length over all [m]."""
        return float(np.ptp(self.points[:, 0]))

    @property
    def beam(self) -> float:
        """Breadth over all [m]."""
        return float(np.ptp(self.points[:, 1]))

    @property
    def height(self) -> float:
        """Height from the lowest to the highest point [m]."""
        return float(np.ptp(self.points[:, 2]))

    def moved(self, x: float, y: float, z: float) -> "ClosedMesh":
        """Return the mesh moved along its axes.

        Args:
            x: Distance forward [m].
            y: Distance to starboard [m].
            z: Distance down [m].
        """
        return ClosedMesh(self.points + np.array([x, y, z]), self.faces)


def read_closed_mesh(path: Path, scale: float = 1.0) -> ClosedMesh:
    """Return the mesh of a hull with its lowest point at z = 0 and x as in the file.

    Args:
        path: STL or OBJ file with x forward, y to port and z up. Its surface is closed: the deck is
            part of it.
        scale: Length of a unit of the file [m].

    Raises:
        BadInput: The file cannot be read, or its surface is open or has no consistent orientation.
    """
    if path.suffix.lower() not in KINDS:
        raise BadInput(f"{path}: {ALLOWED}")
    if not path.is_file():
        raise BadInput(f"{path}: there is no such file")
    size = path.stat().st_size
    if size > MOST_BYTES:
        raise BadInput(f"{path}: {size} bytes; allowed are {MOST_BYTES}")
    try:
        corners = _stl_corners(path) if path.suffix.lower() == ".stl" else _obj_corners(path)
    except (ValueError, IndexError, UnicodeDecodeError) as error:
        raise BadInput(f"{path}: the mesh cannot be read: {error}") from None
    if not 0 < len(corners) <= MOST_TRIANGLES:
        raise BadInput(f"{path}: {len(corners)} triangles; allowed are 1 to {MOST_TRIANGLES}")
    if not np.isfinite(corners).all():
        raise BadInput(f"{path}: the mesh has coordinates that are no finite numbers")
    # a turn by half a revolution about x, which keeps the orientation of the triangles
    mesh = closed_mesh(corners * np.array([scale, -scale, -scale]), str(path))
    return mesh.moved(0.0, 0.0, -float(mesh.points[:, 2].max()))


def time_of_change(path: str) -> int:
    """Return the time of a file's last change [ns]; 0 if there is no such file.

    Args:
        path: The file.
    """
    return Path(path).stat().st_mtime_ns if Path(path).is_file() else 0


def mesh_of_file(path: str, scale: float) -> ClosedMesh:
    """Return the mesh of a file, which is read once until it changes.

    Args:
        path: STL or OBJ file.
        scale: Length of a unit of the file [m].

    Raises:
        BadInput: It cannot be read, or is not closed.
    """
    return _mesh_of_file(path, time_of_change(path), scale)


@lru_cache(maxsize=8)
def _mesh_of_file(path: str, _changed: int, scale: float) -> ClosedMesh:
    """Return the mesh of a file; it is read again after the file has changed."""
    return read_closed_mesh(Path(path), scale)


def closed_mesh(corners: Array, label: str) -> ClosedMesh:
    """Return a closed mesh of triangles, with the outside on the side of their normals.

    A mesh whose triangles all face inwards is turned inside out.

    Args:
        corners: Corners (N, 3, 3) [m] in SNAME axes.
        label: Name of the mesh in messages.

    Raises:
        BadInput: The surface is open, or neighbouring triangles face different sides.
    """
    points, faces = _shared_vertices(corners)
    _check_edges(faces, label)
    volumes = _signed_volumes(points - points.mean(axis=0), faces)
    parts, number = _parts(faces, len(points))
    totals = np.bincount(number, volumes, parts)
    largest = np.abs(totals).max()
    inside_out = int(np.sum(totals < -SAME_POINT * largest))
    if largest <= 0.0:
        raise BadInput(f"{label}: the mesh encloses no volume; {ALLOWED}")
    if inside_out == parts:
        return ClosedMesh(points, faces[:, ::-1].copy())
    if inside_out:
        raise BadInput(
            f"{label}: the mesh has {parts} parts, and the triangles of {inside_out} of them face "
            "inwards; those of all parts must face the water"
        )
    return ClosedMesh(points, faces)


def _stl_corners(path: Path) -> Array:
    """Return the corners (N, 3, 3) of the triangles of an STL file."""
    content = path.read_bytes()
    count = int.from_bytes(content[STL_HEAD - 4 : STL_HEAD], "little")
    if len(content) == STL_HEAD + STL_TRIANGLE * count:
        record = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("more", "<u2")])
        return np.frombuffer(content, record, offset=STL_HEAD)["corners"].astype(float)
    rows = []
    for line in content.decode("ascii").splitlines():
        words = line.split()
        if words and words[0] == "vertex":
            rows.append([float(word) for word in words[1:4]])
    return np.array(rows, dtype=float).reshape(-1, 3, 3)


def _obj_corners(path: Path) -> Array:
    """Return the corners (N, 3, 3) of an OBJ file, whose polygons are divided into triangles."""
    points: list[list[float]] = []
    faces: list[tuple[int, int, int]] = []
    for line in path.read_text(encoding="utf-8").splitlines():
        words = line.split()
        if not words:
            continue
        if words[0] == "v":
            points.append([float(word) for word in words[1:4]])
        if words[0] == "f":
            ring = [_vertex_number(word, len(points)) for word in words[1:]]
            for b, c in zip(ring[1:-1], ring[2:], strict=True):
                faces.append((ring[0], b, c))
    return np.array(points, dtype=float).reshape(-1, 3)[np.array(faces, int).reshape(-1, 3)]


def _vertex_number(word: str, count: int) -> int:
    """Return the index of a vertex of an OBJ face: "7", "7/1/3", or "-1" for the last one."""
    number = int(word.split("/")[0])
    index = number - 1 if number > 0 else count + number
    if not 0 <= index < count:
        raise ValueError(f"a face names vertex {number} of {count}")
    return index


def _shared_vertices(corners: Array) -> tuple[Array, Whole]:
    """Return vertices (V, 3) and triangles (N, 3) of corners, without triangles of no area."""
    repeated = corners.reshape(-1, 3)
    size = float(np.ptp(repeated, axis=0).max())
    unique, place = np.unique(repeated, axis=0, return_inverse=True)
    pairs = cKDTree(unique).query_pairs(SAME_POINT * size, output_type="ndarray")
    links = coo_matrix((np.ones(len(pairs)), pairs.T), shape=(len(unique), len(unique)))
    count, group = connected_components(links, directed=False)
    first = np.full(count, len(unique))
    np.minimum.at(first, group, np.arange(len(unique)))
    faces = group[place.ravel()].reshape(-1, 3)
    a, b, c = faces.T
    return unique[first], faces[(a != b) & (b != c) & (c != a)].astype(np.int64)


def _check_edges(faces: Whole, label: str) -> None:
    """Raise BadInput unless each edge is used as often in one direction as in the other."""
    edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    direction = np.where(edges[:, 0] < edges[:, 1], 1, -1)
    _, place, uses = np.unique(
        np.sort(edges, axis=1), axis=0, return_inverse=True, return_counts=True
    )
    balance = np.bincount(place.ravel(), direction, len(uses))
    is_open = int(np.sum(uses % 2))
    if is_open:
        raise BadInput(
            f"{label}: the mesh is open: {is_open} of {len(uses)} edges have a triangle on one "
            "side only; buoyancy needs a closed surface, with transom and deck"
        )
    unequal = int(np.sum(balance != 0.0))
    if unequal:
        raise BadInput(
            f"{label}: the triangles on both sides of {unequal} of {len(uses)} edges face "
            "different sides; all triangles must face the water"
        )


def _signed_volumes(points: Array, faces: Whole) -> Array:
    """Return the volumes (N,) between each triangle and the origin, by their orientation."""
    a, b, c = (points[faces[:, i]] for i in range(3))
    return np.asarray(np.einsum("ni,ni->n", a, np.cross(b, c)) / 6.0)


def _parts(faces: Whole, vertices: int) -> tuple[int, Whole]:
    """Return the number of parts that share no vertex, and the part (N,) of each triangle."""
    begin, end = faces[:, [0, 1]].ravel(), faces[:, [1, 2]].ravel()
    links = coo_matrix((np.ones(len(begin)), (begin, end)), shape=(vertices, vertices))
    _, group = connected_components(links, directed=False)
    names, number = np.unique(group[faces[:, 0]], return_inverse=True)
    return len(names), number.ravel().astype(np.int64)
