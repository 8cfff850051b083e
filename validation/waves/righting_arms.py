"""Righting arms of meshes against closed forms and a printed example, at any heel."""

from collections.abc import Callable, Sequence
from math import cos, degrees, pi, sin, sqrt, tan
from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq

from boatsim.physics.base import Array
from boatsim.physics.hull.floating import (
    LoadedHull,
    metacentric_heights,
    righting_arm,
    righting_arms,
)
from boatsim.physics.hull.mesh import closed_mesh
from validation.waves.hulls import revolved

SNAME = np.array([1.0, -1.0, -1.0])  # from z up to z down
# Ellipsoid that floats with half its volume, its mass centre below its middle
SEMI_AXES, BELOW = (2.0, 0.8, 0.4), 0.05  # [m] along x, y and z
ELLIPSOID_HEELS = (0.0, 15.0, 30.0, 45.0, 60.0, 75.0, 90.0, 120.0, 150.0, 180.0)  # [deg]
# Paraboloid of revolution with its vertex down, z = r^2 / 2 p
PARAMETER, HEIGHT, IMMERSED = 0.5, 2.0, 1.0  # [m] p, height of the rim, and immersion upright
CENTRE = 0.9  # [m] height of the mass centre above the vertex
PARABOLOID_HEELS = (0.0, 5.0, 10.0, 15.0, 20.0, 25.0, 30.0)  # [deg] the rim stays above the water
MERIDIANS, CIRCLES = 96, 48  # panels around a body and from top to bottom
# C. B. Barrass, D. R. Derrett, Ship Stability for Masters and Mates, chapter on moments of statical
# stability: a box-shaped vessel, its righting arm at 25 degrees and its moments in t m
BOX = (65.0, 12.0, 8.0)  # [m] length, breadth, depth
BOX_DRAUGHT, BOX_CENTRE, BOX_DENSITY = 4.0, 4.0, 1.025  # [m], [m] above the keel, [t/m^3]
BOX_PRINTED = {25.0: (0.56, 1790.9)}  # [deg] -> [m], [t m] with the rounded arm


class Arm(NamedTuple):
    """Righting arm of a body at one heel."""

    heel: float  # [deg]
    found: float  # [m]
    exact: float  # [m]


def body_of_revolution(profile: Array, meridians: int) -> Array:
    """Return the triangles (N, 3, 3) of a closed surface of revolution in SNAME axes.

    Args:
        profile: Radius and height of the circles (M, 2) [m] from the top to the bottom, both with a
            radius of zero.
        meridians: Number of panels around it.
    """
    return revolved(profile, meridians) * SNAME


def ellipsoid(meridians: int = MERIDIANS, circles: int = CIRCLES) -> LoadedHull:
    """Return the ellipsoid with half of its volume in the water.

    Args:
        meridians: Number of panels around it.
        circles: Number of panels from top to bottom.
    """
    polar = np.linspace(0.0, pi, circles + 1)
    profile = np.column_stack([np.sin(polar), np.cos(polar)])
    profile[[0, -1], 0] = 0.0
    mesh = closed_mesh(body_of_revolution(profile, meridians) * np.array(SEMI_AXES), "ellipsoid")
    return LoadedHull(mesh, 0.5 * mesh.volume, np.array([0.0, 0.0, BELOW]))


def ellipsoid_arm(heel: float) -> float:
    """Return the exact righting arm of the ellipsoid [m].

    It is the affine image of a sphere, of which every half has its centre 3 / 8 of the radius from
    the middle. The centres of buoyancy at all heels therefore lie on a similar ellipsoid.

    Args:
        heel: Heel [rad].
    """
    _, b, c = SEMI_AXES
    norm = sqrt((b * sin(heel)) ** 2 + (c * cos(heel)) ** 2)
    return 0.375 * (b * b - c * c) * sin(heel) * cos(heel) / norm + BELOW * sin(heel)


def paraboloid(meridians: int = MERIDIANS, circles: int = CIRCLES) -> LoadedHull:
    """Return the paraboloid with a flat deck at its rim.

    Args:
        meridians: Number of panels around it.
        circles: Number of panels from its rim to its vertex.
    """
    radius = np.linspace(sqrt(2.0 * PARAMETER * HEIGHT), 0.0, circles + 1)
    profile = np.column_stack([radius, radius**2 / (2.0 * PARAMETER)])
    deck = np.array([[0.0, HEIGHT]])
    triangles = body_of_revolution(np.concatenate([deck, profile]), meridians)
    mesh = closed_mesh(triangles, "paraboloid")
    # the share of the volume, so that the immersion is the same for all meshes
    share = (IMMERSED / HEIGHT) ** 2
    return LoadedHull(mesh, share * mesh.volume, np.array([0.0, 0.0, -CENTRE]))


