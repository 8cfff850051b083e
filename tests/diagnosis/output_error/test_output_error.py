"""Laws of the output-error method, on boats of an independent integrator."""

from dataclasses import replace

import numpy as np
import pytest
from pushed_boat import DAMPING, Missing, laid, push, sail

from boatsim.diagnosis.description import FittedTerm, SymbolicDescription
from boatsim.diagnosis.filter import MappedRecording
from boatsim.diagnosis.fit import converge
from boatsim.diagnosis.free_runs import free_run_horizon, free_runs, rms_errors
from boatsim.diagnosis.output_error.errors import output_errors
from boatsim.diagnosis.output_error.fit import fit_to_free_runs
from boatsim.diagnosis.output_error.search import OutputErrorSearch
from boatsim.diagnosis.output_error.stage import (
    _better_of_two,
    _further_starts,
    _search_without_unsure,
    _unsure_effects,
    _with_corrected,
    contradicted_effects,
    fit_to_simulations,
)
from boatsim.diagnosis.problem import Fit, Problem
from boatsim.diagnosis.recording_mapping import map_recording
from boatsim.diagnosis.search.budget import SearchBudget
from boatsim.diagnosis.search.pruning import IdentifiedEffect
from boatsim.diagnosis.search.ranking import select_and_rank_candidates
from boatsim.diagnosis.search.screening import add_effect
from boatsim.diagnosis.symbolic.placeholders import set_placeholder_term
from boatsim.physics.base import Array
from boatsim.physics.effects.described_force import DescribedForce

WEAK_ASTERN = 0.4  # share of the thrust astern that is missing
LIFT = 5.0  # kg, sway force per surge speed and yaw rate in some recordings
ODD = 0.06  # m/s at which the damping is as large as the forces of unknown cause


def nothing(t: float, y: Array, command: Array) -> Array:
    return np.zeros(3)


def draggy(t: float, y: Array, command: Array) -> Array:
    return np.asarray(-0.05 * DAMPING * y[3:6])


def odd(t: float, y: Array, command: Array) -> Array:
    """Forces that no candidate has: they change over the place."""
    swing = np.array([np.sin(2.0 * y[0]), np.cos(2.0 * y[1]), 0.3 * np.sin(2.0 * y[0])])
    return np.asarray(ODD * DAMPING * swing)


def odd_and_weak_astern(t: float, y: Array, command: Array) -> Array:
    return np.asarray(
        -WEAK_ASTERN * push(np.minimum(command[:2], 0.0), command[2:]) + odd(t, y, command)
    )


def held_out_of(problem: Problem, missing: Missing) -> list[MappedRecording]:
    recording = sail("held out", 9, missing)[0]
    return [map_recording(recording, problem.program)]


def whole_budget(problem: Problem) -> SearchBudget:
    return SearchBudget(problem.work_count, problem.config.simulate.budget)


def error(problem: Problem, found: Fit, recordings: list[MappedRecording]) -> float:
    """Geometric mean of the rms errors of position and heading of free runs."""
    horizon = free_run_horizon(problem, recordings)
    rms = rms_errors(free_runs(problem, {"it": found}, recordings, horizon))
    return float(np.exp(np.mean([np.log(one["it"]) for one in rms.values()])))


def test_the_fit_minimises_the_errors_of_free_runs_and_its_derivatives_are_right() -> None:
    problem, retuned = laid(sail("fitted", 1, odd)[0])
    errors = output_errors(problem, retuned, problem.recordings, problem.horizon)
    found = fit_to_free_runs(errors, retuned)
    before = errors.score(retuned, errors.residuals(retuned))
    assert found.score >= before
    assert error(problem, found.model, list(problem.recordings)) < error(
        problem, retuned, list(problem.recordings)
    )
    # a step to any side of the minimum is worse, each with the model's own starting states
    sd = np.sqrt(np.diag(found.model.covariance))
    for j, step in enumerate(sd):
        for sign in (-1.0, 1.0):
            theta = found.model.theta.copy()
            theta[j] += sign * step
            other = replace(found.model, theta=theta)
            assert errors.score(other, errors.residuals(other)) < found.score + 0.1


