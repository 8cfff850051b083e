"""Texts of reports: odds and words."""

import math
from types import SimpleNamespace
from typing import Any

import pytest

from boatsim.diagnosis.report import page
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


def test_a_long_answer_without_names_has_its_first_sentence_as_the_headline() -> None:
    first = "A force is missing that no candidate effect explains (33 N rms in surge)."
    rest = "Seven numbers of the rough model were refined. " * 6
    answer = {"sentence": f"{first} {rest.strip()}", "effects": [], "described": []}
    findings: Any = SimpleNamespace(answer={**answer, "unknown": {"flag": True}}, words={})
    assert page._headline(findings) == first
    assert page._lead(findings) == rest.strip()
