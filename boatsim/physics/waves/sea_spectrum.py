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
from boatsim.physics.waves.sea_state import NO_TABLE, sea_state, spectral_density
from boatsim.physics.waves.spreading import cosine_power
from boatsim.physics.waves.tabulated import TabulatedSpectrum, read_spectrum

FREQUENCIES, DIRECTIONS = 200, 72  # a direction each 5 degrees
DIGITS = 6  # significant digits of a density


def spectrum_of_seas(seas: Sequence[SeaParameters]) -> TabulatedSpectrum:
    """Return the sum of the spectra of seas.

    Waves that all run alike have their energy in one direction of the grid.

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
    ranges = [_range(sea) for sea in seas]
    frequency: Array = np.linspace(
        min(low for low, _ in ranges), max(high for _, high in ranges), FREQUENCIES
    )
    # a direction of the grid is that of the first sea, so that its waves are in it
    steps = 2.0 * pi / DIRECTIONS * np.arange(DIRECTIONS)
    direction: Array = np.sort((seas[0].toward + steps) % (2.0 * pi))
    density = np.zeros((FREQUENCIES, DIRECTIONS))
    for sea in seas:
        density += _density(sea, frequency, direction)
    return TabulatedSpectrum(frequency, direction, density)


def _scaled(found: TabulatedSpectrum, sea: SeaParameters) -> TabulatedSpectrum:
    """Return a spectrum with the height of a sea."""
    factor = (sea.significant_height / found.significant_height) ** 2
    return TabulatedSpectrum(found.frequency, found.direction, factor * found.density)


def _range(sea: SeaParameters) -> tuple[float, float]:
    """Return the lowest and the highest frequency of a sea [rad/s]."""
    if sea.spectrum == "regular":
        raise BadInput(f"{sea.name}: a regular wave has no spectrum")
    if sea.spectrum == "tabulated":
        found = read_spectrum(sea.spectrum_file)
        return float(found.frequency[0]), float(found.frequency[-1])
    own = interpreted(sea_state)(sea.values(), NO_TABLE, 0)
    return own.low, own.low + own.number * own.width


def _density(sea: SeaParameters, frequency: Array, direction: Array) -> Array:
    """Return the density (F, D) of a sea [m^2 s/rad^2]."""
    low, high = _range(sea)
    inside = (frequency >= low * (1.0 - 1e-9)) & (frequency <= high * (1.0 + 1e-9))
    if sea.spectrum == "tabulated":
        found = _scaled(read_spectrum(sea.spectrum_file), sea)
        if len(found.direction):
            return _turned(found, sea.toward, frequency, direction)
        plain = np.interp(frequency, found.frequency, found.density)
    else:
        own = interpreted(sea_state)(sea.values(), NO_TABLE, 0)
        plain = interpreted(spectral_density)(frequency, sea.values(), own)
    off = (direction - sea.toward + pi) % (2.0 * pi) - pi
    share = np.zeros(len(direction))
    if sea.spreading > 0.0:
        share = np.asarray(cosine_power(off, sea.spreading))
    else:
        share[np.argmin(np.abs(off))] = DIRECTIONS / (2.0 * pi)
    return np.asarray(np.outer(np.where(inside, plain, 0.0), share))


def _turned(found: TabulatedSpectrum, by: float, frequency: Array, direction: Array) -> Array:
    """Return the density of a spectrum, whose directions are turned, on another grid."""
    around = np.append(found.direction, found.direction[0] + 2.0 * pi)
    whole = np.concatenate([found.density, found.density[:, :1]], axis=1)
    angle = (direction - by - around[0]) % (2.0 * pi) + around[0]
    over = np.array([np.interp(angle, around, row) for row in whole])
    columns = [np.interp(frequency, found.frequency, column, 0.0, 0.0) for column in over.T]
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
