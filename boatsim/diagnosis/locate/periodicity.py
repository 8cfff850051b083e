"""Whether the missing force comes and goes with a rhythm: a peak in the spectrum of what the filter did not expect.

Prediction errors are white where the model is complete, and each ordinate of their periodogram is then exponentially
distributed. The mean power in a narrow band over that in its neighbours then follows an F distribution; neighbours
rather than the whole spectrum, and the geometric mean of those on either side, so that errors that are merely smooth
or rough are no rhythm.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.special import fdtrc

from boatsim.physics.base import Array

BAND = 1.26  # upper over lower end of a band: a third of an octave
NEIGHBOURS = 2  # bands on either side that a peak is compared with
ROWS_A_PERIOD = 5.0  # that a rhythm must have to be told from errors that differ from row to row
FEWEST = 3  # periodogram ordinates that a band must hold


@dataclass(frozen=True)
class Rhythm:
    """The likeliest peak and its p-value, corrected for all bands and signals looked at."""

    period: float  # [s]
    p_value: float


def rhythm(runs: Sequence[tuple[Array, Array]]) -> Rhythm | None:
    """The likeliest rhythm in runs of (times (N,), whitened prediction errors (N, C)); None if they are too short."""
    frequency, power = (
        np.concatenate(found) for found in zip(*(_periodogram(*run) for run in runs), strict=True)
    )
    if len(frequency) < FEWEST:
        return None
    edges = np.exp(np.arange(np.log(frequency.min()), np.log(frequency.max()), np.log(BAND)))
    band = np.searchsorted(edges, frequency, side="right") - 1
    tried = []
    for b in range(NEIGHBOURS, len(edges) - 1 - NEIGHBOURS):
        here = band == b
        below, above = (band >= b - NEIGHBOURS) & (band < b), (band > b) & (band <= b + NEIGHBOURS)
        if here.sum() >= FEWEST and below.any():
            middle = float(np.average(frequency[here], weights=power[here].sum(axis=1) + 1e-300))
            tried.append((_stands_out(power[here], power[below], power[above]), middle))
    if not tried:
        return None
    p, peak = min(tried)
    return Rhythm(1.0 / peak, min(1.0, p * len(tried)))


def _stands_out(here: Array, below: Array, above: Array) -> float:
    """p-value of a band with no more power than a smooth spectrum through its neighbours has there."""
    smooth = max(np.sqrt(below.mean() * above.mean()), 1e-300)
    return float(fdtrc(2 * here.size, 2 * (below.size + above.size), here.mean() / smooth))


def _periodogram(t: Array, errors: Array) -> tuple[Array, Array]:
    """Frequencies (F,) [Hz] and ordinates (F, C), without zero, the highest and the first row (no prediction)."""
    errors = errors[1:] / np.maximum(np.sqrt(np.mean(errors[1:] ** 2, axis=0)), 1e-300)
    step = float(np.median(np.diff(t)))
    frequency = np.asarray(np.fft.rfftfreq(len(errors), step), dtype=np.float64)
    seen = slice(
        1,
        max(
            1,
            min(len(frequency) - 1, int(np.searchsorted(frequency, 1.0 / (ROWS_A_PERIOD * step)))),
        ),
    )
    return frequency[seen], np.asarray(
        np.abs(np.fft.rfft(errors, axis=0)[seen]) ** 2, dtype=np.float64
    )