def test_right_coefficients_are_found_within_their_deviation() -> None:
    problem, retuned = laid(*(sail(f"fitted {i}", i, draggy)[0] for i in (1, 2, 3)))
    errors = output_errors(problem, retuned, problem.recordings, problem.horizon)
    found = fit_to_free_runs(errors, retuned).model
    for f, x, sd in zip(found.free, found.theta, np.sqrt(np.diag(found.covariance)), strict=True):
        true = 1.05 if "damping" in f.effect else 1.0
        assert abs(x - true) < 3.0 * sd


def test_parameters_of_fixed_effects_keep_their_values() -> None:
    problem, retuned = laid(sail("fitted", 1, odd_and_weak_astern)[0])
    start = add_effect(problem, retuned, "weak_reverse", {"astern_factor": 0.83})
    errors = output_errors(problem, start, problem.recordings, problem.horizon)
    fixed = fit_to_free_runs(errors, start, ["weak_reverse"]).model
    free = fit_to_free_runs(errors, start).model
    assert fixed.value("weak_reverse", "astern_factor")[0] == 0.83
    assert free.value("weak_reverse", "astern_factor")[0] == pytest.approx(
        1.0 - WEAK_ASTERN, abs=0.15
    )


def test_an_effect_that_acts_is_added_beside_forces_of_unknown_cause() -> None:
    problem, retuned = laid(*(sail(f"fitted {i}", i, odd_and_weak_astern)[0] for i in (1, 2)))
    held_out = held_out_of(problem, odd_and_weak_astern)
    search = OutputErrorSearch(problem, retuned, held_out)
    before = error(problem, search.model, held_out)
    search.add_effects(["thrust_imbalance", "weak_reverse", "prop_walk"])
    assert "weak_reverse" in search.model.effects
    assert search.model.value("weak_reverse", "astern_factor")[0] == pytest.approx(
        1.0 - WEAK_ASTERN, abs=0.15
    )
    assert error(problem, search.model, held_out) < before


def test_an_effect_that_does_not_act_is_dropped_and_none_is_added() -> None:
    problem, retuned = laid(*(sail(f"fitted {i}", i, nothing)[0] for i in (1, 2)))
    held_out = held_out_of(problem, nothing)
    start = converge(problem, add_effect(problem, retuned, "prop_walk", {}))
    search = OutputErrorSearch(problem, start, held_out)
    search.drop_effects()
    assert not search.model.effects
    search.add_effects(["prop_walk", "weak_reverse", "thrust_imbalance"])
    assert not search.model.effects


def test_a_stated_effect_is_contradicted_only_if_simulations_are_clearly_better_without() -> None:
    problem, retuned = laid(*(sail(f"fitted {i}", i, odd)[0] for i in (1, 2)))
    held_out = held_out_of(problem, odd)
    wrong = add_effect(problem, retuned, "weak_reverse", {"astern_factor": 0.4})
    assert contradicted_effects(problem, wrong, ["weak_reverse"], held_out) == ("weak_reverse",)
    # simulations with thrust ahead alone do not depend on it
    problem, retuned = laid(sail("ahead", 1, odd, straight=True)[0])
    held_out = [map_recording(sail("held out", 2, odd, straight=True)[0], problem.program)]
    unseen = add_effect(problem, retuned, "weak_reverse", {"astern_factor": 0.4})
    assert contradicted_effects(problem, unseen, ["weak_reverse"], held_out) == ()


def test_nothing_is_changed_where_nothing_is_unexplained() -> None:
    problem, _ = laid(*(sail(f"fitted {i}", i, nothing)[0] for i in (1, 2)))
    held_out = held_out_of(problem, nothing)
    ranking = select_and_rank_candidates(problem, ("weak_reverse",), held_out)
    assert not ranking.has_unexplained_force_or_cause
    assert (
        fit_to_simulations(problem, ranking, ("weak_reverse",), held_out, whole_budget(problem))
        is ranking
    )


def test_where_a_force_is_unexplained_the_corrected_vessel_predicts_no_worse() -> None:
    problem, _ = laid(*(sail(f"fitted {i}", i, odd_and_weak_astern)[0] for i in (1, 2)))
    held_out = held_out_of(problem, odd_and_weak_astern)
    names = ("thrust_imbalance", "prop_walk")
    ranking = select_and_rank_candidates(problem, names, held_out)
    assert ranking.has_unexplained_force_or_cause
    found = fit_to_simulations(
        problem, ranking, (*names, "weak_reverse"), held_out, whole_budget(problem)
    )
    assert found.by_free_runs and "weak_reverse" in found.added
    assert error(problem, found.best, held_out) * 1.05 < error(problem, ranking.best, held_out)
    assert set(found.best.effects) <= {*names, "weak_reverse"}


