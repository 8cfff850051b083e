"""Mean drift against closed forms: Maruo's for a section and Havelock's for a cylinder."""

from pathlib import Path
from typing import NamedTuple

import numpy as np
from scipy.special import h1vp, jvp

from boatsim.hydrodynamics.computation import HullMesh, coefficients_of_rows, run_capytaine
from boatsim.hydrodynamics.mean_drift import energy_error, far_field, kochin_of_row, mean_drift
from boatsim.hydrodynamics.response import linear_stiffness, rigid_body
from boatsim.physics.base import AXES, Array
from boatsim.physics.coefficients.table import Coefficients
from boatsim.physics.particulars import GRAVITY
from validation.waves import section
from validation.waves.hulls import Section, revolved, write_stl

SWAY, HEAVE, ROLL = (AXES.index(axis) for axis in ("sway", "heave", "roll"))
NUMBERS = (1.0, 1.5, 2.0)  # k a of the cylinder
RADIUS, DRAUGHT = 1.0, 3.0  # [m] so deep that the pressure at its bottom is less than 5 %
MERIDIANS, DOWN, INWARD = 32, 12, 4  # panels around the cylinder, on its side and bottom
# The section in deep water, whose waves have 0.7 to 1.6 s, with finer panels than in the flume: the
# drift is as exact as the square of the waves
BODIES = section.LongBodies(
    short=2.0,
    long=4.0,
    panel=0.125,
    section=Section(section.BEAM, section.DRAUGHT, section.BILGE, panels=(6, 3)),
    depth=0.0,
    frequencies=[4.0, 5.0, 6.0, 7.0, 8.0, 9.0],
)
SERIES = 30  # terms of the series of the cylinder


class SectionDrift(NamedTuple):
    """Mean drift of the section at one frequency, per length."""

    frequency: float  # [rad/s]
    moves: bool  # freely floating, or held
    reflection: float  # amplitude of the reflected wave over that of the incident one
    far_field: float  # [N/m per m^2] by the far-field method
    maruo: float  # [N/m per m^2] by Maruo's formula

    @property
    def error(self) -> float:
        """Relative error of the far-field method."""
        return self.far_field / self.maruo - 1.0


class CylinderDrift(NamedTuple):
    """Mean drift of a held cylinder at one frequency."""

    number: float  # k a
    force: float  # over rho g a and the square of the amplitude
    exact: float
    energy: float  # relative error of the conservation of energy


def section_drift(folder: Path) -> list[SectionDrift]:
    """Return the mean drift of the ship section in beam waves, held and freely floating.

    The drift per length is the difference of those of two long bodies, in which the ends cancel.
    The reflection in Maruo's formula follows from the pressure on the hull; the two have only the
    potential on the hull in common.

    Args:
        folder: Working folder.

    Raises:
        BadInput: Capytaine is not installed.
    """
    short, long = section.computed_bodies(folder, BODIES)
    found = section.section_coefficients(folder, BODIES)
    motion, held, free = section_reflection(found)
    results = []
    for moves, reflection in ((False, held), (True, free)):
        response = motion if moves else np.zeros_like(motion)
        sides = []
        for body in (short, long):
            drift = mean_drift(body.rows, body.coefficients, response, np.zeros((6, 6)))
            sides.append(drift[:, 0, 1])
        per_length = (sides[1] - sides[0]) / (BODIES.long - BODIES.short)
        for i, w in enumerate(found.frequency):
            exact = maruo(float(reflection[i]), found.density)
            results.append(
                SectionDrift(float(w), moves, float(reflection[i]), float(per_length[i]), exact)
            )
    return results


