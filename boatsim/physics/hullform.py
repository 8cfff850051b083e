"""Draws the deep-V hull of a small outboard motor boat from its particulars.

`python -m boatsim.physics.hullform models/VESSEL` writes OBJ meshes with the origin at the transom
on the centreline at the design waterline; x forward, y to port, z up.
"""

import math
import sys
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from boatsim.physics.base import Array

Curve = Callable[[Array], Array]  # of s = x / length, 0 at the transom, 1 at the tip of the bow
AROUND = 20  # points around a rounded body


@dataclass(frozen=True)
class DeepV:
    """Lines (keel, chine, sheer) of a hard-chine planing hull.

    Its deadrise is constant up to `parallel` and increases (warp) forward of it.
    """

    length: float = 1.2  # [m] Bayless 2017, table 27
    beam: float = 0.30  # [m] same
    draught: float = 0.06  # [m] same
    deadrise: float = math.radians(25.0)  # [rad] same, section II
    parallel: float = 0.55  # [-] part of the length with straight keel and constant deadrise
    # [m] amidships, estimated, as are the following numbers, which the particulars do not contain
    freeboard: float = 0.075
    stem_height: float = 0.125  # [m] tip of the bow above the waterline
    chine_beam: float = 0.25  # [m]
    rocker: float = 0.037  # [m] rise of the keel from amidships to the transom
    # [-] exponent of the keel's rise to the stem; with `rocker` chosen so that the hull displaces
    # 4.6 kg with the centre of buoyancy at the CG
    fullness: float = 2.4
    chine_end: float = 0.95  # [-] where the chine runs into the stem

    def forebody_fraction(self, s: Array) -> Array:
        """Return a shape function of a hull: 0 along the parallel body, rising to 1 at the bow.

        Args:
            s: Place along the hull, 0 at the transom, 1 at the bow.
        """
        return np.clip((s - self.parallel) / (1 - self.parallel), 0, 1)

    def keel_height(self, s: Array) -> Array:
        """Return the height of the hull's keel and stem above the waterline [m].

        Args:
            s: Place along the hull, 0 at the transom, 1 at the bow.
        """
        aft = np.clip(1 - s / self.parallel, 0, 1)
        return (
            self.rocker * aft**2
            - self.draught
            + (self.draught + self.stem_height) * self.forebody_fraction(s) ** self.fullness
        )

    def chine_points(self, s: Array) -> tuple[Array, Array]:
        """Return half-breadth and height of the hull's chine [m].

        Args:
            s: Place along the hull, 0 at the transom, 1 at the bow.
        """
        along = np.clip((s - 0.4) / (self.chine_end - 0.4), 0, 1)
        half = self.chine_beam / 2 * (1 - along**2.2)
        rise = np.tan(self.deadrise + math.radians(30) * self.forebody_fraction(s))
        return half, self.keel_height(s) + half * rise

    def sheer_points(self, s: Array) -> tuple[Array, Array]:
        """Return half-breadth and height of the hull's deck edge [m].

        Args:
            s: Place along the hull, 0 at the transom, 1 at the bow.
        """
        aft, fore = np.clip((0.4 - s) / 0.4, 0, 1), np.clip((s - 0.4) / 0.6, 0, 1)
        half = self.beam / 2 * (1 - 0.05 * aft**2) * (1 - fore**2.8)
        rise = np.clip((s - 0.3) / 0.7, 0, 1) ** 1.6
        return half, self.freeboard + (self.stem_height - self.freeboard) * rise

    def station_positions(self, count: int = 49) -> Array:
        """Return relative positions (count,) of sections along the hull, denser towards the bow.

        0 is the transom and 1 the bow.

        Args:
            count: Number of sections.
        """
        return np.sin(np.linspace(0, math.pi / 2, count))


