"""The ranking says why a candidate with small odds is no cause, and a limit what it is a limit of."""

import re
from dataclasses import replace

import pytest

from boatsim.diagnosis.answer.findings import Findings
from boatsim.diagnosis.report.candidate_sections import (
    candidate_ranking_section,
    upper_limits_section,
)
from boatsim.diagnosis.report.experiment_section import is_optional, next_experiment_section
from boatsim.diagnosis.report.figures import missing_force_figures
from boatsim.view.page_blocks import Table, Text
from tests.diagnosis.report.test_page import planar


def sure(probability: float = 0.97, **changes: object) -> Findings:
    """The findings of a made-up diagnosis whose only effect has no look-alike."""
    findings = planar()
    effect = {**findings.answer["effects"][0], "tied_with": [], "probability": probability}
    answer = {**findings.answer, "verdict": "named", "effects": [effect], **changes}
    gains = dict.fromkeys((c["name"] for c in findings.answer["candidates"]), 0.1)
    return replace(findings, answer=answer, further_gains=gains)  # type: ignore


def verdicts(findings: Findings) -> dict[str, str]:
    """The verdicts of the ranking, by candidate."""
    [best, *_] = candidate_ranking_section(findings)
    assert isinstance(best, Table)
    return {row[0]: row[best.header.index("verdict")] for row in best.rows}


def test_a_candidate_for_which_the_identified_effect_leaves_nothing_has_that_verdict() -> None:
    found = verdicts(sure())
    assert found["weak reverse"] == "identified"
    assert found["thrust imbalance"] == "weak reverse explains the recordings better"
    assert found["wind"] == "too little evidence"  # 3.04 nats, of the 4 that are required
    assert found["steering offset"] == ""  # its odds already say that the fit may be chance


@pytest.mark.parametrize("skipped", [[], ["12 candidates were not tested with weak_reverse"]])
def test_no_reason_is_given_that_was_not_tested(skipped: list[str]) -> None:
    findings = sure(skipped=skipped)
    if not skipped:
        findings = replace(findings, further_gains={"thrust_imbalance": 9.0})
    assert verdicts(findings)["thrust imbalance"] == ""


def test_the_evidence_of_a_quick_fit_that_may_have_failed_is_no_number() -> None:
    findings = sure()
    answer = findings.answer | {
        "candidates": [
            {"name": "weak_reverse", "gain_nats": 63.4, "probability": 1.0},
            {"name": "tether", "gain_nats": -975.0, "probability": 0.0},
        ]
    }
    [_, statistics, _] = candidate_ranking_section(replace(findings, answer=answer))  # type: ignore
    assert isinstance(statistics, Table)
    assert [row[1] for row in statistics.rows] == ["63.4", "below −8.0"]


def test_the_limit_of_an_effect_of_the_vessel_file_is_a_distance_from_it() -> None:
    [table] = upper_limits_section(replace(planar(), own_effects=frozenset({"thrust_lag"})))
    assert isinstance(table, Table)
    limits = {row[0]: row[1] for row in table.rows}
    assert limits["thrust lag"] == "time constant 0.11 s more or less than in the vessel file"
    assert limits["wind"] == "force 0.041 N"


def test_an_experiment_is_optional_only_if_the_answer_is_sure_and_it_tests_the_answer() -> None:
    assert is_optional(sure())
    assert not is_optional(sure(0.6))
    assert not is_optional(planar())  # the effect has a look-alike
    assert not is_optional(sure(also_possible=[{"name": "wind"}]))
    assert not is_optional(sure(next_experiment={}))
    other = {**planar().answer["next_experiment"], "separates": ["wind", "current"]}
    assert not is_optional(sure(next_experiment=other))


@pytest.mark.parametrize(("probability", "optional"), [(0.97, True), (0.6, False)])
def test_the_section_on_the_next_experiment_says_whether_it_is_needed(
    probability: float, optional: bool
) -> None:
    texts = [b.words for b in next_experiment_section(sure(probability)) if isinstance(b, Text)]
    assert any("is optional" in text for text in texts) == optional


def test_a_force_near_zero_lies_inside_the_plot_of_a_large_positive_force() -> None:
    [curve, *_] = planar().missing
    t = curve.t
    large = {axis: 0.0 * t + 0.2 for axis in curve.force}
    none = {axis: 0.0 * t for axis in curve.force}
    small = {axis: 0.0 * t + 0.001 for axis in curve.force}
    made_up = replace(curve, force=large, sd=small, left=none)
    [drawn] = missing_force_figures([made_up], [], [made_up])
    zeros = re.findall(r'class="y" style="bottom:([\d.]+)%">0<', drawn)
    assert len(zeros) == len(curve.force)
    assert all(float(zero) > 2.0 for zero in zeros)  # per cent of the height of the panel


@pytest.mark.parametrize(
    ("findings", "begins"),
    [
        (sure(next_experiment={}), "These recordings decide the question"),
        (sure(0.6, next_experiment={}), "No further recording of this kind settles"),
    ],
)
def test_without_an_experiment_the_section_says_whether_the_question_is_decided(
    findings: Findings, begins: str
) -> None:
    [text] = next_experiment_section(findings)
    assert isinstance(text, Text) and text.words.startswith(begins)


def test_an_unknown_cause_is_sought_by_changing_one_thing_at_a_time() -> None:
    flagged = planar().answer["unknown"] | {"flag": True}
    texts = [b.words for b in next_experiment_section(sure(unknown=flagged)) if isinstance(b, Text)]
    assert any("one thing changed at a time" in text for text in texts)
    texts = [b.words for b in next_experiment_section(sure()) if isinstance(b, Text)]
    assert not any("one thing changed at a time" in text for text in texts)
