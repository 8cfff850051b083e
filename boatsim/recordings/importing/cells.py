"""Numbers of the text cells of a column, with those that a spreadsheet has changed into dates."""

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from boatsim.physics.base import Array
from boatsim.recordings.importing.dates import (
    may_be_digits_of_date,
    month_number,
    seconds_from_dates,
    zone_name,
)

EMPTY_WORDS = ("", "nan", "null", "none", "na", "n/a", "-")
# 1.2 or 1.02 became "1 February", shown as 01.feb, 1-Feb or 01/02; 1.68 became "January 1968"
DAY_AND_MONTH = re.compile(r"(\d{1,2})[.\-/ ]+([^\W\d_]{3,9})\.?")
MONTH_AND_YEAR = re.compile(r"([^\W\d_]{3,9})\.?[.\-/ ]+(\d{2})")
DECIMALS = re.compile(r"[+-]?\d+[.,](\d+)")
TRUTH = {"true": 1.0, "false": 0.0}
MINUS_SIGNS = ("\u2212", "\u2013")  # minus sign and dash of typesetters, in place of a hyphen
# 6'643'210.5 or 6 643 210.5, also with the blanks that do not break
GROUPS_BY_BLANKS = re.compile(r"[+-]?\d{1,3}(?:['’ \u00a0\u202f]\d{3})+(?:[.,]\d*)?")
# 1,234.5 between commas has quotes around it, and so has 1,5
QUOTED_COMMAS = re.compile(r"\s*[+-]?\d[\d,]*,\d+(\.\d*)?\s*")
GROUPS_BY_COMMAS = re.compile(r"[+-]?\d{1,3}(?:,\d{3})+\.\d*")  # 1,234.5
MIN_NUMBERS = 0.5  # share of the filled cells that are numbers, in a column of numbers
MAX_SHOWN = 20  # characters of a cell in a remark
NUMBER_AND_UNIT = re.compile(
    r"([+-]?\d[\d.,]*(?:e[+-]?\d+)?)\s*([^\W\d_][^\d]{0,7}|[°%])", re.IGNORECASE
)


@dataclass(frozen=True)
class Cells:
    """Numbers of a column.

    Attributes:
        values: Values (N,); nan where a cell is empty or a word.
        are_dates: Whether the cells are dates; the values are then s since 1970 or midnight.
        unit: Unit that stands behind every number, such as deg in `12.3 deg`; "" without one.
        word: The word of a column in which every filled cell is the same word; "" otherwise.
        remarks: Pairs of a message and the index of the first row that it concerns.
    """

    values: Array
    are_dates: bool = False
    unit: str = ""
    word: str = ""
    remarks: tuple[tuple[str, int], ...] = ()


def column_of_cells(cells: Sequence[str], separator: str) -> Cells:
    """Convert the text cells of a table's column to numbers, dates to seconds, other words to nan.

    Args:
        cells: Texts of the column (N,).
        separator: Separator of the table, with which a decimal comma can be told from a separator.
    """
    dates = _dates_of_digits(cells)
    if dates is not None:
        return Cells(dates, are_dates=True)
    texts, remarks = cells, []
    marks = "," if separator == "," else ",."
    for mark in marks:
        if separates_thousands(cells, mark):
            texts = [cell.replace(mark, "") for cell in cells]
            first = next(i for i, cell in enumerate(cells) if mark in cell)
            shown = f"{cells[first].strip()!r} = {texts[first].strip()}"
            remarks.append((f"{mark!r} separates thousands, first in {shown}", first))
    try:
        return Cells(np.array(list(map(_plain_number, texts))), remarks=tuple(remarks))
    except ValueError:
        pass
    if separator == "," and texts is cells:
        texts = _with_decimal_points(cells)
    found = np.full(len(cells), np.nan)
    words = []  # rows whose cell is neither a number nor empty
    for i, cell in enumerate(texts):
        value = number_of_cell(cell, separator)
        if value is None:
            words.append(i)
        else:
            found[i] = value
    if not words:
        return Cells(found, remarks=tuple(remarks))
    numbers = int(np.isfinite(found).sum())
    if numbers < MIN_NUMBERS * (numbers + len(words)):
        times = seconds_from_dates(cells)
        if times is not None:
            return Cells(times, are_dates=True, remarks=_remarks_on_zone(cells))
        with_unit = _numbers_with_unit(texts, words, separator)
        if with_unit is not None:
            return with_unit
    if not numbers:
        different = {cells[i].strip() for i in words}
        word = different.pop() if len(different) == 1 else ""
        return Cells(found, word=word)
    restored = _restored(cells, found, words)
    return replace(restored, remarks=(*remarks, *restored.remarks))


