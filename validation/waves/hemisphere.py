"""A floating hemisphere by the boundary element method against the series of Hulme."""

from pathlib import Path
from typing import NamedTuple

import numpy as np

from boatsim.hydrodynamics.computation import HullMesh, coefficients_of_rows, run_capytaine
from boatsim.physics.particulars import GRAVITY
from validation.waves.hulls import revolved, write_stl

# A. Hulme, The wave forces acting on a floating hemisphere undergoing forced periodic oscillations,
# J. Fluid Mech. 121, 1982, tables 1 (heave) and 2 (surge): k a -> added mass and damping over the
# displaced mass, the damping also over the frequency
HEAVE = {0.2: (0.7938, 0.2793), 0.6: (0.5381, 0.3271), 1.0: (0.4284, 0.2484)}
SURGE = {0.2: (0.5515, 0.0082), 0.6: (0.6586, 0.1516), 1.0: (0.5740, 0.3535)}
RADIUS = 1.0  # [m]
RINGS, MERIDIANS = 8, 32  # panels of the mesh, of equal angles


class Comparison(NamedTuple):
    """One number of the hemisphere: computed and published values."""

    number: float  # k a
    axis: str
    added_mass: tuple[float, float]
    damping: tuple[float, float]
    largest: float  # damping of the axis in the table


def write_hemisphere(path: Path, rings: int = RINGS, meridians: int = MERIDIANS) -> None:
    """Write the mesh of a hemisphere with the volume of the exact one.

    Args:
        path: The STL file.
        rings: Number of panels from waterline to keel.
        meridians: Number of panels around it.
    """
    polar = np.linspace(0.0, 0.5 * np.pi, rings + 1)
    radius = RADIUS / volume_share(rings, meridians) ** (1.0 / 3.0)
    profile = radius * np.column_stack([np.cos(polar), -np.sin(polar)])
    write_stl(path, revolved(profile, meridians))


def volume_share(rings: int, meridians: int) -> float:
    """Return the volume of the polyhedron over that of the hemisphere around it.

    Args:
        rings: Number of panels from waterline to keel.
        meridians: Number of panels around it.
    """
    polar = np.linspace(0.0, 0.5 * np.pi, rings + 1)
    polygon = 0.5 * meridians * np.sin(2.0 * np.pi / meridians)  # area over radius squared
    r, z = np.cos(polar), np.sin(polar)
    slices = (r[:-1] ** 2 + r[:-1] * r[1:] + r[1:] ** 2) * np.diff(z) / 3.0
    return float(polygon * np.sum(slices) / (2.0 * np.pi / 3.0))


def comparison(folder: Path) -> list[Comparison]:
    """Return computed and published values of heave and surge.

    Args:
        folder: Working folder.

    Raises:
        BadInput: Capytaine is not installed.
    """
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / "hemisphere.stl"
    write_hemisphere(path)
    depth = RADIUS / volume_share(RINGS, MERIDIANS) ** (1.0 / 3.0)
    hull = HullMesh(path, depth, density=1000.0)
    numbers = sorted(HEAVE)
    frequencies = [float(np.sqrt(number * GRAVITY / RADIUS)) for number in numbers]
    rows = run_capytaine(hull, frequencies, [0.0], lambda stage, share: None)
    found = coefficients_of_rows(rows, hull, [0.0])
    mass = 1000.0 * 2.0 / 3.0 * np.pi * RADIUS**3
    results = []
    for axis, place, table in (("heave", 2, HEAVE), ("surge", 0, SURGE)):
        largest = max(damping for _, damping in table.values())
        for k, number in enumerate(numbers):
            added = float(found.added_mass[k, place, place]) / mass
            damping = float(found.damping[k, place, place]) / mass / frequencies[k]
            exact = table[number]
            results.append(
                Comparison(number, axis, (added, exact[0]), (damping, exact[1]), largest)
            )
    return results