@pytest.mark.parametrize("other_day", ["odd", "odd_and_weak_astern"])
def test_a_start_that_harms_a_group_of_recordings_is_not_taken(other_day: str) -> None:
    problem, retuned = laid(*(sail(f"fitted {i}", i, odd_and_weak_astern)[0] for i in (1, 2)))
    held_out = []
    for seed, day in ((7, "first day"), (8, "first day"), (9, "first day"), (10, "other day")):
        missing = odd_and_weak_astern if day == "first day" else globals()[other_day]
        mapped = map_recording(sail(f"{day} {seed}", seed, missing)[0], problem.program)
        held_out.append(replace(mapped, groups=(day,)))
    effect = add_effect(problem, retuned, "weak_reverse", {"astern_factor": 1.0 - WEAK_ASTERN})
    simple = OutputErrorSearch(problem, retuned, held_out)
    found = _better_of_two(simple, simple.model, effect, (), whole_budget(problem))
    assert ("weak_reverse" in found.model.effects) is (other_day == "odd_and_weak_astern")


def test_of_two_searches_the_vessel_that_predicts_better_is_kept() -> None:
    problem, retuned = laid(*(sail(f"fitted {i}", i, odd_and_weak_astern)[0] for i in (1, 2)))
    held_out = held_out_of(problem, odd_and_weak_astern)
    selected = add_effect(problem, retuned, "prop_walk", {"side_force_per_thrust": 0.1})
    simple = OutputErrorSearch(problem, retuned, held_out)
    before = simple.model
    assert "prop_walk" not in before.effects
    simple.add_effects(("weak_reverse",))
    assert simple.model.effects == ("weak_reverse",)
    budget = whole_budget(problem)
    assert _better_of_two(simple, before, selected, (), budget) is simple
    astern = add_effect(problem, retuned, "weak_reverse", {"astern_factor": 1.0 - WEAK_ASTERN})
    less = OutputErrorSearch(problem, retuned, held_out)
    better = _better_of_two(less, less.model, astern, (), budget)
    assert better.model.effects == ("weak_reverse",)


