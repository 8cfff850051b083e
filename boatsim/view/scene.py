"""Scene of a 3D log, taken from a compiled MuJoCo model: coloured triangles and places of arrows.

Axes are those of the picture: z up, x forward, y to port; SNAME (x, y, psi) appears as
(x, -y, -psi).
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from boatsim.physics.base import Array
from boatsim.physics.particulars import GRAVITY

if TYPE_CHECKING:
    from boatsim.physics.vessel import Vessel
    from boatsim.simulate.tank import Tank
from boatsim.simulate.world import Model

Triangles = NDArray[np.uint32]
DRAWN_GROUPS = (0, 1, 2)  # geom groups that MuJoCo's viewers draw; contact shapes are in group 3
OUTBOARD = "outboard_"  # prefix of bodies that turn with the steering of their side
# values of mjtGeom
SPHERE = 2
CAPSULE = 3
ELLIPSOID = 4
CYLINDER = 5
BOX = 6
MESH = 7
# twice the area of a triangle, by that of the box around all points, below which its corners count
# as lying on a line; far above rounding
FLATNESS = 1e-12
REACH = 0.6  # length of the arrow of full thrust, by the length of the vessel
# force of an arrow of that length by the weight of a vessel whose thrust is not a command
PUSH = 0.05


class Solid(NamedTuple):
    """Coloured shape of the hull, an outboard or the tank in a 3D log, made of triangles."""

    part: str
    name: str
    vertices: Array  # (V, 3) m, in the axes of the part
    triangles: Triangles  # (T, 3) indices into vertices
    colour: tuple[float, float, float, float]  # red, green, blue, opacity, 0 to 1


class Thruster(NamedTuple):
    """Position of a thruster's arrow in a 3D log, and the signals for its length and direction."""

    name: str  # "port"
    x: float  # [m] forward of the CG
    y: float  # [m] to starboard
    thrust: str  # column of the recording: "actual_thrust_port_N"
    steer: str  # column of its angle; one that does not exist means straight ahead


@dataclass(frozen=True)
class Scene:
    """Shapes of vessel and tank and positions of thrust arrows for a 3D log."""

    vessel: str
    length: float  # [m]
    # [m] length along x, width along y, centre x, centre y (SNAME)
    tank: tuple[float, float, float, float]
    solids: tuple[Solid, ...] = ()
    thrusters: tuple[Thruster, ...] = ()
    reach: float = 0.3  # [m/N] length of an arrow per newton
    open: bool = False  # no walls; the eye follows the vessel
    times: float = 1.0  # drawn size of vessels by their true size

    def enlarge_vessels(self, times: float) -> "Scene":
        """Return the scene with vessels drawn larger; water and paths do not change.

        Args:
            times: Factor of the size.
        """
        solids: list[Solid] = []
        for solid in self.solids:
            if solid.part != "tank":
                solid = solid._replace(vertices=times * solid.vertices)
            solids.append(solid)
        thrusters = [t._replace(x=times * t.x, y=times * t.y) for t in self.thrusters]
        return replace(
            self,
            length=times * self.length,
            solids=tuple(solids),
            thrusters=tuple(thrusters),
            times=times * self.times,
        )

    def hull_outline(self) -> Array:
        """Return the outline of the drawn hull from above, a closed convex polygon (V, 2) [m]."""
        points = np.concatenate([s.vertices[:, :2] for s in self.solids if s.part == "hull"])
        corners = convex_hull(points)
        return np.concatenate([corners, corners[:1]])


def convex_hull(points: Array) -> Array:
    """Return the corners (V, 2) of the convex hull of points in a plane, counterclockwise.

    It is the method of two chains (A. M. Andrew, Information Processing Letters 9, 1979), which
    needs none of scipy's geometry, whose import takes as long as a short run.

    Args:
        points: The points (N, 2).
    """
    ordered = np.unique(np.asarray(points, dtype=float), axis=0)  # by x, then by y
    flat = FLATNESS * float(np.prod(np.ptp(ordered, axis=0)))
    lower = _chain(ordered.tolist(), flat)
    upper = _chain(ordered[::-1].tolist(), flat)
    return np.array(lower[:-1] + upper[:-1])


