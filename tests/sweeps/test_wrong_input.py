"""Expressions of a sweep and journals that cannot be used, each refused in one line."""

import json
import os
from pathlib import Path
from typing import Any

import pytest

from boatsim.errors import BadInput
from boatsim.simulate.cases import read_scenario
from boatsim.sweeps.axes import parse_axis
from boatsim.sweeps.entries import DiagnosisEntry, RunEntry
from boatsim.sweeps.journal import NAME, Journal
from boatsim.sweeps.keys import find_target_values, parse_target
from boatsim.sweeps.sampled_keys import parse_sampled_key

MANY = "9" * 400
ABOUT = {"of": "one"}


@pytest.mark.parametrize("values", [f"{MANY}:1:3", f"0:{MANY}:3", f"0:1:{MANY}", f"{MANY},1"])
def test_a_number_of_400_digits_is_no_value_of_an_axis(values: str) -> None:
    with pytest.raises(BadInput, match="integer of 400 digits; allowed are 18"):
        parse_axis(f"body.mass={values}")


def test_a_range_whose_width_is_infinite_is_refused() -> None:
    with pytest.raises(BadInput, match="difference is a number"):
        parse_axis("body.mass=-1e308:1e308:3")


@pytest.mark.parametrize("numbers", [f"{MANY}, 1", f"0, {MANY}", "true, 1", "nan, 1", "0, 1e400"])
def test_such_a_number_is_none_of_a_distribution(numbers: str) -> None:
    with pytest.raises(BadInput, match="400 digits|takes numbers: mean, sd"):
        parse_sampled_key(f"body.mass=normal({numbers})")


@pytest.mark.parametrize("number", ["²", "9" * 5000, "0", "-1"])
def test_a_number_of_a_goal_is_one_that_exists(number: str) -> None:
    table, place = read_scenario("joystick_boat/berth")
    with pytest.raises(BadInput, match="goal"):
        find_target_values(table, place, parse_target(f"goal.{number}.sway_mps"))


ENTRY = {"run": 0, "failure": None, "met": None, "norms": {"a": [1.0, "m"]}}
NAMED = {"run": 0, "failure": None, "verdict": "named", "causes": ["a"], "values": {}, "rms": {}}


@pytest.mark.parametrize(
    ("form", "entry", "said"),
    [
        (RunEntry, [], "input should be an object"),
        (RunEntry, 3, "input should be an object"),
        (RunEntry, {"failure": None}, "run is missing"),
        (RunEntry, {"run": 0}, "failure is missing"),
        (RunEntry, {**ENTRY, "run": "0"}, "run = '0'"),
        (RunEntry, {**ENTRY, "run": -1}, "run = -1"),
        (RunEntry, {**ENTRY, "run": 4}, "run = 4; there are 4"),
        (RunEntry, {**ENTRY, "run": 10**400}, "run = 1000"),
        (RunEntry, {**ENTRY, "failure": 3}, "failure = 3"),
        (RunEntry, {**ENTRY, "norms": [1]}, "norms = [1]"),
        (RunEntry, {**ENTRY, "norms": {"a": 1.0}}, "norms.a = 1.0"),
        (RunEntry, {**ENTRY, "norms": {"a": ["1", "m"]}}, "norms.a.0 = '1'"),
        (RunEntry, {**ENTRY, "norms": {"a": [float("nan"), "m"]}}, "norms.a.0 = nan"),
        (DiagnosisEntry, {"run": 0, "failure": None}, "verdict is missing"),
        (DiagnosisEntry, {**NAMED, "values": {"a": [None, ""]}}, "values.a.0 = None"),
        (DiagnosisEntry, {**NAMED, "causes": "a"}, "causes = 'a'"),
    ],
)
def test_a_damaged_entry_of_a_journal_is_named_by_its_line(
    tmp_path: Path, form: Any, entry: object, said: str
) -> None:
    good = {"run": 1, "failure": "diverged"}
    lines = [ABOUT, good, entry, good]
    before = "".join(f"{json.dumps(line)}\n" for line in lines)
    (tmp_path / NAME).write_text(before)
    with pytest.raises(BadInput) as error:
        Journal(tmp_path, ABOUT, form, 4)
    text = str(error.value)
    assert f"{NAME}, line 3: " in text and said in text and "delete the line" in text
    assert "\n" not in text and (tmp_path / NAME).read_text() == before


@pytest.mark.parametrize("first", ["[]", "3", "null", '"a"', "[" * 100_000])
def test_a_first_line_that_is_no_definition_is_no_journal(tmp_path: Path, first: str) -> None:
    (tmp_path / NAME).write_text(f"{first}\n")
    with pytest.raises(BadInput, match="is not a journal of boatsim"):
        Journal(tmp_path, ABOUT)


def test_a_named_pipe_is_no_journal(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / NAME)
    with pytest.raises(BadInput, match="is no regular file"):
        Journal(tmp_path, ABOUT)
