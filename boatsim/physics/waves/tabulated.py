"""Tabulated sea: a measured or computed spectrum over frequency, with or without direction.

    # direction = to          or from: where the waves of a direction run to, or come from
    frequency_hz,direction_deg,density_m2_per_hz_deg
    ...

A spectrum without directions has the columns frequency_hz and density_m2_per_hz. Directions are
clockwise from north, or from x of a run. Frequencies may be in frequency_radps, directions in
direction_rad, and densities in m2s_per_rad or m2s_per_rad2.
"""

from dataclasses import dataclass
from functools import lru_cache
from math import pi
from pathlib import Path

import numpy as np

from boatsim.errors import BadInput
from boatsim.physics.signals import Array
from boatsim.physics.stated_table import ANGLES, StatedTable, read_stated_table

WORDS = {"direction": ("to", "from")}
FREQUENCIES = {"frequency_hz": 2.0 * pi, "frequency_radps": 1.0}
DIRECTIONS = {f"direction_{unit}": factor for unit, factor in ANGLES.items()}
PLAIN = {"density_m2_per_hz": 0.5 / pi, "density_m2s_per_rad": 1.0}
DIRECTIONAL = {
    "density_m2_per_hz_deg": 0.5 / pi / ANGLES["deg"],
    "density_m2s_per_rad2": 1.0,
}
# Shares of the energy of a cell at whose ends its directions are stored; in between they are linear
SHARES = 32
FINE = 16  # points of a direction between two of the table, by which its energy is integrated
CLOSE = 1e-5  # relative difference of frequencies and [rad] of directions that are the same


@dataclass(frozen=True, eq=False)
class TabulatedSpectrum:
    """Spectral density of the elevation over frequency and direction.

    Attributes:
        frequency: Angular frequencies (F,) [rad/s], increasing.
        direction: Directions (D,) to which the waves run [rad], increasing, within one turn; empty
            for a spectrum without directions.
        density: Density (F, D) [m^2 s/rad^2], or (F,) [m^2 s/rad].
    """

    frequency: Array
    direction: Array
    density: Array

    @property
    def over_frequency(self) -> Array:
        """Density over the frequency alone (F,) [m^2 s/rad]."""
        if not len(self.direction):
            return self.density
        around = np.append(self.direction, self.direction[0] + 2.0 * pi)
        whole = np.concatenate([self.density, self.density[:, :1]], axis=1)
        return np.asarray(np.trapezoid(whole, around, axis=1))

    @property
    def significant_height(self) -> float:
        """Four times the rms of the elevation [m]."""
        return float(4.0 * np.sqrt(np.trapezoid(self.over_frequency, self.frequency)))


def read_spectrum(path: str | Path) -> TabulatedSpectrum:
    """Read a spectrum from a file; a second call returns the same object.

    Args:
        path: The file.

    Raises:
        BadInput: A line has another form, a direction of a frequency is missing, or there are no
            waves.
    """
    file = Path(path)
    if not file.is_file():
        raise BadInput(f"{file}: there is no such file")
    return _read_spectrum(file.resolve(), file.stat().st_mtime_ns)


@lru_cache(maxsize=8)
def _read_spectrum(path: Path, _: int) -> TabulatedSpectrum:
    table = read_stated_table(path, WORDS, ())
    frequency = table.column(FREQUENCIES)
    if frequency is None:
        raise BadInput(f"{path}: a column {' or '.join(FREQUENCIES)} is required")
    direction = table.column(DIRECTIONS)
    density = _density(table, direction is not None)
    if np.any(density < 0.0):
        raise BadInput(f"{path}: a density is negative; allowed is 0 and above")
    waves = _different(frequency)
    if len(waves) < 3 or waves[0] < 0.0:
        raise BadInput(f"{path}: at least three frequencies above 0 are required")
    if direction is None:
        if len(waves) != len(frequency):
            raise BadInput(f"{path}: a frequency stands twice; a column of directions is missing")
        found = TabulatedSpectrum(waves, np.zeros(0), density[np.argsort(frequency)])
    else:
        if table.words["direction"] == "from":
            direction = direction + pi
        angle = direction % (2.0 * pi)
        angle[angle > 2.0 * pi - CLOSE] = 0.0
        found = _directional(waves, frequency, angle, density, path)
    if found.significant_height <= 0.0:
        raise BadInput(f"{path}: the spectrum has no waves; every density is 0")
    return found


