"""Cells of tables: decimal commas, cells that a spreadsheet changed, words among numbers."""

import math
import re
from pathlib import Path

import numpy as np
import pytest

from boatsim.recordings.importing.cells import column_of_cells, number_of_cell
from boatsim.recordings.logs.table import read

MONTHS = "jan feb mar apr mai jun jul aug sep okt nov des".split()


def after_spreadsheet(text: str) -> str:
    """What a spreadsheet with decimal commas shows for a number with a point (Norwegian)."""
    whole, point, decimals = text.partition(".")
    if not point or not whole.isdigit():
        return text
    day, number = int(whole), int(decimals)
    if len(decimals) <= 2 and 1 <= number <= 12 and 1 <= day <= 28:
        return f"{day:02d}.{MONTHS[number - 1]}"
    if len(decimals) == 2 and 1 <= day <= 12 and number > 12:
        return f"{MONTHS[day - 1]}.{decimals}"
    return text


def test_numbers_that_a_spreadsheet_made_dates_of_come_back_or_are_left_empty():
    rng = np.random.default_rng(1)
    true = np.round(rng.normal(3.0, 4.0, 3000), 3)
    true[::7] = np.round(true[::7], 2)
    true[::11] = np.round(true[::11], 1)
    texts = [f"{x:g}" if x == round(x, 2) else f"{x:.3f}".rstrip("0") for x in true]
    cells = list(map(after_spreadsheet, texts))
    assert sum(a != b for a, b in zip(cells, texts, strict=True)) > 100
    found = column_of_cells(cells, ";")
    read_again = np.isfinite(found.values)
    assert np.array_equal(found.values[read_again], true[read_again])
    is_unclear = [re.fullmatch(r"\d\d\.(?!okt|nov|des)[a-z]{3}", cell) for cell in cells]
    assert np.array_equal(~read_again, np.array(list(map(bool, is_unclear))))
    assert not found.are_dates
    assert len(found.remarks) == 2


@pytest.mark.parametrize(
    ("cell", "others", "number"),
    [
        ("jan.68", "1.111", 1.68),
        ("Mai 25", "1.11", 5.25),
        ("01.nov", "1.11", 1.11),
        ("01.feb", "1.11", 1.02),  # two decimals everywhere
        ("01.feb", "1.1", 1.2),  # one decimal everywhere
        ("01.feb", "1.111", math.nan),  # 1.2 or 1.02
    ],
)
def test_the_decimals_of_a_column_show_what_a_date_was(cell, others, number):
    found = column_of_cells([cell, *[others] * 9], ";").values[0]
    assert found == pytest.approx(number, nan_ok=True)


@pytest.mark.parametrize(
    ("text", "separator", "number"),
    [("1,5", ";", 1.5), ("1.234,5", ";", 1234.5), ("-0,25", "\t", -0.25), ("n/a", ",", math.nan)],
)
def test_a_comma_is_decimal_where_it_does_not_separate_cells(text, separator, number):
    assert number_of_cell(text, separator) == pytest.approx(number, nan_ok=True)


def test_quoted_commas_are_decimal_unless_the_column_has_points():
    assert column_of_cells(["1,5", "2,5", "x"], ",").values[:2] == pytest.approx([1.5, 2.5])
    thousands = column_of_cells(["1,234.5", "2.5", "x"], ",").values[:2]
    assert thousands == pytest.approx([1234.5, 2.5])


def log_of(tmp_path: Path, lines: list[str]) -> Path:
    file = tmp_path / "log.csv"
    file.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return file


def test_a_first_column_without_a_name_may_be_the_time(tmp_path):
    lines = [";lat;yaw"]
    for i in range(30):
        lines.append(f"2024-04-23_12:18:{10 + i // 10}:{i % 10}00000;59,{9000 + i};{i},5")
    log = read(log_of(tmp_path, lines))
    assert log.signals["lat"].values[1] == pytest.approx(59.9001)
    assert np.diff(log.signals["yaw"].t) == pytest.approx(0.1, abs=1e-6)
    assert any("times are those of column column_1" in remark for remark in log.remarks)


def test_columns_between_blanks_are_read(tmp_path):
    lines = ["time  x   y"] + [f"{0.1 * i:.1f}   {i}  {-i}" for i in range(30)]
    log = read(log_of(tmp_path, lines))
    assert log.signals["y"].values[-1] == -29.0
    assert log.signals["y"].t[-1] == pytest.approx(2.9)


def test_a_remark_names_row_column_and_first_cell(tmp_path):
    lines = ["time,x"] + [f"{0.1 * i:.1f},{i}" for i in range(30)]
    lines[12] = "1.1,####"
    log = read(log_of(tmp_path, lines))
    assert log.remarks == (
        f"{tmp_path / 'log.csv'}: row 13, column x: 1 cell is no number and is left empty, "
        "first '####'",
    )


@pytest.mark.parametrize("header", ["time,x,y", None])
def test_the_first_row_of_quoted_decimal_commas_is_a_row_and_no_units(tmp_path, header):
    cells = [(f"{0.1 * i:.1f}", f"{i + 0.125:.3f}", f"{-i:.2f}") for i in range(30)]
    lines = [",".join(f'"{cell}"'.replace(".", ",") for cell in row) for row in cells]
    log = read(log_of(tmp_path, [header, *lines] if header else lines))
    x = list(log.signals.values())[1]
    assert x.values == pytest.approx(np.arange(30) + 0.125)
    assert x.unit == ""


@pytest.mark.parametrize("separator", [";", "\t"])
@pytest.mark.parametrize("decimals", [0, 1])
def test_thousands_with_commas_are_read_in_tables_of_spreadsheets(tmp_path, separator, decimals):
    speed = np.round(np.linspace(850.0, 1350.0, 40), decimals)
    file = tmp_path / "log.csv"
    lines = [f"time{separator}n_rpm"]
    lines += [f"{0.1 * i:.1f}{separator}{x:,.{decimals}f}" for i, x in enumerate(speed)]
    file.write_text("\n".join(lines) + "\n")
    log = read(file)
    assert log.signals["n_rpm"].values == pytest.approx(speed)
    assert any("column n_rpm: ',' separates thousands" in remark for remark in log.remarks)
    assert log.signals["n_rpm"].t == pytest.approx(0.1 * np.arange(40))


@pytest.mark.parametrize(
    ("cells", "values"),
    [
        (["1,001.7"], [1001.7]),
        (["1,344", "859.5"], [1344.0, 859.5]),
        (["1,344", "1,001"], [1.344, 1.001]),  # no second sign
        (["0,344", "1"], [0.344, 1.0]),
        (["1,34", "859.5"], [1.34, 859.5]),
        (["59.900.123", "59,9001", "59,9002"], [math.nan, 59.9001, 59.9002]),
    ],
)
def test_commas_of_thousands_need_two_signs_between_semicolons(cells, values):
    assert column_of_cells(cells, ";").values == pytest.approx(values, nan_ok=True)
