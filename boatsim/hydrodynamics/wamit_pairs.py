"""Quadratic transfer functions of difference frequencies from WAMIT: NAME.12d or NAME.11d.

A row has two periods, two directions, the axis, modulus, phase, real and imaginary part. Forces are
dimensionless with density, gravity and the unit of length, moments with its square, both per
product of the amplitudes. The phase is that of exp(i (w_1 - w_2) t).
"""

from pathlib import Path

import numpy as np

from boatsim.errors import BadInput
from boatsim.hydrodynamics.axes import SIGNS
from boatsim.hydrodynamics.headings import on_starboard_side
from boatsim.physics.coefficients.pair_files import complete_pairs
from boatsim.physics.coefficients.table import DriftPairs
from boatsim.physics.particulars import GRAVITY
from boatsim.physics.signals import Array

SUFFIXES = (".12d", ".11d")  # by the direct method and by the indirect one
COLUMNS = 9
SAME_DIRECTION = 1e-3  # [deg] between directions that are the same


def pairs_next_to(path: Path) -> Path | None:
    """Return the file of quadratic transfer functions next to another output, None without one.

    Args:
        path: NAME.1 or another output.
    """
    for suffix in SUFFIXES:
        if path.with_suffix(suffix).is_file():
            return path.with_suffix(suffix)
    return None


def wamit_pairs(rows: list[list[float]], path: Path, density: float, length: float) -> DriftPairs:
    """Return the slow drift of pairs of waves of one direction from the rows of a file.

    Pairs of waves of two directions are not used.

    Args:
        rows: Numbers of the rows.
        path: File, for messages.
        density: Density of the water [kg/m^3].
        length: Unit of length [m].

    Raises:
        BadInput: The rows have another form, or a pair is missing.
    """
    found: dict[tuple[float, float, float], Array] = {}
    for row in rows:
        if len(row) < COLUMNS:
            raise BadInput(f"{path}: a row has {len(row)} columns; {COLUMNS} are required")
        if row[4] not in range(1, 7):
            raise BadInput(f"{path}: motion {row[4]:g}; only one body of six is read")
        i = int(row[4]) - 1
        if min(row[0], row[1]) <= 0.0 or abs(row[2] - row[3]) > SAME_DIRECTION:
            continue
        waves = (2.0 * np.pi / row[0], 2.0 * np.pi / row[1], -np.radians(row[2]))
        values = found.setdefault(waves, np.zeros(6, dtype=complex))
        size = density * GRAVITY * length ** (1 + (i > 2))
        values[i] = (row[7] + 1j * row[8]) * size * SIGNS[i]
    if not found:
        raise BadInput(f"{path}: there is no pair of waves of one direction")
    pairs = complete_pairs(np.array(list(found)), np.array(list(found.values())), str(path))
    count = len(pairs.frequency)
    flat: Array = np.asarray(pairs.values.reshape(count * count, len(pairs.heading), 6))
    heading, values = on_starboard_side(pairs.heading, flat, path)
    shape = (count, count, len(heading), 6)
    return DriftPairs(pairs.frequency, heading, np.asarray(values.reshape(shape)))