def _density(table: StatedTable, directional: bool) -> Array:
    units = DIRECTIONAL if directional else PLAIN
    found = table.column(units)
    if found is None:
        words = "with" if directional else "without"
        raise BadInput(
            f"{table.path}: a column {' or '.join(units)} is required for a spectrum {words} "
            "directions"
        )
    return found


def _different(values: Array) -> Array:
    """Return the different numbers, increasing."""
    ordered = np.sort(values)
    new = np.append(True, np.diff(ordered) > CLOSE * max(1.0, float(ordered[-1])))
    return np.asarray(ordered[new])


def _directional(
    waves: Array, frequency: Array, angle: Array, density: Array, path: Path
) -> TabulatedSpectrum:
    """Return a spectrum on a grid; directions after a whole turn count once."""
    directions = _different(angle)
    if len(directions) < 4:
        raise BadInput(f"{path}: {len(directions)} directions; at least four are required")
    grid = np.full((len(waves), len(directions)), np.nan)
    for w, direction, value in zip(frequency, angle, density, strict=True):
        k = int(np.argmin(np.abs(waves - w)))
        grid[k, int(np.argmin(np.abs(directions - direction)))] = value
    if np.isnan(grid).any():
        k, d = np.argwhere(np.isnan(grid))[0]
        raise BadInput(
            f"{path}: every frequency needs the same directions; {waves[k]:.4g} rad/s lacks "
            f"{np.degrees(directions[d]):.4g} deg"
        )
    return TabulatedSpectrum(waves, directions, grid)


@lru_cache(maxsize=16)
def spectrum_table(found: TabulatedSpectrum, components: int, cut: float) -> tuple[float, ...]:
    """Return the table of a sea's cells, as compiled laws read it.

    It has the number of cells, the lowest frequency and the width of a cell [rad/s] and the number
    of shares into which the directions of a cell are divided. Then follow for each cell its part of
    the energy of the spectrum and the directions [rad] at the ends of these shares.

    Args:
        found: The spectrum.
        components: Number of waves, one for each cell.
        cut: Highest frequency [rad/s]; 0 for that of the spectrum.
    """
    frequency, plain = found.frequency, found.over_frequency
    high = frequency[-1] if cut == 0.0 else min(cut, float(frequency[-1]))
    edges = np.linspace(frequency[0], high, components + 1)
    # the integral of a density that is linear between its points is exact at all edges
    points = np.union1d(frequency, edges)
    density = np.interp(points, frequency, plain)
    below = np.append(0.0, np.cumsum(0.5 * (density[1:] + density[:-1]) * np.diff(points)))
    total = float(np.trapezoid(plain, frequency))
    share = np.diff(np.interp(edges, points, below)) / total
    middle = 0.5 * (edges[1:] + edges[:-1])
    rows = np.zeros((components, SHARES + 2))
    rows[:, 0] = share
    if len(found.direction):
        for i, w in enumerate(middle):
            rows[i, 1:] = _direction_shares(found, float(w))
    head = (float(components), float(edges[0]), float(edges[1] - edges[0]), float(SHARES))
    return (*head, *rows.ravel().tolist())


def _direction_shares(found: TabulatedSpectrum, frequency: float) -> Array:
    """Return the directions below which the shares sin^2(pi j / 2 n) of the energy lie.

    They begin where the density is least, so that no share lies on both sides of it.
    """
    k = int(np.clip(np.searchsorted(found.frequency, frequency) - 1, 0, len(found.frequency) - 2))
    part = (frequency - found.frequency[k]) / (found.frequency[k + 1] - found.frequency[k])
    density = (1.0 - part) * found.density[k] + part * found.density[k + 1]
    first = int(np.argmin(density))
    angle = np.append(found.direction[first:], found.direction[: first + 1] + 2.0 * pi)
    value = np.append(density[first:], density[: first + 1])
    fine = np.interp(
        np.linspace(0.0, len(angle) - 1.0, FINE * (len(angle) - 1) + 1),
        np.arange(len(angle)),
        angle,
    )
    dense = np.interp(fine, angle, value)
    below = np.append(0.0, np.cumsum(0.5 * (dense[1:] + dense[:-1]) * np.diff(fine)))
    if below[-1] <= 0.0:
        return np.zeros(SHARES + 1)
    wanted = np.sin(np.linspace(0.0, 0.5 * pi, SHARES + 1)) ** 2
    # where the density is 0 the sum does not grow: the last such direction begins the first share
    rising = np.append(np.diff(below) > 0.0, True)
    return np.asarray(np.interp(wanted, below[rising] / below[-1], fine[rising]))
