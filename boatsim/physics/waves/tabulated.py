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
SAME_DENSITY = 1e-6  # relative difference of densities that are the same
# Directions cover a sector if the step from its end to its begin is more than this multiple of
# every other step: a table of the whole circle that lacks one of its directions has a step twice
# as wide as the others, and one with finer steps about its peak has several of the widest
GAP = 1.5


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


def close_sector(direction: Array, density: Array) -> tuple[Array, Array]:
    """Return directions and density with the density 0 outside the sector that they cover.

    The density falls to 0 within the step next to each end, so that its integral over a sector
    with equal steps is the sum over its directions times the step. Directions of the whole circle
    are returned as they are.

    Args:
        direction: Directions (D,) [rad], increasing, within one turn.
        density: Density (F, D).
    """
    steps = np.diff(np.append(direction, direction[0] + 2.0 * pi))
    widest = int(np.argmax(steps))
    if len(direction) < 3 or steps[widest] <= GAP * np.delete(steps, widest).max():
        return direction, density
    count = len(direction)
    half = 0.5 * steps[widest]
    after_end = direction[widest] + min(half, steps[widest - 1])
    before_begin = direction[widest] + steps[widest] - min(half, steps[(widest + 1) % count])
    added = [after_end]
    if before_begin - after_end > CLOSE:
        added.append(before_begin)
    angles = np.append(direction, added) % (2.0 * pi)
    order = np.argsort(angles)
    empty = np.zeros((len(density), len(added)))
    return angles[order], np.concatenate([density, empty], axis=1)[:, order]


def read_spectrum(path: str | Path) -> TabulatedSpectrum:
    """Read a spectrum from a file; a second call returns the same object.

    Args:
        path: The file.

    Raises:
        BadInput: A line has another form, a direction of a frequency is missing or stands twice
            with different densities, or there are no waves.
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
    # programs of time series write the mean level as a frequency of 0
    steady = frequency == 0.0
    if np.any(density[steady] > 0.0):
        raise BadInput(f"{path}: the density at the frequency 0 is not 0; waves have none there")
    frequency, density = frequency[~steady], density[~steady]
    if direction is not None:
        direction = direction[~steady]
    if len(frequency) < 3 or frequency.min() < 0.0:
        raise BadInput(f"{path}: at least three frequencies above 0 are required")
    waves = _different(frequency)
    if len(waves) < 3:
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
        d = int(np.argmin(np.abs(directions - direction)))
        if not (np.isnan(grid[k, d]) or np.isclose(value, grid[k, d], SAME_DENSITY, 0.0)):
            raise BadInput(
                f"{path}: {waves[k]:.4g} rad/s and {np.degrees(directions[d]):.4g} deg stand "
                "twice, with different densities"
            )
        grid[k, d] = value
    if np.isnan(grid).any():
        k, d = np.argwhere(np.isnan(grid))[0]
        raise BadInput(
            f"{path}: every frequency needs the same directions; {waves[k]:.4g} rad/s lacks "
            f"{np.degrees(directions[d]):.4g} deg"
        )
    return TabulatedSpectrum(waves, *close_sector(directions, grid))


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
    rows = np.zeros((components, SHARES + 2))
    rows[:, 0] = np.diff(np.interp(edges, points, below)) / total
    if len(found.direction):
        for i, energy in enumerate(_energy_of_cells(found, points, edges)):
            rows[i, 1:] = _direction_shares(found.direction, energy)
    head = (float(components), float(edges[0]), float(edges[1] - edges[0]), float(SHARES))
    return (*head, *rows.ravel().tolist())


def _energy_of_cells(found: TabulatedSpectrum, points: Array, edges: Array) -> Array:
    """Return the integral of a spectrum over each cell of frequencies (C, D), by direction.

    Args:
        found: The spectrum.
        points: Its frequencies and the edges of all cells, between which its density is linear.
        edges: Edges of the cells (C + 1,).
    """
    columns = [np.interp(points, found.frequency, column) for column in found.density.T]
    density = np.stack(columns, axis=1)
    parts = 0.5 * (density[1:] + density[:-1]) * np.diff(points)[:, None]
    # a sum of each cell by itself: differences of a long sum would leave rounding where it is 0
    first = np.searchsorted(points, edges[:-1])
    return np.asarray(np.add.reduceat(parts, first, axis=0))


def _direction_shares(direction: Array, energy: Array) -> Array:
    """Return the directions below which the shares sin^2(pi j / 2 n) of the energy lie.

    They begin where the energy is least, so that no share lies on both sides of it.

    Args:
        direction: Directions of the spectrum (D,) [rad].
        energy: Energy of the waves of a cell per direction (D,).
    """
    first = int(np.argmin(energy))
    angle = np.append(direction[first:], direction[: first + 1] + 2.0 * pi)
    value = np.append(energy[first:], energy[: first + 1])
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
