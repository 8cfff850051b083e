"""What an answer states about the group of recordings in which an effect acts."""

from dataclasses import replace

import numpy as np
import pytest
from pushed_boat import BOAT, sail

from boatsim.diagnosis.answer.effect_entries import added_entry
from boatsim.diagnosis.answer.schema import AddedEntry
from boatsim.diagnosis.answer.verdict import verdict_sentences
from boatsim.diagnosis.candidates import candidate_library
from boatsim.diagnosis.filter import MappedRecording
from boatsim.diagnosis.fit import unfitted_hypothesis
from boatsim.diagnosis.prior_noise import prior_noise_levels
from boatsim.diagnosis.problem import Problem
from boatsim.diagnosis.recording_mapping import map_recording
from boatsim.diagnosis.report.sections import report_sections
from boatsim.physics.base import Array
from boatsim.physics.program import Program
from boatsim.view.page_blocks import Text
from tests.diagnosis.report.test_page import planar

PROGRAM = Program(BOAT, candidate_library(BOAT).compiled_effects)
EFFECT = "thrust_gain_error"
FACTOR = 0.8


def still(_: float, __: Array, ___: Array) -> Array:
    return np.zeros(3)


@pytest.fixture(scope="module")
def recording() -> MappedRecording:
    return map_recording(sail("run", 1, still)[0], PROGRAM)


def entry_in(recording: MappedRecording, own: str, runs: tuple[str, ...]) -> AddedEntry:
    """The entry of a factor in group a, where some groups have factors of their own."""
    recordings = [replace(recording, groups=tuple(groups.split())) for groups in runs]
    levels = prior_noise_levels(BOAT, [sail("run", 1, still)[0]])
    problem = Problem(recordings, levels, {})
    effects = tuple(f"{EFFECT}@{group}" for group in own)
    free = problem.free_parameters(effects)
    best = unfitted_hypothesis(effects, free, np.full(len(free), FACTOR), levels)
    return added_entry(problem, best, f"{EFFECT}@a")


@pytest.mark.parametrize(
    ("own", "others"),
    [
        ("a", "this is relative to the others"),
        ("ab", "this is relative to the others, except group b"),
        ("abc", "groups b and c have another value"),
    ],
)
def test_a_factor_is_relative_to_the_groups_without_one(
    recording: MappedRecording, own: str, others: str
) -> None:
    entry = entry_in(recording, own, ("a", "b", "c"))
    assert entry["group"] == "a" and "same_recordings" not in entry
    [parameter] = entry["parameters"].values()
    assert parameter["statement"].startswith("in group a, all thrust is 80 %")
    assert parameter["statement"].endswith(f"; {others}")


def test_groups_of_the_same_recordings_are_in_the_entry(recording: MappedRecording) -> None:
    entry = entry_in(recording, "a", ("a d e", "b", "b"))
    assert entry["same_recordings"] == ["d", "e"]
    assert entry["words"].startswith("in group a (the same recordings as d and e), ")


def test_two_groups_of_which_either_may_differ_are_stated_as_that() -> None:
    findings = planar()
    effect = findings.answer["effects"][0]
    name = effect["name"].replace("_", " ")
    statement = (
        f"These recordings do not show whether {name} is of group june or april, only that these "
        "groups differ."
    )
    assert "do not show whether" not in verdict_sentences(findings.answer)
    in_june = {**effect, "name": f"{effect['name']}@june", "group": "june"}
    answer = findings.answer | {"effects": [in_june | {"tied_groups": ["april"]}]}
    assert statement in verdict_sentences(answer)
    texts = []
    for section in report_sections(replace(findings, answer=answer)):
        texts += [block.words for block in section.blocks if isinstance(block, Text)]
    assert statement in texts
