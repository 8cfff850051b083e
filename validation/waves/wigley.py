"""Heave and pitch of two Wigley hulls in head waves at zero speed against model tests.

The hulls have L / B = 10 and 5. The rig held them in surge and roll, and left heave and pitch free.
The responses are those of the frequency domain with added mass and damping of the boundary element
method, once with its excitation and once with that of `strip_wave_loads` from the hull's mesh.
"""

from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import numpy as np

from boatsim.hydrodynamics.computation import HullMesh, coefficients_of_rows, run_capytaine
from boatsim.hydrodynamics.response import linear_stiffness, rigid_body
from boatsim.physics.base import AXES, Array, make_motion
from boatsim.physics.coefficients.table import Coefficients
from boatsim.physics.effects.strip_wave_loads import StripWaveLoads
from boatsim.physics.particulars import GRAVITY
from validation.waves.hulls import closed_hull, write_obj

LENGTH, DRAUGHT, GYRADIUS = 3.0, 0.1875, 0.75  # [m] of both hulls; gyradius in pitch
DENSITY = 1000.0  # [kg/m^3]
STATIONS, LINES = 20, 8  # panels over half the length and over the draught
HEAD = np.pi  # [rad] direction of the waves
HEAVE, PITCH = AXES.index("heave"), AXES.index("pitch")
LONG = 1.0  # wavelength over length from which responses are large and errors are counted


class Hull(NamedTuple):
    """A hull of the model tests."""

    name: str
    beam: float  # [m]
    centre: float  # [m] height of the mass centre above the keel
    # wavelength over length -> heave over the amplitude of the wave, pitch over 2 pi / L times it
    measured: dict[float, tuple[float, float]]


# J. M. J. Journee, Experiments and calculations on four Wigley hullforms in head waves, Delft
# University of Technology, Ship Hydromechanics Laboratory, report 909, 1992: particulars, and
# tables 10-III and 10-IV of the motions at zero speed
HULLS = (
    Hull(
        "III",
        0.3,
        0.17,
        {
            0.417: (0.05, 0.12),
            0.5: (0.07, 0.51),
            0.55: (0.11, 0.14),
            0.64: (0.22, 0.21),
            0.75: (0.04, 0.33),
            0.857: (0.19, 0.49),
            1.0: (0.29, 0.57),
            1.25: (0.45, 0.63),
            1.5: (0.57, 0.57),
            1.75: (0.67, 0.54),
            2.0: (0.74, 0.50),
        },
    ),
    Hull(
        "IV",
        0.6,
        0.1875,
        {
            0.5: (0.27, 0.38),
            0.75: (0.10, 0.33),
            1.0: (0.30, 0.57),
            1.25: (0.43, 0.62),
            1.5: (0.65, 0.69),
            1.75: (0.71, 0.60),
            2.0: (0.79, 0.54),
        },
    ),
)


class Response(NamedTuple):
    """Heave and pitch of a hull in one wave, without units."""

    hull: str
    ratio: float  # wavelength over length
    measured: tuple[float, float]
    panels: tuple[float, float]
    strips: tuple[float, float]


def half_breadth(hull: Hull, x: Array, z: Array) -> Array:
    """Return the half-breadth of a hull; above the water its sides are vertical [m].

    Source: the report, section 2.

    Args:
        hull: The hull.
        x: Places ahead of mid-length [m].
        z: Heights above the waterline [m].
    """
    xi, zeta = 2.0 * x / LENGTH, np.clip(-z / DRAUGHT, 0.0, 1.0)
    along = (1.0 - xi**2) * (1.0 + 0.2 * xi**2)
    return np.asarray(0.5 * hull.beam * along * (1.0 - zeta**2))


def write_hull(path: Path, hull: Hull, stations: int = STATIONS, lines: int = LINES) -> None:
    """Write the closed mesh of a hull.

    Args:
        path: The OBJ file.
        hull: The hull.
        stations: Number of panels over half the length.
        lines: Number of panels over the draught.
    """
    x = 0.5 * LENGTH * np.sin(np.linspace(0.0, 0.5 * np.pi, stations + 1))
    z = np.append(np.linspace(-DRAUGHT, 0.0, lines + 1), 0.25 * DRAUGHT)
    triangles = closed_hull(x, z, lambda along, up: half_breadth(hull, along, up))
    write_obj(path, triangles, f"Wigley hull {hull.name}, z = 0 at the waterline")


