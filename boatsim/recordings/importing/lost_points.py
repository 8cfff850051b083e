"""Numbers such as 1.234, from which a spreadsheet with decimal commas took the point: 1234.

Such a program takes a point before exactly three digits for a separator of thousands. Other numbers
of the column, such as 0.98 or 1.02, stay texts with a point. The neighbours in time then show that
a number is a thousand times too large.
"""

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from boatsim.physics.base import Array
from boatsim.recordings.importing.cells import Cells
from boatsim.recordings.importing.missing_values import PLACEHOLDERS

THOUSAND = 1000.0
WITHOUT_POINT = re.compile(r"[+-]?[1-9]\d{3,5}")  # 1.234 to 999.999
# Ratio of a number with its point to a neighbour, up to which the leap between them is one by a
# thousand. Other causes of a leap, such as a placeholder, are seldom so close
MAX_RATIO = 3.0
# A usual step is exceeded by one step in ten; noise has steps of three times that one
USUAL_QUANTILE, MAX_STEPS = 0.9, 3.0
# A whole number that no other number comes near by this factor is pointed out if a thousandth of it
# is no larger than they are
LEAP = 10.0
MIN_STEPS = 5  # between neighbours that kept their points, without which no step is usual


def may_have_lost_points(values: Array) -> bool:
    """Return whether a column has numbers from 1000 on, and all its fractions are smaller.

    Args:
        values: Values (N,) of the column.
    """
    size = np.abs(values[np.isfinite(values)])
    fractions = size[size != np.floor(size)]
    if not len(fractions) or fractions.max() >= THOUSAND:
        return False
    return bool((size >= THOUSAND).any())


def with_lost_points(found: Cells, texts: Sequence[str]) -> Cells:
    """Return a column in which numbers that have lost their point are restored or left empty.

    A number is restored if it then follows its neighbours. It is left empty if it then only has the
    size of one of them. Other numbers are kept, with a remark if all others are far smaller.

    Args:
        found: The numbers of the column.
        texts: Texts of the column (N,).
    """
    values = found.values
    if found.are_dates or not may_have_lost_points(values):
        return found
    pointless = _rows_without_point(values, texts)
    known = np.isfinite(values) & ~pointless
    limit = MAX_STEPS * _usual_step(values, known)
    largest = float(np.abs(values[known]).max())
    restored, unclear, kept = list[int](), list[int](), list[int]()
    for run in _runs_without_point(np.flatnonzero(np.isfinite(values)), pointless):
        if run.is_a_thousand_times_too_large(values, limit):
            rows = restored if run.follows(values, limit) else unclear
            rows += run.rows
        else:
            kept += [i for i in run.rows if _leaps(float(values[i]), largest)]
    changed = values.copy()
    changed[restored] /= THOUSAND
    changed[unclear] = np.nan
    remarks = list(found.remarks)
    if restored:
        first = restored[0]
        remarks.append(
            (
                f"{_cells(restored)} lost the decimal point in a spreadsheet, read with it "
                f"again, first {texts[first].strip()!r} = {changed[first]:g}",
                first,
            )
        )
    if unclear:
        first = unclear[0]
        remarks.append(
            (
                f"{_cells(unclear)} may have lost the decimal point in a spreadsheet, left empty, "
                f"first {texts[first].strip()!r}",
                first,
            )
        )
    if kept:
        first = kept[0]
        remarks.append(
            (
                f"{_cells(kept)} may have lost the decimal point in a spreadsheet: all other "
                f"numbers are at most {largest:g}, first {texts[first].strip()!r}, kept",
                first,
            )
        )
    return replace(found, values=changed, remarks=tuple(remarks))


@dataclass(frozen=True)
class _Run:
    """Rows without a point, one after another, and the rows with a point before and after them."""

    rows: list[int]
    neighbours: list[int]

    def is_a_thousand_times_too_large(self, values: Array, limit: float) -> bool:
        """Whether a thousandth of its first or last number has the size of a neighbour."""
        for row, neighbour in self._ends():
            value, other = float(values[row]) / THOUSAND, float(values[neighbour])
            if other != 0.0 and 1.0 / MAX_RATIO <= value / other <= MAX_RATIO:
                return True
            if other != 0.0 and abs(value - other) <= limit:
                return True
        return False

    def follows(self, values: Array, limit: float) -> bool:
        """Whether thousandths of its numbers follow each other and both neighbours."""
        steps = [abs(values[row] / THOUSAND - values[other]) for row, other in self._ends()]
        steps += list(np.abs(np.diff(values[self.rows])) / THOUSAND)
        return float(max(steps)) <= limit

    def _ends(self) -> list[tuple[int, int]]:
        """Pairs of an end of the run and its neighbour."""
        ends = []
        for neighbour in self.neighbours:
            row = self.rows[0] if neighbour < self.rows[0] else self.rows[-1]
            ends.append((row, neighbour))
        return ends


def _leaps(value: float, largest: float) -> bool:
    """Whether a number is far larger than all others with points, but a thousandth of it is not."""
    return abs(value) > LEAP * largest and abs(value) / THOUSAND <= largest


def _rows_without_point(values: Array, texts: Sequence[str]) -> NDArray[np.bool_]:
    """Rows (N,) whose number is whole and from 1000 on, and stands for no missing value."""
    rows = np.zeros(len(values), dtype=np.bool_)
    for i in np.flatnonzero(np.abs(values) >= THOUSAND).tolist():
        whole = WITHOUT_POINT.fullmatch(texts[i].strip())
        rows[i] = whole is not None and values[i] not in PLACEHOLDERS
    return rows


def _usual_step(values: Array, known: NDArray[np.bool_]) -> float:
    """Step between neighbours that one in ten exceeds; of all rows if few kept their points."""
    both = known[1:] & known[:-1]
    steps = np.abs(np.diff(values))[both]
    if len(steps) < MIN_STEPS:
        all_values = np.where(known, values, values / THOUSAND)
        steps = np.abs(np.diff(all_values[np.isfinite(all_values)]))
    return float(np.quantile(steps, USUAL_QUANTILE)) if len(steps) else 0.0


def _runs_without_point(finite: NDArray[np.intp], pointless: NDArray[np.bool_]) -> list[_Run]:
    """The runs of rows without a point among the rows that are not empty."""
    runs = list[_Run]()
    before: int | None = None
    rows = list[int]()
    for row in [*finite.tolist(), None]:
        if row is not None and pointless[row]:
            rows.append(row)
            continue
        if rows:
            runs.append(_Run(rows, [i for i in (before, row) if i is not None]))
        before, rows = row, []
    return runs


def _cells(rows: Sequence[int]) -> str:
    """Number of cells."""
    return "1 cell" if len(rows) == 1 else f"{len(rows)} cells"