@pytest.mark.parametrize("factor", [-1e3, 3.0])  # the simulation diverges, or is worse
def test_a_fit_in_new_units_after_which_held_out_simulations_are_worse_is_not_kept(
    factor: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    problem, retuned = laid(sail("fitted", 1, odd)[0])
    search = OutputErrorSearch(problem, retuned, held_out_of(problem, odd))
    best = search.best
    surge = [f.name == "surge" for f in best.model.free]
    theta = np.where(surge, factor * best.model.theta, best.model.theta)
    away = replace(best, model=replace(best.model, theta=theta))
    monkeypatch.setattr(search, "_fitted", lambda start: away)
    search._accept(best)
    np.testing.assert_array_equal(search.model.theta, best.model.theta)
    if factor > 0.0:
        search._accept(away)  # nothing better is there
        np.testing.assert_array_equal(search.model.theta, theta)


def test_nothing_is_added_once_the_budget_is_spent() -> None:
    problem, _ = laid(*(sail(f"fitted {i}", i, odd_and_weak_astern)[0] for i in (1, 2)))
    held_out = held_out_of(problem, odd_and_weak_astern)
    ranking = select_and_rank_candidates(problem, ("prop_walk",), held_out)
    for work in (1, problem.config.simulate.budget):
        budget = SearchBudget(problem.work_count, work)
        found = fit_to_simulations(problem, ranking, ("weak_reverse",), held_out, budget)
        assert budget.is_spent is (work == 1)
        assert bool(found.added) is (work > 1)


def test_an_event_of_a_single_recording_is_not_called_an_added_effect() -> None:
    problem, retuned = laid(sail("fitted", 1, odd)[0])
    held_out = held_out_of(problem, odd)
    ranking = select_and_rank_candidates(problem, ("weak_reverse",), held_out)
    term = DescribedForce(name="described_1", axis="surge", run="fitted")
    description = SymbolicDescription((FittedTerm(term, 0.1, 20.0, carries=False),), retuned, 0.0)
    corrected = replace(retuned, effects=("described_1", "weak_reverse"))
    found = _with_corrected(replace(ranking, description=description), corrected, ())
    assert found.added == ("weak_reverse",)


def test_a_search_also_starts_from_the_coefficients_that_free_runs_determine() -> None:
    problem, retuned = laid(*(sail(f"fitted {i}", i, odd_and_weak_astern)[0] for i in (1, 2)))
    held_out = held_out_of(problem, odd_and_weak_astern)
    before = OutputErrorSearch(problem, retuned, held_out).model
    term = DescribedForce(name="described_1", axis="sway", of=("sign_sway_speed",), coefficient=0.5)
    set_placeholder_term(problem, "described_1", term, [*problem.recordings, *held_out])
    filtered = replace(retuned, theta=1.5 * retuned.theta)  # a filter may be that wrong
    filtered = add_effect(problem, filtered, "weak_reverse", {"astern_factor": 0.7})
    filtered = add_effect(problem, filtered, "described_1", {"coefficient": 0.5})
    whole, lean = _further_starts(problem, filtered, before, filtered.effects)
    assert whole is filtered
    assert lean.effects == ("weak_reverse",)
    assert lean.value("weak_reverse", "astern_factor")[0] == 0.7
    for f, x in zip(lean.free, lean.theta, strict=True):
        if f.relative:
            assert x == before.values()[f.effect, f.name]
    # there is a single start where the filter selected nothing, and none beside the same effects
    assert _further_starts(problem, before, before, ()) == []
    assert len(_further_starts(problem, before, before, ("weak_reverse",))) == 2


def test_a_formula_that_holds_for_the_fitted_recordings_alone_is_left_out() -> None:
    def lifted(t: float, y: Array, command: Array) -> Array:
        lift = np.array([0.0, LIFT * y[3] * y[5], 0.0])
        return np.asarray(odd_and_weak_astern(t, y, command) + lift)

    problem, _ = laid(*(sail(f"fitted {i}", i, lifted)[0] for i in (1, 2)))
    held_out = held_out_of(problem, odd_and_weak_astern)
    ranking = select_and_rank_candidates(problem, ("prop_walk",), held_out)
    assert ranking.has_unexplained_force_or_cause
    term = DescribedForce(
        name="described_1", axis="sway", of=("surge_speed", "yaw_rate"), coefficient=LIFT
    )
    set_placeholder_term(problem, "described_1", term, [*problem.recordings, *held_out])
    best = add_effect(
        problem, ranking.recalibrated, "weak_reverse", {"astern_factor": 1.0 - WEAK_ASTERN}
    )
    best = add_effect(problem, best, "described_1", {"coefficient": LIFT})
    described = replace(ranking, best=best)
    found = fit_to_simulations(problem, described, (), held_out, whole_budget(problem))
    assert found.best.effects == ("weak_reverse",)
    assert error(problem, found.best, held_out) < error(problem, best, held_out)


@pytest.mark.parametrize(
    ("stated", "sizes", "stays"),
    [
        ("prop_walk", {"side_force_per_thrust": 0.2}, False),
        ("weak_reverse", {"astern_factor": 1.0 - WEAK_ASTERN}, True),
    ],
)
def test_an_unsure_effect_is_given_up_only_if_simulations_are_better_without_it(
    stated: str, sizes: dict[str, float], stays: bool
) -> None:
    problem, retuned = laid(*(sail(f"fitted {i}", i, odd_and_weak_astern)[0] for i in (1, 2)))
    held_out = held_out_of(problem, odd_and_weak_astern)
    start = add_effect(problem, retuned, stated, sizes)
    corrected = OutputErrorSearch(problem, start, held_out, [stated]).model
    candidates = ("weak_reverse", "thrust_imbalance", stated)
    found = _search_without_unsure(problem, corrected, retuned, candidates, held_out)
    assert (found is corrected) is stays
    assert found.effects == ("weak_reverse",)


def test_an_effect_is_unsure_below_the_probability_of_a_sure_one() -> None:
    problem, retuned = laid(sail("fitted", 1, odd)[0])
    ranking = select_and_rank_candidates(problem, ("weak_reverse",))
    sure = problem.config.decide.sure_probability
    named = []
    for name, probability in (("wind", sure), ("current", sure - 0.01), ("tether", 0.5)):
        named.append(IdentifiedEffect(name, 20.0, 20.0, probability, (), {}))
    ranking = replace(ranking, named=tuple(named))
    assert _unsure_effects(problem, ranking, ["wind", "current"]) == ["current"]