def _dates_of_digits(cells: Sequence[str]) -> Array | None:
    """Times (N,) [s] of cells such as 20240423121812.30, None for others; a float is too coarse."""
    first = next(filter(str.strip, cells), "")
    if not may_be_digits_of_date(first):
        return None
    return seconds_from_dates(cells)


def _remarks_on_zone(cells: Sequence[str]) -> tuple[tuple[str, int], ...]:
    """The remark on the name of a zone, if dates have one."""
    zone = zone_name(cells)
    if not zone:
        return ()
    return ((f"the name of the time zone, {zone}, is ignored", 0),)


def separates_thousands(cells: Sequence[str], mark: str) -> bool:
    """Return whether a comma or a point separates thousands in the numbers of a column.

    Three digits must follow each mark. A second sign is needed: a number has two marks, or all
    numbers without one are whole and below 1000, or a number has decimals behind the other mark.

    Args:
        cells: Texts of the column (N,).
        mark: Comma or point.
    """
    other = "." if mark == "," else ","
    grouped = re.compile(rf"[+-]?[1-9]\d{{0,2}}(?:\{mark}\d{{3}})+(\{other}\d*)?")
    small = re.compile(rf"[+-]?\d{{1,3}}(\{other}\d*)?")
    has_groups, has_small, has_two, has_decimals, has_both = False, False, False, False, False
    for cell in cells:
        text = cell.strip()
        if not any(map(str.isdigit, text)):
            continue
        form = grouped if mark in text else small
        found = form.fullmatch(text)
        if found is None:
            return False
        if found[1]:
            has_decimals = True
            has_both = has_both or mark in text
        elif mark in text:
            has_groups = True
            has_two = has_two or text.count(mark) > 1
        else:
            has_small = True
    if has_decimals:
        # 59.900 among 59,9001 is damaged; a program with points writes commas between thousands
        return has_both or (has_groups and mark == ",")
    return has_groups and (has_small or has_two)


def _numbers_with_unit(texts: Sequence[str], words: Sequence[int], separator: str) -> Cells | None:
    """Numbers of cells that have the same unit behind them; None for other cells.

    Args:
        texts: Texts of the column (N,).
        words: Rows whose cell is neither a number nor empty.
        separator: Separator of the table.
    """
    values = np.full(len(texts), np.nan)
    unit = ""
    for i in words:
        parts = NUMBER_AND_UNIT.fullmatch(texts[i].strip())
        if parts is None or (unit and parts[2] != unit):
            return None
        value = number_of_cell(parts[1], separator)
        if value is None:
            return None
        values[i], unit = value, parts[2]
    return Cells(values, unit=unit.strip())


def number_of_cell(cell: str, separator: str) -> float | None:
    """Return the number of a cell, nan if it is empty, None if it is a word.

    Args:
        cell: The text.
        separator: Separator of the table; if it is no comma, commas are decimal.
    """
    text = cell.strip()
    if text.lower() in EMPTY_WORDS:
        return float("nan")
    for sign in MINUS_SIGNS:
        text = text.replace(sign, "-")
    if GROUPS_BY_BLANKS.fullmatch(text):
        text = re.sub(r"['’\s]", "", text)
    if separator != "," and "," in text:
        if text.rfind(",") > text.rfind("."):
            text = text.replace(".", "")  # of thousands
        elif GROUPS_BY_COMMAS.fullmatch(text):
            text = text.replace(",", "")
        text = text.replace(",", ".")
    try:
        if "_" in text:
            return None
        return float(text)
    except ValueError:
        return TRUTH.get(text.lower())


