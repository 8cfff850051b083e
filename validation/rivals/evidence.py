"""Comparison of hypotheses by BIC, plain or with correlated errors taken into account."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from boatsim.physics.base import Array

DIES_OUT = 0.05  # errors with a smaller correlation count as independent


@dataclass(frozen=True)
class Judge:
    """Comparison of hypotheses.

    With `plain`, the textbook BIC: all values are independent, and all hypotheses are equally
    likely. Otherwise correlated errors reduce the effective number of values, and the number of
    tested effects is penalised (extended BIC: J. Chen, Z. Chen, Biometrika 95, 2008).
    """

    plain: bool
    tried: int  # number of candidates tested

    def rows_per_independent_value(self, stretches: Sequence[Array]) -> Array:
        """Return the rows (C,) per independent value, for errors (M, C) with gaps as nan."""
        channels = stretches[0].shape[1]
        if self.plain:
            return np.ones(channels)
        return np.array([_correlation_length(stretches, c) for c in range(channels)])

    def gain(
        self, before: Sequence[Array], after: Sequence[Array], more: int, entries: int = 1
    ) -> float:
        """Return half of the decrease of BIC [nats].

        Args:
            before: errors (M, C) of the first hypothesis by stretch of time.
            after: errors of the second hypothesis.
            more: additional parameters.
            entries: additional effects.
        """
        one, two, counts = sum_of_squares(before), sum_of_squares(after), count_values(after)
        independent = counts / self.rows_per_independent_value(after)
        fit = 0.5 * float(np.sum(independent * np.log(one / two)))
        price = 0.0 if self.plain else entries * float(np.log(max(self.tried, 1)))
        return fit - 0.5 * more * float(np.log(max(independent.sum(), 2.0))) - price


def sum_of_squares(stretches: Sequence[Array]) -> Array:
    """Return the sum of squares (C,)."""
    return np.asarray(np.sum([np.nansum(e**2, axis=0) for e in stretches], axis=0)) + 1e-30


def count_values(stretches: Sequence[Array]) -> Array:
    """Return the number of values (C,)."""
    return np.asarray(np.sum([np.isfinite(e).sum(axis=0) for e in stretches], axis=0), dtype=float)


def rms_by_channel(stretches: Sequence[Array]) -> Array:
    """Return the rms (C,)."""
    return np.sqrt(sum_of_squares(stretches) / np.maximum(count_values(stretches), 1.0))


def _correlation_length(stretches: Sequence[Array], channel: int) -> float:
    """Return one plus twice the sum of the correlations, up to the first negligible one."""
    errors = [np.nan_to_num(e[:, channel]) for e in stretches]
    whole, total = sum(float(e @ e) for e in errors), 1.0
    for lag in range(1, max(len(e) for e in errors) // 2):
        correlation = sum(float(e[lag:] @ e[:-lag]) for e in errors) / max(whole, 1e-300)
        if correlation < DIES_OUT:
            break
        total += 2.0 * correlation
    return total
