"""Coefficients of VERES (ShipX): mass, added mass, damping and stiffness of NAME.re7.

The axes are those of `boatsim.hydrodynamics.veres`: x aft, y to starboard and z up. Source of the
layout: the reader of T. I. Fossen's MSS toolbox, read_veres_ABC.m.
"""

from pathlib import Path
from typing import NamedTuple

import numpy as np

from boatsim.errors import BadInput
from boatsim.hydrodynamics.veres import SIGNS, TEXT_LINES
from boatsim.physics.base import Array

MATRICES = 6  # of a frequency: added mass, damping and stiffness, each of the hull and in addition
VISCOUS = 3  # numbers of the viscous damping of roll: linear, quadratic, and the latter linearized


class VeresCoefficients(NamedTuple):
    """Coefficients of a ship over speed, heading and frequency, in SNAME axes.

    Attributes:
        density: Density of the water [kg/m^3].
        length: Length between perpendiculars [m].
        draught: Draught [m].
        centre: Mass centre ahead of amidships and above the baseline (2,) [m].
        body: Mass matrix (6, 6) about the point of the motions.
        speed: Forward speeds (U,) [m/s].
        heading: Directions (H,) to which the waves run [rad]; pi is from ahead.
        frequency: Frequencies of the waves (N,) [rad/s].
        added_mass: Added mass (U, H, N, 6, 6).
        more_added_mass: Added mass of tanks and what else is not the hull, of the same shape.
        damping: Damping by radiated waves.
        more_damping: Damping of tanks and what else is not the hull.
        stiffness: Stiffness.
        viscous: Viscous damping of roll (U, H, N): linear, with the quadratic part linearized for
            the height of the waves [N m s].
    """

    density: float
    length: float
    draught: float
    centre: tuple[float, float]
    body: Array
    speed: Array
    heading: Array
    frequency: Array
    added_mass: Array
    more_added_mass: Array
    damping: Array
    more_damping: Array
    stiffness: Array
    viscous: Array


def read_veres_coefficients(path: Path) -> VeresCoefficients:
    """Read NAME.re7.

    Args:
        path: The file.

    Raises:
        BadInput: The file has another form.
    """
    try:
        lines = path.read_text(encoding="latin-1").splitlines()[TEXT_LINES:]
        numbers = np.array(" ".join(lines).replace("D", "E").split(), dtype=float)
    except (OSError, ValueError) as error:
        raise BadInput(f"{path}: the coefficients cannot be read: {error}") from None
    density, _, length, _, draught, aft, above = numbers[:7]
    speeds, headings, frequencies, axes = (round(float(count)) for count in numbers[9:13])
    row = 1 + MATRICES * 36 + VISCOUS
    block = 5 + headings * (1 + frequencies * row)  # of a speed
    begin = 13 + 36
    if axes != 6 or len(numbers) != begin + speeds * block:
        raise BadInput(f"{path}: {len(numbers)} numbers; the file states {begin + speeds * block}")
    body = numbers[13:begin].reshape(6, 6)
    tables = numbers[begin:].reshape(speeds, block)
    by_heading = tables[:, 5:].reshape(speeds, headings, 1 + frequencies * row)
    rows = by_heading[..., 1:].reshape(speeds, headings, frequencies, row)
    matrices = rows[..., 1 : 1 + MATRICES * 36].reshape(*rows.shape[:3], MATRICES, 6, 6)
    sname = matrices * SIGNS[:, None] * SIGNS
    added, more_added, damping, more_damping, stiffness, more_stiffness = np.moveaxis(sname, 3, 0)
    return VeresCoefficients(
        float(density),
        float(length),
        float(draught),
        (-float(aft), float(above)),
        body * SIGNS[:, None] * SIGNS,
        tables[:, 0],
        np.pi - np.radians(by_heading[0, :, 0]),
        rows[0, 0, :, 0],
        added,
        more_added,
        damping,
        more_damping,
        stiffness + more_stiffness,
        rows[..., -VISCOUS] + rows[..., -1],
    )