def is_number(cell: str, separator: str) -> bool:
    """Return whether a cell is a number or empty; between commas, commas may be in quotes.

    Args:
        cell: The text, without quotes.
        separator: Separator of the table.
    """
    if separator == "," and QUOTED_COMMAS.fullmatch(cell):
        return True
    return number_of_cell(cell, separator) is not None


def _plain_number(cell: str) -> float:
    """The number of a cell. Python accepts 1_000, which is no number here. Raises ValueError."""
    if "_" in cell:
        raise ValueError(cell)
    return float(cell)


def _with_decimal_points(cells: Sequence[str]) -> Sequence[str]:
    """Cells of a table with commas between its cells: a comma in a quoted number is decimal.

    If other cells of the column have points, the commas separate thousands.
    """
    has_points = any("." in cell for cell in cells)
    point = "." if not has_points else ""
    changed = []
    for cell in cells:
        if QUOTED_COMMAS.fullmatch(cell):
            cell = cell.replace(",", point)
        changed.append(cell)
    return changed


def _restored(cells: Sequence[str], found: Array, words: Sequence[int]) -> Cells:
    """A column of numbers, in which cells that a spreadsheet made dates of are numbers again."""
    decimals = set()
    for row in np.flatnonzero(np.isfinite(found)).tolist():
        if digits := DECIMALS.fullmatch(cells[row].strip()):
            decimals.add(len(digits[1]))
    values = found.copy()
    restored, unclear, others = list[int](), list[int](), list[int]()
    for i in words:
        numbers = _numbers_before_spreadsheet(cells[i].strip(), decimals)
        if len(numbers) == 1:
            values[i] = numbers[0]
            restored.append(i)
        elif numbers:
            unclear.append(i)
        else:
            others.append(i)
    remarks = []
    if restored:
        first = restored[0]
        remarks.append(
            (
                f"{_cells_were(restored)} changed into dates by a spreadsheet and read as "
                f"numbers again, first {cells[first].strip()!r} = {values[first]:g}",
                first,
            )
        )
    if unclear:
        first = unclear[0]
        both = " or ".join(
            f"{x:g}" for x in _numbers_before_spreadsheet(cells[first].strip(), decimals)
        )
        remarks.append(
            (
                f"{_cells_were(unclear)} changed into dates by a spreadsheet and left "
                f"empty, first {cells[first].strip()!r}, which was {both}",
                first,
            )
        )
    if others:
        first = others[0]
        shown = cells[first].strip()[:MAX_SHOWN]
        what = f"{len(others)} cells are no numbers and are left empty"
        if len(others) == 1:
            what = "1 cell is no number and is left empty"
        remarks.append((f"{what}, first {shown!r}", first))
    return Cells(values, remarks=tuple(remarks))


def _cells_were(rows: Sequence[int]) -> str:
    """Number of cells and the verb of the sentence."""
    if len(rows) == 1:
        return "1 cell was"
    return f"{len(rows)} cells were"


def _numbers_before_spreadsheet(text: str, decimals: set[int]) -> list[float]:
    """The numbers that a spreadsheet with decimal commas may have changed into this date.

    Args:
        text: The cell, such as `01.feb` or `jan.68`.
        decimals: Numbers of decimals of the other cells of the column.
    """
    if (found := DAY_AND_MONTH.fullmatch(text)) and (month := month_number(found[2])):
        whole = float(found[1])
        is_unknown = not decimals & {1, 2}
        numbers = []
        if month < 10 and (is_unknown or 1 in decimals):
            numbers.append(round(whole + month / 10.0, 1))  # 1.2
        if month >= 10 or is_unknown or 2 in decimals:
            numbers.append(round(whole + month / 100.0, 2))  # 1.02, 1.11
        return numbers
    if (found := MONTH_AND_YEAR.fullmatch(text)) and (month := month_number(found[1])):
        numbers = [round(month + int(found[2]) / 100.0, 2)]
        if max(decimals, default=0) >= 4:
            for century in (19, 20):  # 1.1968
                numbers.append(month + (100 * century + int(found[2])) / 10000.0)
        return numbers
    return []
