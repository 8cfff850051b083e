"""Conversion of coefficients from the axes of boundary element programs to SNAME.

These programs have z up and y to port, and headings counter-clockwise. Capytaine and Nemoh write
the time as exp(-i w t), WAMIT as exp(i w t).
"""

from dataclasses import replace

import numpy as np

from boatsim.physics.coefficients.memory_fit import fit_memory, memory_response
from boatsim.physics.coefficients.table import Coefficients
from boatsim.physics.signals import Array

# Sign of each motion and force of z-up axes in SNAME axes
SIGNS = np.array([1.0, -1.0, -1.0, 1.0, -1.0, -1.0])
# Largest share by which a hull may differ from one that is symmetric to port and starboard: the
# coupling of the two sets of axes over the geometric mean of the entries on the diagonal
ASYMMETRY = 0.02
UPRIGHT, SIDEWAYS = (0, 2, 4), (1, 3, 5)


def to_sname(matrix: Array) -> Array:
    """Return matrices (..., 6, 6) of z-up axes in SNAME axes."""
    return np.asarray(np.asarray(matrix) * SIGNS[:, None] * SIGNS)


def excitation_to_sname(excitation: Array, conjugate: bool) -> Array:
    """Return the excitation (..., 6) of z-up axes in SNAME axes, with the time factor exp(i w t).

    Args:
        excitation: Complex excitation.
        conjugate: Whether its time factor is exp(-i w t).
    """
    found = np.asarray(excitation) * SIGNS
    if conjugate:
        found = np.conj(found)
    return np.asarray(found)


def asymmetry(added_mass: Array) -> float:
    """Return how strongly the added mass couples motions that a symmetric hull does not couple.

    Args:
        added_mass: Added mass (N, 6, 6).

    Returns:
        Largest coupling over the geometric mean of its entries on the diagonal [-].
    """
    diagonal = np.sqrt(np.abs(np.einsum("nii->ni", added_mass)))
    size = diagonal[:, :, None] * diagonal[:, None, :]
    size[size == 0.0] = np.inf
    share = np.abs(added_mass) / size
    return float(share[:, UPRIGHT, :][:, :, SIDEWAYS].max())


def with_memory(found: Coefficients) -> Coefficients:
    """Return a copy of coefficients with the fitted memory of the radiation force.

    Args:
        found: The coefficients.
    """
    response = memory_response(
        found.frequency, found.added_mass, found.damping, found.infinite_added_mass
    )
    return replace(found, memory=fit_memory(found.frequency, response))


def restoring_matrix(
    weight: float, area: float, first: Array, second: Array, volume: float, depth: float
) -> Array:
    """Return the hydrostatic stiffness (6, 6) of waterplane and buoyancy in SNAME axes.

    It is the stiffness of a floating hull but for the moment of its weight, to which m g z_G is
    added in roll and pitch, z_G being the depth of the mass centre. Source: J. N. Newman, Marine
    Hydrodynamics, 1977, section 6.16.

    Args:
        weight: Density of the water times gravity [N/m^3].
        area: Area of the waterplane [m^2].
        first: Its first moments along x and y, to starboard (2,) [m^3].
        second: Its second moments along x and y (2,) [m^4].
        volume: Displaced volume [m^3].
        depth: Depth of the centre of buoyancy [m].
    """
    found = np.zeros((6, 6))
    found[2, 2] = area
    found[2, 3] = found[3, 2] = first[1]
    found[2, 4] = found[4, 2] = -first[0]
    found[3, 3] = second[1] - volume * depth
    found[4, 4] = second[0] - volume * depth
    return weight * found