def _chain(points: list[list[float]], flat: float) -> list[list[float]]:
    """The points at which the lower or upper half of a convex hull turns to the left."""
    found: list[list[float]] = []
    for x, y in points:
        while len(found) > 1:
            (ax, ay), (bx, by) = found[-2:]
            if (bx - ax) * (y - ay) - (by - ay) * (x - ax) > flat:
                break
            found.pop()
        found.append([x, y])
    return found


def scene_from_model(model: "Model", vessel: "Vessel", tank: "Tank") -> Scene:
    """Return the scene of a 3D log for a vessel in a tank, with the shapes of its MuJoCo model.

    Args:
        model: The compiled model.
        vessel: Its vessel.
        tank: Its tank.
    """
    thrust = [c.high for n, c in vessel.commands.items() if vessel.roles.get(n) == "thrust"]
    return Scene(
        vessel.name,
        vessel.length,
        (tank.length, tank.width, *tank.centre),
        _add_missing_hull(tuple(_solids(model)), vessel),
        tuple(_thrusters(vessel)),
        REACH * vessel.length / max(thrust, default=PUSH * GRAVITY * vessel.body.mass),
        open=not tank.walls,
    )


def plain_scene(length: float, beam: float, tank: tuple[float, float, float, float]) -> Scene:
    """Return the scene of a 3D log for a vessel without a model: a box with a pointed bow.

    Args:
        length: Length of the vessel [m].
        beam: Its beam [m].
        tank: Length, width and centre of the water [m].
    """
    half, side, low, high = 0.5 * length, 0.5 * beam, -0.05 * length, 0.08 * length
    outline = [(-half, side), (-half, -side), (0.5 * half, -side), (half, 0.0), (0.5 * half, side)]
    vertices = np.array([(x, y, z) for z in (low, high) for x, y in outline])
    caps = [(0, i + 1, i) for i in (1, 2, 3)] + [(5, 5 + i, 6 + i) for i in (1, 2, 3)]
    sides = [t for i in range(5) for j in [(i + 1) % 5] for t in ((i, j, 5 + j), (i, 5 + j, 5 + i))]
    solid = Solid(
        "hull", "hull", vertices, np.array(caps + sides, dtype=np.uint32), (0.93, 0.62, 0.13, 1.0)
    )
    return Scene("boat", length, tank, (solid,), (), REACH * length)


def _add_missing_hull(solids: tuple[Solid, ...], vessel: "Vessel") -> tuple[Solid, ...]:
    """The shapes of a model, with a box where its hull has none that can be drawn."""
    if "hull" in {solid.part for solid in solids}:
        return solids
    size = plain_scene(vessel.length, vessel.beam, (1.0, 1.0, 0.0, 0.0))
    return *solids, *size.solids


def _thrusters(vessel: "Vessel") -> Iterator[Thruster]:
    """A thruster for each effect with a thrust, at its position."""
    for effect in vessel.effects:
        on = vessel.bindings(effect) if "thrust" in type(effect).roles else {}
        if isinstance(on.get("thrust"), str):
            x, y = (float(getattr(effect, n, 0.0)) for n in ("x", "y"))
            yield Thruster(effect.name, x, y, f"actual_{on['thrust']}", f"actual_{on.get('angle')}")


def _solids(model: "Model") -> Iterator[Solid]:
    """All drawn shapes, in the axes of their part."""
    for geom in range(model.ngeom):
        if model.geom_group[geom] not in DRAWN_GROUPS:
            continue
        body = int(model.geom_bodyid[geom])
        shape = _geom_triangles(model, geom)
        if shape is not None:
            vertices, triangles = shape
            part, placed = _to_part_axes(
                model,
                body,
                _rotate_vertices(model.geom_quat[geom], vertices) + model.geom_pos[geom],
            )
            material = int(model.geom_matid[geom])
            rgba = model.mat_rgba[material] if material >= 0 else model.geom_rgba[geom]
            r, g, b, a = map(float, rgba)
            yield Solid(
                part, model.geom(geom).name or f"shape_{geom}", placed, triangles, (r, g, b, a)
            )


