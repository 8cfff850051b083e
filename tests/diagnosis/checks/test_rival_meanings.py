"""Reinterpretations of a log that fit about as well as the best one are its alternatives."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from boatsim.diagnosis.checks.finding import Finding, scaling_corrections
from boatsim.diagnosis.checks.hypothesis_test import Comparison, Score, _clear_finding
from boatsim.diagnosis.checks.reinterpretations import Reinterpretation
from boatsim.diagnosis.config import DEFAULT
from boatsim.recordings.notes import Notes
from boatsim.recordings.table import Recording

ROWS = 100


def meaning(name: str, column: str) -> Reinterpretation:
    return Reinterpretation(name, f"{column} is reversed", scaling_corrections([column], -1.0))


def finding(agrees: bool = True, fix: str = "", **evidence: float) -> Finding | None:
    """The finding where reversed columns have this evidence, and the log as recorded has 0 nats.

    Simulations agree with every reversed column, or with none.
    """
    scored = [(meaning(name, name), Score(value, 0.1)) for name, value in evidence.items()]
    program = SimpleNamespace(vessel=SimpleNamespace(name="boat"))
    comparison: Any = SimpleNamespace(
        config=DEFAULT.checks,
        problem=SimpleNamespace(program=program),
        simulations_agree=lambda recordings, changes: agrees,
    )
    notes = Notes(facts={"position_fix": fix} if fix else {})
    recordings = [Recording("run", np.arange(float(ROWS)), {"psi_rad": np.zeros(ROWS)}, notes)]
    return _clear_finding(scored, Score(0.0, 0.5), recordings, comparison)


@pytest.mark.parametrize(
    ("evidence", "chosen", "others", "words"),
    [
        # equally good ones keep their order, and rivals follow by evidence
        ({"r": 99.0, "y": 100.0}, "r", ["y"], "equally well: y is reversed"),
        ({"r": 90.0, "y": 100.0}, "y", ["r"], "almost as well: r is reversed"),
        ({"r": 90.0, "v": 95.0, "y": 100.0}, "y", ["v", "r"], "almost as well: v is reversed"),
        ({"r": 70.0, "y": 100.0}, "y", [], ""),
    ],
)
def test_rivals_are_alternatives(
    evidence: dict[str, float], chosen: str, others: list[str], words: str
) -> None:
    found = finding(**evidence)
    assert found is not None and found.name == chosen
    assert [alternative for alternative, _ in found.alternatives] == [
        f"{name} is reversed" for name in others
    ]
    assert words in found.evidence
    assert bool(others) == ("Another fault" in found.evidence or "another fault" in found.evidence)


@pytest.mark.parametrize(
    ("fix", "y_evidence", "chosen", "words"),
    [
        ("gnss", 100.0, "r", "it is less likely: a satellite receiver measured the positions"),
        ("camera", 100.0, "y_m", "The log does not show which"),
        ("", 100.0, "y_m", "The log does not show which"),
        ("gnss", 110.0, "y_m", "almost as well: r is reversed"),  # the log shows it
    ],
)
def test_positions_of_satellites_decide_between_equally_good_ones(
    fix: str, y_evidence: float, chosen: str, words: str
) -> None:
    found = finding(fix=fix, y_m=y_evidence, r=100.0)
    assert found is not None and found.name == chosen
    assert words in found.evidence
    assert len(found.alternatives) == 1


def test_a_small_gain_over_the_log_as_recorded_is_no_finding() -> None:
    assert finding(r=DEFAULT.checks.compare_min_gain - 1.0) is None


def test_a_meaning_with_which_simulations_are_no_better_is_no_finding() -> None:
    assert finding(agrees=False, r=90.0, y=100.0) is None


@pytest.mark.parametrize(
    ("recorded", "changed", "agrees"),
    [
        ({"position": 1.0, "heading": 1.0}, {"position": 0.5, "heading": 1.1}, True),
        ({"position": 1.0, "heading": 1.0}, {"position": 0.99, "heading": 1.0}, False),
        ({"position": 1.0, "heading": 1.0}, {"position": 0.5}, False),  # the heading diverges
        ({}, {}, True),  # too short for a simulation
    ],
)
def test_simulations_decide_between_meanings_by_their_errors(
    recorded: dict[str, float],
    changed: dict[str, float],
    agrees: bool,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    errors = iter((recorded, changed))
    monkeypatch.setattr(Comparison, "problem_with_changes", lambda *_: None)
    monkeypatch.setattr(Comparison, "_simulation_errors", lambda *_: next(errors))
    problem: Any = SimpleNamespace(config=DEFAULT)
    nothing: Any = None
    assert Comparison(problem, nothing, DEFAULT.checks).simulations_agree([], ()) is agrees
