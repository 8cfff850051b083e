"""Finds effects where much remains unexplained although no candidate gains enough by itself.

Two cases hide a cause from forward selection. The latent (unmodelled) force of the Kalman filter
may explain what a candidate would explain: the candidate then gains little as long as that force
is as large as it is without it. And two causes may hide each other, so that neither gains much
alone.
"""

from collections.abc import Iterator

import numpy as np

from boatsim.diagnosis.candidates import name_without_prefixes
from boatsim.diagnosis.fit import converge, fit
from boatsim.diagnosis.problem import Fit
from boatsim.diagnosis.search.candidate_sets import CandidateSets
from boatsim.diagnosis.search.evidence import unexplained_evidence, unknown_cause_threshold
from boatsim.diagnosis.search.screening import screen
from boatsim.physics.groups import group_of, without_group

NOT_SOUGHT = "effects that hide each other were not sought, although much remains unexplained"


def add_further_effects(sets: CandidateSets, best: Fit) -> Fit | None:
    """Return a fit with one or two more candidate effects that explain an unexplained force.

    Candidates are screened with the latent force at its assumed level. The most promising ones are
    fitted, and if none gains enough, each of them together with the most promising second one.

    Args:
        sets: Cache of the fits of candidate sets, with the estimation problem.
        best: Fit to which no single candidate adds enough evidence.

    Returns:
        The best fit whose further effects gain enough; None if there is none, or if little remains
        unexplained.
    """
    key = frozenset(best.effects), frozenset(sets.banned)
    if key not in sets.further:
        before = sets.budget.used_work
        sets.further[key] = _find_further_effects(sets, best)
        sets.add_further_work(sets.budget.used_work - before)
    return sets.further[key]


def _find_further_effects(sets: CandidateSets, best: Fit) -> Fit | None:
    threshold = unknown_cause_threshold(sets.config.select, sets.explained_evidence(best))
    room = sets.config.select.most_effects - len(best.effects)
    if room < 1 or unexplained_evidence(sets.problem, best) < threshold:
        return None
    if _ends(sets):
        sets.budget.record_skipped_attempt(NOT_SOUGHT)
        return None
    order = list[str]()
    least = best.evidence
    singles = list(_additions(sets, best, order, least))
    found = _sufficient(singles, best.evidence + sets.required_gain)
    if found is not None or room < 2:
        return found
    if sets.skips_thorough_search:  # second effects are those that promised most alone
        order = _best_of_each_kind(sets, order)[: sets.config.select.saving_seconds]
    pairs: list[Fit] = []
    for single in singles:
        if _ends(sets):
            sets.budget.record_skipped_attempt(NOT_SOUGHT)
            break
        pairs += _additions(sets, single, order.copy(), least)
    return _sufficient(pairs, best.evidence + 2.0 * sets.required_gain)


def _best_of_each_kind(sets: CandidateSets, order: list[str]) -> list[str]:
    """The first candidate of each kind and group: one drive of several with the same fault.

    Otherwise the drives of a vessel with many would leave no room for other kinds.
    """
    found: dict[tuple[type, str], str] = {}
    for name in order:
        kind = type(sets.problem.candidates[without_group(name)])
        found.setdefault((kind, group_of(name)), name)
    return list(found.values())


def _sufficient(fits: list[Fit], least: float) -> Fit | None:
    """The fit with most evidence, if that is enough."""
    best = max(fits, key=lambda one: one.evidence, default=None)
    return best if best is not None and best.evidence > least else None


def _ends(sets: CandidateSets) -> bool:
    """Whether the budget of the search is spent, or the share of it that is used here."""
    most = sets.config.select.further_share * sets.config.select.budget
    return sets.budget.is_spent or sets.further_work > most


def _additions(sets: CandidateSets, best: Fit, order: list[str], least: float) -> Iterator[Fit]:
    """Yield converged fits with one more effect, for the candidates that promise most.

    `order` names the candidates, none for all; it is replaced by their order. A search that saves
    work does not refine fits whose evidence is not above `least`. Where the budget is spent, or
    does not suffice for all candidates, the rest is not fitted.
    """
    problem = sets.problem
    if not order and sets.budget.remaining_work < sets.screening_work:
        sets.budget.record_skipped_attempt(NOT_SOUGHT)
        return
    calm = sets.gauss_newton_steps_at_assumed_disturbance(best)
    if not np.isfinite(calm.evidence):
        return
    ideas = set(map(name_without_prefixes, best.effects))
    names = []
    for name in order or sets.candidates:
        if name_without_prefixes(name) not in ideas and name not in sets.random | sets.banned:
            names.append(name)
    screened = screen(problem, calm, names)
    order[:] = sorted(names, key=lambda name: -screened[name].evidence)
    for name in _best_of_each_kind(sets, order)[: sets.config.select.further_fits]:
        if sets.budget.is_spent:
            sets.budget.record_skipped_attempt(NOT_SOUGHT)
            return
        start = sets.gauss_newton_steps_at_assumed_disturbance(screened[name])
        if np.isfinite(start.evidence) and sets.skips_thorough_search:
            start = fit(problem, start)
            if not start.evidence > least:
                yield start
                continue
        if np.isfinite(start.evidence):
            yield sets.cache_better_fit(converge(problem, start))
