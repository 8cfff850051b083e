"""Conversions of signals to a column that are not linear: ranges, measured curves, allocations."""

import math
from collections.abc import Mapping
from itertools import pairwise

import numpy as np
from pydantic import Field, model_validator

from boatsim.files import Table, validate_table
from boatsim.physics.base import Array


class Range(Table):
    """Conversion of a signal with three known values, such as a pulse of 1100 to 1900 us.

    On either side of neutral the column is the end of that side times the share of the way to it,
    to the power of `exponent`.

    Attributes:
        signal: Expression of the signal.
        low: Value of the signal at `least`.
        neutral: Value of the signal at 0.
        high: Value of the signal at `most`.
        least: Value of the column where the signal is low.
        most: Value of the column where the signal is high.
        exponent: 1 for proportion, 2 for the thrust of a propeller of a number of revolutions.
    """

    signal: str
    low: float
    neutral: float
    high: float
    least: float = -1.0
    most: float = 1.0
    exponent: float = Field(1.0, ge=0.5, le=3.0)

    @model_validator(mode="after")
    def _in_order(self) -> "Range":
        if not (self.low < self.neutral < self.high or self.low > self.neutral > self.high):
            raise ValueError("neutral must lie between low and high")
        return self

    def convert(self, values: Array) -> Array:
        """Convert a signal (N,) to the column on both sides of neutral; constant beyond."""
        ends = sorted([(self.low, -1.0), (self.neutral, 0.0), (self.high, 1.0)])
        of_signal, of_share = np.array(ends).T
        share = np.interp(values, of_signal, of_share)
        full = np.where(share < 0.0, self.least, self.most)
        return np.asarray(full * np.abs(share) ** self.exponent)

    @property
    def unclipped_range(self) -> tuple[float, float]:
        """Smallest and largest value of the signal between which the column is not clipped."""
        return min(self.low, self.high), max(self.low, self.high)


class Curve(Table):
    """Conversion of a signal by a measured table, such as command against thrust.

    Between two points the column is linear, beyond the first and the last it is that of this point.

    Attributes:
        signal: Expression of the signal.
        points: Pairs [value of the signal, value of the column], by increasing signal.
    """

    signal: str
    points: list[tuple[float, float]] = Field(min_length=2, max_length=100)

    @model_validator(mode="after")
    def _increase(self) -> "Curve":
        for (first, _), (second, _) in pairwise(self.points):
            if not first < second:
                raise ValueError("points must be pairs [signal, column] by increasing signal")
        return self

    def convert(self, values: Array) -> Array:
        """Convert a signal (N,) to the column by a table of points, constant beyond its ends."""
        of_signal, of_column = np.array(self.points).T
        return np.asarray(np.interp(values, of_signal, of_column))

    @property
    def unclipped_range(self) -> tuple[float, float]:
        """Smallest and largest value of the signal between which the column is not clipped."""
        return self.points[0][0], self.points[-1][0]


class Allocation(Table):
    """Conversion of orders in another form, such as a force and a moment, to that of one drive.

    The terms are added, their sum is limited, and a power law converts it: with `coefficient` k and
    `exponent` p the column is k |s|^p with the sign of the sum s, or with `inverse = true` the
    number x of which s is k |x|^p: the shaft rate that gives a thrust. One row of an allocation
    matrix (Fossen 2021, section 9.5) is a sum, and each drive has its own.

    Attributes:
        sum: Terms: expressions of signals, ranges or curves. A curve of two points is a factor with
            saturation.
        low: Smallest value of the sum.
        high: Largest value of the sum.
        coefficient: k of the power law of a positive sum.
        coefficient_below: k of a negative sum; the same by default.
        exponent: p of the power law; 2 of a propeller.
        inverse: Whether the column is the number of which the sum is the power law.
    """

    sum: list[str | Range | Curve] = Field(min_length=1, max_length=20)
    low: float = -math.inf
    high: float = math.inf
    coefficient: float = Field(1.0, gt=0.0)
    coefficient_below: float | None = Field(None, gt=0.0)
    exponent: float = Field(1.0, ge=0.25, le=4.0)
    inverse: bool = False

    @model_validator(mode="after")
    def _in_order(self) -> "Allocation":
        if not self.low < self.high:
            raise ValueError("low must be less than high")
        return self

    def convert(self, values: Array) -> Array:
        """Convert the sum (N,) of the terms to the column by the limits and the power law."""
        total = np.clip(values, self.low, self.high)
        below = self.coefficient_below or self.coefficient
        k = np.where(total < 0.0, below, self.coefficient)
        size = k * np.abs(total) ** self.exponent
        if self.inverse:
            size = (np.abs(total) / k) ** (1.0 / self.exponent)
        return np.asarray(np.sign(total) * size)

    @property
    def unclipped_range(self) -> tuple[float, float]:
        """Smallest and largest value of the sum between which the column is not clipped."""
        return self.low, self.high


def conversion_of(table: Mapping[str, object], label: str) -> Range | Curve:
    """Return the conversion of one signal, a `Curve` if the table has points, else a `Range`.

    Args:
        table: The table.
        label: File and key in messages.

    Raises:
        BadInput: The table is neither.
    """
    if "points" in table:
        return validate_table(Curve, table, label)
    return validate_table(Range, table, label)


def map_conversion_of(table: Mapping[str, object], label: str) -> Range | Curve | Allocation:
    """Return the conversion of one signal, or the `Allocation` of several if there is a sum.

    Args:
        table: The table.
        label: File and key in messages.

    Raises:
        BadInput: The table is none of them.
    """
    if "sum" not in table:
        return conversion_of(table, label)
    terms = table["sum"]
    made = []
    for i, term in enumerate(terms if isinstance(terms, list) else []):
        if isinstance(term, dict):
            term = conversion_of(term, f"{label}.sum[{i}]")
        made.append(term)
    return validate_table(Allocation, {**table, "sum": made or terms}, label)
