"""The budget of a search: its count, the end of the search, and the report of what was skipped."""

import math
from dataclasses import replace

import numpy as np
import pytest
from pushed_boat import FEW_ROWS

from boatsim.diagnosis import pipeline
from boatsim.diagnosis.answer.incomplete import (
    COMPARED,
    INCOMPLETE,
    TERMS_NOT_SOUGHT,
    TIME_NOT_CHOSEN,
    incomplete_sentence,
)
from boatsim.diagnosis.config import DiagnosisConfig
from boatsim.diagnosis.loading import LoadedRecordings
from boatsim.diagnosis.problem import Fit
from boatsim.diagnosis.question import Question, set_up_estimation_problem
from boatsim.diagnosis.report.sentences import console_lines
from boatsim.diagnosis.search import ranking as ranking_stage
from boatsim.diagnosis.search.budget import BudgetSpentError, SearchBudget, in_addition_to_phrase
from boatsim.diagnosis.search.candidate_sets import CandidateSets, Recordings
from boatsim.diagnosis.search.ranking import select_and_rank_candidates
from boatsim.diagnosis.work import ACTUATOR, CALL, CORRECTION, WorkCount

CANDIDATES = ("weak_reverse", "steady_force", "thrust_lag", "wave_forcing")


def with_budget(work: int) -> DiagnosisConfig:
    return replace(FEW_ROWS, select=replace(FEW_ROWS.select, budget=work))


def question_with(loaded: LoadedRecordings, config: DiagnosisConfig) -> Question:
    question = set_up_estimation_problem(loaded, config)
    return replace(question, candidates=CANDIDATES)


def selection_with(loaded: LoadedRecordings, config: DiagnosisConfig) -> pipeline.Selection:
    question = question_with(loaded, config)
    return pipeline.select_candidates(question, pipeline.fit_baseline_models(question), loaded)


def test_a_pass_counts_its_integration_steps_and_a_repeated_one_nothing(
    loaded: LoadedRecordings,
) -> None:
    problem = question_with(loaded, FEW_ROWS).problem
    found = problem.nominal_hypothesis()
    on = problem.program.effect_switches()
    passes = problem.filter(found.free, found.theta, on, found.levels)
    before = problem.work_count.work
    problem.log_likelihood(found.free, found.theta, on, found.levels)  # known from the pass
    assert problem.work_count.work == before
    problem.whitened_errors(found.free, found.theta, on, found.levels, passes)
    work, dof = 0, len(problem.program.vessel.dof)
    for mapped in problem.recordings:
        intervals = np.diff(mapped.times)
        steps = sum(max(1, math.ceil(h / mapped.largest_step - 1e-9)) for h in intervals)
        rows, channels = mapped.measured.shape
        size = dof + ACTUATOR * mapped.commands.shape[1]
        corrections = CORRECTION * rows * size * (dof + channels) / 2
        work += CALL + round(steps * size + corrections)
    assert problem.work_count.work == before + work


def test_all_recordings_of_a_diagnosis_share_one_count(loaded: LoadedRecordings) -> None:
    question = question_with(loaded, FEW_ROWS)
    counts = [mapped.filtered for mapped in (*question.problem.recordings, *question.held_out)]
    assert all(count is question.problem.work_count for count in counts)


def test_the_default_budget_skips_nothing(loaded: LoadedRecordings) -> None:
    ranking = selection_with(loaded, FEW_ROWS).ranking
    assert not ranking.skipped
    assert [one.name for one in ranking.named] == ["weak_reverse"]


def test_a_search_without_budget_adds_nothing_and_states_what_it_skipped(
    loaded: LoadedRecordings,
) -> None:
    ranking = selection_with(loaded, with_budget(1)).ranking
    assert not ranking.named and not ranking.best.effects
    assert len(ranking.first) == len(CANDIDATES)  # each candidate alone is always screened
    assert any(what.startswith("weak_reverse was not added") for what in ranking.skipped)
    assert TIME_NOT_CHOSEN in ranking.skipped


def test_a_selection_may_get_less_work_than_the_budget(loaded: LoadedRecordings) -> None:
    question = question_with(loaded, FEW_ROWS)
    base = pipeline.fit_baseline_models(question)
    ranking = pipeline.select_candidates(question, base, loaded, work=1).ranking
    assert not ranking.best.effects
    assert any(what.startswith("weak_reverse was not added") for what in ranking.skipped)


