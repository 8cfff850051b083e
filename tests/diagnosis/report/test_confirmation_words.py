"""The report states what each effect alone does to held-out errors, and why a file is not changed."""

from dataclasses import replace
from typing import Any

import pytest

from boatsim.diagnosis.answer.confirmation import effect_error_entry
from boatsim.diagnosis.answer.findings import Findings
from boatsim.diagnosis.answer.schema import (
    AddedEntry,
    Answer,
    PossibleEntry,
    RecalibrationEntry,
)
from boatsim.diagnosis.answer.verdict import verdict_sentences
from boatsim.diagnosis.open_set.confirmation import Errors
from boatsim.diagnosis.report.confirmation import effect_sentences, recalibration_sentences
from boatsim.diagnosis.report.page import report_html, report_markdown
from boatsim.diagnosis.report.sections import report_sections
from boatsim.diagnosis.report.sentences import console_lines
from tests.diagnosis.report.test_page import planar

ERRORS = {
    "position_rms_m": Errors(0.52, 0.31),
    "heading_rms_rad": Errors(0.05, 0.06),
    "roll_rms_rad": Errors(0.02, 0.02),
}
STATEMENT = (
    "On held-out data adding it reduces the position error from 52.0 cm to 31.0 cm, increases the "
    "heading error from 2.86° to 3.44° and does not change the roll error (1.15°)."
)


def confirmed(value: bool) -> Findings:
    """The findings of a made-up diagnosis, with the errors of its effect alone."""
    findings = planar()
    effect = {
        **findings.answer["effects"][0],
        "alone": effect_error_entry(ERRORS),
        "confirmed": value,
    }
    return replace(findings, answer={**findings.answer, "effects": [effect]})  # type: ignore


def prop_walk(in_patch: bool) -> PossibleEntry:
    """An effect that is only possible."""
    return {
        "name": "prop_walk",
        "probability": 0.2,
        "gain_nats": 9.0,
        "words": "the propellers push the stern sideways",
        "why": "several weak signs",
        "in_patch": in_patch,
    }


def everywhere(findings: Findings) -> list[str]:
    """What the terminal, the page and the Markdown file show."""
    sections = report_sections(findings)
    pages = [report_html(findings, sections), report_markdown(findings, sections)]
    return ["\n".join(console_lines(findings)), *pages]


def test_each_effect_has_a_sentence_on_what_it_alone_does() -> None:
    findings = confirmed(True)
    assert effect_sentences(findings.answer["effects"][0]) == [STATEMENT]
    for text in everywhere(findings):
        assert STATEMENT in text and "neither confirm" not in text


def test_an_effect_that_held_out_recordings_do_not_confirm_is_marked() -> None:
    for text in everywhere(confirmed(False)):
        assert "Held-out recordings neither confirm nor contradict it" in text


@pytest.mark.parametrize(
    ("entry", "expected"),
    [
        (
            {"adopted": False, "undetermined": [], "refitted": {"position_rms_m": 0.2}},
            "The retuned vessel has the coefficients of the vessel file, because refitted "
            "ones are worse on held-out data: 20.0 cm in position instead of 14.2 cm.",
        ),
        (
            {"adopted": True, "undetermined": ["linear_damping.sway"], "refitted": {}},
            "The retuned vessel keeps these numbers of the vessel file, because the recordings "
            "do not determine them well enough: linear damping (sway).",
        ),
        (
            {"adopted": True, "undetermined": [], "refitted": {}},
            "The corrected vessel is the retuned one: it would predict the held-out recordings "
            "worse with what is also possible (prop walk).",
        ),
        (
            {"adopted": True, "undetermined": [], "refitted": {}, "by_free_runs": True},
            "Because the cause of a force is unknown, the numbers of the retuned vessel were fitted "
            "to simulations of the fitted recordings with the recorded commands alone; held-out "
            "recordings are predicted better so.",
        ),
    ],
)
def test_coefficients_and_effects_that_are_not_adopted_are_stated(
    entry: RecalibrationEntry, expected: str
) -> None:
    findings = planar()
    possible = prop_walk(in_patch="corrected vessel is" not in expected)
    answer: Answer = {**findings.answer, "recalibration": entry, "also_possible": [possible]}
    findings = replace(findings, answer=answer)
    assert recalibration_sentences(findings)[0] == expected
    for text in everywhere(findings):
        assert expected in text


