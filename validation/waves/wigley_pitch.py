"""Sensitivity of the computed pitch of the Wigley hulls, and its limit in long waves.

The pitch of both hulls over the slope of the wave is computed with what could change it: a finer
mesh, a model that surges freely, a higher mass centre and a larger radius of gyration. For each
wave a further moment of inertia is found with which the computed pitch would be the measured one.

The moment of the pressure of the undisturbed wave is integrated over the lines of the hull, without
panels. Over the stiffness and the slope of the wave it is the pitch of a hull that has no inertia,
radiates no waves and scatters none.
"""

from pathlib import Path
from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq

from boatsim.hydrodynamics.response import linear_stiffness, rigid_body
from boatsim.physics.base import AXES
from boatsim.physics.coefficients.table import Coefficients
from boatsim.physics.particulars import GRAVITY
from validation.waves.wigley import (
    DRAUGHT,
    GYRADIUS,
    LENGTH,
    LONG,
    Hull,
    computed,
    half_breadth,
)

SURGE, HEAVE, PITCH = (AXES.index(axis) for axis in ("surge", "heave", "pitch"))
FINE = (30, 12)  # panels over half the length and over the draught of the finer mesh
VERY_LONG = 40.0  # wavelength over the length in which a floating body follows the surface
HIGHER = 0.05  # [m] by which the mass centre is raised; the hulls draw 0.19 m
LARGER = 1.1  # factor on the radius of gyration
POINTS = 60  # of Gauss and Legendre's quadrature over half the length and over the draught


class Pitch(NamedTuple):
    """Pitch of a hull in one wave over the slope of the wave; inertia as a share.

    Attributes:
        ratio: Wavelength over the length.
        measured: Measured pitch; nan if it was not.
        panels: Computed as in the comparison of all motions.
        fine: With a finer mesh.
        surging: With a model that surges freely.
        higher: With a higher mass centre.
        gyradius: With a larger radius of gyration.
        undisturbed: Moment of the undisturbed wave over the stiffness.
        inertia: Further moment of inertia with which the computed pitch is the measured one, over
            the computed added moment of inertia; nan if there is none.
    """

    ratio: float
    measured: float
    panels: float
    fine: float
    surging: float
    higher: float
    gyradius: float
    undisturbed: float
    inertia: float


class Model(NamedTuple):
    """Distribution of the mass of a model and what it is free to do."""

    centre: float  # [m] height of the mass centre above the keel
    gyradius: float  # [m] in pitch
    surges: bool = False
    inertia: float = 0.0  # further moment of inertia over the added one


def pitch_over_slope(found: Coefficients, row: int, model: Model) -> float:
    """Return the pitch of a model in head waves over the slope of the wave.

    Args:
        found: Coefficients of the hull.
        row: Number of the frequency.
        model: The model.
    """
    w, depth = float(found.frequency[row]), DRAUGHT - model.centre
    mass = found.density * found.volume
    gyradii = np.array([1.0, model.gyradius, model.gyradius])
    inertia = rigid_body(mass, (0.0, depth), mass * gyradii**2) + found.added_mass[row]
    inertia[PITCH, PITCH] += model.inertia * found.added_mass[row, PITCH, PITCH]
    stiffness = linear_stiffness(found, mass, depth)
    dynamic = stiffness + 1j * w * found.damping[row] - w * w * inertia
    free = [HEAVE, PITCH]
    if model.surges:
        free = [SURGE, HEAVE, PITCH]
    motion = np.linalg.solve(dynamic[np.ix_(free, free)], found.excitation[row, 0, free])
    return float(np.abs(motion[-1]) * GRAVITY / w**2)


def undisturbed_pitch(hull: Hull, ratio: float) -> float:
    """Return the pitching moment of the undisturbed wave over stiffness and slope.

    A strip of breadth b has the vertical force rho g a cos(w t + k x) (b(0) - k int b exp(-k z) dz)
    and the force ahead rho g a k sin(w t + k x) int b exp(-k z) dz at the depth z.

    Args:
        hull: The hull.
        ratio: Wavelength over the length.
    """
    nodes, weights = np.polynomial.legendre.leggauss(POINTS)
    x, share = 0.25 * LENGTH * (nodes + 1.0), 0.5 * LENGTH * weights  # both halves together
    z, part = 0.5 * DRAUGHT * (nodes + 1.0), 0.5 * DRAUGHT * weights
    k = 2.0 * np.pi / (ratio * LENGTH)
    breadth = 2.0 * half_breadth(hull, x[:, None], -z[None, :])
    top = 2.0 * half_breadth(hull, x, np.zeros_like(x))
    pressed = breadth * np.exp(-k * z)
    vertical = top - k * (pressed @ part)
    ahead = k * np.cos(k * x) * ((pressed * z) @ part)
    moment = np.sum(share * (x * np.sin(k * x) * vertical - ahead))
    # waterplane and buoyancy, and the weight at the depth of the mass centre
    volume, buoyancy = np.sum(share * (breadth @ part)), np.sum(share * ((breadth * z) @ part))
    depth = DRAUGHT - hull.centre
    stiffness = np.sum(share * x**2 * top) - buoyancy + volume * depth
    return float(moment / (k * stiffness))


def pitch_study(folder: Path, hull: Hull) -> list[Pitch]:
    """Return the pitch of a hull in waves of its length and more, by increasing wavelength.

    The last wave is very long and was not measured.

    Args:
        folder: Working folder.
        hull: The hull.

    Raises:
        BadInput: Capytaine is not installed.
    """
    ratios = [VERY_LONG, *sorted((r for r in hull.measured if r >= LONG), reverse=True)]
    found = computed(folder / f"wigley_{hull.name}.obj", hull, ratios)
    fine = computed(folder / f"wigley_{hull.name}_fine.obj", hull, ratios, *FINE)
    as_tested = Model(hull.centre, GYRADIUS)
    rows = []
    for i, ratio in enumerate(ratios):
        measured = np.nan
        if ratio in hull.measured:
            measured = hull.measured[ratio][1] * ratio  # over 2 pi / L in the table
        rows.append(
            Pitch(
                ratio,
                measured,
                pitch_over_slope(found, i, as_tested),
                pitch_over_slope(fine, i, as_tested),
                pitch_over_slope(found, i, as_tested._replace(surges=True)),
                pitch_over_slope(found, i, as_tested._replace(centre=hull.centre + HIGHER)),
                pitch_over_slope(found, i, as_tested._replace(gyradius=LARGER * GYRADIUS)),
                undisturbed_pitch(hull, ratio),
                _missing_inertia(found, i, as_tested, measured),
            )
        )
    return rows[::-1]


def _missing_inertia(found: Coefficients, row: int, model: Model, measured: float) -> float:
    """Return the inertia with which the pitch is the measured one; nan if there is none."""

    def difference(share: float) -> float:
        return pitch_over_slope(found, row, model._replace(inertia=share)) - measured

    low, high = -1.0, 1.0
    if np.isnan(measured) or difference(low) * difference(high) > 0.0:
        return float("nan")
    return float(brentq(difference, low, high))


def rows_within(rows: list[Pitch], name: str, share: float = 0.1) -> int:
    """Return the number of waves in which a computed pitch is close to the measured one.

    Args:
        rows: Measured and computed pitch.
        name: Field of the computed pitch.
        share: Largest relative error.
    """
    count = 0
    for row in rows:
        if abs(getattr(row, name) / row.measured - 1.0) <= share:  # not for nan
            count += 1
    return count
