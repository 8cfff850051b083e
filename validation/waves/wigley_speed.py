"""Heave, pitch damping and wave loads of a Wigley hull at forward speed against model tests.

The radiation is computed from coefficients at zero speed in three ways: with no effect of speed but
the frequency of encounter, with the equations in body axes, and with the terms of `forward_speed`
of `radiation_memory` in addition, which make them those of strip theory. The excitation is that at
zero speed, with the frequency of encounter; strip theory adds the moment -U / (i w_e) of the
diffraction force in heave, which loads at rest leave out, and takes the diffraction at the
frequency of encounter (`speed_diffraction`).
"""

from pathlib import Path
from typing import NamedTuple

import numpy as np

from boatsim.hydrodynamics.capytaine_worker import MetWave
from boatsim.hydrodynamics.computation import HullMesh, coefficients_of_rows, run_capytaine
from boatsim.physics.base import Array
from boatsim.physics.particulars import GRAVITY
from validation.waves.ship_speed import METHODS
from validation.waves.slow_table import HEAVE, PITCH, SlowTable, Wave
from validation.waves.speed_diffraction import MovingHull
from validation.waves.wigley import (
    DENSITY,
    DRAUGHT,
    GYRADIUS,
    HEAD,
    HULLS,
    LENGTH,
    half_breadth,
    write_hull,
)

HULL = HULLS[0]
UNIT = np.sqrt(LENGTH / GRAVITY)  # [s]
# J. M. J. Journee, Delft University of Technology, report 909, 1992, hull III; values as quoted in
# the tests of the program michell (github.com/risingtideresearch/michell, files
# crates/michell-seakeeping/src/validation.rs and docs/seakeeping-findings.md, September 2026),
# which leave out heave at the resonance of pitch, and all values of pitch
# Table 2-III, forced heave at Fn 0.3: w sqrt(L / g), A33 / rho V, B33 / rho V sqrt(L / g)
FORCED_FROUDE = 0.3
FORCED_HEAVE = (
    (2.22, 0.707, 1.963),
    (2.78, 0.537, 1.994),
    (3.34, 0.465, 1.854),
    (3.88, 0.425, 1.706),
    (4.45, 0.421, 1.518),
)
# Forced pitch at w sqrt(L / g) = 2.2: Fn, B55 / rho V L^2 sqrt(L / g)
FORCED_PITCH_AT = 2.2
FORCED_PITCH = ((0.2, 0.074), (0.3, 0.073), (0.4, 0.066))
# Table 6-III, held hull at Fn 0.3: wavelength / L, X3 / (C33 a), X5 / (k C55 a)
LOADS_FROUDE = 0.3
LOADS = ((1.25, 0.345, 0.444), (1.5, 0.454, 0.546), (1.75, 0.515, 0.600), (2.0, 0.577, 0.658))
# Table 8-III, free in heave and pitch: Fn, wavelength / L, heave over the amplitude
MOTIONS = (
    (0.2, 1.25, 0.71),
    (0.2, 1.5, 0.81),
    (0.2, 2.0, 0.90),
    (0.3, 1.25, 1.28),
    (0.3, 1.384, 1.11),
    (0.3, 1.5, 1.01),
    (0.3, 2.0, 0.99),
)
# Lowest and highest frequency of the table of coefficients [rad/s], and their number
LOWEST, HIGHEST, NUMBER = 2.0, 9.0, 22
POINTS = 60  # of Gauss and Legendre's quadrature over half the length and over the draught


def head_wave(ratio: float, froude: float) -> Wave:
    """Return a head wave.

    Args:
        ratio: Wavelength over length.
        froude: Froude number.
    """
    k = 2.0 * np.pi / (ratio * LENGTH)
    return Wave(float(np.sqrt(GRAVITY * k)), float(k), froude_speed(froude))


def froude_speed(froude: float) -> float:
    """Return the speed [m/s] of a Froude number."""
    return froude * float(np.sqrt(GRAVITY * LENGTH))


def write_mesh(folder: Path) -> HullMesh:
    """Write the mesh of the hull.

    Args:
        folder: Working folder.
    """
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f"wigley_{HULL.name}.obj"
    write_hull(path, HULL)
    return HullMesh(path, DRAUGHT, density=DENSITY)


def slow_table(folder: Path) -> SlowTable:
    """Return the coefficients of the hull at zero speed.

    Args:
        folder: Working folder.

    Raises:
        BadInput: Capytaine is not installed.
    """
    mesh = write_mesh(folder)
    frequencies = [float(w) for w in np.linspace(LOWEST, HIGHEST, NUMBER)]
    rows = run_capytaine(mesh, frequencies, [HEAD], lambda stage, share: None)
    found = coefficients_of_rows(rows, mesh, [HEAD])
    return SlowTable(found, DRAUGHT - HULL.centre, GYRADIUS, undisturbed_heave)


