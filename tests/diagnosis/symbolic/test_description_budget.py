"""Work of a description: a term costs nothing where it does not act, and the total has an end."""

from dataclasses import replace

import numpy as np
import pytest
from pushed_boat import laid, sail

from boatsim.diagnosis.config import DEFAULT
from boatsim.diagnosis.problem import Fit, Problem
from boatsim.diagnosis.symbolic import term_selection
from boatsim.diagnosis.symbolic.placeholders import set_placeholder_term
from boatsim.diagnosis.symbolic.term_selection import Formula, select_terms
from boatsim.physics.base import Array
from boatsim.physics.effects.described_force import DescribedForce


def swinging(t: float, y: Array, command: Array) -> Array:
    return np.array([2.0 * y[5] * abs(y[5]), 0.0, 0.3 * np.cos(2.0 * np.pi * t / 9.0)])


@pytest.fixture(scope="module")
def mapped() -> tuple[Problem, Fit]:
    return laid(sail("first", 1, swinging)[0], sail("second", 2, swinging)[0])


def event(period: float) -> DescribedForce:
    term = {"axis": "sway", "acts": "swinging", "begin": 3.0, "end": 3.0 + period}
    return replace(DescribedForce.from_settings(term), run="first")


def test_a_term_of_one_recording_costs_no_pass_over_another(mapped: tuple[Problem, Fit]) -> None:
    problem, best = mapped
    effects = (*best.effects, "described_1")
    free, on = problem.free_parameters(effects), problem.program.effect_switches(effects)
    theta = np.append(best.theta, 0.2)
    likelihoods, work = set[float](), []
    for period in (2.0, 2.5, 3.0):
        set_placeholder_term(problem, "described_1", event(period), problem.recordings)
        likelihoods.add(problem.log_likelihood(free, theta, on, best.levels))
        work.append([recording.filtered.work for recording in problem.recordings])
    assert len(likelihoods) == 3
    first, second = zip(*work, strict=True)
    assert first[0] < first[1] < first[2]
    assert second[0] == second[1] == second[2] > 0


@pytest.mark.slow
def test_a_description_ends_where_nothing_of_the_work_of_the_diagnosis_is_left_to_it(
    mapped: tuple[Problem, Fit],
) -> None:
    problem, best = mapped
    assert len(select_terms(problem, best, ()).terms) > 1
    total = problem.work_count.work + DEFAULT.work.for_simulations
    spent = replace(DEFAULT.work, total=total)
    limited = replace(problem, config=replace(DEFAULT, work=spent))
    found = select_terms(limited, best, ())
    assert len(found.terms) == 1 and not found.complete


@pytest.mark.slow
def test_no_term_is_begun_that_would_take_more_work_than_is_left(
    mapped: tuple[Problem, Fit],
) -> None:
    problem, best = mapped

    def described(**settings: int) -> tuple[int, int, bool]:
        """Number of terms, work, and whether the description is complete."""
        config = replace(DEFAULT, describe=replace(DEFAULT.describe, **settings))
        before = problem.work_count.work
        found = select_terms(replace(problem, config=config), best, ())
        return len(found.terms), problem.work_count.work - before, found.complete

    terms, work_of_one, _ = described(most_terms=1)
    assert terms == 1
    terms, work, complete = described(budget=round(1.5 * work_of_one))
    assert terms == 1 and not complete and work < 1.5 * work_of_one


def test_terms_that_only_replace_effects_are_not_sought_without_end(
    mapped: tuple[Problem, Fit], monkeypatch: pytest.MonkeyPatch
) -> None:
    problem, best = mapped
    refused = list[str]()

    def replaces_effect(before: Formula, extended: Formula, fewer: dict[str, Formula]) -> bool:
        refused.extend(extended.terms)
        return True

    monkeypatch.setattr(term_selection, "_replaces_effect", replaces_effect)
    config = replace(DEFAULT, describe=replace(DEFAULT.describe, budget=1))
    found = select_terms(replace(problem, config=config), best, ())
    assert len(refused) == 1 and not found.terms and not found.complete