def section_reflection(found: Coefficients) -> tuple[Array, Array, Array]:
    """Return the motion of the section in beam waves and its coefficients of reflection.

    The parts of the waves that are symmetric and antisymmetric about the section are reflected
    with a modulus of one. Held, their phase is twice that of the excitation; free, that of the
    impedance comes in addition (J. N. Newman, J. Fluid Mech. 71, 1975).

    Args:
        found: Coefficients of the section.

    Returns:
        Motion (N, 1, 6) in waves of unit amplitude, and the moduli of the reflected waves (N,) of
        the held and of the free section.
    """
    body = rigid_body(section.MASS, (0.0, section.DEPTH), np.array([section.INERTIA, 1.0, 1.0]))
    stiffness = linear_stiffness(found, section.MASS, section.DEPTH)
    motion = np.zeros((len(found.frequency), 1, 6), dtype=complex)
    held, free = [], []
    for i, w in enumerate(found.frequency):
        dynamic = stiffness + 1j * w * found.damping[i] - w * w * (body + found.added_mass[i])
        outgoing, moving = [], []
        for axes in ([HEAVE], [SWAY, ROLL]):
            excitation = found.excitation[i, 0, axes]
            own = dynamic[np.ix_(axes, axes)]
            motion[i, 0, axes] = np.linalg.solve(own, excitation)
            outgoing.append(np.exp(2j * np.angle(excitation[0])))
            impedance = np.linalg.det(own)
            moving.append(outgoing[-1] * np.conj(impedance) / impedance)
        held.append(abs(sum(outgoing)) / 2.0)
        free.append(abs(sum(moving)) / 2.0)
    return motion, np.array(held), np.array(free)


def maruo(reflection: float, density: float) -> float:
    """Return the mean drift of a section in deep water by Maruo's formula [N/m per m^2].

    It is rho g / 2 R^2 in waves of unit amplitude.

    Args:
        reflection: Amplitude of the reflected wave over that of the incident one, R.
        density: Density of the water [kg/m^3].
    """
    return 0.5 * density * GRAVITY * reflection**2


def cylinder_force(number: float) -> float:
    """Return the mean drift of a deep circular cylinder, over rho g a and the squared amplitude.

    Source: T. H. Havelock, The pressure of water waves upon a fixed obstacle, Proc. R. Soc. A 175,
    1940. For short waves it is 2 / 3.

    Args:
        number: Wave number times radius.
    """
    order = np.arange(SERIES)
    factor = np.where(order == 0, 1.0, 2.0)
    amplitude = -jvp(order, number) / h1vp(order, number)
    theta = 2.0 * np.pi / 720 * np.arange(720)
    scattered = np.cos(np.outer(theta, order)) @ (factor * amplitude)
    width = 2.0 / np.pi / number * np.abs(scattered) ** 2
    return float(0.25 * np.sum(width * (1.0 - np.cos(theta))) * 2.0 * np.pi / 720)


def cylinder_drift(folder: Path) -> list[CylinderDrift]:
    """Return the mean drift of a held circular cylinder in deep water.

    Args:
        folder: Working folder.

    Raises:
        BadInput: Capytaine is not installed.
    """
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / "cylinder.stl"
    # the polygon has the area of the circle
    share = 0.5 * MERIDIANS / np.pi * np.sin(2.0 * np.pi / MERIDIANS)
    radius = RADIUS / np.sqrt(share)
    down = -DRAUGHT * np.linspace(0.0, 1.0, DOWN + 1) ** 1.5
    inward = radius * np.linspace(1.0, 0.0, INWARD + 1)[1:]
    side = np.column_stack([np.full(DOWN + 1, radius), down])
    bottom = np.column_stack([inward, np.full(INWARD, -DRAUGHT)])
    write_stl(path, revolved(np.concatenate([side, bottom]), MERIDIANS))
    hull = HullMesh(path, DRAUGHT, density=1000.0)
    frequencies = [float(np.sqrt(number * GRAVITY / RADIUS)) for number in NUMBERS]
    heading = [0.0]
    rows = run_capytaine(hull, frequencies, heading, lambda stage, share: None)
    found = coefficients_of_rows(rows, hull, heading)
    held = np.zeros((len(NUMBERS), 1, 6))
    drift = mean_drift(rows, found, held, np.zeros((6, 6)))
    results = []
    by_frequency = {row["frequency"]: row for row in rows}
    for i, number in enumerate(NUMBERS):
        kochin = kochin_of_row(by_frequency[frequencies[i]], held[i])
        waves = far_field(frequencies[i], found.depth, found.density)
        force = float(drift[i, 0, 0]) / (found.density * GRAVITY * RADIUS)
        error = float(energy_error(kochin, found.heading, waves)[0])
        results.append(CylinderDrift(number, force, cylinder_force(number), error))
    return results
