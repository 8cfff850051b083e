"""Coefficients from Nemoh: RadiationCoefficients.tec and ExcitationForce.tec."""

import re
from pathlib import Path

import numpy as np

from boatsim.errors import BadInput
from boatsim.hydrodynamics.axes import excitation_to_sname, to_sname
from boatsim.hydrodynamics.headings import is_conjugate, on_starboard_side
from boatsim.hydrodynamics.wamit import OutputScale
from boatsim.physics.coefficients.memory_fit import estimated_infinite_added_mass
from boatsim.physics.coefficients.table import Coefficients
from boatsim.physics.signals import Array

RADIATION, EXCITATION = "RadiationCoefficients.tec", "ExcitationForce.tec"
# Angles beyond a whole turn are in degrees: version 2 of Nemoh writes radians, version 3 degrees
WHOLE_TURN = 2.0 * np.pi + 0.01


def read_nemoh(path: Path, scale: OutputScale) -> Coefficients:
    """Read coefficients from the two files of Nemoh for one body with six degrees of freedom.

    The excitation's phase convention is recognised by the force in surge of long waves. Nemoh
    writes no added mass at infinite frequency; it is estimated.

    Args:
        path: RadiationCoefficients.tec, or its folder.
        scale: Dimensions that the files do not contain; the unit of length is not used.

    Raises:
        BadInput: A file is missing or has another form.
    """
    folder = path if path.is_dir() else path.parent
    zones = _read_zones(folder / RADIATION)
    if len(zones) != 6:
        raise BadInput(f"{folder / RADIATION}: {len(zones)} zones; six motions are required")
    frequency = zones[0][1][:, 0]
    added_mass, damping = np.zeros((2, len(frequency), 6, 6))
    for i, (_, rows) in enumerate(zones):
        if rows.shape != (len(frequency), 13):
            raise BadInput(f"{folder / RADIATION}: a row of 13 numbers is required")
        added_mass[:, i], damping[:, i] = rows[:, 1::2], rows[:, 2::2]
    added_mass, damping = to_sname(added_mass), to_sname(damping)
    heading, excitation = _read_excitation(folder / EXCITATION, len(frequency))
    return Coefficients(
        source=f"Nemoh, {folder.name}",
        density=scale.density,
        depth=scale.depth,
        draught=scale.draught,
        volume=scale.volume,
        buoyancy=np.zeros(3),
        restoring=np.zeros((6, 6)),
        frequency=frequency,
        added_mass=added_mass,
        damping=damping,
        infinite_added_mass=estimated_infinite_added_mass(frequency, added_mass, damping),
        heading=heading,
        excitation=excitation,
    )


def _read_zones(path: Path) -> list[tuple[str, Array]]:
    """Return the title and the rows of each zone of a Tecplot file."""
    if not path.is_file():
        raise BadInput(f"{path}: there is no such file")
    zones: list[tuple[str, list[list[float]]]] = []
    for line in path.read_text(encoding="utf-8", errors="replace").splitlines():
        if line.lstrip().lower().startswith("zone"):
            zones.append((line, []))
        elif zones:
            try:
                row = [float(word) for word in line.split()]
            except ValueError:
                continue
            if row:
                zones[-1][1].append(row)
    found = []
    for title, rows in zones:
        if not rows or len({len(row) for row in rows}) != 1:
            raise BadInput(f"{path}: a zone has no rows or rows of different lengths")
        found.append((title, np.array(rows)))
    return found


def _read_excitation(path: Path, frequencies: int) -> tuple[Array, Array]:
    """Return headings and excitation of all zones, one for each direction."""
    headings, tables = [], []
    for title, rows in _read_zones(path):
        degrees = re.search(r"(-?\d+(?:\.\d+)?)\s*deg", title)
        if degrees is None:
            raise BadInput(f"{path}: a zone does not state its direction in degrees")
        if rows.shape != (frequencies, 13):
            raise BadInput(f"{path}: {frequencies} rows of 13 numbers are required")
        headings.append(np.radians(float(degrees[1])))
        tables.append(rows)
    if not tables:
        raise BadInput(f"{path}: there is no zone")
    values = np.stack(tables, axis=1)
    phase = values[:, :, 2::2]
    if np.abs(phase).max() > WHOLE_TURN:
        phase = np.radians(phase)
    excitation = values[:, :, 1::2] * np.exp(1j * phase)
    heading = np.array(headings)
    turned = excitation_to_sname(excitation, is_conjugate(heading, excitation))
    return on_starboard_side(-heading, turned, path)
