"""A truncated cylinder by the boundary element method against expansions in eigenfunctions."""

from pathlib import Path
from typing import NamedTuple

import numpy as np

from boatsim.hydrodynamics.computation import HullMesh, coefficients_of_rows, run_capytaine
from boatsim.physics.base import AXES
from boatsim.physics.coefficients.table import Coefficients
from boatsim.physics.particulars import GRAVITY
from validation.waves.hulls import revolved, write_stl
from validation.waves.truncated_cylinder import (
    Cylinder,
    CylinderCoefficients,
    cylinder_coefficients,
)

RADIUS, DRAUGHT = 1.0, 0.5  # [m]
DEPTHS = (1.5, 6.0)  # [m] of the water
NUMBERS = (0.2, 0.6, 1.0)  # k a
COMPARED = ("surge", "heave", "pitch")
# Panels around the cylinder, over its side and from its edge to the centre of its bottom
PANELS = ((16, 3, 5), (32, 6, 10), (64, 12, 20))


class Number(NamedTuple):
    """One coefficient: by the boundary element method, exact, and its error.

    The error is the difference over the largest exact value of the axis at this depth.
    """

    found: float
    exact: float
    error: float


class Comparison(NamedTuple):
    """Coefficients of one axis at one depth of the water and one frequency, without units."""

    depth: float  # [m]
    number: float  # k a
    axis: str
    added_mass: Number
    damping: Number
    excitation: Number


def write_cylinder(path: Path, panels: tuple[int, int, int]) -> None:
    """Write the mesh of the cylinder, a prism of the same volume.

    Args:
        path: The STL file.
        panels: Numbers of panels around it, over its side, and over the radius of its bottom.
    """
    around, down, inward = panels
    polygon = 0.5 * around * np.sin(2.0 * np.pi / around)  # area over radius squared
    radius = RADIUS * np.sqrt(np.pi / polygon)
    side = np.column_stack([np.full(down + 1, radius), np.linspace(0.0, -DRAUGHT, down + 1)])
    inner = radius * np.linspace(1.0, 0.0, inward + 1)[1:]
    bottom = np.column_stack([inner, np.full(inward, -DRAUGHT)])
    write_stl(path, revolved(np.concatenate([side, bottom]), around))


def frequency(number: float, depth: float) -> float:
    """Return the frequency of waves [rad/s].

    Args:
        number: Wave number times radius.
        depth: Depth of the water [m].
    """
    k = number / RADIUS
    return float(np.sqrt(GRAVITY * k * np.tanh(k * depth)))


def panel_coefficients(
    folder: Path, depth: float, numbers: tuple[float, ...], panels: tuple[int, int, int]
) -> Coefficients:
    """Return the coefficients of the cylinder by the boundary element method.

    Args:
        folder: Working folder.
        depth: Depth of the water [m].
        numbers: Wave numbers times radius.
        panels: Panels of the mesh, as `write_cylinder` takes them.

    Raises:
        BadInput: Capytaine is not installed.
    """
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f"cylinder_{panels[0]}.stl"
    write_cylinder(path, panels)
    hull = HullMesh(path, DRAUGHT, density=1000.0, depth=depth)
    frequencies = [frequency(number, depth) for number in numbers]
    rows = run_capytaine(hull, frequencies, [0.0], lambda stage, share: None)
    return coefficients_of_rows(rows, hull, [0.0])


def compared(
    folder: Path,
    depth: float,
    panels: tuple[int, int, int] = PANELS[1],
    numbers: tuple[float, ...] = NUMBERS,
) -> list[Comparison]:
    """Return computed and exact coefficients at one depth of the water.

    Added mass is over the displaced mass, damping also over the frequency, and excitation over the
    heave stiffness; in pitch they are also over the square of the radius and over the radius.

    Args:
        folder: Working folder.
        depth: Depth of the water [m].
        panels: Panels of the mesh.
        numbers: Wave numbers times radius.

    Raises:
        BadInput: Capytaine is not installed.
    """
    found = panel_coefficients(folder, depth, numbers, panels)
    cylinder = Cylinder(RADIUS, DRAUGHT, depth)
    exact = [cylinder_coefficients(cylinder, frequency(number, depth)) for number in numbers]
    results = []
    for axis in COMPARED:
        rows = [_numbers(found, exact[i], i, axis) for i in range(len(numbers))]
        largest = np.abs([[b for _, b in row] for row in rows]).max(axis=0)
        for number, row in zip(numbers, rows, strict=True):
            cells = []
            for (a, b), scale in zip(row, largest, strict=True):
                cells.append(Number(abs(a), abs(b), float(np.abs(a - b) / scale)))
            results.append(Comparison(depth, number, axis, *cells))
    return results


def _numbers(
    found: Coefficients, exact: CylinderCoefficients, row: int, axis: str
) -> list[tuple[complex, complex]]:
    """Return added mass, damping and excitation of an axis without units, found and exact."""
    i, w = AXES.index(axis), float(found.frequency[row])
    volume = np.pi * RADIUS**2 * DRAUGHT
    mass, force = found.density * volume, found.density * GRAVITY * np.pi * RADIUS**2
    if axis == "pitch":
        mass, force = mass * RADIUS**2, force * RADIUS
    return [
        (found.added_mass[row, i, i] / mass, exact.added_mass[i, i] / mass),
        (found.damping[row, i, i] / mass / w, exact.damping[i, i] / mass / w),
        (found.excitation[row, 0, i] / force, exact.excitation[i] / force),
    ]


class Refinement(NamedTuple):
    """Largest errors of an axis over all frequencies, for each of `PANELS`."""

    axis: str
    added_mass: list[float]
    damping: list[float]
    excitation: list[float]


def panel_count(panels: tuple[int, int, int]) -> int:
    """Return the number of triangles of a mesh.

    Args:
        panels: Numbers of panels around it, over its side, and over the radius of its bottom.
    """
    around, down, inward = panels
    return around * (2 * (down + inward) - 1)  # one triangle each at the centre of the bottom


def mesh_convergence(folder: Path, depth: float) -> list[Refinement]:
    """Return the errors of meshes whose panels are halved twice, for each axis.

    Args:
        folder: Working folder.
        depth: Depth of the water [m].

    Raises:
        BadInput: Capytaine is not installed.
    """
    by_mesh = [compared(folder, depth, panels) for panels in PANELS]
    results = []
    for axis in COMPARED:
        columns: list[list[float]] = []
        for name in ("added_mass", "damping", "excitation"):
            column = []
            for rows in by_mesh:
                errors = [getattr(row, name).error for row in rows if row.axis == axis]
                column.append(max(errors))
            columns.append(column)
        results.append(Refinement(axis, *columns))
    return results
