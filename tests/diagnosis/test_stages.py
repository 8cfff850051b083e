"""Each stage of a diagnosis, called alone on one small recording of one vessel."""

from dataclasses import FrozenInstanceError, replace
from pathlib import Path

import numpy as np
import pytest
from pushed_boat import BOAT, FEW_ROWS

from boatsim.diagnosis import loading, pipeline
from boatsim.diagnosis.answer.compose import compose_answer
from boatsim.diagnosis.answer.stages import Stages
from boatsim.diagnosis.loading import LoadedRecordings, Request
from boatsim.diagnosis.model_names import MODELS
from boatsim.diagnosis.question import Question, set_up_estimation_problem
from boatsim.diagnosis.report.sentences import console_lines
from boatsim.diagnosis.search.ranking import Baseline
from boatsim.errors import BadInput

ONLY = "weak_reverse"  # the candidate that is tested


@pytest.fixture(scope="module")
def question(loaded: LoadedRecordings) -> Question:
    return replace(set_up_estimation_problem(loaded, FEW_ROWS), candidates=(ONLY,))


@pytest.fixture(scope="module")
def base(question: Question) -> Baseline:
    return pipeline.fit_baseline_models(question)


def test_load_holds_out_the_middle_third_of_a_single_recording(loaded: LoadedRecordings) -> None:
    assert [len(part) for part in (loaded.fitted, loaded.held_out)] == [2, 1]
    assert "middle third" in loaded.note
    assert loaded.vessel.name == BOAT.name
    with pytest.raises(FrozenInstanceError):
        loaded.note = ""  # type: ignore[misc]
    path = Path(str(loaded.fitted[0].path))
    with pytest.raises(BadInput, match="given twice"):
        loading.load_recordings(Request([path], [path], vessel=BOAT.name))


def test_check_finds_nothing_wrong_with_a_sound_recording(
    loaded: LoadedRecordings, question: Question
) -> None:
    assert not [f for f in pipeline.check_recordings(loaded, question) if f.kind == "fault"]


def test_fit_recalibrates_the_vessel(base: Baseline) -> None:
    assert base.recalibrated.evidence > base.nominal.evidence
    assert not base.recalibrated.effects


def test_later_stages_take_the_results_of_earlier_ones(
    loaded: LoadedRecordings, question: Question, base: Baseline
) -> None:
    selection = pipeline.select_candidates(question, base, loaded)
    assert selection.ranking.recalibrated is base.recalibrated
    assert set(selection.ranking.first) == {ONLY}
    decision = pipeline.decide_causes(question, selection)
    assert len(decision.judgements) == len(selection.ranking.named)
    ranking = replace(pipeline.describe_unexplained_force(question, decision), description=None)
    ranking = pipeline.adopt_refitted_coefficients(question, decision, ranking)
    evaluation = pipeline.validate_on_held_out(question, decision, ranking)
    assert set(MODELS) <= set(evaluation.free_runs[0].channels)
    plan = pipeline.plan_next_experiment(decision, ranking)
    location = pipeline.locate_missing_force(decision, ranking, evaluation)
    assert set(location.strengths) == set(location.remaining) == set(BOAT.dof)
    stages = Stages(decision, ranking, evaluation, location, plan)
    answer = compose_answer(loaded, question, (), stages, 1.0)
    assert len(answer["where"]["region"]) == len(location.regions)
    assert answer["tried"] == [ONLY]
    assert answer["fit"]["held_out"] == [mapped.name for mapped in question.held_out]
    assert answer["config"]["load.row_rate"] == 4.0
    position, heading = answer["fit"]["position_rms_m"], answer["fit"]["heading_rms_rad"]
    nominal = position["nominal"] * heading["nominal"]
    assert position["recalibrated"] * heading["recalibrated"] <= nominal
    for effect in answer["effects"]:
        alone = effect["alone"]["position_rms_m"]
        assert alone["with"] == pytest.approx(position["patched"], rel=0.05)
    assert answer["seconds"] == 1.0


def test_possible_effects_that_make_predictions_worse_are_not_in_the_corrected_vessel(
    loaded: LoadedRecordings, question: Question, base: Baseline
) -> None:
    decision = pipeline.decide_causes(question, pipeline.select_candidates(question, base, loaded))
    ranking = decision.ranking
    found = ranking.best
    theta = found.theta.copy()
    theta[[f.relative for f in found.free]] *= 30.0
    for named in (ranking.named[:1], ()):
        bad = replace(ranking, best=replace(found, theta=theta), named=named, description=None)
        adopted = pipeline.adopt_refitted_coefficients(question, decision, bad)
        assert (adopted.best is adopted.recalibrated) == (not named)
    good = replace(ranking, named=(), description=None)
    adopted = pipeline.adopt_refitted_coefficients(question, decision, good)
    assert adopted.best is found


@pytest.mark.parametrize(
    ("stage", "words"),
    [
        ("describe_unexplained_force", "the description of the unexplained force"),
        ("plan_next_experiment", "the search for the next experiment"),
    ],
)
def test_a_late_stage_that_fails_is_reported_and_the_selection_is_kept(
    stage: str,
    words: str,
    loaded: LoadedRecordings,
    question: Question,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def fail(*_: object) -> None:
        raise np.linalg.LinAlgError("Singular matrix")

    monkeypatch.setattr(pipeline, "set_up_estimation_problem", lambda *_: question)
    monkeypatch.setattr(pipeline, stage, fail)
    found = pipeline.diagnose_loaded(loaded, config=FEW_ROWS)
    answer = found.findings.answer
    assert [effect["name"] for effect in answer["effects"]] == [ONLY]
    assert "diverges" not in answer["unknown"]
    statement = f"{words} failed and was skipped: Singular matrix"
    assert answer["skipped"] == [statement]
    assert answer["sentence"].endswith(f" T{statement[1:]}.")
    assert statement in "\n".join(console_lines(found.findings))


def test_a_validation_that_fails_states_its_reason(
    loaded: LoadedRecordings, question: Question, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(*_: object) -> None:
        raise FloatingPointError("overflow")

    monkeypatch.setattr(pipeline, "set_up_estimation_problem", lambda *_: question)
    monkeypatch.setattr(pipeline, "validate_on_held_out", fail)
    answer = pipeline.diagnose_loaded(loaded, config=FEW_ROWS).findings.answer
    assert answer["verdict"] == "unknown"
    assert answer["sentence"].endswith(
        "The validation of the selected effects failed and was skipped: overflow."
    )
