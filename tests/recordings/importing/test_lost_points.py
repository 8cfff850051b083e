"""Numbers from which a spreadsheet with decimal commas took the point are found again."""

import re

import numpy as np
import pytest

from boatsim.recordings.importing.cells import Cells
from boatsim.recordings.importing.table_columns import column_of_texts, without_placeholders
from boatsim.recordings.logs.table import read

T = 0.1 * np.arange(300)
RNG = np.random.default_rng(2)
SIGNALS = {
    "speed": np.round(1.5 + 0.9 * np.sin(0.2 * T), 3),  # about 1, to both sides
    "sway": np.round(1.4 * np.sin(0.3 * T) + 0.02 * RNG.standard_normal(len(T)), 3),
    "heading": np.round(180.0 + 170.0 * np.sin(0.1 * T), 3),
    "noise": np.round(1.0 + 0.4 * RNG.random(len(T)), 3),
}


def opened_by_a_spreadsheet(text: str) -> str:
    """A point before exactly three digits separates thousands, unless the number begins with 0."""
    if re.fullmatch(r"-?[1-9]\d{0,2}\.\d{3}", text):
        return text.replace(".", "")
    return text


def column(texts: list[str]) -> Cells:
    return without_placeholders(column_of_texts("x", texts, ";"))


@pytest.mark.parametrize(
    ("name", "form"),
    # with three decimals throughout, no number of the others keeps its point
    [("speed", ".3f"), ("sway", ".3f"), *((name, "g") for name in SIGNALS)],
)
def test_lost_points_are_found_or_the_cells_are_left_empty(name: str, form: str) -> None:
    true = SIGNALS[name]
    texts = [f"{x:{form}}" for x in true]
    cells = list(map(opened_by_a_spreadsheet, texts))
    damaged = np.array([a != b for a, b in zip(cells, texts, strict=True)])
    found = column(cells)
    known = np.isfinite(found.values)
    assert damaged.sum() > 50
    assert np.array_equal(found.values[known], true[known])
    assert known[~damaged].all()
    assert known[damaged].mean() > 0.5
    assert any("decimal point in a spreadsheet, read with it again" in m for m, _ in found.remarks)


def test_a_number_that_does_not_follow_its_neighbours_is_left_empty_with_a_remark() -> None:
    texts = [f"{1.05 + 0.001 * i:.3f}" for i in range(40)]
    texts[20] = "2345"
    found = column(texts)
    assert np.isnan(found.values[20]) and np.isfinite(found.values).sum() == 39
    ((message, row),) = found.remarks
    assert row == 20 and "may have lost the decimal point" in message and "left empty" in message


@pytest.mark.parametrize(
    "texts",
    [
        [f"{x:g}" for x in 990.0 + 0.5 * np.arange(60)],  # 999.5, 1000, 1000.5
        [f"{x:g}" for x in 0.1 * np.arange(10001)],  # a clock until 1000 s
        [f"{x:g}" for x in 500.0 * np.arange(40)],
        ["0"] * 30 + ["1500"] * 30,
        ["0.0"] * 30 + ["1500.0"] * 30,
    ],
)
def test_true_numbers_from_1000_on_are_kept_without_a_remark(texts: list[str]) -> None:
    found = column(texts)
    assert np.array_equal(found.values, [float(text) for text in texts])
    assert not found.remarks


def test_a_leap_from_zero_is_kept_and_pointed_out() -> None:
    found = column(["0.5", "2.5"] * 15 + ["0.0", "1234", "0.0"])
    assert found.values[31] == 1234.0
    assert "kept" in found.remarks[0][0]


def test_a_number_for_missing_values_is_none_that_lost_its_point() -> None:
    texts = [f"{9.9 + 0.01 * i:.2f}" for i in range(40)]
    texts[20] = "9999"
    ((message, _),) = column(texts).remarks
    assert "stands for a missing value" in message


def test_a_table_names_the_row_and_the_first_cell(tmp_path) -> None:
    file = tmp_path / "log.csv"
    speeds = [f"{1.1 + 0.01 * i:.2f}" for i in range(40)]
    speeds[7] = "1171"
    lines = ["time;speed", *(f"{0.1 * i:.1f};{x}" for i, x in enumerate(speeds))]
    file.write_text("\n".join(lines) + "\n")
    log = read(file)
    assert log.signals["speed"].values[7] == 1.171
    assert log.remarks == (
        f"{file}: row 9, column speed: 1 cell lost the decimal point in a spreadsheet, read with "
        "it again, first '1171' = 1.171",
    )