def met_excitation(hull: MovingHull, wave: Wave) -> Array:
    """Return the excitation (2,) in heave and pitch with the diffraction at the encounter.

    Args:
        hull: The hull.
        wave: The wave.
    """
    met = MetWave(wave.frequency, wave.encounter, HEAD, wave.speed)
    return np.asarray(hull.excitation(met)[[HEAVE, PITCH]], dtype=complex)


def undisturbed_heave(number: float) -> float:
    """Return the upward force of the pressure of an undisturbed head wave per amplitude [N/m].

    Args:
        number: Wave number [rad/m].
    """
    nodes, weights = np.polynomial.legendre.leggauss(POINTS)
    x, share = 0.25 * LENGTH * (nodes + 1.0), 0.5 * LENGTH * weights  # both halves together
    z, part = 0.5 * DRAUGHT * (nodes + 1.0), 0.5 * DRAUGHT * weights
    breadth = 2.0 * half_breadth(HULL, x[:, None], -z[None, :])
    top = 2.0 * half_breadth(HULL, x, np.zeros_like(x))
    pressed = top - number * ((breadth * np.exp(-number * z)) @ part)
    return float(DENSITY * GRAVITY * np.sum(share * np.cos(number * x) * pressed))


class ForcedHeave(NamedTuple):
    """Added mass and damping in heave, measured and computed, without units."""

    frequency: float
    added_mass: tuple[float, float]
    damping: tuple[float, float]


def forced_heave(table: SlowTable) -> list[ForcedHeave]:
    """Return measured and computed added mass and damping in heave.

    Args:
        table: The coefficients.
    """
    rows = []
    for number, added, damping in FORCED_HEAVE:
        w = number / UNIT
        force = table.radiation(w, froude_speed(FORCED_FROUDE), "forward speed")[0, 0]
        found = -force.real / w**2 / table.mass, force.imag / w / table.mass * UNIT
        rows.append(ForcedHeave(number, (added, found[0]), (damping, found[1])))
    return rows


def pitch_damping(table: SlowTable) -> list[tuple[float, float, tuple[float, ...]]]:
    """Return Froude number, measured damping in pitch and that of each of `METHODS`, no units.

    Args:
        table: The coefficients.
    """
    w, rows = FORCED_PITCH_AT / UNIT, []
    for froude, measured in FORCED_PITCH:
        found = []
        for method in METHODS:
            force = table.radiation(w, froude_speed(froude), method)[1, 1]
            found.append(float(force.imag / w / (table.mass * LENGTH**2) * UNIT))
        rows.append((froude, measured, tuple(found)))
    return rows


class Load(NamedTuple):
    """Heave force and pitching moment of a wave on the held hull, without units."""

    ratio: float
    measured: tuple[float, float]
    zero_speed: tuple[float, float]
    diffraction: tuple[float, float]  # with the moment of the diffraction at forward speed
    encounter: tuple[float, float]  # with the diffraction at the frequency of encounter too


def wave_loads(table: SlowTable, hull: MovingHull) -> list[Load]:
    """Return measured and computed loads of head waves on the held hull.

    Args:
        table: The coefficients.
        hull: The hull.
    """
    rows = []
    for ratio, *measured in LOADS:
        wave = head_wave(ratio, LOADS_FROUDE)
        unit = np.diag(table.stiffness) * np.array([1.0, wave.number])
        found = []
        for diffraction in (False, True):
            found.append(np.abs(table.excitation(wave, diffraction)) / unit)
        found.append(np.abs(met_excitation(hull, wave)) / unit)
        pairs = [(float(force), float(moment)) for force, moment in (measured, *found)]
        rows.append(Load(ratio, *pairs))
    return rows


class Heave(NamedTuple):
    """Heave of the hull over the amplitude of the wave."""

    froude: float
    ratio: float
    measured: float
    found: tuple[float, ...]  # by each of `METHODS`
    diffraction: float  # by the last one, with the moment of the diffraction at forward speed
    encounter: float  # by the last one, with the diffraction at the frequency of encounter too
    pitch: tuple[float, ...]  # over 2 pi / L times the amplitude, by each of `METHODS`


def heave_at_speed(table: SlowTable, hull: MovingHull) -> list[Heave]:
    """Return measured and computed heave in head waves.

    Args:
        table: The coefficients.
        hull: The hull.
    """
    rows = []
    for froude, ratio, measured in MOTIONS:
        wave = head_wave(ratio, froude)
        motions = [np.abs(table.heave_and_pitch(wave, method)) for method in METHODS]
        last = np.abs(table.heave_and_pitch(wave, METHODS[-1], True))
        heave = tuple(float(one[0]) for one in motions)
        pitch = tuple(float(one[1]) * LENGTH / (2.0 * np.pi) for one in motions)
        met = np.abs(table.motion_under(wave, METHODS[-1], met_excitation(hull, wave)))
        rows.append(Heave(froude, ratio, measured, heave, float(last[0]), float(met[0]), pitch))
    return rows


def mean_error(pairs: list[tuple[float, float]]) -> float:
    """Return the mean of the relative errors without their sign.

    Args:
        pairs: Measured and computed values.
    """
    return float(np.mean([abs(found / measured - 1.0) for measured, found in pairs]))
