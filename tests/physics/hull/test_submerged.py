"""Submerged part of bodies against closed forms and an independent integrator."""

from math import asin, cos, pi, sin, sqrt, tan

import hull_meshes as bodies
import numpy as np
import pytest
from scipy.spatial import ConvexHull, Delaunay

from boatsim.physics.base import Array
from boatsim.physics.hull.mesh import ClosedMesh
from boatsim.physics.hull.submerged import attitude, submerged_part, wetted_triangles

EXACT = 1e-9


def cut_points(mesh: ClosedMesh, depth: float, heel: float, trim: float) -> tuple[Array, Array]:
    """Corners (n, 3) of the submerged part of a convex body, and of its waterplane (m, 2).

    All pairs of vertices on different sides of the surface are cut: more lines than the edges, but
    none leaves the body.
    """
    points = mesh.points @ attitude(heel, trim).T + np.array([0.0, 0.0, depth])
    low, high = points[points[:, 2] > 0.0], points[points[:, 2] <= 0.0]
    share = low[:, None, 2] / (low[:, None, 2] - high[None, :, 2])
    cuts = low[:, None] + share[..., None] * (high[None] - low[:, None])
    cuts = cuts.reshape(-1, 3)
    return np.concatenate([low, cuts]), cuts[:, :2]


def volume_and_centre(points: Array) -> tuple[float, Array]:
    """Volume and centre of the convex hull of points, by a division into tetrahedra."""
    simplices = points[Delaunay(points, qhull_options="QJ Pp").simplices]
    volumes = np.abs(np.linalg.det(simplices[:, 1:] - simplices[:, :1])) / 6.0
    return float(volumes.sum()), volumes @ simplices.mean(axis=1) / volumes.sum()


@pytest.mark.parametrize("seed", range(8))
def test_convex_bodies_at_any_attitude_agree_with_their_tetrahedra(seed: int) -> None:
    rng = np.random.default_rng(seed)
    mesh = bodies.convex(rng.uniform(-1.0, 1.0, (20, 3)) * np.array([2.0, 0.7, 0.4]))
    for _ in range(5):
        depth, heel, trim = rng.uniform([-0.2, -pi, -1.2], [0.2, pi, 1.2])
        found = submerged_part(mesh, depth, heel, trim)
        points, waterplane = cut_points(mesh, depth, heel, trim)
        volume, centre = volume_and_centre(points)
        assert found.volume == pytest.approx(volume, rel=1e-7)  # joggled tetrahedra are not exact
        assert found.centre + np.array([0.0, 0.0, depth]) == pytest.approx(centre, abs=1e-7)
        assert ConvexHull(points).volume == pytest.approx(found.volume, rel=EXACT)
        assert ConvexHull(waterplane).volume == pytest.approx(found.area, rel=EXACT)


@pytest.mark.parametrize("heel", [0.0, 0.2, -0.3])
@pytest.mark.parametrize("trim", [0.0, 0.05])
def test_box_whose_surface_crosses_its_four_sides(heel: float, trim: float) -> None:
    """Closed forms of a truncated prism, in the axes of the box."""
    length, beam, draught = 4.0, 2.0, 1.0
    found = submerged_part(
        bodies.box(length, beam, 2.0), draught * cos(heel) * cos(trim), heel, trim
    )
    # depth of the bottom along the normal of the bottom: draught + y tan(heel) - x tan(trim) / cos
    ahead, aside = -tan(trim) / cos(heel), tan(heel)
    along, across = length**2 / 12.0, beam**2 / 12.0
    volume = length * beam * draught
    height = 0.5 * (draught**2 + ahead**2 * along + aside**2 * across) / draught
    assert found.volume == pytest.approx(volume, rel=EXACT)
    expected = [ahead * along / draught, aside * across / draught, -height]
    assert found.body_centre == pytest.approx(expected, abs=EXACT)
    assert found.area == pytest.approx(length * beam / (cos(heel) * cos(trim)), rel=EXACT)


def test_waterplane_of_a_box() -> None:
    found = submerged_part(bodies.box(4.0, 2.0, 2.0).moved(0.3, 0.1, 0.0), 0.7)
    assert found.area == pytest.approx(8.0, rel=EXACT)
    assert found.flotation == pytest.approx([0.3, 0.1], abs=EXACT)
    expected = np.diag([2.0 * 4.0**3 / 12.0, 4.0 * 2.0**3 / 12.0])
    assert found.second == pytest.approx(expected, abs=EXACT)


