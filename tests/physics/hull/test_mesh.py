"""Closed meshes of hulls: files, shared vertices, and the refusal of open or twisted surfaces."""

import struct
from pathlib import Path

import hull_meshes as bodies
import numpy as np
import pytest

from boatsim.errors import BadInput
from boatsim.physics.base import Array
from boatsim.physics.hull.mesh import closed_mesh, read_closed_mesh

OBJ = """# a tetrahedron with a polygon, counted from both ends
v 0 0 0
v 2 0 0
v 2 2 0
v 0 2 0
v 1 1 3
f 4/1 3/2 2//3 1
f 1 2 -1
f 2 3 -1
f 3 4 5

f 4 1 5
"""


def upward(corners: Array) -> Array:
    """Corners of SNAME axes in those of a file: y to port and z up."""
    return corners * np.array([1.0, -1.0, -1.0])


def stl_text(corners: Array) -> str:
    lines = ["solid body"]
    for triangle in corners:
        lines += ["facet normal 0 0 0", "outer loop"]
        lines += ["vertex {:.9g} {:.9g} {:.9g}".format(*point) for point in triangle]
        lines += ["endloop", "endfacet"]
    return "\n".join([*lines, "endsolid body", ""])


def binary_stl(corners: Array) -> bytes:
    parts = [b"binary".ljust(80), struct.pack("<I", len(corners))]
    for triangle in corners:
        parts.append(struct.pack("<12fH", 0.0, 0.0, 0.0, *triangle.ravel(), 0))
    return b"".join(parts)


def test_text_and_binary_stl_hold_the_same_mesh(tmp_path: Path) -> None:
    corners = upward(bodies.box(4.0, 1.5, 0.75).corners)
    (tmp_path / "text.stl").write_text(stl_text(corners))
    (tmp_path / "binary.STL").write_bytes(binary_stl(corners))
    for name in ("text.stl", "binary.STL"):
        mesh = read_closed_mesh(tmp_path / name, scale=0.5)
        assert (mesh.length, mesh.beam, mesh.height) == pytest.approx((2.0, 0.75, 0.375))
        assert mesh.volume == pytest.approx(2.0 * 0.75 * 0.375)
        assert mesh.points[:, 2].max() == 0.0  # the lowest point, z down
        assert len(mesh.points) == 8 and len(mesh.faces) == 12


def test_polygons_of_an_obj_file_become_triangles(tmp_path: Path) -> None:
    path = tmp_path / "pyramid.obj"
    path.write_text(OBJ)
    mesh = read_closed_mesh(path)
    assert len(mesh.faces) == 6
    assert mesh.volume == pytest.approx(2.0 * 2.0 * 3.0 / 3.0)


def test_mesh_that_faces_inwards_is_turned() -> None:
    corners = bodies.box(4.0, 1.5, 0.75).corners
    assert closed_mesh(corners[:, ::-1], "box").volume == pytest.approx(4.0 * 1.5 * 0.75)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda c: c[1:], "box: the mesh is open: 3 of 18 edges have a triangle on one side only"),
        (
            lambda c: np.concatenate([c[:1, ::-1], c[1:]]),
            "box: the triangles on both sides of 3 of 18 edges face different sides",
        ),
        (
            lambda c: np.concatenate([c, c[:, ::-1] + 10.0]),
            "box: the mesh has 2 parts, and the triangles of 1 of them face inwards",
        ),
    ],
)
def test_surface_without_an_inside_is_refused(change: object, message: str) -> None:
    corners = bodies.box(4.0, 1.5, 0.75).corners
    with pytest.raises(BadInput, match=message):
        closed_mesh(change(corners), "box")  # type: ignore[operator]


@pytest.mark.parametrize(
    ("name", "content", "message"),
    [
        ("hull.ply", "", "allowed are closed surfaces of triangles in .stl or .obj files"),
        ("hull.obj", "v 0 0 0\nf 1 2 3\n", "a face names vertex 2 of 1"),
        ("hull.obj", "v 0 0 zero\n", "the mesh cannot be read"),
        ("hull.stl", "solid x\nendsolid x\n", "0 triangles; allowed are 1 to"),
    ],
)
def test_file_that_is_no_mesh_is_refused(
    tmp_path: Path, name: str, content: str, message: str
) -> None:
    (tmp_path / name).write_text(content)
    with pytest.raises(BadInput, match=message):
        read_closed_mesh(tmp_path / name)


def test_missing_file_is_refused(tmp_path: Path) -> None:
    with pytest.raises(BadInput, match="there is no such file"):
        read_closed_mesh(tmp_path / "none.stl")