@dataclass
class Mesh:
    """Triangle mesh of a boat part; surfaces share no vertices, so that their edges are sharp."""

    points: list[Array] = field(default_factory=list)
    faces: list[tuple[int, int, int]] = field(default_factory=list)

    def add_surface(self, grid: Array, *, flip: bool = False) -> None:
        """Add to the mesh the surface through a grid of points.

        Args:
            grid: Points (rows, columns, 3). With the columns upwards, the outside is to the left
                along the rows.
            flip: Whether the outside is to the right instead.
        """
        rows, columns, _ = grid.shape
        start = sum(len(p) for p in self.points)
        self.points.append(grid.reshape(-1, 3))
        for i in range(rows - 1):
            for j in range(columns - 1):
                a, b = start + i * columns + j, start + (i + 1) * columns + j
                for corners in ((a, b, b + 1), (a, b + 1, a + 1)):
                    self.faces.append(corners if flip else corners[::-1])

    def add_surface_and_mirror(self, grid: Array) -> None:
        """Add to the mesh a surface on the port side (y > 0) and its mirror image to starboard.

        Args:
            grid: Points (rows, columns, 3) of the surface.
        """
        self.add_surface(grid)
        self.add_surface(grid * (1, -1, 1), flip=True)

    def add_closed_body(self, rings: Sequence[Array]) -> None:
        """Add to the mesh a closed body that passes through rings of points, with end caps.

        Args:
            rings: Rings (n, 3) through which it passes, counter-clockwise seen against their order.
        """
        closed = np.array([np.vstack([r, r[:1]]) for r in rings])
        self.add_surface(closed)
        for ring, flip in ((closed[0], True), (closed[-1], False)):
            self.add_surface(
                np.array([ring, np.tile(ring[:-1].mean(0), (len(ring), 1))]), flip=flip
            )

    def obj_text(self, about: str) -> str:
        """Return the mesh as text of a Wavefront OBJ file, without triangles of zero area.

        Args:
            about: Comment in the first line.
        """
        points = np.round(np.vstack(self.points), 5) + 0.0
        lines = [f"# {about}", *(f"v {x:.5f} {y:.5f} {z:.5f}" for x, y, z in points)]
        for a, b, c in self.faces:
            if np.linalg.norm(np.cross(points[b] - points[a], points[c] - points[a])) > 1e-9:
                lines.append(f"f {a + 1} {b + 1} {c + 1}")
        return "\n".join(lines) + "\n"


def ruled_surface(a: Array, b: Array, rows: int) -> Array:
    """Return the points (n, rows, 3) of the ruled surface between two curves of n points.

    Args:
        a: Points (n, 3) of the first curve.
        b: Points (n, 3) of the second curve.
        rows: Points from one curve to the other.
    """
    t = np.linspace(0, 1, rows)[None, :, None]
    return np.asarray(a[:, None, :] * (1 - t) + b[:, None, :] * t)


def curve_points(x: Array, y: Array | float, z: Array | float) -> Array:
    """Return an array (n, 3) of the points of a curve, from coordinates that are (n,) or scalar."""
    return np.stack(np.broadcast_arrays(x, y, z), axis=-1).astype(float)


def rounded_rectangle(
    centre: Sequence[float], half: tuple[float, float], power: float = 2.0, axis: str = "z"
) -> Array:
    """Return the points (n, 3) of a rounded rectangle (superellipse) in space.

    Args:
        centre: Its centre (3,).
        half: Half of its width and height.
        power: 2: ellipse; larger: closer to a rectangle.
        axis: Normal of its plane, "x" or "z".
    """
    angle = np.linspace(0, 2 * math.pi, AROUND, endpoint=False)
    c, s = np.cos(angle), np.sin(angle)
    p = half[0] * np.sign(c) * np.abs(c) ** (2 / power)
    q = half[1] * np.sign(s) * np.abs(s) ** (2 / power)
    zero = np.zeros_like(p)
    return np.asarray(centre) + (
        curve_points(p, q, zero) if axis == "z" else curve_points(zero, p, q)
    )