def test_wedge() -> None:
    """Triangular section with its edge below: similar triangles."""
    beam, depth, length, draught = 1.2, 0.9, 3.0, 0.5
    section = np.array([[0.0, 0.0], [beam / 2, -depth], [-beam / 2, -depth]])
    found = submerged_part(bodies.prism(section, length), draught)
    breadth = beam * draught / depth
    assert found.volume == pytest.approx(0.5 * breadth * draught * length, rel=EXACT)
    assert found.area == pytest.approx(breadth * length, rel=EXACT)
    assert found.centre == pytest.approx([0.0, 0.0, -2.0 / 3.0 * draught], abs=EXACT)
    assert found.second[1, 1] == pytest.approx(length * breadth**3 / 12.0, rel=EXACT)


@pytest.mark.parametrize("heel", [0.0, 0.4, 1.3, 2.9])
def test_half_immersed_polygonal_cylinder_at_any_heel(heel: float) -> None:
    """A regular polygon with an even number of corners is symmetric to its centre."""
    corners, radius, length = 24, 0.5, 2.0
    found = submerged_part(bodies.prism(bodies.circle(radius, corners), length), 0.0, heel)
    section = 0.5 * corners * radius**2 * sin(2.0 * pi / corners)
    assert found.volume == pytest.approx(0.5 * section * length, rel=EXACT)
    turned = submerged_part(
        bodies.prism(bodies.circle(radius, corners), length), 0.0, heel + 2.0 * pi / corners
    )
    assert turned.centre == pytest.approx(found.centre, abs=EXACT)
    assert turned.second == pytest.approx(found.second, abs=EXACT)


def test_cylinder_and_sphere_converge_with_the_square_of_the_panels() -> None:
    radius, depth = 0.7, 0.3
    # segment of a circle, cap of a sphere
    segment = radius**2 * (pi / 2 + asin(depth / radius)) + depth * sqrt(radius**2 - depth**2)
    cap = pi * (radius + depth) ** 2 * (2.0 * radius - depth) / 3.0
    plane = pi * (radius**2 - depth**2)
    errors = []
    for parts in (12, 24, 48):
        cylinder = submerged_part(bodies.prism(bodies.circle(radius, 2 * parts), 1.0), depth)
        ball = submerged_part(bodies.sphere(radius, parts), depth, 0.7, 0.4)
        errors.append(
            (
                1.0 - cylinder.volume / segment,
                1.0 - ball.volume / cap,
                1.0 - ball.area / plane,
            )
        )
    for coarse, fine in zip(errors[:-1], errors[1:], strict=True):
        assert np.array(coarse) / np.array(fine) == pytest.approx(4.0, rel=0.1)
    assert np.max(errors[-1]) < 0.01


def test_wigley_hull_converges_with_the_square_of_the_panels() -> None:
    length, beam, draught = 3.0, 0.3, 0.1875
    exact = np.array(
        [
            4.0 / 9.0 * length * beam * draught,
            2.0 / 3.0 * length * beam,
            3.0 / 8.0 * draught,
            4.0 / 105.0 * beam**3 * length,
            beam * length**3 / 30.0,
        ]
    )
    errors = []
    for parts in (8, 16, 32):
        part = submerged_part(bodies.wigley(length, beam, draught, parts), 0.0)
        found = [part.volume, part.area, part.centre[2], part.second[1, 1], part.second[0, 0]]
        errors.append(np.abs(np.array(found) / exact - 1.0))
    for coarse, fine in zip(errors[:-1], errors[1:], strict=True):
        assert coarse / fine == pytest.approx(4.0, rel=0.1)
    assert errors[-1].max() < 0.002


def test_hull_above_and_below_the_surface() -> None:
    mesh = bodies.box(4.0, 2.0, 2.0)
    assert submerged_part(mesh, -0.1, 0.0).volume == 0.0
    below = submerged_part(mesh, 5.0, 0.4)
    assert below.volume == pytest.approx(16.0, rel=EXACT)
    assert below.area == pytest.approx(0.0, abs=EXACT)


def test_cut_triangles_keep_their_orientation() -> None:
    rng = np.random.default_rng(0)
    corners = rng.uniform(-1.0, 1.0, (200, 3, 3))
    wet = wetted_triangles(corners)
    assert (wet[:, :, 2] >= 0.0).all()
    dry = wetted_triangles(corners * -1.0) * -1.0
    whole = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]).sum(axis=0)
    parts = np.concatenate([wet, dry])
    both = np.cross(parts[:, 1] - parts[:, 0], parts[:, 2] - parts[:, 0]).sum(axis=0)
    assert both == pytest.approx(whole, abs=EXACT)
