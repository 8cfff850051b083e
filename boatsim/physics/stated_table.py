"""A plain table of numbers whose first lines state its conventions.

# key = value             a convention, whose keys the reader knows; other lines with # are remarks
column,column,...
number,number,...
"""

import csv
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from boatsim.errors import BadInput, nearest_hint, unknown_name_message
from boatsim.physics.signals import Array

MOST_ROWS = 200_000
ANGLES = {"rad": 1.0, "deg": np.pi / 180.0}  # units of an angle [rad]


@dataclass(frozen=True, eq=False)
class StatedTable:
    """A table of numbers with its conventions.

    Attributes:
        path: The file.
        words: Conventions that are one of several words.
        numbers: Conventions that are numbers.
        columns: Names of the columns.
        rows: Numbers (R, C).
    """

    path: Path
    words: Mapping[str, str]
    numbers: Mapping[str, float]
    columns: tuple[str, ...]
    rows: Array

    def column(self, units: Mapping[str, float]) -> Array | None:
        """Return the column of the first name that the table has, in SI units; None without one.

        Args:
            units: Names of columns, and the unit of each.
        """
        for name, factor in units.items():
            if name in self.columns:
                return np.asarray(factor * self.rows[:, self.columns.index(name)])
        return None


def read_stated_table(
    path: Path, words: Mapping[str, Sequence[str]], numbers: Iterable[str]
) -> StatedTable:
    """Read a table and its conventions.

    Args:
        path: The file.
        words: Conventions and their allowed words, the default first.
        numbers: Conventions that are numbers, 0 by default.

    Raises:
        BadInput: A line has another form.
    """
    if not path.is_file():
        raise BadInput(f"{path}: there is no such file")
    lines = path.read_text(encoding="utf-8-sig", errors="replace").splitlines()
    chosen = {key: allowed[0] for key, allowed in words.items()}
    given = dict.fromkeys(numbers, 0.0)
    begin = 0
    while begin < len(lines) and lines[begin].startswith("#"):
        key, equals, value = (part.strip() for part in lines[begin][1:].partition("="))
        begin += 1
        label = f"{path}:{begin}"
        if not equals:
            continue  # a remark
        if key in chosen:
            if value not in words[key]:
                allowed = ", ".join(words[key])
                raise BadInput(f"{label}: {key} = {value!r}; allowed are {allowed}")
            chosen[key] = value
        elif key in given:
            given[key] = _number(value, f"{label}: {key}")
        elif _is_meant(key, [*chosen, *given]):
            raise BadInput(unknown_name_message(f"{label}: convention", key, [*chosen, *given]))
    columns, rows = _rows(lines[begin:], begin, path)
    return StatedTable(path, chosen, given, columns, rows)


def _is_meant(key: str, known: Sequence[str]) -> bool:
    """Return whether the text before "=" is probably meant as a convention, and no remark.

    It is a word that resembles the name of a convention, or begins with such a name and further
    words.
    """
    first, _, others = key.partition(" ")
    if not others:
        return bool(nearest_hint(key, known))
    return len(first) > 1 and first in known


def _number(text: str, label: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = np.nan
    if not np.isfinite(value):
        raise BadInput(f"{label} = {text[:40]!r}; a number is required")
    return value


def _rows(lines: list[str], begin: int, path: Path) -> tuple[tuple[str, ...], Array]:
    """Return the names of the columns and the numbers (R, C)."""
    try:
        table = [row for row in csv.reader(lines) if row]
    except csv.Error as error:
        raise BadInput(f"{path}: no CSV file: {error}") from None
    if len(table) > MOST_ROWS:
        raise BadInput(f"{path}: more than {MOST_ROWS} rows")
    if len(table) < 2:
        raise BadInput(f"{path}: there are no rows")
    columns = tuple(name.strip() for name in table[0])
    rows = []
    for number, row in enumerate(table[1:], begin + 2):
        if len(row) != len(columns):
            raise BadInput(f"{path}:{number}: {len(row)} columns; {len(columns)} are required")
        values = []
        for name, cell in zip(columns, row, strict=True):
            values.append(_number(cell, f"{path}:{number}: {name}"))
        rows.append(values)
    return columns, np.array(rows)
