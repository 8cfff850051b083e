"""Samples of a column at equally spaced times, never across a gap of its sensor."""

import numpy as np

from boatsim.diagnosis.config import ChecksConfig
from boatsim.physics.base import Array

# Equal steps per row, at most: memory is bounded for rows in bursts
MAX_ROWS_RATIO = 4


def equal_steps(t: Array) -> Array:
    """Return times from the first to the last row at the median interval of the rows.

    Args:
        t: Times (N,) [s] of the rows.

    Returns:
        Times (M,) [s]; none if most rows have the same time.
    """
    step = float(np.median(np.diff(t)))
    if not step > 0.0:
        return np.zeros(0)
    step = max(step, float(np.ptp(t)) / (MAX_ROWS_RATIO * len(t)))
    return np.asarray(t[0] + step * np.arange(round(float(np.ptp(t)) / step) + 1))


def values_at_times(t: Array, rows: Array, values: Array, config: ChecksConfig) -> Array:
    """Return the values (M,) of a column between its neighbouring samples; nan in its gaps.

    Args:
        t: Times (M,) [s].
        rows: Times (N,) [s] of the rows.
        values: The column (N,), nan where nothing was sampled.
        config: Thresholds of the quality checks.
    """
    sampled = np.isfinite(values)
    own, measured = rows[sampled], values[sampled]
    after = np.searchsorted(own, t).clip(1, len(own) - 1)
    longest = config.rates_max_gap * float(np.median(np.diff(own)))
    tolerance = 1e-6 * longest
    within = (t >= own[0] - tolerance) & (t <= own[-1] + tolerance)
    within &= own[after] - own[after - 1] <= longest
    return np.where(within, np.interp(t, own, measured), np.nan)


def moving_average(values: Array, k: int) -> Array:
    """Return the mean (N,) over k values on either side, nan where one is missing.

    Args:
        values: The values (N,); both ends are unchanged.
        k: Number of values on either side.
    """
    missing = ~np.isfinite(values)
    total = np.concatenate(([0.0], np.cumsum(np.where(missing, 0.0, values))))
    absent = np.concatenate(([0], np.cumsum(missing)))
    mean = values.copy()
    width = 2 * k + 1
    inside = (total[width:] - total[:-width]) / width
    mean[k:-k] = np.where(absent[width:] > absent[:-width], np.nan, inside)
    return mean
