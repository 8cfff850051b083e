"""Which boats survive a disturbance, and up to which value of it a given share of them does."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import inf, nan, sqrt

import numpy as np
from numpy.typing import NDArray

from boatsim.physics.signals import Array

REQUIRED = 0.95  # share of the boats that must survive: one boat in twenty may need its own gains
QUANTILE = 1.96  # of the standard normal distribution, two-sided 95 %


@dataclass(frozen=True)
class LadderPoint:
    """Boats of one controller under one value of a disturbance.

    Attributes:
        value: Value of the disturbance.
        errors: Rms errors (n, signals), infinite if the motion has diverged.
        survived: Whether each boat (n,) survives.
    """

    value: float
    errors: Array
    survived: NDArray[np.bool_]

    @property
    def share(self) -> float:
        """Share of the boats that survive."""
        return float(self.survived.mean())

    @property
    def interval(self) -> tuple[float, float]:
        """95 % interval of the probability that a boat survives."""
        return wilson_interval(self.share, len(self.survived))

    def error_quantiles(self, signal: int) -> tuple[float, float, float]:
        """Return median, 95 % quantile and largest value of the error of a signal.

        Args:
            signal: Number of the signal.
        """
        errors = self.errors[:, signal]
        median, high = np.quantile(errors, (0.5, REQUIRED), method="inverted_cdf")
        return float(median), float(high), float(errors.max())


@dataclass(frozen=True)
class Ladder:
    """Boats of one controller under growing values of a disturbance.

    Attributes:
        controller: Name of the controller.
        disturbance: Name of the disturbance.
        unit: Its unit.
        points: The values, the neutral one first.
    """

    controller: str
    disturbance: str
    unit: str
    points: tuple[LadderPoint, ...]

    @property
    def survived_points(self) -> Sequence[LadderPoint]:
        """The points before the first one that fewer than 95 % of the boats survive."""
        for number, point in enumerate(self.points):
            if point.share < REQUIRED:
                return self.points[:number]
        return self.points

    @property
    def largest_survived(self) -> float:
        """Largest value that 95 % of the boats survive, with all smaller ones; nan for none."""
        if not self.survived_points:
            return nan
        return self.survived_points[-1].value

    @property
    def first_failed(self) -> LadderPoint | None:
        """The smallest value that fewer than 95 % of the boats survive; None if there is none."""
        survived = len(self.survived_points)
        if survived == len(self.points):
            return None
        return self.points[survived]


def surviving_boats(errors: Array, bars: Array) -> NDArray[np.bool_]:
    """Return which boats (n,) survive: every judged error is finite and at most its bar.

    Args:
        errors: Rms errors (n, signals).
        bars: Largest rms error (signals,) of a boat that survives; infinite if it is not judged.
    """
    bounded = np.where(np.isinf(bars), np.inf, errors)
    within = np.where(np.isinf(bars), True, bounded <= bars)
    return np.asarray(within.all(axis=1) & ~np.isnan(errors).any(axis=1))


def judged_bars(nominal: Sequence[Array], bars: Array) -> Array:
    """Return the bars (signals,) of the signals that are judged; infinite for the others.

    A signal is judged if at least one controller keeps it within the bar on half of the boats
    without disturbance. A signal that no controller tracks, such as a sway speed in open loop,
    measures no robustness. If no signal is tracked, all are judged.

    Args:
        nominal: Rms errors (n, signals) without disturbance, of each controller.
        bars: Largest rms error (signals,) of each signal.
    """
    tracked = np.zeros(len(bars), dtype=bool)
    for errors in nominal:
        tracked |= np.median(errors, axis=0) <= bars
    if not tracked.any():
        return bars
    return np.where(tracked, bars, inf)


def wilson_interval(share: float, count: int) -> tuple[float, float]:
    """Return the 95 % interval of a probability (E. B. Wilson, JASA 22, 1927).

    Args:
        share: Observed share.
        count: Number of trials, at least one.
    """
    z = QUANTILE
    middle = (share + z * z / (2 * count)) / (1 + z * z / count)
    variance = share * (1 - share) / count + z * z / (4 * count * count)
    half = z * sqrt(variance) / (1 + z * z / count)
    return max(middle - half, 0.0), min(middle + half, 1.0)
