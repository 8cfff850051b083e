"""Tables as readers return them: columns of numbers, with the first invalid cells."""

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from boatsim.errors import BadInput
from boatsim.physics.base import Array


@dataclass(frozen=True)
class Raw:
    """Unchecked table of numbers as a file reader returns it, with the cells that are not numbers.

    Attributes:
        path: The file.
        columns: Name -> values (N,); empty cells and cells that are not numbers are nan.
        rows: Line of the file (CSV) or number of the row (Parquet) of each row, counted from 1.
        text: Column -> row and content of its first cell that is not a number.
    """

    path: Path
    columns: dict[str, Array]
    rows: Sequence[int]
    text: dict[str, tuple[int, str]] = field(default_factory=dict)


def select_rows(
    columns: Mapping[str, Array], rows: "slice | NDArray[np.bool_] | NDArray[np.int64]"
) -> dict[str, Array]:
    """Return the columns of a table with a selection of its rows.

    Args:
        columns: Name -> values (N,).
        rows: A slice, a mask (N,) or numbers of rows.
    """
    selected = {}
    for name, values in columns.items():
        selected[name] = values[rows]
    return selected


def file_error(
    path: Path, message: str, row: int | None = None, column: str | None = None
) -> BadInput:
    """Return the exception for a recording that cannot be used, with file, row and column.

    Args:
        path: The file.
        message: The reason.
        row: Row of the mistake, counted from 1.
        column: Column of the mistake.
    """
    places = []
    if row is not None:
        places.append(f"row {row}")
    if column is not None:
        places.append(f"column {column}")
    where = f"{path}:"
    if places:
        where += f" {', '.join(places)}:"
    return BadInput(" ".join(f"{where} {message}".split()))


def check_unique_names(path: Path, header: list[str]) -> None:
    """Check that the columns of a file have different names. Raises BadInput."""
    for name, count in Counter(header).items():
        if count > 1:
            raise file_error(path, "there are two columns of this name", 1, name or "(no name)")


def parse_numbers(raw: Raw, name: str, cells: Sequence[object]) -> Array:
    """Convert the text cells of one column of a table to numbers (N,).

    Args:
        raw: The table; its `text` gets the first cell that is not a number.
        name: Name of the column.
        cells: The cells; empty ones become nan.
    """
    try:
        return np.array(list(map(_number, cells)), dtype=float)
    except (ValueError, TypeError, OverflowError):
        values = []
        for row, cell in zip(raw.rows, cells, strict=True):
            values.append(_number_or_nan(raw, name, row, cell))
        return np.array(values)


def _number(cell: object) -> float:
    if isinstance(cell, str) and "_" in cell:  # Python accepts 1_000, a recording must not
        raise ValueError(cell)
    return float(cell)  # type: ignore[arg-type]


def _number_or_nan(raw: Raw, name: str, row: int, cell: object) -> float:
    try:
        if isinstance(cell, str) and not cell.strip():
            return float("nan")
        return _number(cell)
    except (ValueError, TypeError, OverflowError):
        raw.text.setdefault(name, (row, str(cell)[:40]))
        return float("nan")