def test_a_budget_that_ends_the_search_halfway_keeps_the_best_set_found(
    loaded: LoadedRecordings,
) -> None:
    question = question_with(loaded, FEW_ROWS)
    base = pipeline.fit_baseline_models(question)
    before = question.problem.work_count.work
    complete = pipeline.select_candidates(question, base, loaded).ranking
    used = question.problem.work_count.work - before
    evidence = []
    for share in (0.0, 0.3, 0.6, 1.0):
        ranking = selection_with(loaded, with_budget(1 + int(share * used))).ranking
        evidence.append(ranking.best.evidence)
    assert evidence == sorted(evidence)
    assert evidence[-1] == complete.best.evidence


def test_a_search_without_budget_removes_no_effect_in_whose_place_nothing_can_come(
    loaded: LoadedRecordings, monkeypatch: pytest.MonkeyPatch
) -> None:
    question = question_with(loaded, FEW_ROWS)
    base = pipeline.fit_baseline_models(question)
    found = pipeline.select_candidates(question, base, loaded).ranking
    asked = list[Fit]()

    def remember(sets: CandidateSets, best: Fit, held_out: Recordings) -> Fit:
        asked.append(best)
        return best

    monkeypatch.setattr(ranking_stage, "remove_dwarfed_effect", remember)
    problem, none = question.problem, SearchBudget(question.problem.work_count, 0)
    again = select_and_rank_candidates(
        problem, CANDIDATES, question.held_out, found.best, base=base, budget=none
    )
    assert again.best.effects == found.best.effects == ("weak_reverse",)
    assert not asked and ranking_stage.NOT_EXAMINED in again.skipped


def test_the_same_budget_gives_the_same_answer_again(loaded: LoadedRecordings) -> None:
    first, second = (selection_with(loaded, with_budget(200_000)).ranking for _ in range(2))
    assert first.skipped == second.skipped
    assert first.best.effects == second.best.effects
    assert first.best.evidence == second.best.evidence


@pytest.mark.slow
def test_the_answer_says_in_words_what_was_skipped(loaded: LoadedRecordings) -> None:
    found = pipeline.diagnose_loaded(loaded, config=with_budget(1))
    answer = found.findings.answer
    assert answer["skipped"]
    assert answer["sentence"].endswith(INCOMPLETE)
    printed = "\n".join(console_lines(found.findings))
    for what in answer["skipped"]:
        assert f"the search's budget was spent: {what}" in printed


def test_the_answer_says_that_candidates_were_not_compared_only_where_that_is_so() -> None:
    assert incomplete_sentence(()) == ""
    candidates = "2 candidates were not refitted in place of wind"
    assert incomplete_sentence((candidates, TIME_NOT_CHOSEN)) == INCOMPLETE
    assert incomplete_sentence((TIME_NOT_CHOSEN,)) == f"{COMPARED} {TIME_NOT_CHOSEN}."
    both = incomplete_sentence((TIME_NOT_CHOSEN, TERMS_NOT_SOUGHT))
    assert both == f"{COMPARED} {TIME_NOT_CHOSEN}, and {TERMS_NOT_SOUGHT}."


def test_a_diagnosis_without_work_for_a_second_search_has_compared_all_candidates(
    loaded: LoadedRecordings,
) -> None:
    select = replace(FEW_ROWS.select, again_share=1e9)
    found = pipeline.diagnose_loaded(loaded, config=replace(FEW_ROWS, select=select))
    answer = found.findings.answer
    assert answer["skipped"] == [TIME_NOT_CHOSEN]
    assert answer["sentence"].endswith(f"{COMPARED} {TIME_NOT_CHOSEN}.")


def test_statements_count_the_candidates_once_for_each_trial() -> None:
    budget = SearchBudget(WorkCount(), 0)
    budget.record_skipped_candidates(3, f"tested {in_addition_to_phrase(['wind'])}")
    budget.record_skipped_candidates(2, f"tested {in_addition_to_phrase(['wind'])}")
    budget.record_skipped_candidates(0, "refitted in place of wind")
    budget.record_skipped_candidates(1, "refitted in place of current")
    assert budget.skipped_work_statements == (
        "2 candidates were not tested in addition to wind",
        "1 candidate was not refitted in place of current",
    )


def test_a_search_that_has_to_be_complete_ends_at_once() -> None:
    budget = SearchBudget(WorkCount(), 0, complete=True)
    budget.record_skipped_candidates(0, "tested alone")
    with pytest.raises(BudgetSpentError):
        budget.record_skipped_candidates(1, "tested alone")