def hull_mesh(hull: DeepV) -> Mesh:
    """Return a mesh of the bottom, topsides and transom of a hull, for drawing."""
    s = hull.station_positions()
    x = s * hull.length
    chine_half, chine_z = hull.chine_points(s)
    sheer_half, sheer_z = hull.sheer_points(s)
    keel = curve_points(x, 0.0, hull.keel_height(s))
    chine = curve_points(x, chine_half, chine_z)
    step = curve_points(
        x, np.minimum(chine_half * 1.04, np.maximum(sheer_half, chine_half)), chine_z
    )
    sheer = curve_points(x, sheer_half, np.maximum(sheer_z, hull.keel_height(s)))
    mesh = Mesh()
    for lower, upper, rows in ((keel, chine, 4), (chine, step, 2), (step, sheer, 6)):
        mesh.add_surface_and_mirror(ruled_surface(lower, upper, rows))
    side = np.array([keel[0], chine[0], step[0], sheer[0]])
    mesh.add_surface_and_mirror(np.array([side, side * (1, 0, 1)]).transpose(1, 0, 2))
    return mesh


def deck_mesh(hull: DeepV) -> Mesh:
    """Return a mesh of foredeck, side decks, cockpit, and a stripe below the deck edge."""
    s = np.unique(np.concatenate([hull.station_positions(), [0.04, 0.0401, 0.56, 0.5601]]))
    half, z = hull.sheer_points(s)
    x = s * hull.length
    open_here = (s > 0.04) & (s < 0.5601)
    camber = 0.06 * half
    inner = np.where(open_here, 0.74 * half, 0.0)
    floor = np.where(open_here, 0.012, z + camber)
    edge = curve_points(x, half, z)
    rim = curve_points(x, inner, z + camber * (1 - (inner / np.maximum(half, 1e-9)) ** 2))
    foot = curve_points(x, inner, floor)
    mesh = Mesh()
    for outer, inward in ((edge, rim), (rim, foot), (foot, curve_points(x, 0.0, floor))):
        mesh.add_surface_and_mirror(ruled_surface(outer, inward, 5))
    out = 0.0008  # [m] the stripe lies this far outside the shell
    mesh.add_surface_and_mirror(
        ruled_surface(edge + (0, out, -0.014), edge + (0, out, 0.001), 2)[: len(s) - 1]
    )
    return mesh


def fittings_mesh() -> Mesh:
    """Return a mesh of a small motor boat's console, seats and windscreen frame."""
    mesh = Mesh()
    console = ((0.0, 0.045), (0.06, 0.045), (0.075, 0.034), (0.1, 0.02))
    mesh.add_closed_body(
        [
            rounded_rectangle((0.52 - 0.1 * up, 0, 0.012 + up), (half, 0.05), 6)
            for up, half in console
        ]
    )
    for y in (-0.045, 0.045):
        mesh.add_closed_body(
            [rounded_rectangle((0.33, y, 0.012 + up), (0.035, 0.032), 5) for up in (0.0, 0.04)]
        )
        mesh.add_closed_body(
            [
                rounded_rectangle((0.30 - 0.15 * up, y, 0.052 + up), (0.008, 0.032), 5)
                for up in (0.0, 0.05)
            ]
        )
    mesh.add_closed_body(
        [rounded_rectangle((0.12, 0, 0.012 + up), (0.03, 0.085), 6) for up in (0.0, 0.04)]
    )
    return mesh


def outboard_cowl_mesh() -> Mesh:
    """Return a mesh of an outboard motor's cover; origin on the steering axis at the waterline."""
    mesh = Mesh()
    levels = ((0.062, 0.75), (0.068, 0.93), (0.085, 1.0), (0.11, 0.98), (0.128, 0.88), (0.137, 0.6))
    mesh.add_closed_body(
        [
            rounded_rectangle((-0.028 - 0.05 * (z - 0.06), 0, z), (0.036 * k, 0.025 * k), 3.2)
            for z, k in levels
        ]
    )
    return mesh


