"""Where the table of a text begins: the lines of a logger before its header, and its separator."""

import csv
from collections import Counter
from collections.abc import Sequence
from contextlib import suppress
from itertools import repeat

from boatsim.recordings.importing.cells import is_number
from boatsim.recordings.importing.dates import seconds_from_dates

SEPARATORS = ",;\t|"
BLANK = " "  # any number of blanks between the cells
SAMPLE = 200  # lines that are compared to find the header
MIN_FOLLOWING = 5  # lines that show the kinds of the cells
MIN_TABLE_SHARE = 0.5  # of the sampled lines that have the number of cells of the table


def cells_of_line(line: str, separator: str) -> list[str]:
    """Return the cells of a line. Raises csv.Error."""
    if separator == BLANK:
        return line.split()
    return next(csv.reader([line], delimiter=separator), [])


def separator_of(header: str, row: str) -> str:
    """Return the separator of a table; blanks if header and row have equally many words."""
    best = max(SEPARATORS, key=header.count)
    if best == "," and is_row_of_numbers(cells_of_line(header, ";"), ";") and ";" in header:
        return ";"  # a first row of numbers with decimal commas
    if best not in header and len(header.split()) == len(row.split()) > 1:
        return BLANK
    return best


def header_line(lines: Sequence[str]) -> int:
    """Return the index of the line of a text with which its table begins.

    Loggers write their name, settings or the date of a trial before the table. These lines have
    other numbers of cells than the rows.

    Args:
        lines: Lines that are not empty, at least two.
    """
    sample = lines[:SAMPLE]
    first = separator_of(sample[0], sample[1])
    if _share_of_width(sample[1:], first, _width(sample[0], first)) >= MIN_TABLE_SHARE:
        return 0
    best, most = 0, 0
    for separator in SEPARATORS:
        widths = [_width(line, separator) for line in sample]
        width, _ = Counter(widths[len(widths) // 2 :]).most_common(1)[0]
        numbers = _count_numbers(sample[len(widths) // 2 :], separator)
        if width < 2 or numbers <= most:
            continue
        best, most = widths.index(width), numbers
    return best


def is_row_of_numbers(cells: Sequence[str], separator: str) -> bool:
    """Whether all cells of a line are numbers or empty, so that it is no header."""
    return all(map(is_number, cells, repeat(separator)))


def is_row_of_table(cells: Sequence[str], following: Sequence[str], separator: str) -> bool:
    """Return whether the first line of a table with words is a row, so that there is no header.

    Each of its cells is of the kind of those below: a number, a date, or a word that comes again.
    At least one is a number or a date, and one a word.

    Args:
        cells: Cells of the first line.
        following: The next lines.
        separator: Separator of the table.
    """
    kinds = [_kind_of_cell(cell, separator) for cell in cells]
    if not {"word", "value"} <= set(kinds):
        return False
    rows = []
    for line in following:
        with suppress(csv.Error):
            rows.append(cells_of_line(line, separator))
    same_width = [row for row in rows if len(row) == len(cells)]
    if len(same_width) < MIN_FOLLOWING or 2 * len(same_width) < len(following):
        return False
    for i, kind in enumerate(kinds):
        below = [row[i] for row in same_width]
        if kind == "word" and cells[i] not in below:
            return False
        if kind == "value":
            values = [_kind_of_cell(cell, separator) == "value" for cell in below[:MIN_FOLLOWING]]
            if not any(values):
                return False
    return True


def _kind_of_cell(cell: str, separator: str) -> str:
    """Whether a cell is a "value" (number or date), a "word" or "" for an empty one."""
    if not cell.strip():
        return ""
    if is_number(cell, separator) or seconds_from_dates([cell]) is not None:
        return "value"
    return "word"


def _width(line: str, separator: str) -> int:
    """Number of cells of a line, without an empty one at its end."""
    return _widths(line, separator)[0]


def _widths(line: str, separator: str) -> tuple[int, int]:
    """Number of cells of a line without an empty one at its end, and of all cells."""
    try:
        cells = cells_of_line(line.strip("\r\n"), separator)
    except csv.Error:
        return 0, 0
    is_open = len(cells) > 1 and not cells[-1].strip()
    return len(cells) - is_open, len(cells)


def _count_numbers(lines: Sequence[str], separator: str) -> int:
    """Number of the cells of lines that are numbers or empty with a separator.

    Decimal commas part the cells of a table with semicolons into more cells, which are no numbers.
    """
    count = 0
    for line in lines:
        try:
            cells = cells_of_line(line.strip("\r\n"), separator)
        except csv.Error:
            continue
        if len(cells) > 1:
            count += sum(map(is_number, cells, repeat(separator)))
    return count


def _share_of_width(lines: Sequence[str], separator: str, width: int) -> float:
    same = sum(width in _widths(line, separator) for line in lines)
    return same / len(lines)