@pytest.mark.parametrize(
    ("in_patch", "expected"),
    [
        (True, "the numbers of the retuned and corrected vessel were fitted to simulations"),
        (False, "It does not have prop walk: simulations are at least as good without it."),
    ],
)
def test_what_the_fit_to_simulations_changes_is_stated(in_patch: bool, expected: str) -> None:
    findings = planar()
    entry: RecalibrationEntry = {
        "adopted": True,
        "undetermined": [],
        "refitted": {},
        "by_free_runs": True,
    }
    possible = prop_walk(in_patch=in_patch)
    answer: Answer = {
        **findings.answer,
        "recalibration": entry,
        "also_possible": [possible],
        "by_free_runs": True,
    }
    assert expected in " ".join(recalibration_sentences(replace(findings, answer=answer)))


@pytest.mark.parametrize(
    ("names", "expected"),
    [
        (
            ["weak_reverse"],
            "“meaning of weak_reverse”: simulations get better by it, but it is not",
        ),
        (
            ["weak_reverse", "prop_walk"],
            "“meaning of weak_reverse” and “meaning of prop_walk”: simulations get better by them",
        ),
    ],
)
def test_effects_added_for_predictions_are_listed_and_not_called_causes(
    names: list[str], expected: str
) -> None:
    findings = planar()
    added: list[AddedEntry] = []
    for name in names:
        added.append(
            {
                "name": name,
                "kind": "physics",
                "words": f"meaning of {name}",
                "parameters": {"factor": {"value": 0.61, "sd": 0.04, "unit": ""}},
            }
        )
    findings = replace(findings, answer={**findings.answer, "added": added})
    assert f"For predictions, the corrected vessel also contains {expected}" in verdict_sentences(
        findings.answer
    )
    sections = report_sections(findings)
    for page in (report_html(findings, sections), report_markdown(findings, sections)):
        assert "They may stand in for other causes." in page
        for name in names:
            assert f"Meaning of {name}" in page.replace("\\_", "_")
        assert "0.610 ± 0.040" in page


def test_an_added_effect_is_stated_with_its_group_and_its_bound() -> None:
    added: Any = {
        "name": "camera_scale@5 March",
        "group": "5 March",
        "kind": "measurement",
        "words": "in group 5 March, the positions are scaled (not physics)",
        "parameters": {"x_fraction": {"value": -0.4, "sd": 0.02, "unit": "", "at_bound": True}},
    }
    answer = planar().answer | {"added": [added]}
    expected = (
        "“in group 5 March, the positions are scaled” (at the bound of its range): simulations"
    )
    assert expected in verdict_sentences(answer)


def test_a_possible_effect_is_stated_with_a_formula_or_without_if_held_out_recordings_confirm_it() -> (
    None
):
    findings = planar()
    law: Any = {
        "axis": "sway",
        "statement": "a side force that no candidate effect explains",
        "terms": [{"of": "yaw rate", "value": 3.0, "sd": 0.2, "unit": "N s", "gain_nats": 40.0}],
        "carries_over": True,
    }
    possible: Any = {
        "name": "quay",
        "probability": 0.02,
        "gain_nats": 200.0,
        "words": "the hull touches a quay or another fixed wall",
        "why": "so much remains",
        "in_patch": True,
        "confirmed": True,
    }
    stated = "The corrected vessel contains “the hull touches a quay or another fixed wall”"
    for entry, described, unexplained, expected in (
        (possible, [law], True, True),
        ({**possible, "confirmed": False}, [law], True, False),
        ({**possible, "in_patch": False}, [law], True, False),
        (possible, [], True, True),
        (possible, [], False, False),
    ):
        answer: Answer = {
            **findings.answer,
            "described": described,
            "also_possible": [entry],
            "added": [],
            "unknown": {**findings.answer["unknown"], "flag": unexplained},
        }
        assert (stated in verdict_sentences(answer)) == expected


def test_a_corrected_vessel_of_possible_or_added_effects_is_compared_with_the_retuned_one() -> None:
    findings = planar()
    bare: Answer = {**findings.answer, "effects": [], "described": [], "also_possible": []}
    added: AddedEntry = {"name": "wind", "kind": "physics", "words": "wind", "parameters": {}}
    possible, dropped = prop_walk(in_patch=True), prop_walk(in_patch=False)
    assert not replace(findings, answer=bare).has_added_effects
    assert replace(findings, answer={**bare, "added": [added]}).has_added_effects
    assert replace(findings, answer={**bare, "also_possible": [possible]}).has_added_effects
    assert not replace(findings, answer={**bare, "also_possible": [dropped]}).has_added_effects