def outboard_leg_mesh() -> Mesh:
    """Return a mesh of an outboard motor below its cover, with a propeller of three blades.

    It contains leg, cavitation plate, gear case and skeg.
    """
    mesh = Mesh()
    strut = ((-0.055, 0.017), (0.0, 0.018), (0.064, 0.026))
    mesh.add_closed_body(
        [rounded_rectangle((-0.026, 0, z), (half, 0.35 * half), 2.4) for z, half in strut]
    )
    mesh.add_closed_body(
        [rounded_rectangle((-0.036, 0, z), (0.032, 0.018), 2.6) for z in (-0.031, -0.028)]
    )
    case = (
        (-0.062, 0.008),
        (-0.052, 0.0095),
        (-0.03, 0.0105),
        (-0.012, 0.009),
        (-0.002, 0.005),
        (0.002, 0.001),
    )
    mesh.add_closed_body([rounded_rectangle((x, 0, -0.055), (r, r), axis="x") for x, r in case])
    skeg = ((-0.082, 0.006), (-0.06, 0.016))
    mesh.add_closed_body(
        [rounded_rectangle((-0.034 + 0.3 * (z + 0.055), 0, z), (half, 0.0018)) for z, half in skeg]
    )
    hub = ((-0.078, 0.004), (-0.074, 0.0065), (-0.062, 0.0078))
    mesh.add_closed_body([rounded_rectangle((x, 0, -0.055), (r, r), axis="x") for x, r in hub])
    for turn in (0.0, 2 * math.pi / 3, 4 * math.pi / 3):
        mesh.add_surface(propeller_blade(turn))
        mesh.add_surface(propeller_blade(turn), flip=True)
    return mesh


def propeller_blade(turn: float) -> Array:
    """Return the surface points (4, 3, 3) of one propeller blade, for drawing.

    Its pitch angle decreases towards the tip.

    Args:
        turn: Angle about the shaft [rad].
    """
    rows = []
    for radius, chord, pitch in (
        (0.006, 0.007, 1.0),
        (0.014, 0.011, 0.75),
        (0.021, 0.010, 0.6),
        (0.0245, 0.004, 0.55),
    ):
        for t in (-1, 0, 1):
            across, along = t * chord * math.cos(pitch), t * chord * math.sin(pitch)
            angle = turn + across / radius
            y, z = radius * math.cos(angle), radius * math.sin(angle)
            rows.append((-0.069 + along, y, -0.055 + z))
    return np.array(rows).reshape(4, 3, 3)


def collision_mesh(hull: DeepV) -> Mesh:
    """Return a mesh for contacts with walls: a convex prism around the deck edge of a hull.

    It has few vertices.
    """
    s = np.array([0.0, 0.4, 0.6, 0.75, 0.87, 0.95, 1.0])
    half, _ = hull.sheer_points(s)
    plan = np.vstack(
        [
            curve_points(s * hull.length, -half, 0.0),
            curve_points(s * hull.length, half, 0.0)[-2::-1],
        ]
    )
    mesh = Mesh()
    mesh.add_closed_body([plan + (0, 0, -hull.draught), plan + (0, 0, hull.freeboard)])
    return mesh


def obj_texts() -> dict[str, str]:
    """Return the text of each OBJ mesh file of the example motor boat, by file name."""
    hull = DeepV()
    parts = {
        "shell": hull_mesh(hull),
        "deck": deck_mesh(hull),
        "fittings": fittings_mesh(),
        "outboard_cowl": outboard_cowl_mesh(),
        "outboard_leg": outboard_leg_mesh(),
        "collision": collision_mesh(hull),
    }
    texts = {}
    for name, mesh in parts.items():
        texts[f"{name}.obj"] = mesh.obj_text(f"{name}, drawn by boatsim.physics.hullform")
    return texts


def main(arguments: Iterable[str]) -> None:
    """Write the OBJ mesh files of the example motor boat into folders.

    Args:
        arguments: The folders.
    """
    for folder in arguments:
        for name, text in obj_texts().items():
            (Path(folder) / name).write_text(text)


if __name__ == "__main__":
    main(sys.argv[1:])
