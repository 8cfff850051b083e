"""The simulate stage: where a force remains unexplained, free runs decide what predicts best."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from boatsim.diagnosis.description import FittedTerm, SymbolicDescription
from boatsim.diagnosis.filter import MappedRecording
from boatsim.diagnosis.fit import remove_effect, unfitted_hypothesis
from boatsim.diagnosis.free_runs import free_run_horizon, free_runs, rms_errors
from boatsim.diagnosis.open_set.refinement import refines_estimated_number
from boatsim.diagnosis.output_error.errors import MODEL
from boatsim.diagnosis.output_error.search import (
    OutputErrorSearch,
    rms_error_ratio,
    with_coefficients_of_file,
)
from boatsim.diagnosis.problem import Fit, Problem, free_parameter_values
from boatsim.diagnosis.recalibration import Recalibration
from boatsim.diagnosis.search import generalization
from boatsim.diagnosis.search.budget import SearchBudget
from boatsim.diagnosis.search.ranking import Ranking
from boatsim.diagnosis.stage_budgets import unsure_budget

FIRST_SHARE = 0.5  # of the budget, for the first search, so that further ones can end


def fit_to_simulations(
    problem: Problem,
    ranking: Ranking,
    candidates: Sequence[str],
    held_out: Sequence[MappedRecording],
    budget: SearchBudget,
) -> Ranking:
    """Fit the retuned and the corrected vessel to free runs, where a force remains unexplained.

    A Kalman filter ascribes such a force to a disturbance, so that it finds coefficients and
    effects which explain single steps, but may simulate badly. Parameters of effects that are
    stated as causes keep their values, unless free runs found these effects. An effect that
    simulations contradict is only possible, and so is one that is only probably a cause where a
    search without it finds a vessel that predicts clearly better. Candidates are added that make
    simulations better, as a description. Each vessel is replaced only if it predicts held-out
    recordings clearly better.

    Args:
        problem: The estimation problem: recordings, vessel model, candidate effects and priors.
        ranking: Selected and described effects, with the adopted coefficients.
        candidates: Names of the candidates that may be added.
        held_out: Held-out recordings, at least one.
        budget: Work that may be done; then no further effect of the filter is dropped, and none
            is added.

    Returns:
        The ranking with the vessels that predict best; the same one if nothing is unexplained.
    """
    if not ranking.has_unexplained_force_or_cause or ranking.divergences:
        return ranking
    first = budget.part(FIRST_SHARE)
    simple = OutputErrorSearch(problem, ranking.recalibrated, held_out, budget=first)
    simple.start_from(with_coefficients_of_file(ranking.recalibrated))
    retuned = simple.model
    better = _is_clearly_better(problem, retuned, ranking.recalibrated, held_out)
    stated = []
    for one in ranking.named:
        refines = refines_estimated_number(problem, ranking.best, one.name)
        if not refines and one.name not in ranking.balanced:
            stated.append(one.name)
    contradicted = contradicted_effects(problem, ranking.best, stated, held_out)
    kept = [name for name in stated if name not in contradicted]
    if kept:
        only_stated = _without_effects(problem, ranking.best, kept)
        simple = OutputErrorSearch(problem, only_stated, held_out, kept, first)
        simple.start_from(with_coefficients_of_file(only_stated))
    before = simple.model
    candidates = [name for name in candidates if name not in contradicted]
    simple.add_effects(candidates)
    others = [name for name in ranking.best.effects if name not in contradicted]
    search = simple
    for start in _further_starts(problem, ranking.best, before, others):
        search = _better_of_two(search, before, start, candidates, budget)
    if search.budget.is_spent and not budget.is_spent:
        search.budget = budget
        search.add_effects(candidates)
    corrected = search.model
    unsure = _unsure_effects(problem, ranking, kept)
    if unsure:
        sure = [name for name in kept if name not in unsure]
        start = _with_retuned_coefficients(problem, ranking.best, sure, retuned)
        corrected = _search_without_unsure(problem, corrected, start, candidates, held_out)
        contradicted += tuple(name for name in unsure if name not in corrected.effects)
    found = ranking
    if better:
        found = _with_retuned(problem, ranking, retuned, held_out)
    if _is_clearly_better(problem, corrected, found.best, held_out):
        found = _with_corrected(found, corrected, contradicted)
    return found


def contradicted_effects(
    problem: Problem,
    best: Fit,
    stated: Sequence[str],
    held_out: Sequence[MappedRecording],
) -> tuple[str, ...]:
    """Return those effects without which free runs are clearly more probable.

    Held-out recordings have to agree. An effect on which free runs do not depend, such as an error
    of a rate sensor, is never contradicted.

    Args:
        problem: The estimation problem.
        best: Fit of the vessel model with some candidate effects.
        stated: Names of effects that are stated as causes.
        held_out: Held-out recordings, at least one.
    """
    found = list[str]()
    if not stated:
        return ()
    search = OutputErrorSearch(problem, best, held_out, stated)
    for name in stated:
        if search.drop_if_clearly_better(name):
            found.append(name)
    return tuple(found)


def _unsure_effects(problem: Problem, ranking: Ranking, stated: Sequence[str]) -> list[str]:
    """Names of the stated effects that are only probably causes."""
    found = []
    for one in ranking.named:
        if one.name in stated and is_unsure(problem, one.probability):
            found.append(one.name)
    return found


def is_unsure(problem: Problem, probability: float) -> bool:
    """Return whether an effect that is stated with some probability is only probably a cause.

    Args:
        problem: The estimation problem with its configuration.
        probability: Probability that the effect is a cause, 0 to 1.
    """
    return probability < problem.config.decide.sure_probability


def _search_without_unsure(
    problem: Problem,
    corrected: Fit,
    start: Fit,
    candidates: Sequence[str],
    held_out: Sequence[MappedRecording],
) -> Fit:
    """The vessel of a search that may give up effects which are only probably causes.

    Such an effect keeps the parameters of the filter, and leaves little for others to improve that
    it stands in for.

    Args:
        problem: The estimation problem.
        corrected: The vessel with these effects.
        start: The vessel without them.
        candidates: Names of the candidates that may be added, these effects included.
        held_out: Held-out recordings, at least one.

    Returns:
        The vessel that was found from the start, if it predicts held-out recordings clearly better;
        else the one with these effects.
    """
    budget = unsure_budget(problem)
    search = OutputErrorSearch(problem, start, held_out, start.effects, budget)
    search.add_effects(candidates)
    if _is_clearly_better(problem, search.model, corrected, held_out):
        return search.model
    return corrected


def _is_clearly_better(
    problem: Problem, found: Fit, reference: Fit, held_out: Sequence[MappedRecording]
) -> bool:
    """Whether a vessel predicts held-out recordings clearly better, and no group much worse."""
    horizon = free_run_horizon(problem, held_out)
    ratio = rms_error_ratio(problem, found, reference, held_out, horizon)
    if ratio * problem.config.simulate.better > 1.0:
        return False
    return not generalization.harmed_groups(problem, reference, found, held_out, horizon)


def _further_starts(problem: Problem, best: Fit, before: Fit, others: Sequence[str]) -> list[Fit]:
    """Return the vessels from which the search starts besides that of the stated effects.

    The first one is the vessel of the Kalman filter. In the second one the coefficients are those
    that were fitted to free runs, because the filter ascribes much of what a wrong coefficient does
    to a disturbance, so that its coefficients may be too far from those of free runs to be a start.
    The terms of a formula are left out of the second one: they describe what the model with the
    filter's coefficients left unexplained.

    Args:
        problem: The estimation problem.
        best: Fit of the Kalman filter with all effects and terms that it selected.
        before: The vessel with the effects that are stated as causes, fitted to free runs.
        others: Names of the effects and terms of the filter that simulations do not contradict.
    """
    starts = list[Fit]()
    if set(others) != set(before.effects):
        starts.append(_without_effects(problem, best, others))
    effects = [name for name in others if not type(problem.candidates[name]).described]
    if set(effects) != set(before.effects):
        starts.append(_with_retuned_coefficients(problem, best, effects, before))
    return starts


def _with_retuned_coefficients(
    problem: Problem, best: Fit, effects: Sequence[str], retuned: Fit
) -> Fit:
    """The vessel with some effects of one fit, and with all values that another fit has."""
    free = problem.free_parameters(tuple(effects))
    theta = free_parameter_values(free, {**best.values(), **retuned.values()})
    return unfitted_hypothesis(tuple(effects), free, theta, retuned.levels)


def _better_of_two(
    simple: OutputErrorSearch,
    before: Fit,
    start: Fit,
    candidates: Sequence[str],
    budget: SearchBudget,
) -> OutputErrorSearch:
    """The better of two searches: a completed one, and one from effects of the filter.

    Each search adds one effect at a time, so that its result depends on its start. What the filter
    selected is no start if simulations of a group of recordings get much worse by it, because later
    steps are compared with the start.

    Args:
        simple: The completed search, such as that from the effects that are stated as causes.
        before: The vessel of the effects that are stated as causes, before effects were added.
        start: The vessel with effects that the filter selected.
        candidates: Names of the candidates that may be added.
        budget: Work that the second search may do.
    """
    problem, held_out = simple.problem, simple.held_out
    if budget.is_spent:
        return simple
    whole = OutputErrorSearch(problem, start, held_out, simple.fixed_effects, budget)
    whole.drop_effects()
    if generalization.harmed_groups(problem, before, whole.model, held_out, whole.horizon):
        return simple
    whole.add_effects(candidates)
    if simple.held_out_ratio(whole.model) < 1.0 and not simple.harms(whole.model):
        return whole
    return simple


def _without_effects(problem: Problem, best: Fit, kept: Sequence[str]) -> Fit:
    """A fit with some of its effects only, not refitted."""
    found = best
    for name in best.effects:
        if name not in kept:
            found = remove_effect(problem, found, name)
    return found


def _with_retuned(
    problem: Problem, ranking: Ranking, retuned: Fit, held_out: Sequence[MappedRecording]
) -> Ranking:
    """The ranking with the retuned vessel that free runs over the fitted recordings gave."""
    horizon = free_run_horizon(problem, held_out)
    errors = rms_errors(free_runs(problem, {MODEL: retuned}, held_out, horizon))
    recalibration = Recalibration(
        retuned, (), True, {family: rms[MODEL] for family, rms in errors.items()}, by_free_runs=True
    )
    best = retuned if not ranking.best.effects else ranking.best
    return replace(ranking, best=best, recalibrated=retuned, recalibration=recalibration)


def _with_corrected(ranking: Ranking, found: Fit, contradicted: Sequence[str]) -> Ranking:
    """The ranking with the corrected vessel that free runs gave."""
    before = {one.name for one in (*ranking.named, *ranking.doubtful)}
    if ranking.description is not None:  # its terms, with events of single recordings
        before |= {one.term.name for one in ranking.description.terms}
    named, doubtful = list(ranking.named), list(ranking.doubtful)
    for one in ranking.named:
        if one.name not in found.effects:
            named.remove(one)
            if one.name in contradicted or one.name in ranking.balanced:
                doubtful.append(one)
    return replace(
        ranking,
        best=_with_known_covariance(found, ranking.best, [one.name for one in named]),
        named=tuple(named),
        doubtful=tuple(doubtful),
        contradicted=tuple(contradicted),
        added=tuple(name for name in found.effects if name not in before),
        description=_moved_description(ranking, found),
        by_free_runs=True,
    )


def _with_known_covariance(found: Fit, before: Fit, stated: Sequence[str]) -> Fit:
    """A fit in which effects that kept their parameters have the covariance of an earlier fit."""
    old = {(f.effect, f.name): i for i, f in enumerate(before.free) if f.effect in stated}
    own, theirs = list[int](), list[int]()
    for i, f in enumerate(found.free):
        j = old.get((f.effect, f.name))
        if j is not None and not f.relative and found.theta[i] == before.theta[j]:
            own.append(i)
            theirs.append(j)
    covariance = found.covariance.copy()
    covariance[own, :] = covariance[:, own] = 0.0
    covariance[np.ix_(own, own)] = before.covariance[np.ix_(theirs, theirs)]
    return replace(found, covariance=covariance)


def _moved_description(ranking: Ranking, found: Fit) -> SymbolicDescription | None:
    """The formula with the coefficients of a fit; terms that it lacks do not hold."""
    if ranking.description is None:
        return None
    terms = list[FittedTerm]()
    for one in ranking.description.terms:
        if one.carries and one.term.name in found.effects:
            value, sd = found.value(one.term.name, "coefficient")
            terms.append(_moved_term(one, value, sd))
        else:
            terms.append(replace(one, carries=False))
    return replace(ranking.description, terms=tuple(terms))


def _moved_term(one: FittedTerm, value: float, sd: float) -> FittedTerm:
    """A term with another coefficient; its curve is proportional to that."""
    curve, before = one.curve, one.term.coefficient
    if curve is not None and before:
        curve = replace(curve, law=curve.law * value / before, sd=abs(sd / before * curve.law))
    return replace(one, term=replace(one.term, coefficient=value), sd=sd, curve=curve)