def _to_part_axes(model: "Model", body: int, vertices: Array) -> tuple[str, Array]:
    """Name of the part of a body, and the vertices in axes of the part."""
    while body:
        name = model.body(body).name
        if name == "hull" or name.startswith(OUTBOARD):
            return name, vertices
        vertices = _rotate_vertices(model.body_quat[body], vertices) + model.body_pos[body]
        body = int(model.body_parentid[body])
    return "tank", vertices


def _rotate_vertices(quaternion: Array, vertices: Array) -> Array:
    """Vertices (V, 3) rotated by a unit quaternion (w, x, y, z)."""
    w, axis = quaternion[0], quaternion[1:]
    cross = 2.0 * np.cross(axis, vertices)
    turned: Array = vertices + w * cross + np.cross(axis, cross)
    return turned


def _geom_triangles(model: "Model", geom: int) -> tuple[Array, Triangles] | None:
    kind, size = int(model.geom_type[geom]), model.geom_size[geom]
    if kind == MESH:
        mesh = int(model.geom_dataid[geom])
        at, count = model.mesh_vertadr[mesh], model.mesh_vertnum[mesh]
        face, faces = model.mesh_faceadr[mesh], model.mesh_facenum[mesh]
        return np.array(model.mesh_vert[at : at + count], dtype=float), model.mesh_face[
            face : face + faces
        ].astype("u4")
    if kind in (SPHERE, ELLIPSOID):
        vertices, triangles = _surface_of_revolution(
            [(np.cos(a), np.sin(a)) for a in np.linspace(-np.pi / 2, np.pi / 2, 17)]
        )
        return vertices * (size if kind == ELLIPSOID else size[0]), triangles
    if kind == CAPSULE:
        ends = [(np.cos(a), np.sin(a), np.sign(a)) for a in np.linspace(-np.pi / 2, np.pi / 2, 18)]
        return _surface_of_revolution(
            [(size[0] * r, size[0] * z + size[1] * end) for r, z, end in ends]
        )
    if kind == CYLINDER:
        vertices, triangles = _surface_of_revolution(
            [(0.0, -1.0), (1.0, -1.0), (1.0, 1.0), (0.0, 1.0)]
        )
        return vertices * (size[0], size[0], size[1]), triangles
    if kind == BOX:
        vertices, triangles = _surface_of_revolution(
            [(0.0, -1.0), (2**0.5, -1.0), (2**0.5, 1.0), (0.0, 1.0)], 4, np.pi / 4
        )
        return vertices * size, triangles
    return None


def _surface_of_revolution(
    profile: list[tuple[float, float]], around: int = 32, start: float = 0.0
) -> tuple[Array, Triangles]:
    """Surface of revolution about z of a profile of (radius, z); strips do not share vertices."""
    angles = start + np.linspace(0.0, 2.0 * np.pi, around, endpoint=False)
    vertices: list[Array] = []
    triangles: list[NDArray[np.int64]] = []
    for (r0, z0), (r1, z1) in zip(profile[:-1], profile[1:], strict=True):
        base = 2 * around * len(triangles)
        for r, z in ((r0, z0), (r1, z1)):
            vertices.append(
                np.column_stack([r * np.cos(angles), r * np.sin(angles), np.full(around, z)])
            )
        i, j = np.arange(around), (np.arange(around) + 1) % around
        strip = [(i, j, around + j), (i, around + j, around + i)]
        triangles.append(base + np.concatenate([np.column_stack(corner) for corner in strip]))
    return np.concatenate(vertices), np.concatenate(triangles).astype(np.uint32)
