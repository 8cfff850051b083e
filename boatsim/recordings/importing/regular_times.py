"""Times of the samples of a sensor with a regular rate that a program read at other times."""

import numpy as np

from boatsim.physics.base import Array

MIN_SAMPLES = 50  # fewer do not determine the period
SEARCH = (0.9, 1.1)  # periods that are tried, relative to the mean step without gaps
MAX_SAMPLES = 2000  # from which the period is found; the cost grows with their square
PHASE_WINDOW = 40.0  # [s] within which the clocks of sensor and program do not drift apart
# Mean resultant length of the phases. Delays that are evenly spread over a whole period have 0,
# over half of it 0.64. 200 samples without any rhythm exceed 0.15 in 1 % of logs; the roughness of
# the track is the second sign
MIN_CONCENTRATION = 0.15
MIN_JITTER = 0.05  # rms of the shifts, relative to the period, that is worth removing
# The velocities by the positions must become smoother by this factor, the second sign of a rhythm.
# Where some samples move to a wrong turn of the sensor, the largest changes do not shrink by half
MAX_ROUGHNESS = 0.5


def regular_times(t: Array, track: Array) -> tuple[Array, float] | None:
    """Return the times at which a sensor of regular rate measured, and the period.

    A program that polls a sensor stamps its samples up to one turn of its loop too late, by another
    delay each time. A vessel under way then seems to move in jerks. The phases of the stamps show
    the rhythm of the sensor if the loop is shorter than its period (Rayleigh test of directional
    statistics: Mardia, Jupp 2000); the mean delay stays.

    Args:
        t: Times (N,) [s] at which new samples were read, increasing.
        track: Positions (N,) as complex numbers [m].

    Returns:
        Times (N,) [s] and period [s]; None if the samples have no rhythm, or are regular already.
    """
    if len(t) < MIN_SAMPLES:
        return None
    steps = np.diff(t)
    usual = float(np.mean(steps[steps < 2.5 * np.median(steps)]))
    period = _period(t, usual)
    turns = (t - t[0]) / period
    phase = _local_phase(t, turns)
    if phase is None:
        return None
    regular = t[0] + period * (np.round(turns - phase) + phase)
    kept = np.append(True, np.diff(regular) > 0.5 * period)
    kept &= np.append(kept[1:], True)
    regular = np.where(kept, regular, t)
    if not np.all(np.diff(regular) > 0.0):
        return None
    shift = float(np.sqrt(np.mean((regular - t) ** 2)))
    smoother = np.all(_roughness(regular, track) < MAX_ROUGHNESS * _roughness(t, track))
    if shift < MIN_JITTER * period or not smoother:
        return None
    return regular, period


def _period(t: Array, usual: float) -> float:
    """The period [s] near the usual step at which the phases are most concentrated."""
    last = t[min(len(t), MAX_SAMPLES) - 1]
    duration = min(float(last - t[0]), 4.0 * PHASE_WINDOW)
    rows = t - t[0] <= duration
    step = 0.25 / duration
    frequencies = np.arange(1.0 / (SEARCH[1] * usual), 1.0 / (SEARCH[0] * usual), step)
    waves = np.exp(-2j * np.pi * np.outer(frequencies, t[rows] - t[0]))
    return float(1.0 / frequencies[int(np.argmax(np.abs(waves.sum(axis=1))))])


def _local_phase(t: Array, turns: Array) -> Array | None:
    """Mean phase (N,) [turns] around each sample, which drifts slowly; None without a rhythm."""
    unit = np.exp(2j * np.pi * turns)
    total = np.append(0.0, np.cumsum(unit))
    begin = np.searchsorted(t, t - 0.5 * PHASE_WINDOW)
    end = np.searchsorted(t, t + 0.5 * PHASE_WINDOW, side="right")
    mean = (total[end] - total[begin]) / (end - begin)
    if float(np.median(np.abs(mean))) < MIN_CONCENTRATION:
        return None
    return np.asarray(np.unwrap(np.angle(mean)) / (2.0 * np.pi))


def _roughness(t: Array, track: Array) -> Array:
    """Changes of the velocity from one step to the next [m/s]: median, and percentile 95.

    The latter shows samples that are moved to a wrong turn of the sensor.
    """
    velocity = np.diff(track) / np.diff(t)
    return np.asarray(np.percentile(np.abs(np.diff(velocity)), [50.0, 95.0]))
