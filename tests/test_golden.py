"""No norm of a shipped scenario drifts unseen."""

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from alike import long, slow
from runs import found

from benchmarks import golden
from benchmarks.golden import (
    REACH,
    TOLERANCE,
    add_to_history,
    changes_of_metrics,
    main,
    path_of,
    scenarios_with_metrics,
    stored_values,
    update,
    values_to_store,
)
from boatsim.simulate.evaluation import Metric

STORED = [
    name
    for file in sorted(path_of("joystick_boat/sway_1").parent.glob("*.json"))
    for name in golden.read_values(file)
]
# Not the first ones of their families, but the only ones with this controller on this vessel
CONTROLLERS = ("jet_ski/yaw_disturbance_pd", "kynoc/seas_90_sliding_roll")
OLD = {
    "yaw_rate_inf": {
        "today": 0.5,
        "at_reported": 1.1,
        "published": 2.8,
        "verdict": "no tolerance stated",
        "unit": "deg/s",
    }
}


def with_today(value: float | None) -> golden.Values:
    return {"yaw_rate_inf": OLD["yaw_rate_inf"] | {"today": value}}


def family(name: str) -> tuple[str, str]:
    """Vessel and first word of a scenario's name."""
    vessel, _, rest = name.partition("/")
    return vessel, rest.partition("_")[0]


def marked_scenarios() -> list[Any]:
    """Scenarios with stored metrics, and when they are run.

    The tests of the thesis are always run. Of each family of other scenarios the first one is a
    slow test, and one with each controller of each vessel; the others are long ones.
    """
    families: dict[tuple[str, str], list[str]] = {}
    for name in STORED:
        families.setdefault(family(name), []).append(name)
    marked: list[Any] = []
    for name in STORED:
        if name.startswith("joystick_boat/"):
            marked.append(name)
        elif name == families[family(name)][0] or name in CONTROLLERS:
            marked.append(slow(name))
        else:
            marked.append(long(name))
    return marked


@pytest.mark.parametrize("name", marked_scenarios())
def test_norms_are_what_they_were_and_lie_within_their_bars(name: str) -> None:
    norms = found(name)[0]
    assert {n: (norm.value, norm.band) for n, norm in norms.items() if norm.ok is False} == {}
    lines = changes_of_metrics(name, stored_values(name), values_to_store(norms))
    assert not lines, "\n".join(
        [*lines, 'if this is wanted: python -m benchmarks.golden --update --reason "..."']
    )


def test_nothing_is_kept_of_scenarios_that_are_gone() -> None:
    files = sorted(path_of("joystick_boat/sway_1").parent.glob("*.json"))
    stored = {name for file in files for name in golden.read_values(file)}
    assert stored == set(scenarios_with_metrics()) and len(stored) >= 29
    assert [
        file for file in files if any(path_of(name) != file for name in golden.read_values(file))
    ] == []


def test_a_drift_is_a_line_with_scenario_norm_old_new_and_paper() -> None:
    (line,) = changes_of_metrics("joystick_boat/sway_1", OLD, with_today(0.7))
    assert line == "joystick_boat/sway_1 yaw_rate_inf: 0.5 -> 0.7 deg/s (paper: 2.8)"


def test_drift_begins_at_the_tolerance() -> None:
    assert changes_of_metrics("x", OLD, with_today(0.5 * (1 + 0.9 * TOLERANCE))) == []
    assert len(changes_of_metrics("x", OLD, with_today(0.5 * (1 + 1.1 * TOLERANCE)))) == 1


def test_norms_that_come_go_or_lose_their_value_are_drifts() -> None:
    assert changes_of_metrics("x", {}, OLD) == ["x yaw_rate_inf is new"]
    assert changes_of_metrics("x", OLD, {}) == ["x yaw_rate_inf is gone"]
    assert changes_of_metrics("x", OLD, with_today(None)) == [
        "x yaw_rate_inf: 0.5 -> None deg/s (paper: 2.8)"
    ]


@pytest.mark.parametrize("reason", [[], ["--reason", ""], ["--reason", " \n"]])
def test_an_update_without_a_reason_is_refused(
    reason: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["--update", *reason]) == 2
    assert capsys.readouterr().err == '--update needs --reason "why the metrics changed"\n'


def test_an_update_writes_the_values_and_the_reason(tmp_path: Path) -> None:
    history = tmp_path / "tests" / "golden" / "HISTORY.md"
    history.parent.mkdir(parents=True)
    history.write_text("# History\n\nWhat it is.\n\n- older reason\n  - old line\n")
    new = with_today(0.7)
    update(
        {"boat/one": (new, changes_of_metrics("boat/one", OLD, new))},
        "servo lag corrected",
        tmp_path,
    )
    other = {"moved": OLD["yaw_rate_inf"]}
    update({"boat/two": (other, ["boat/two moved is new"])}, "another", tmp_path)
    assert json.loads(path_of("boat/one", tmp_path).read_text())["seed"] == 0
    assert stored_values("boat/two", tmp_path) == other
    assert changes_of_metrics("boat/one", stored_values("boat/one", tmp_path), new) == []
    assert history.read_text() == (
        "# History\n\nWhat it is.\n\n- another\n  - 1 new metrics\n- servo lag corrected\n"
        "  - boat/one yaw_rate_inf: 0.5 -> 0.7 deg/s (paper: 2.8)\n- older reason\n  - old line\n"
    )


def test_an_empty_history_gets_its_first_entry() -> None:
    assert add_to_history("# History\n", "first values", ["a b is new", "a c is new"]) == (
        "# History\n\n- first values\n  - 2 new metrics\n"
    )


def test_what_is_kept_of_a_norm_survives_the_file() -> None:
    norm = Metric(1 / 3, "m", 0.07, 0.05, (0.0, 1.0), True, 2 / 3, 0.01)
    stored = json.loads(json.dumps(values_to_store({"moved": norm})))
    assert stored == {
        "moved": {
            "today": 0.333333333,
            "at_reported": 0.666666667,
            "published": 0.07,
            "verdict": "not reproduced",
            "unit": "m",
        }
    }


def test_of_a_loop_that_runs_away_only_what_goes_beyond_its_own_restlessness_is_a_drift() -> None:
    old = {"yaw_rate_inf": OLD["yaw_rate_inf"] | {"moves": 0.1}}
    assert changes_of_metrics("x", old, with_today(0.5 + 0.9 * REACH * 0.1)) == []
    assert len(changes_of_metrics("x", old, with_today(0.5 + 1.1 * REACH * 0.1))) == 1


def test_how_far_starts_beside_it_end_is_kept_where_it_is_more_than_arithmetic() -> None:
    norm = Metric(2.0, "m", None, None, None, None, None, None)
    assert (
        "moves"
        not in values_to_store({"moved": norm}, [{"moved": replace(norm, value=2.0 + 1e-9)}])[
            "moved"
        ]
    )
    near = [{"moved": replace(norm, value=x)} for x in (2.1, 1.7)]
    assert values_to_store({"moved": norm}, near)["moved"]["moves"] == pytest.approx(0.3)
