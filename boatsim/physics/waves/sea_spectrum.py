"""Spectrum over frequency and direction of the seas of a vessel, and its file."""

import csv
from collections.abc import Sequence
from math import pi
from pathlib import Path

import numpy as np

from boatsim.errors import BadInput
from boatsim.files import replace_file
from boatsim.physics.debugging import interpreted
from boatsim.physics.signals import Array
from boatsim.physics.stated_table import ANGLES
from boatsim.physics.waves.sea_parameters import SeaParameters
from boatsim.physics.waves.sea_state import NO_TABLE, energy_above, sea_state, spectral_density
from boatsim.physics.waves.spreading import cosine_power
from boatsim.physics.waves.tabulated import CLOSE, TabulatedSpectrum, read_spectrum

FREQUENCIES, DIRECTIONS = 200, 72  # of a sea; a direction each 5 degrees
STEP = 2.0 * pi / DIRECTIONS  # [rad]
DIGITS = 6  # significant digits of a density


def spectrum_of_seas(seas: Sequence[SeaParameters]) -> TabulatedSpectrum:
    """Return the sum of the spectra of seas.

    It has the frequencies of each sea, so that none is coarser than alone. The energy of a sea is
    that of its significant height below its cut. Waves that all run alike have their energy in one
    direction of the grid.

    Args:
        seas: The seas, with a height each.

    Raises:
        BadInput: There is no sea, or one is a regular wave.
    """
    if not seas:
        raise BadInput("there is no sea with a spectrum")
    if len(seas) == 1 and seas[0].spectrum == "tabulated" and seas[0].spreading == 0.0:
        own = read_spectrum(seas[0].spectrum_file)
        if not len(own.direction):
            return _scaled(own, seas[0])
    grids = [_frequencies(sea) for sea in seas]
    frequency = _apart(np.concatenate(grids))
    # a direction of the grid is that of the first sea, so that its waves are in it
    steps = STEP * np.arange(DIRECTIONS)
    direction: Array = np.sort((seas[0].toward + steps) % (2.0 * pi))
    density = np.zeros((len(frequency), DIRECTIONS))
    for sea, grid in zip(seas, grids, strict=True):
        own = TabulatedSpectrum(frequency, direction, _density(sea, grid, frequency, direction))
        rms = 0.25 * own.significant_height
        density += own.density * (_energy(sea, grid) / rms**2)
    return TabulatedSpectrum(frequency, direction, density)


def _scaled(found: TabulatedSpectrum, sea: SeaParameters) -> TabulatedSpectrum:
    """Return a spectrum with the height of a sea."""
    factor = (sea.significant_height / found.significant_height) ** 2
    return TabulatedSpectrum(found.frequency, found.direction, factor * found.density)


def _frequencies(sea: SeaParameters) -> Array:
    """Return the frequencies of a sea (F,) [rad/s], up to its cut."""
    if sea.spectrum == "regular":
        raise BadInput(f"{sea.name}: a regular wave has no spectrum")
    if sea.spectrum == "tabulated":
        frequency = read_spectrum(sea.spectrum_file).frequency
        if 0.0 < sea.cut < frequency[-1]:
            return np.append(frequency[frequency < sea.cut], sea.cut)
        return frequency
    own = interpreted(sea_state)(sea.values(), NO_TABLE, 0)
    return np.linspace(own.low, own.low + own.number * own.width, FREQUENCIES)


def _apart(frequency: Array) -> Array:
    """Return frequencies, increasing, without those that a reader of the file takes as the same."""
    ordered = np.sort(frequency)
    least = 2.0 * CLOSE * max(1.0, float(ordered[-1]))
    kept = [ordered[0]]
    for one in ordered[1:]:
        if one > kept[-1] + least:
            kept.append(one)
    return np.array(kept)


def _energy(sea: SeaParameters, grid: Array) -> float:
    """Return the mean square of the elevation of a sea below its highest frequency [m^2]."""
    if sea.spectrum == "tabulated":
        found = _scaled(read_spectrum(sea.spectrum_file), sea)
        return float(np.trapezoid(np.interp(grid, found.frequency, found.over_frequency), grid))
    frequency, above = energy_above(sea.values())
    share = 1.0 - float(np.interp(grid[-1], frequency, above))
    return share * sea.significant_height**2 / 16.0


def _density(sea: SeaParameters, grid: Array, frequency: Array, direction: Array) -> Array:
    """Return the density (F, D) of a sea up to a factor, 0 outside the grid of its frequencies."""
    inside = (frequency >= grid[0] * (1.0 - 1e-9)) & (frequency <= grid[-1] * (1.0 + 1e-9))
    if sea.spectrum == "tabulated":
        found = read_spectrum(sea.spectrum_file)
        if len(found.direction):
            return _turned(found, sea.toward, frequency, direction) * inside[:, None]
        plain = np.interp(frequency, found.frequency, found.density)
    else:
        own = interpreted(sea_state)(sea.values(), NO_TABLE, 0)
        plain = interpreted(spectral_density)(frequency, sea.values(), own)
    off = (direction - sea.toward + pi) % (2.0 * pi) - pi
    share = np.zeros(len(direction))
    if sea.spreading > 0.0:
        share = np.asarray(cosine_power(off, sea.spreading))
    else:
        share[np.argmin(np.abs(off))] = 1.0 / STEP
    return np.asarray(np.outer(np.where(inside, plain, 0.0), share))


def _turned(found: TabulatedSpectrum, by: float, frequency: Array, direction: Array) -> Array:
    """Return the density of a spectrum, whose directions are turned, on another grid.

    A direction of the grid has the mean density of its step, so that no narrow sea is lost.
    """
    edges = direction[0] + STEP * (np.arange(DIRECTIONS + 1) - 0.5)
    own = found.direction + by
    points = np.union1d(edges, (own - edges[0]) % (2.0 * pi) + edges[0])
    over = np.array([np.interp(points, own, row, period=2.0 * pi) for row in found.density])
    parts = 0.5 * (over[:, 1:] + over[:, :-1]) * np.diff(points)
    cells = np.add.reduceat(parts, np.searchsorted(points, edges[:-1]), axis=1) / STEP
    columns = [np.interp(frequency, found.frequency, column, 0.0, 0.0) for column in cells.T]
    return np.stack(columns, axis=1)


def write_spectrum(path: Path, found: TabulatedSpectrum) -> None:
    """Write a spectrum as a table that `tabulated.read_spectrum` reads.

    Args:
        path: The file.
        found: The spectrum.
    """
    hertz = found.frequency / (2.0 * pi)
    with replace_file(path) as part, part.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        if not len(found.direction):
            writer.writerow(["frequency_hz", "density_m2_per_hz"])
            for f, value in zip(hertz, found.density, strict=True):
                writer.writerow([f"{f:.9g}", f"{2.0 * pi * value:.{DIGITS}g}"])
            return
        file.write("# direction = to\n")
        writer.writerow(["frequency_hz", "direction_deg", "density_m2_per_hz_deg"])
        size = 2.0 * pi * ANGLES["deg"]
        for f, row in zip(hertz, found.density, strict=True):
            for angle, value in zip(np.degrees(found.direction), row, strict=True):
                writer.writerow([f"{f:.9g}", f"{angle:.9g}", f"{size * value:.{DIGITS}g}"])
