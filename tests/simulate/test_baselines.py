"""`boatsim test`: a folder's metrics have baselines, a change is named, every bad file is listed,
machines can read it."""

import json
import tomllib
import xml.etree.ElementTree as xml
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from boatsim.cli import app
from boatsim.simulate.baselines import (
    TOLERANCE,
    Baseline,
    BaselinesFile,
    compare_with_baselines,
    make_baselines,
    read_baselines,
    to_toml,
)
from boatsim.simulate.evaluation import Metric

SCENARIO = """
vessel = "joystick_boat"
load = ["light", "narrow"]
duration = 2.0
[controller]
use = "l1_joystick"
[[goal]]
sway_mps = 0.07
"""


def boatsim(*arguments: object) -> Any:
    """The command run in this process: exit_code, stdout, stderr."""
    return CliRunner().invoke(app, [str(a) for a in arguments], catch_exceptions=False)


def norm(value: float | None) -> Metric:
    return Metric(value, "m")


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """One scenario with baselines."""
    home = tmp_path / "mine"
    home.mkdir()
    (home / "sway.toml").write_text(SCENARIO)
    assert boatsim("test", home, "--pin", "--seeds", 2).exit_code == 0
    return home


def test_the_same_folder_gives_the_same_pins_and_nothing_differs(folder: Path) -> None:
    before = (folder / "pins.toml").read_bytes()
    assert boatsim("test", folder).exit_code == 0
    assert boatsim("test", folder, "--pin", "--seeds", 2).exit_code == 0
    assert (folder / "pins.toml").read_bytes() == before


def test_a_change_of_the_boat_is_named_with_old_and_new_value_and_leaves_with_1(
    folder: Path,
) -> None:
    old = read_baselines(folder)
    assert old is not None
    (folder / "sway.toml").write_text(SCENARIO.replace("light", "heavy"))
    result = boatsim("test", folder)
    assert result.exit_code == 1
    pin = old.scenario["sway.toml"]["sway_error_rms"]
    assert f"sway.toml: sway_error_rms: {pin.value:.6g} -> " in result.stdout
    assert boatsim("test", folder, "--pin").exit_code == 0
    assert boatsim("test", folder).exit_code == 0


def test_every_bad_file_is_listed_and_the_good_ones_run(folder: Path) -> None:
    (folder / "bad.toml").write_text("vesel = 1")
    (folder / "worse.toml").write_text("[")
    result = boatsim("test", folder)
    assert result.exit_code == 2
    assert [line.split(":")[1].split("/")[-1].strip() for line in result.stderr.splitlines()] == [
        "bad.toml",
        "worse.toml",
    ]
    assert "as baseline" in result.stdout


def test_new_and_missing_scenarios_differ(folder: Path) -> None:
    (folder / "sway.toml").rename(folder / "other.toml")
    result = boatsim("test", folder)
    assert result.exit_code == 1
    assert "other.toml: has no baseline" in result.stdout
    assert "sway.toml: sway_error_rms has a baseline and is not computed any more" in result.stdout


def test_a_file_that_can_not_be_read_keeps_its_pins(folder: Path) -> None:
    before = tomllib.loads((folder / "pins.toml").read_text())["scenario"]
    (folder / "sway.toml").write_text("[")
    assert boatsim("test", folder, "--pin").exit_code == 2
    assert tomllib.loads((folder / "pins.toml").read_text())["scenario"] == before


def test_a_missed_guard_differs_though_it_is_pinned(folder: Path) -> None:
    (folder / "sway.toml").write_text(SCENARIO + "[norms.sway_error_rms]\nguard = [0.0, 1e-9]\n")
    result = boatsim("test", folder, "--pin")
    assert result.exit_code == 1 and "outside its regression band" in result.stdout


def test_junit_counts_its_cases_and_json_says_what_the_table_does(folder: Path) -> None:
    (folder / "odd \u0001 <&>.toml").write_text("vesel = 1")
    (folder / "sway.toml").write_text(SCENARIO.replace("light", "heavy"))
    result = boatsim("test", folder, "--json", "--junit", folder / "junit.xml")
    top = xml.parse(folder / "junit.xml").getroot()
    (suite,) = top
    assert (top.tag, suite.tag) == ("testsuites", "testsuite")
    for element in (top, suite):
        assert [element.get(k) for k in ("tests", "failures", "errors")] == ["2", "1", "1"]
    assert {case.get("name"): [child.tag for child in case] for case in suite} == {
        "odd \\x01 <&>.toml": ["error"],
        "sway.toml": ["failure"],
    }
    said = json.loads(result.stdout)
    assert said["exit"] == result.exit_code == 2
    assert [one["exit"] for one in said["scenarios"]] == [2, 1]
    entry = said["scenarios"][1]["norms"]["sway_error_rms"]
    assert abs(entry["value"] - entry["pin"]["value"]) > entry["pin"]["tolerance"]


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["nowhere"], "nowhere is not a folder"),
        ([".", "--seeds", "3"], "only with --pin"),
        (["."], "no scenario"),
    ],
)
def test_wrong_use_is_one_line(
    arguments: list[str], said: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    result = boatsim("test", *arguments)
    assert result.exit_code == 2 and said in result.stderr and len(result.stderr.splitlines()) == 1


def test_a_tolerance_spans_the_seeds_and_is_never_less_than_arithmetic() -> None:
    pins = make_baselines(
        [
            {"a": norm(2.0), "b": norm(1.0)},
            {"a": norm(2.3), "b": norm(1.0)},
            {"a": norm(1.9), "b": norm(None)},
        ]
    )
    assert pins["a"] == Baseline(value=2.0, unit="m", tolerance=0.4)
    assert pins["b"] == Baseline(value=1.0, unit="m", tolerance=TOLERANCE)


def test_drift_begins_at_the_tolerance_and_a_norm_that_is_lost_is_one() -> None:
    pins = {"a": Baseline(value=2.0, unit="m", tolerance=0.4)}
    assert compare_with_baselines(pins, {"a": norm(2.39)}) == []
    assert compare_with_baselines(pins, {"a": norm(2.41)}) == ["a: 2 -> 2.41 m (+- 0.4)"]
    assert compare_with_baselines(pins, {"a": Metric(None, "m", lacking="not reached: why")}) == [
        "a: 2 -> not reached: why m (+- 0.4)"
    ]
    assert compare_with_baselines(pins, {}) == [
        "a has a baseline and is not computed any more"
    ] and compare_with_baselines({}, {"a": norm(1.0)}) == ["a has no baseline"]


def test_pins_survive_their_file(tmp_path: Path) -> None:
    pins = BaselinesFile(
        seeds=3,
        scenario={
            'a "b".toml:c': {"x_1": Baseline(value=1e-12, unit="1/s"), "y": Baseline(unit="°")}
        },
    )
    (tmp_path / "pins.toml").write_text(to_toml(pins), encoding="utf-8")
    assert read_baselines(tmp_path) == pins