def paraboloid_arm(heel: float) -> float:
    """Return the exact righting arm of the paraboloid [m].

    Every segment of the same volume has the same length h along the axis, and its centre is at two
    thirds of it above the surface, where the surface is parallel to its base (Archimedes, On
    Floating Bodies, book 2). The metacentric radius upright is p.

    Args:
        heel: Heel [rad].
    """
    height = 2.0 / 3.0 * IMMERSED + PARAMETER - CENTRE
    return sin(heel) * (height + 0.5 * PARAMETER * tan(heel) ** 2)


def arms_of_ellipsoid(meridians: int = MERIDIANS, circles: int = CIRCLES) -> list[Arm]:
    """Return computed and exact righting arms of the ellipsoid.

    Args:
        meridians: Number of panels around it.
        circles: Number of panels from top to bottom.
    """
    return _arms(ellipsoid(meridians, circles), ELLIPSOID_HEELS, ellipsoid_arm)


def arms_of_paraboloid(meridians: int = MERIDIANS, circles: int = CIRCLES) -> list[Arm]:
    """Return computed and exact righting arms of the paraboloid.

    Args:
        meridians: Number of panels around it.
        circles: Number of panels from its rim to its vertex.
    """
    return _arms(paraboloid(meridians, circles), PARABOLOID_HEELS, paraboloid_arm)


def _arms(hull: LoadedHull, heels: Sequence[float], exact: Callable[[float], float]) -> list[Arm]:
    """Return computed and exact righting arms of a body at heels [deg]."""
    rows = []
    for one in righting_arms(hull, np.radians(heels)):
        rows.append(Arm(degrees(one.heel), one.arm, exact(one.heel)))
    return rows


def upright_density(parameter: float, height: float, meridians: int, circles: int) -> float:
    """Return the relative density above which a homogeneous paraboloid floats upright.

    It is that of a metacentric height of zero. Archimedes' value is (1 - 3 p / 2 H)^2 for a
    height H of more than 3 p / 2 (On Floating Bodies, book 2, proposition 4, where 2 p is the
    parameter of the parabola).

    Args:
        parameter: Half the parameter of the parabola, p [m].
        height: Height H [m].
        meridians: Number of panels around it.
        circles: Number of panels from its rim to its vertex.
    """
    radius = np.linspace(sqrt(2.0 * parameter * height), 0.0, circles + 1)
    profile = np.column_stack([radius, radius**2 / (2.0 * parameter)])
    triangles = body_of_revolution(np.concatenate([[[0.0, height]], profile]), meridians)
    mesh = closed_mesh(triangles, "paraboloid")
    centre = np.array([0.0, 0.0, -2.0 / 3.0 * height])

    def metacentric_height(density: float) -> float:
        hull = LoadedHull(mesh, density * mesh.volume, centre)
        return metacentric_heights(hull, righting_arm(hull, 0.0).submerged)[0]

    return float(brentq(metacentric_height, 0.01, 0.99, xtol=1e-6))


def box_vessel() -> LoadedHull:
    """Return the box-shaped vessel of the printed example."""
    length, breadth, depth = BOX
    corners = []
    for x in (-0.5 * length, 0.5 * length):
        for y in (-0.5 * breadth, 0.5 * breadth):
            corners += [(x, y, 0.0), (x, y, -depth)]
    points = np.array(corners)
    # corners by the bits of their number: x, y, z; each side is two triangles
    sides = ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5))
    faces = []
    for a, b, c, d in sides:
        faces += [(a, b, c), (a, c, d)]
    mesh = closed_mesh(points[np.array(faces)], "box")
    centre = np.array([0.0, 0.0, -BOX_CENTRE])
    return LoadedHull(mesh, length * breadth * BOX_DRAUGHT, centre)


def largest_error(rows: list[Arm]) -> float:
    """Return the largest error of righting arms over the largest arm.

    Args:
        rows: Computed and exact arms.
    """
    exact = np.array([arm.exact for arm in rows])
    found = np.array([arm.found for arm in rows])
    return float(np.abs(found - exact).max() / np.abs(exact).max())


def archimedes() -> tuple[float, float]:
    """Return the density above which the paraboloid floats upright, computed and exact [-]."""
    found = upright_density(PARAMETER, HEIGHT, MERIDIANS, CIRCLES)
    return found, (1.0 - 1.5 * PARAMETER / HEIGHT) ** 2


def box_example() -> list[tuple[float, tuple[float, float], tuple[float, float]]]:
    """Return the heels [deg] of the printed example, with printed and computed arm and moment.

    Arms are in m, and moments in t m.
    """
    hull, rows = box_vessel(), []
    for heel, printed in BOX_PRINTED.items():
        arm = righting_arm(hull, float(np.radians(heel))).arm
        rows.append((heel, printed, (arm, arm * hull.volume * BOX_DENSITY)))
    return rows
