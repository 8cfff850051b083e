"""What one hypothesis gains over another by BIC, plain or with the colour of the errors counted in."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from boatsim.physics.base import Array

DIES_OUT = 0.05  # correlation of errors, from which on they count as independent


@dataclass(frozen=True)
class Judge:
    """How hypotheses are compared.

    `plain`: as in a textbook, every value an independent one, one hypothesis as likely as another however many were
    tried. Otherwise errors that are alike from row to row count as so many fewer values, and what was tried is paid
    for (extended BIC: J. Chen, Z. Chen, Biometrika 95, 2008).
    """

    plain: bool
    tried: int  # entries

    def alike(self, stretches: Sequence[Array]) -> Array:
        """(C,) rows that together tell as much as one, of errors (M, C) over stretches of time, nan where missing."""
        channels = stretches[0].shape[1]
        return (
            np.ones(channels)
            if self.plain
            else np.array([_alike(stretches, c) for c in range(channels)])
        )

    def gain(
        self, before: Sequence[Array], after: Sequence[Array], more: int, entries: int = 1
    ) -> float:
        """Half of what BIC falls by [nats], errors over stretches of time, `more` parameters of so many entries."""
        one, two, counts = squares(before), squares(after), rows(after)
        independent = counts / self.alike(after)
        fit = 0.5 * float(np.sum(independent * np.log(one / two)))
        price = 0.0 if self.plain else entries * float(np.log(max(self.tried, 1)))
        return fit - 0.5 * more * float(np.log(max(independent.sum(), 2.0))) - price


def squares(stretches: Sequence[Array]) -> Array:
    """(C,) sum of squares."""
    return np.asarray(np.sum([np.nansum(e**2, axis=0) for e in stretches], axis=0)) + 1e-30


def rows(stretches: Sequence[Array]) -> Array:
    """(C,) how many there are."""
    return np.asarray(np.sum([np.isfinite(e).sum(axis=0) for e in stretches], axis=0), dtype=float)


def sizes(stretches: Sequence[Array]) -> Array:
    """(C,) rms."""
    return np.sqrt(squares(stretches) / np.maximum(rows(stretches), 1.0))


def _alike(stretches: Sequence[Array], channel: int) -> float:
    """One and twice the sum of the correlations, up to the first that is next to nothing."""
    errors = [np.nan_to_num(e[:, channel]) for e in stretches]
    whole, total = sum(float(e @ e) for e in errors), 1.0
    for lag in range(1, max(len(e) for e in errors) // 2):
        correlation = sum(float(e[lag:] @ e[:-lag]) for e in errors) / max(whole, 1e-300)
        if correlation < DIES_OUT:
            break
        total += 2.0 * correlation
    return total
