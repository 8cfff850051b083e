"""Test for a periodic missing force: a peak in the spectrum of the prediction errors.

Prediction errors are white if the model is complete, and each ordinate of their periodogram is then
exponentially distributed. The ratio of the mean power in a narrow band and in the neighbouring
bands has an F distribution. The reference is the geometric mean of the neighbours on either side,
so that a spectrum that only rises or falls has no peak.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.special import fdtrc

from boatsim.diagnosis.config import DEFAULT, LocateConfig
from boatsim.physics.base import Array

TINY = 1e-300  # avoids division by zero


@dataclass(frozen=True)
class Peak:
    """The most significant peak in the spectrum of the prediction errors: its period and p-value.

    The p-value is corrected for the number of frequency bands tested.
    """

    period: float  # [s]
    p_value: float


def most_significant_peak(
    runs: Sequence[tuple[Array, Array]], config: LocateConfig = DEFAULT.locate
) -> Peak | None:
    """Test for a periodic missing force: find the most significant peak of the prediction errors.

    The spectra of all recordings are combined.

    Args:
        runs: Times (N,) [s] and whitened prediction errors (N, C) of each run.
        config: Thresholds of the test.

    Returns:
        The peak; None if the runs are too short for a test.
    """
    frequencies = []
    powers = []
    for times, errors in runs:
        frequency, power = _periodogram(times, errors, config)
        frequencies.append(frequency)
        powers.append(power)
    frequency = np.concatenate(frequencies)
    power = np.concatenate(powers)
    if len(frequency) < config.periodicity_min_ordinates:
        return None
    width = np.log(config.periodicity_band)
    edges = np.exp(np.arange(np.log(frequency.min()), np.log(frequency.max()), width))
    band = np.searchsorted(edges, frequency, side="right") - 1
    side = config.periodicity_neighbours
    tests = []
    for b in range(side, len(edges) - 1 - side):
        inside = band == b
        below = (band >= b - side) & (band < b)
        above = (band > b) & (band <= b + side)
        if inside.sum() >= config.periodicity_min_ordinates and below.any():
            weights = power[inside].sum(axis=1) + TINY
            centre = float(np.average(frequency[inside], weights=weights))
            tests.append((_p_value(power[inside], power[below], power[above]), centre))
    if not tests:
        return None
    p_value, centre = min(tests)
    return Peak(1.0 / centre, min(1.0, p_value * len(tests)))


def _p_value(inside: Array, below: Array, above: Array) -> float:
    """p-value of the hypothesis that the power in a band follows from its neighbours."""
    reference = max(np.sqrt(below.mean() * above.mean()), TINY)
    ratio = inside.mean() / reference
    return float(fdtrc(2 * inside.size, 2 * (below.size + above.size), ratio))


def _periodogram(t: Array, errors: Array, config: LocateConfig) -> tuple[Array, Array]:
    """Frequencies (F,) [Hz] and ordinates (F, C).

    The first row is no prediction. Frequency zero and periods of few rows are left out.
    """
    errors = errors[1:] / np.maximum(np.sqrt(np.mean(errors[1:] ** 2, axis=0)), TINY)
    step = float(np.median(np.diff(t)))
    frequency = np.asarray(np.fft.rfftfreq(len(errors), step), dtype=np.float64)
    highest = 1.0 / (config.periodicity_min_rows * step)
    end = min(len(frequency) - 1, int(np.searchsorted(frequency, highest)))
    kept = slice(1, max(1, end))
    power = np.abs(np.fft.rfft(errors, axis=0)[kept]) ** 2
    return frequency[kept], np.asarray(power, dtype=np.float64)
