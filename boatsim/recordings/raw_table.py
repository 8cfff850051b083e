"""A table as a reader found it: named columns of cells, with the row each bad cell stands in."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from boatsim.errors import BadInput
from boatsim.physics.base import Array


@dataclass(frozen=True)
class Raw:
    """A table as read: empty cells are nan, cells that are not numbers are kept aside with their row."""

    path: Path
    columns: dict[str, Array]  # each (N,)
    rows: Sequence[int]  # line of the file (CSV) or number of the row (Parquet), counted from 1
    # column -> row and content of its first bad cell
    text: dict[str, tuple[int, str]] = field(default_factory=dict)


def refuse(path: Path, message: str, row: int | None = None, column: str | None = None) -> BadInput:
    """The one line of a bad recording: file, row, column, what is wrong."""
    where = "".join(
        f" {what} {value},"
        for what, value in (("row", row), ("column", column))
        if value is not None
    )
    return BadInput(" ".join(f"{path}:{where.rstrip(',')}{':' if where else ''} {message}".split()))


def no_twins(path: Path, header: list[str]) -> None:
    """Refuse a header that names a column twice. Raises BadInput."""
    for name, count in Counter(header).items():
        if count > 1:
            raise refuse(path, "there are two columns of this name", 1, name or "(no name)")


def numbers(raw: Raw, name: str, cells: Sequence[object]) -> Array:
    """(N,) floats; empty cells become nan, and the first cell that is no number is noted in `raw.text`."""
    try:
        return np.array(list(map(_plain, cells)), dtype=float)
    except (ValueError, TypeError, OverflowError):
        return np.array(
            [_lenient(raw, name, row, cell) for row, cell in zip(raw.rows, cells, strict=True)]
        )


def _plain(cell: object) -> float:
    if isinstance(cell, str) and "_" in cell:  # Python reads 1_000, a CSV file should not say so
        raise ValueError(cell)
    return float(cell)  # type: ignore[arg-type]


def _lenient(raw: Raw, name: str, row: int, cell: object) -> float:
    try:
        return float("nan") if isinstance(cell, str) and not cell.strip() else _plain(cell)
    except (ValueError, TypeError, OverflowError):
        raw.text.setdefault(name, (row, str(cell)[:40]))
        return float("nan")
