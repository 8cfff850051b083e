"""Weights of free runs by Student's t distribution, so that a few runs do not decide.

Something else may act in single free runs: the crew at the start of a recording, a gap before the
first row, a gust. Their errors are many times those of other runs, and in a sum of squares they
would determine the parameters. By Student's t distribution an error counts by its square while it
is usual, and by its logarithm where it is much larger (K. L. Lange, R. J. A. Little,
J. M. G. Taylor, Robust statistical modeling using the t distribution, Journal of the American
Statistical Association 84, 1989).
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from boatsim.diagnosis.free_runs import FAMILIES, FreeRun
from boatsim.physics.base import Array

DEGREES_OF_FREEDOM = 4.0  # of the distribution, as Lange, Little and Taylor recommend
PASSES = 50  # most passes of the estimate of the scale
CONVERGED = 1e-6  # relative change of the scale that ends them, far below its standard error


@dataclass(frozen=True)
class RunErrors:
    """Errors of a model's free runs by family of signals (position, heading, ...).

    Attributes:
        squares: (R,) sum of the mean square errors of the recorded signals of each run; infinite
            where the simulation diverges.
        signals: (R,) number of its recorded signals.
    """

    squares: Mapping[str, Array]
    signals: Mapping[str, Array]

    @property
    def count(self) -> int:
        """Number of the runs."""
        return len(next(iter(self.squares.values())))

    def squared_distances(self, scale: Mapping[str, float]) -> Array:
        """Return the sum (R,) of the squared errors of each run, in units of a scale.

        Args:
            scale: Scale of the errors by family.
        """
        found = np.zeros(self.count)
        for family, unit in scale.items():
            found += self.squares[family] / unit**2
        return found

    def weights(self, scale: Mapping[str, float]) -> Array:
        """Return the weights (R,) of the runs, 0 where the simulation diverges.

        Args:
            scale: Scale of the errors by family.
        """
        signals = sum(self.signals[family] for family in scale)
        squares = self.squared_distances(scale)
        return np.asarray((DEGREES_OF_FREEDOM + signals) / (DEGREES_OF_FREEDOM + squares))

    def scale(self) -> dict[str, float]:
        """Return the scale of the errors of one signal of each family, of maximum likelihood.

        The maximum is reached by expectation maximisation from the medians. Families without an
        error, and those recorded in diverging runs only, are left out.
        """
        scale = dict[str, float]()
        for family, squares in self.squares.items():
            recorded = self.signals[family] > 0.0
            each = squares[recorded] / self.signals[family][recorded]
            usual = float(np.median(each)) if len(each) else 0.0
            if 0.0 < usual < np.inf:
                scale[family] = float(np.sqrt(usual))
        for _ in range(PASSES):
            before, scale = scale, self._next_scale(scale)
            if all(abs(scale[one] / before[one] - 1.0) < CONVERGED for one in scale):
                break
        return scale

    def _next_scale(self, scale: Mapping[str, float]) -> dict[str, float]:
        """One pass of the expectation maximisation."""
        weights = self.weights(scale)
        used = weights > 0.0  # runs that do not diverge
        found = {}
        for family in scale:
            signals = float(np.sum(self.signals[family][used]))
            if signals > 0.0:
                total = float(np.sum(weights[used] * self.squares[family][used]))
                found[family] = float(np.sqrt(total / signals))
        return found


def run_errors(runs: Sequence[FreeRun], model: str) -> RunErrors:
    """Return the errors of a model's free runs.

    Args:
        runs: Free runs, at least one.
        model: Name of the model.
    """
    squares = {family: np.zeros(len(runs)) for family in FAMILIES}
    signals = {family: np.zeros(len(runs)) for family in FAMILIES}
    for i, run in enumerate(runs):
        simulated, recorded = run.channels[model], run.channels["recorded"]
        for family, names in FAMILIES.items():
            for name in names:
                known = np.isfinite(recorded[name]) if name in recorded else np.zeros(0, dtype=bool)
                if known.any():
                    with np.errstate(over="ignore", invalid="ignore"):
                        square = float(np.mean((simulated[name] - recorded[name])[known] ** 2))
                    squares[family][i] += square if np.isfinite(square) else np.inf
                    signals[family][i] += 1.0
    return RunErrors(squares, signals)


def log_likelihood_gain(
    found: RunErrors, reference: RunErrors, scale: Mapping[str, float]
) -> float:
    """Return how much more probable free runs are by one model than by another [nats].

    The errors have Student's t distribution, with each recorded signal of a run as one observation.
    The gain is minus infinity if a simulation diverges that does not with the reference. One that
    diverges with the reference alone counts as the largest error of the other runs.

    Args:
        found: Errors of the model that is judged.
        reference: Errors of the model that it is compared with.
        scale: Scale of the errors by family.
    """
    signals = sum(found.signals[family] for family in scale)
    change = _change_of_logarithms(found, reference, scale)
    if np.any(change == np.inf):
        return -np.inf
    return float(-0.5 * np.sum((DEGREES_OF_FREEDOM + signals) * change))


def typical_error_ratio(
    found: RunErrors, reference: RunErrors, scale: Mapping[str, float]
) -> float:
    """Return the ratio of the typical errors of two models over the same free runs.

    It is the geometric mean over the runs. Twice the scale is added to both errors in quadrature,
    as in Student's t distribution, so that neither a few large errors nor tiny ones decide. The
    ratio is infinite if a simulation diverges that does not with the reference. One that diverges
    with the reference alone counts as the largest error of the other runs.

    Args:
        found: Errors of the model that is judged.
        reference: Errors of the model that it is compared with.
        scale: Scale of the errors by family.
    """
    change = _change_of_logarithms(found, reference, scale)
    if np.any(change == np.inf):
        return np.inf
    return float(np.exp(0.5 * np.mean(change)))


def _change_of_logarithms(
    found: RunErrors, reference: RunErrors, scale: Mapping[str, float]
) -> Array:
    """Change (R,) of the logarithm in the density of Student's t distribution, 0 where equal.

    It is infinite where the model diverges alone, and 0 where both do. The change of a run in which
    the reference diverges alone is limited by the largest other error, so that the other runs
    count, too.
    """
    own, other = found.squared_distances(scale), reference.squared_distances(scale)
    cured = np.isinf(other) & np.isfinite(own)
    usual = other[np.isfinite(other)]
    if len(usual):
        other[cured] = np.maximum(own[cured], np.max(usual))
    with np.errstate(invalid="ignore"):
        after, before = np.log(DEGREES_OF_FREEDOM + own), np.log(DEGREES_OF_FREEDOM + other)
        return np.where(after == before, 0.0, after - before)  # both may diverge
