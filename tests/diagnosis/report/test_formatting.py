"""Texts of reports: odds and words."""

import math

import pytest

from boatsim.view.formatting import capitalize, format_odds


@pytest.mark.parametrize(
    ("nats", "odds"),
    [
        (0.5, "the better fit may be chance"),
        (4.0, "1 in 55 that the better fit is chance"),
        (math.log(9.9e5), "1 in 990,000 that the better fit is chance"),
        (14.0, "less than 1 in a million that the better fit is chance"),
        (1e7, "less than 1 in a million that the better fit is chance"),
    ],
)
def test_odds_are_stated_as_far_as_a_recording_can_show_them(nats: float, odds: str) -> None:
    assert format_odds(nats) == odds


def test_a_sentence_begins_with_a_capital_but_a_column_keeps_its_name() -> None:
    assert capitalize("the heading is late") == "The heading is late"
    assert capitalize("x_m, y_m were logged late") == "x_m, y_m were logged late"
