"""How far off the fitted numbers of a vessel may be, all together: what a diagnosis leaves in a patched file."""

from dataclasses import dataclass, replace
from typing import NamedTuple, Self

import numpy as np
from pydantic import Field, PositiveFloat, model_validator
from scipy.special import ndtri

from boatsim.files import Table
from boatsim.physics.signals import Array

CORRELATION_DECIMALS = 9  # in a file; far below the uncertainty of an estimated correlation


class FittedTable(Table):
    """One fitted quantity, and the numbers that differ with it."""

    fitted: str
    sd: PositiveFloat
    scales: list[str] = []  # "effect.number" that are times 1 + x
    shifts: dict[str, float] = {}  # "effect.number" -> what is added to it per x


class SpreadTable(Table):
    """[spread] of a patched vessel file."""

    correlation: list[list[float]] = []  # of the quantities in [[spread.of]], in their order
    of: list[FittedTable] = Field(default=[])

    @model_validator(mode="after")
    def _square(self) -> Self:
        wanted = (len(self.of), len(self.of))
        if self.of and np.shape(self.correlation) != wanted:
            raise ValueError(f"correlation is not a table of {wanted[0]} rows of {wanted[1]}")
        if self.of and np.linalg.eigvalsh(np.array(self.correlation)).min() < -1e-6:
            raise ValueError("correlation is that of no quantities: an eigenvalue is below 0")
        return self


class Change(NamedTuple):
    """What k boats have in place of a number: times the factor, and the shift added."""

    factor: Array | float = 1.0
    shift: Array | float = 0.0


@dataclass(frozen=True)
class Spread:
    """Normal distribution of what was fitted, about the numbers of the vessel file."""

    of: tuple[FittedTable, ...]
    sd: Array  # (F,)
    root: Array  # (F, F) of the correlation

    @classmethod
    def read(cls, table: SpreadTable) -> "Spread | None":
        """From a vessel file; None where it says nothing."""
        if not table.of:
            return None
        values, vectors = np.linalg.eigh(np.array(table.correlation, dtype=float))
        return cls(
            tuple(table.of),
            np.array([f.sd for f in table.of]),
            vectors * np.sqrt(np.maximum(values, 0.0)),
        )

    def table(self) -> dict[str, object]:
        """Return the [spread] table of a vessel file."""
        correlation = np.round(self.root @ self.root.T, CORRELATION_DECIMALS)
        return {"correlation": correlation.tolist(), "of": [one.model_dump() for one in self.of]}

    def times(self, factor: float) -> "Spread":
        """As wide as that factor says."""
        return replace(self, sd=self.sd * factor)

    def drawn(self, shares: Array) -> dict[str, Change]:
        """What becomes of each "effect.number", from numbers drawn by lot (k, F)."""
        off = ndtri(shares) @ self.root.T * self.sd
        found: dict[str, Change] = {}
        for one, x in zip(self.of, off.T, strict=True):
            for name in one.scales:
                had = found.get(name, Change())
                found[name] = Change(had.factor * (1.0 + x), had.shift)
            for name, weight in one.shifts.items():
                had = found.get(name, Change())
                found[name] = Change(had.factor, had.shift + weight * x)
        return found
