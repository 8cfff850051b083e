"""The stages of a diagnosis share its work, and each leaves what later ones need."""

from dataclasses import replace

import pytest
from pushed_boat import FEW_ROWS, laid, sail, weak_astern

from boatsim.diagnosis import pipeline
from boatsim.diagnosis.config import DEFAULT, DiagnosisConfig
from boatsim.diagnosis.config.work import WorkConfig
from boatsim.diagnosis.loading import LoadedRecordings
from boatsim.diagnosis.open_set.decision import Decision
from boatsim.diagnosis.pipeline import Selection
from boatsim.diagnosis.problem import Problem
from boatsim.diagnosis.question import Question, set_up_estimation_problem
from boatsim.diagnosis.stage_budgets import (
    description_budget,
    pair_budget,
    search_budget,
    simulation_budget,
    unsure_budget,
)


@pytest.fixture(scope="module")
def problem() -> Problem:
    return laid(sail("first", 1, weak_astern)[0])[0]


def with_work(problem: Problem, left: int, description: int = 0, simulations: int = 0) -> Problem:
    """A problem of which some work is left, and later stages need some."""
    total = problem.work_count.work + left
    work = WorkConfig(total, description, simulations)
    return replace(problem, config=replace(DEFAULT, work=work))


def test_each_stage_gets_its_own_budget_where_much_work_is_left(problem: Problem) -> None:
    much, config = with_work(problem, 10**12), DEFAULT
    assert search_budget(much).remaining_work == config.select.budget
    assert search_budget(much, 1000).remaining_work == 1000
    assert pair_budget(much).remaining_work == config.simulate.pair_budget
    assert description_budget(much).remaining_work == config.describe.budget
    assert simulation_budget(much).remaining_work == config.simulate.budget
    assert unsure_budget(much).remaining_work == config.simulate.unsure_budget


def test_a_stage_leaves_the_work_of_later_ones(problem: Problem) -> None:
    little = with_work(problem, 1000, description=100, simulations=300)
    assert search_budget(little).remaining_work == 600
    assert pair_budget(little).remaining_work == 900  # free runs find the pair
    assert description_budget(little).remaining_work == 700
    assert simulation_budget(little).remaining_work == 1000


def test_the_first_fit_to_free_runs_leaves_work_to_one_without_unsure_effects(
    problem: Problem,
) -> None:
    kept = DEFAULT.simulate.unsure_budget
    little = with_work(problem, kept + 700)
    assert simulation_budget(little, has_unsure=True).remaining_work == 700
    assert simulation_budget(little).remaining_work == kept + 700


def test_nothing_is_left_where_later_stages_need_all(problem: Problem) -> None:
    little = with_work(problem, 1000, description=100, simulations=1200)
    assert search_budget(little).is_spent and description_budget(little).is_spent
    assert simulation_budget(little).remaining_work == 1000
    assert simulation_budget(with_work(problem, -5)).is_spent


def test_the_default_shares_leave_work_to_each_stage() -> None:
    work, select = DEFAULT.work, DEFAULT.select
    searches = select.budget + select.last_budget
    assert searches + work.for_description + work.for_simulations < work.total
    assert select.last_budget < select.budget


def test_the_work_of_earlier_problems_counts(loaded: LoadedRecordings) -> None:
    question = set_up_estimation_problem(loaded, FEW_ROWS)
    pipeline.fit_baseline_models(question)
    done = question.problem.work_count.work
    again = set_up_estimation_problem(loaded, FEW_ROWS, question.problem.work_count)
    assert done > 0
    assert again.problem.work_count is question.problem.work_count
    assert again.problem.work_count.work >= done


class Searched(Exception):
    """The second search was begun."""


@pytest.fixture(scope="module")
def question(loaded: LoadedRecordings) -> Question:
    return replace(set_up_estimation_problem(loaded, FEW_ROWS), candidates=("weak_reverse",))


@pytest.fixture(scope="module")
def decision(loaded: LoadedRecordings, question: Question) -> Decision:
    base = pipeline.fit_baseline_models(question)
    selection = pipeline.select_candidates(question, base, loaded)
    unexplained = replace(selection.ranking, structured=True)
    return pipeline.decide_causes(question, Selection(selection.problem, unexplained))


@pytest.mark.slow
@pytest.mark.parametrize(
    ("skipped", "share", "work", "searches"),
    [
        ((), 0.08, DEFAULT.work, True),
        (("wind was not added",), 0.08, DEFAULT.work, False),
        (("wind was not added",), 0.9, DEFAULT.work, True),
        ((), 0.9, WorkConfig(1, 0, 0), False),
    ],
)
def test_the_second_search_begins_only_where_it_can_reach_as_much(
    skipped: tuple[str, ...],
    share: float,
    work: WorkConfig,
    searches: bool,
    loaded: LoadedRecordings,
    question: Question,
    decision: Decision,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    ranking = replace(decision.ranking, skipped=skipped)
    gained = float(ranking.best.evidence - ranking.recalibrated.evidence)
    assert 0.08 * gained > 5.0

    def search(*_: object) -> Selection:
        raise Searched

    monkeypatch.setattr(pipeline, "largest_gain_on_top", lambda *_: share * gained)
    monkeypatch.setattr(pipeline, "select_candidates", search)
    select = replace(FEW_ROWS.select, last_gain=5.0)
    config: DiagnosisConfig = replace(FEW_ROWS, work=work, select=select)
    asked = replace(question, problem=replace(question.problem, config=config))
    first = replace(decision, ranking=ranking)
    if searches:
        with pytest.raises(Searched):
            pipeline.try_last_candidates(loaded, asked, first)
        return
    kept, same, last = pipeline.try_last_candidates(loaded, asked, first)
    assert kept is loaded and same is asked
    statement = last.ranking.skipped[-1]
    assert statement.startswith("candidates that are tried last were not tried: ")
    assert "drive_deadband" in statement
