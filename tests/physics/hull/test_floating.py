"""Equilibrium and righting arms: wall-sided formula, beams of square section, sphere, trim."""

from itertools import pairwise
from math import cos, degrees, pi, radians, sin, sqrt, tan

import hull_meshes as bodies
import numpy as np
import pytest

from boatsim.errors import BadInput
from boatsim.physics.hull.floating import (
    LoadedHull,
    depth_of_volume,
    metacentric_heights,
    righting_arm,
    righting_arms,
    vanishing_angle,
)

EXACT = 1e-9
LENGTH, BEAM, DEPTH, DRAUGHT, CENTRE = 4.0, 2.0, 1.5, 0.7, 0.6  # [m] of a barge


def barge(centre: float = CENTRE) -> LoadedHull:
    """A box with its mass centre at a height above the bottom."""
    mesh = bodies.box(LENGTH, BEAM, DEPTH)
    return LoadedHull(mesh, LENGTH * BEAM * DRAUGHT, np.array([0.0, 0.0, -centre]))


def test_metacentric_heights_of_a_barge() -> None:
    hull = barge()
    across, along = metacentric_heights(hull, righting_arm(hull, 0.0).submerged)
    assert across == pytest.approx(DRAUGHT / 2 + BEAM**2 / 12.0 / DRAUGHT - CENTRE, rel=EXACT)
    assert along == pytest.approx(DRAUGHT / 2 + LENGTH**2 / 12.0 / DRAUGHT - CENTRE, rel=EXACT)


@pytest.mark.parametrize("heel", [-0.3, 0.1, 0.3, 0.5, 0.6])
def test_righting_arm_of_a_barge_is_that_of_the_wall_sided_formula(heel: float) -> None:
    """GZ = sin(heel) (GM + BM tan^2(heel) / 2) until the deck or the bilge reaches the surface."""
    assert abs(tan(heel)) < min(DRAUGHT, DEPTH - DRAUGHT) / (BEAM / 2)
    radius = BEAM**2 / 12.0 / DRAUGHT
    height = DRAUGHT / 2 + radius - CENTRE
    found = righting_arm(barge(), heel)
    assert found.arm == pytest.approx(
        sin(heel) * (height + 0.5 * radius * tan(heel) ** 2), abs=EXACT
    )
    assert found.trim == pytest.approx(0.0, abs=EXACT)
    assert found.depth == pytest.approx(DRAUGHT * cos(heel), abs=EXACT)


def test_righting_arm_of_a_barge_beyond_the_immersion_of_its_deck() -> None:
    """At 90 degrees and 180 degrees it is the distance of the centres in the axes of the box; in
    between, a polygon of the section is cut by a line."""
    hull = barge()
    assert righting_arm(hull, pi / 2).arm == pytest.approx(DEPTH / 2 - CENTRE, abs=EXACT)
    assert righting_arm(hull, pi).arm == pytest.approx(0.0, abs=EXACT)
    for heel in (0.9, 1.4, 2.0, 2.8):
        y, z, area = section_below(heel, DRAUGHT * BEAM)
        assert area == pytest.approx(DRAUGHT * BEAM, rel=1e-12)
        lever = y * cos(heel) - (z + CENTRE) * sin(heel)
        assert righting_arm(hull, heel).arm == pytest.approx(lever, abs=EXACT)


def section_below(heel: float, area: float) -> tuple[float, float, float]:
    """Centre (y, z) and area of the section of the barge below the surface, by bisection."""
    low, high = -5.0, 5.0
    found = (0.0, 0.0, 0.0)
    for _ in range(200):
        middle = 0.5 * (low + high)
        found = polygon_below(heel, middle)
        if found[2] < area:
            low = middle
        else:
            high = middle
    return found


def polygon_below(heel: float, depth: float) -> tuple[float, float, float]:
    """Centre and area of the part of the section with depth + y sin + z cos > 0."""
    ring = [(-BEAM / 2, 0.0), (BEAM / 2, 0.0), (BEAM / 2, -DEPTH), (-BEAM / 2, -DEPTH)]
    kept: list[tuple[float, float]] = []
    for a, b in pairwise([*ring, ring[0]]):
        first = depth + a[0] * sin(heel) + a[1] * cos(heel)
        second = depth + b[0] * sin(heel) + b[1] * cos(heel)
        if first > 0.0:
            kept.append(a)
        if first * second < 0.0:
            share = first / (first - second)
            kept.append((a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])))
    area = y = z = 0.0
    for a, b in pairwise([*kept, *kept[:1]]):
        part = 0.5 * (a[0] * b[1] - a[1] * b[0])
        area += part
        y += part * (a[0] + b[0]) / 3.0
        z += part * (a[1] + b[1]) / 3.0
    if area == 0.0:
        return 0.0, 0.0, 0.0
    return y / area, z / area, abs(area)


