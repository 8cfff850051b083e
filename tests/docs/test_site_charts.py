"""The charts of the site: they have the numbers of the tables of their page."""

import re

import pytest

from tests.pages import ROOT, results_charts

PAGE = (ROOT / "docs" / "results.md").read_text(encoding="utf-8")
CALIBRATION = ("## Calibration of the stated probabilities", "### 1,000 logs with other weights")


@pytest.mark.parametrize("name", results_charts.draw_all(PAGE, in_file=True))
def test_a_chart_in_the_repository_is_drawn_from_the_tables_of_its_page(name: str) -> None:
    drawn = results_charts.draw_all(PAGE, in_file=True)[name]
    file = results_charts.FOLDER / f"{name}.svg"
    redraw = "run python docs/_ext/results_charts.py"
    assert file.read_text(encoding="utf-8") == f"{drawn}\n", redraw
    assert f"(charts/{name}.svg)" in PAGE


@pytest.mark.parametrize("heading", CALIBRATION)
def test_the_interval_of_a_bar_is_the_one_printed_in_the_table(heading: str) -> None:
    printed = 0
    for _, here, _ in results_charts.table_below(PAGE, heading, "| figure | here | goal |"):
        for found in re.finditer(r"(\d+) of (\d+) \(([\d.]+) to ([\d.]+)\)", here):
            low, high = results_charts.wilson_interval(int(found[1]), int(found[2]))
            assert (low, high) == pytest.approx((float(found[3]), float(found[4])), abs=6e-4)
            printed += 1
    assert printed >= 5


def test_a_bar_meets_a_low_goal_from_below_and_a_high_goal_from_above() -> None:
    rates = {rate.label: rate for rate in results_charts.rates(PAGE, CALIBRATION[0])}
    flagged = rates["visible unknown causes flagged, steered by a pilot"]
    assert (flagged.cases, flagged.of, flagged.goal) == (90, 91, 0.9)
    for cases, of, goal, met in ((9, 10, 0.9, True), (8, 10, 0.9, False), (0, 10, 0.0, True)):
        bar = results_charts.rate_bar(results_charts.Rate("", cases, of, goal))
        assert bar.met is met
    assert results_charts.rate_bar(results_charts.Rate("", 1, 10, 0.05)).met is False


def test_the_ratio_of_a_goal_with_a_unit_is_that_of_the_errors() -> None:
    bars = {bar.label: bar for bar in results_charts.real_bars(PAGE)}
    oscillator = bars["silverbox: one free run over the whole arrow test"]
    assert oscillator.goal == pytest.approx(1.0 / 14.568)
    assert bars["kvlcc2_roll_decay: every second 20 s window, held out"].goal == 0.3
    assert len(bars) >= 10
