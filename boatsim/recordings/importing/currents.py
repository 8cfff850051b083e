"""The current along a run: the velocity over ground less that through the water."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from boatsim.errors import BadInput
from boatsim.physics.base import Array
from boatsim.recordings.importing.conversion_state import ConversionState, signal_of
from boatsim.recordings.importing.resample import clean_samples
from boatsim.recordings.importing.water_speed_table import WaterSpeed
from boatsim.recordings.known_values import filled

NEEDED = ("x_m", "y_m", "psi_rad")
FEWEST = 3  # points of a straight line


def current_columns(
    work: ConversionState, rows: Array, signals: Mapping[str, Array], given: WaterSpeed
) -> dict[str, Array]:
    """Return the velocity of the water to north and east (N,) [m/s], by the names of its columns.

    It is the slope of the drift over a window: of the track less the way through the water. Without
    a sideways speed through the water, this is along the bow.

    Args:
        work: State of the conversion.
        rows: Times (N,) of the rows [s].
        signals: Column -> values (N,); nan where none was measured.
        given: Speed through the water, window, and names of the columns.

    Raises:
        BadInput: A column of the pose, or the speed, has no value.
    """
    missing = []
    for name in NEEDED:
        if name not in signals or not np.isfinite(signals[name]).any():
            missing.append(name)
    if missing:
        raise BadInput(f"{work.file}: current needs values of {' and '.join(missing)}")
    through = np.asarray(_speed(work, rows, "speed", given.speed), dtype=np.complex128)
    if given.across is not None:
        through += 1j * _speed(work, rows, "across", given.across)
    x, y = (filled(rows, signals[name]) for name in NEEDED[:2])
    psi = signals["psi_rad"]
    known = np.isfinite(psi)
    bow = np.exp(1j * np.interp(rows, rows[known], np.unwrap(psi[known])))
    through *= bow
    steps = 0.5 * (through[1:] + through[:-1]) * np.diff(rows)
    drift = x + 1j * y - np.append(0.0, np.cumsum(steps))
    current = slope_over_window(rows, drift, given.window)
    return {given.north: current.real.copy(), given.east: current.imag.copy()}


def slope_over_window(
    t: Array, values: NDArray[np.complex128], window: float
) -> NDArray[np.complex128]:
    """Return the slopes (N,) of straight lines through the values in a window about each time.

    Near the ends the slope is that of the first or last whole window.

    Args:
        t: Times (N,) [s], increasing.
        values: Values (N,).
        window: Length of the window [s]; at most the whole record is used.
    """
    step = float(np.median(np.diff(t)))
    grid = np.arange(t[0], t[-1] + 0.5 * step, step)
    even = np.interp(grid, t, values.real) + 1j * np.interp(grid, t, values.imag)
    count = int(np.clip(round(window / step) + 1, FEWEST, len(grid)))
    places = step * (np.arange(count) - 0.5 * (count - 1))
    kernel = places / np.sum(places**2)
    inner = np.convolve(even, kernel[::-1], "valid")
    middle = grid[: len(inner)] + 0.5 * step * (count - 1)
    found = np.interp(t, middle, inner.real) + 1j * np.interp(t, middle, inner.imag)
    return np.asarray(found, dtype=np.complex128)


def _speed(work: ConversionState, rows: Array, key: str, text: str) -> Array:
    """A speed through the water (N,) [m/s] at the times of the rows."""
    signal, how = signal_of(work, f"current.{key}", text)
    speed = clean_samples(signal.t, how.convert(signal.values))
    if not len(speed.t):
        raise BadInput(f"{work.file}: current.{key} = {text[:80]!r} has no value")
    return np.interp(rows, speed.t, speed.values)