@pytest.mark.parametrize(
    ("density", "heel"),
    [((3.0 - sqrt(3.0)) / 6.0, 0.0), (9.0 / 32.0, pi / 4), (23.0 / 32.0, pi / 4)],
)
def test_beam_of_square_section_changes_its_stability_at_known_densities(
    density: float, heel: float
) -> None:
    """A long beam of relative density s floats flat up to 6 s^2 - 6 s + 1 = 0, and with an edge
    down from 9/32 to 23/32."""
    mesh = bodies.box(10.0, 1.0, 1.0)
    hull = LoadedHull(mesh, 10.0 * density, np.array([0.0, 0.0, -0.5]))
    step = 1e-4
    slope = (righting_arm(hull, heel + step).arm - righting_arm(hull, heel - step).arm) / (2 * step)
    assert slope == pytest.approx(0.0, abs=1e-6)


def test_metacentre_of_a_sphere_is_its_centre() -> None:
    """Its righting arm is proportional to the sine of the heel, up to the panels."""
    mesh = bodies.sphere(1.0, 32)
    hull = LoadedHull(mesh, 0.4 * mesh.volume, np.array([0.0, 0.0, 0.2]))
    curve = righting_arms(hull, np.radians([0.0, 30.0, 60.0, 90.0, 150.0]))
    assert metacentric_heights(hull, curve[0].submerged) == pytest.approx((0.2, 0.2), rel=0.01)
    for one in curve:
        assert one.arm == pytest.approx(0.2 * sin(one.heel), abs=1e-3)


def test_slope_of_the_righting_arm_is_the_metacentric_height() -> None:
    mesh = bodies.wigley(3.0, 0.3, 0.1875, 12)
    hull = LoadedHull(mesh, 0.6 * mesh.volume, np.array([0.0, 0.0, 0.05]))
    across, _ = metacentric_heights(hull, righting_arm(hull, 0.0).submerged)
    assert righting_arm(hull, 1e-5).arm / 1e-5 == pytest.approx(across, rel=1e-6)


def test_hull_trims_until_its_centres_are_one_above_the_other() -> None:
    """A wedge that is deeper ahead, with its mass centre ahead of its middle."""
    points = np.array(
        [(x, y, z) for x in (-2.0, 2.0) for y in (-1.0, 1.0) for z in (-1.0, 0.1 * x)]
    )
    mesh = bodies.convex(points)
    hull = LoadedHull(mesh, 0.5 * mesh.volume, np.array([0.3, 0.05, -0.4]))
    for heel in (0.0, 0.5, -1.1, 2.5):
        found = righting_arm(hull, heel)
        level = found.submerged.rotation @ hull.centre
        assert found.submerged.volume == pytest.approx(hull.volume, rel=1e-12)
        assert found.submerged.centre[0] == pytest.approx(level[0], abs=EXACT)
        assert found.arm == pytest.approx(found.submerged.centre[1] - level[1], abs=EXACT)


def test_righting_arm_is_the_change_of_the_depth_of_buoyancy_below_the_mass_centre() -> None:
    """Energy over weight: the height of the mass centre above the centre of buoyancy."""
    hull = barge()
    step = radians(0.01)

    def energy(heel: float) -> float:
        found = righting_arm(hull, heel)
        level = found.submerged.rotation @ hull.centre
        return float(found.submerged.centre[2] - level[2])

    for heel in (0.4, 0.9, 1.6, 2.7):
        slope = (energy(heel + step) - energy(heel - step)) / (2.0 * step)
        assert righting_arm(hull, heel).arm == pytest.approx(slope, abs=1e-6)


def test_angle_of_vanishing_stability() -> None:
    hull = barge(0.8)
    curve = righting_arms(hull, np.radians(np.arange(0.0, 181.0, 15.0)))
    found = vanishing_angle(hull, curve)
    assert found is not None
    assert righting_arm(hull, found - radians(0.05)).arm > 0.0
    assert righting_arm(hull, found + radians(0.05)).arm < 0.0
    assert 0.0 < degrees(found) < 90.0
    upright = righting_arms(barge(-2.0), np.radians([0.0, 60.0, 120.0, 170.0]))
    assert vanishing_angle(barge(-2.0), upright) is None


def test_hull_heavier_than_its_volume_sinks() -> None:
    mesh = bodies.box(LENGTH, BEAM, DEPTH)
    with pytest.raises(BadInput, match=r"encloses 12 m\^3, and 13 m\^3 are to be displaced"):
        depth_of_volume(mesh, 13.0)
