"""Joint uncertainty of the fitted numbers of a vessel, in a patched vessel file."""

from dataclasses import dataclass, replace
from typing import NamedTuple, Self

import numpy as np
from pydantic import Field, PositiveFloat, model_validator

from boatsim.files import Table
from boatsim.physics.signals import Array

CORRELATION_DECIMALS = 9  # in a file; far below the uncertainty of an estimated correlation


class FittedTable(Table):
    """Entry of a patched vessel file: one fitted quantity x, its standard deviation and its use.

    It lists the numbers of the vessel that change with x.
    """

    fitted: str
    sd: PositiveFloat
    scales: list[str] = []  # "effect.number": multiplied by 1 + x
    shifts: dict[str, float] = {}  # "effect.number" -> change per x


class SpreadTable(Table):
    """Table [spread] of a patched vessel file: uncertainty of the fitted quantities."""

    correlation: list[list[float]] = []  # of the quantities in [[spread.of]], in their order
    of: list[FittedTable] = Field(default=[])

    @model_validator(mode="after")
    def _check_square_covariance(self) -> Self:
        wanted = (len(self.of), len(self.of))
        if self.of and np.shape(self.correlation) != wanted:
            raise ValueError(f"correlation is not a table of {wanted[0]} rows of {wanted[1]}")
        if self.of and np.linalg.eigvalsh(np.array(self.correlation)).min() < -1e-6:
            raise ValueError("correlation is no correlation matrix: an eigenvalue is below 0")
        return self


class SampledChange(NamedTuple):
    """Random changes of one number of k vessels: a factor and a shift for each vessel."""

    factor: Array | float = 1.0
    shift: Array | float = 0.0


@dataclass(frozen=True)
class FittedUncertainty:
    """Joint normal distribution of the F quantities that a diagnosis fitted to a vessel.

    Its mean is the numbers of the vessel file.
    """

    of: tuple[FittedTable, ...]
    sd: Array  # (F,)
    root: Array  # (F, F) of the correlation matrix

    @classmethod
    def from_table(cls, table: SpreadTable) -> "FittedUncertainty | None":
        """Return the uncertainty of fitted quantities in a vessel file; None if there is none.

        Args:
            table: Table [spread] of the vessel file.
        """
        if not table.of:
            return None
        values, vectors = np.linalg.eigh(np.array(table.correlation, dtype=float))
        sd = np.array([f.sd for f in table.of])
        return cls(tuple(table.of), sd, vectors * np.sqrt(np.maximum(values, 0.0)))

    def to_table(self) -> dict[str, object]:
        """Return the table [spread] of a vessel file that stores this uncertainty."""
        correlation = np.round(self.root @ self.root.T, CORRELATION_DECIMALS)
        return {"correlation": correlation.tolist(), "of": [one.model_dump() for one in self.of]}

    def with_scaled_sd(self, factor: float) -> "FittedUncertainty":
        """Return a copy of the uncertainty with all standard deviations multiplied by a factor.

        Args:
            factor: The factor.
        """
        return replace(self, sd=self.sd * factor)

    def sample_changes(self, shares: Array) -> dict[str, SampledChange]:
        """Sample k vessels from the uncertainty; return the change of each affected number.

        The keys are "effect.number".

        Args:
            shares: Independent numbers (k, F), uniform in (0, 1).
        """
        from scipy.special import ndtri  # only here, because its import is slow

        off = ndtri(shares) @ self.root.T * self.sd
        found: dict[str, SampledChange] = {}
        for one, x in zip(self.of, off.T, strict=True):
            for name in one.scales:
                had = found.get(name, SampledChange())
                found[name] = SampledChange(had.factor * (1.0 + x), had.shift)
            for name, weight in one.shifts.items():
                had = found.get(name, SampledChange())
                found[name] = SampledChange(had.factor, had.shift + weight * x)
        return found