def strip_excitation(path: Path, found: Coefficients) -> Array:
    """Return the excitation of head waves by strips, with the coefficients of each frequency.

    Args:
        path: Mesh of the hull.
        found: Coefficients of the hull by the boundary element method.

    Returns:
        Complex amplitudes (N, 6) of waves of unit amplitude, for exp(i w t).
    """
    rows = []
    for i, w in enumerate(found.frequency):
        period = 2.0 * np.pi / float(w)
        effect = StripWaveLoads(
            spectrum="regular",
            significant_height=2.0,
            modal_period=period,
            toward=HEAD,
            density=found.density,
            mesh=str(path),
            draught=DRAUGHT,
            sway_mass_at=0.0,
            sway_mass_below=0.0,
            sway_damping_at=0.0,
            **_own_coefficients(found, i),
        )
        effect = replace(effect, **effect.sections().particulars())
        start, later = (effect.wrench(make_motion(t=t)) for t in (0.0, 0.25 * period))
        rows.append(np.array(start) - 1j * np.array(later))
    return np.array(rows)


def _own_coefficients(found: Coefficients, row: int) -> dict[str, float]:
    """Return added mass and damping at one frequency as parameters of the effect."""
    values = {}
    for i, axis in enumerate(AXES):
        values[f"{axis}_mass"] = max(0.0, float(found.added_mass[row, i, i]))
        values[f"{axis}_damping"] = max(0.0, float(found.damping[row, i, i]))
    return values


def motions(hull: Hull, found: Coefficients, excitation: Array) -> Array:
    """Return heave and pitch (N, 2) per amplitude of the wave [m/m, rad/m], complex.

    Args:
        hull: The hull.
        found: Its coefficients.
        excitation: Complex amplitudes (N, 6) of the excitation.
    """
    depth, mass = DRAUGHT - hull.centre, found.density * found.volume
    body = rigid_body(mass, (0.0, depth), mass * np.array([1.0, GYRADIUS**2, GYRADIUS**2]))
    stiffness = linear_stiffness(found, mass, depth)
    free = [HEAVE, PITCH]
    rows = []
    for i, w in enumerate(found.frequency):
        dynamic = stiffness + 1j * w * found.damping[i] - w * w * (body + found.added_mass[i])
        rows.append(np.linalg.solve(dynamic[np.ix_(free, free)], excitation[i, free]))
    return np.array(rows)


def computed(
    path: Path, hull: Hull, ratios: list[float], stations: int = STATIONS, lines: int = LINES
) -> Coefficients:
    """Return the coefficients of a hull in head waves, by decreasing wavelength.

    Args:
        path: OBJ file to write.
        hull: The hull.
        ratios: Wavelengths over the length, decreasing.
        stations: Number of panels over half the length.
        lines: Number of panels over the draught.

    Raises:
        BadInput: Capytaine is not installed.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    write_hull(path, hull, stations, lines)
    frequencies = [float(np.sqrt(2.0 * np.pi * GRAVITY / (r * LENGTH))) for r in ratios]
    mesh = HullMesh(path, DRAUGHT, density=DENSITY)
    rows = run_capytaine(mesh, frequencies, [HEAD], lambda stage, share: None)
    return coefficients_of_rows(rows, mesh, [HEAD])


def responses(folder: Path, hull: Hull) -> list[Response]:
    """Return measured and computed responses of a hull, by increasing wavelength.

    Args:
        folder: Working folder.
        hull: The hull.

    Raises:
        BadInput: Capytaine is not installed.
    """
    path = folder / f"wigley_{hull.name}.obj"
    ratios = sorted(hull.measured, reverse=True)
    found = computed(path, hull, ratios)
    by_panels = _without_units(motions(hull, found, found.excitation[:, 0]))
    by_strips = _without_units(motions(hull, found, strip_excitation(path, found)))
    results = []
    for i, ratio in enumerate(ratios):
        results.append(Response(hull.name, ratio, hull.measured[ratio], by_panels[i], by_strips[i]))
    return results[::-1]


def _without_units(found: Array) -> list[tuple[float, float]]:
    """Return amplitudes of heave, and of pitch over 2 pi / L, per amplitude of the wave."""
    amplitude = np.abs(found)
    return [(float(z), float(theta) * LENGTH / (2.0 * np.pi)) for z, theta in amplitude]


class Errors(NamedTuple):
    """Relative errors of heave and pitch of a method, over the rows of long waves."""

    largest: tuple[float, float]
    mean: tuple[float, float]
    within: tuple[int, int]  # rows within 10 %
    rows: int


def long_wave_errors(rows: list[Response], method: str) -> Errors:
    """Return the errors of a method in waves of at least one length.

    Args:
        rows: Measured and computed responses.
        method: "panels" or "strips".
    """
    found = []
    for row in rows:
        if row.ratio >= LONG:
            found.append(np.array(getattr(row, method)) / np.array(row.measured) - 1.0)
    errors = np.array(found)
    size = np.abs(errors)
    heave, pitch = range(2)
    return Errors(
        (float(size[:, heave].max()), float(size[:, pitch].max())),
        (float(errors[:, heave].mean()), float(errors[:, pitch].mean())),
        (int(np.sum(size[:, heave] <= 0.1)), int(np.sum(size[:, pitch] <= 0.1))),
        len(errors),
    )
