"""Clock rates of a log by its track and by its heading, over parts in which the vessel turns."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from boatsim.diagnosis.config import ChecksConfig
from boatsim.physics.base import Array
from boatsim.recordings.motion_clock import Stretches


@dataclass(frozen=True)
class RateComparison:
    """Clock rates by the track and by the heading over turning stretches of all recordings.

    Attributes:
        track: Clock rates (K,) by positions and velocities.
        turning: Clock rates (K,) by heading and yaw rate.
        weight: Square of the change of heading (K,), the precision of `turning`.
        file: Number of the file (K,).
    """

    track: Array
    turning: Array
    weight: Array
    file: NDArray[np.int64]

    def selected(self, used: NDArray[np.bool_]) -> "RateComparison":
        """Return the comparison over some of the stretches (K,)."""
        return RateComparison(
            self.track[used], self.turning[used], self.weight[used], self.file[used]
        )

    @property
    def correlation(self) -> float:
        """Weighted correlation of both rates about their means in each file."""
        a, b = self._about_means(self.track), self._about_means(self.turning)
        size = float(np.sqrt(_mean(a * a, self.weight) * _mean(b * b, self.weight)))
        if size > 0.0:
            return float(_mean(a * b, self.weight)) / size
        return 0.0

    @property
    def significance(self) -> float:
        """Number of standard deviations by which the correlation differs from none."""
        c = self.correlation
        freedom = max(self.effective_sample_size - 1.0 - len(np.unique(self.file)), 0.0)
        return c * float(np.sqrt(freedom / max(1.0 - c * c, 1e-9)))

    def agrees(self, config: ChecksConfig) -> bool:
        """Return whether both rates certainly vary in the same way."""
        enough = self.correlation > config.clock_min_correlation
        return enough and self.significance > config.clock_min_sds

    def covariance(self) -> tuple[float, float]:
        """Covariance of both rates about their means in each file, and its standard deviation."""
        return self._mean_and_sd(self._about_means(self.track) * self._about_means(self.turning))

    @property
    def effective_sample_size(self) -> float:
        """Number of stretches of equal weight that would be as informative."""
        return float(self.weight.sum() ** 2 / (self.weight**2).sum())

    def velocity_gain(self) -> tuple[float, float]:
        """Gain of the velocities for which both rates agree on average, and its sd.

        It is the ratio of the mean rates, because the mean of their ratios grows with the noise of
        the heading.
        """
        turning = _mean(self.turning, self.weight)
        gain = _mean(self.track, self.weight) / turning
        _, sd = self._mean_and_sd(self.track - gain * self.turning)
        return gain, sd / turning

    def mean_clock_rate(self) -> tuple[float, float]:
        """Mean clock rate by the heading, and its sd."""
        return self._mean_and_sd(self.turning)

    def _about_means(self, rates: Array) -> Array:
        """Rates (K,) less their weighted means in each file."""
        found = rates.copy()
        for file in np.unique(self.file).tolist():
            own = self.file == file
            found[own] -= _mean(rates[own], self.weight[own])
        return found

    def _mean_and_sd(self, values: Array) -> tuple[float, float]:
        """Weighted mean of values (K,) of the stretches, and its standard deviation."""
        middle = _mean(values, self.weight)
        variance = _mean((values - middle) ** 2, self.weight)
        return middle, float(np.sqrt(variance / self.effective_sample_size))


def _mean(values: Array, weight: Array) -> float:
    return float((values * weight).sum() / weight.sum())


def compare_clock_rates(
    runs: Sequence[Stretches], files: Sequence[str], config: ChecksConfig
) -> RateComparison | None:
    """Return both clock rates over turning stretches; None if these are too few.

    Args:
        runs: Stretches of each recording.
        files: File of each recording.
        config: Thresholds of the quality checks.
    """
    track, turning, weight = list[Array](), list[Array](), list[Array]()
    file = list[NDArray[np.int64]]()
    for run, name in zip(runs, files, strict=True):
        travelled = (run.travelled**2).sum(axis=0)
        used = (np.abs(run.turned) > config.clock_min_turn) & (travelled > 0.0)
        along = (run.travelled * run.moved).sum(axis=0)
        track.append(along[used] / travelled[used])
        turning.append(run.swung[used] / run.turned[used])
        weight.append(run.turned[used] ** 2)
        file.append(np.full(int(used.sum()), files.index(name)))
    if sum(map(len, track)) < config.clock_min_stretches:
        return None
    weights = np.concatenate(weight)
    weights = np.minimum(weights, np.median(weights))
    found = RateComparison(
        np.concatenate(track), np.concatenate(turning), weights, np.concatenate(file)
    )
    if not float(found.turning.min()) > 0.0:
        return _without_contradictions(found, config)
    return found


def _without_contradictions(found: RateComparison, config: ChecksConfig) -> RateComparison | None:
    """The stretches in which heading and yaw rate agree in their sense."""
    same = found.turning > 0.0
    if same.sum() < max(config.clock_min_stretches, config.clock_min_agreement * len(same)):
        return None
    return found.selected(same)
