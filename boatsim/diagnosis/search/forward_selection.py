"""Forward selection: adds the candidates one by one, each time the one that gains most evidence."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from boatsim.diagnosis.candidates import name_without_prefixes
from boatsim.diagnosis.problem import Fit
from boatsim.diagnosis.search.budget import in_addition_to_phrase
from boatsim.diagnosis.search.candidate_sets import CandidateSets
from boatsim.diagnosis.search.equal_errors import merge_equal_errors
from boatsim.diagnosis.search.evidence import (
    combined_gain,
    log_evidence_gains,
    quadratic_evidence_gain,
)
from boatsim.diagnosis.search.further_effects import add_further_effects

# shares of the work of a selection, by experience: at its begin and end, and what remains of it
# after each further effect
BEGIN = 0.5
END = 0.8
REMAINS = 0.7


def select_forward(sets: CandidateSets, best: Fit, among: Sequence[str] = ()) -> Fit:
    """Add candidate effects to a fit one by one, each time the one that gains most evidence.

    The selection ends when no candidate gains enough. Earlier effects that a newer one makes
    unnecessary are removed, and equal errors of several drives become one of all drives. When the
    budget of the search is spent, no further candidate is added.

    Args:
        sets: Cache of the fits of candidate sets, with the estimation problem.
        best: Fit from which the selection starts.
        among: Names of the candidates that may be added; none: all of them.

    Returns:
        The converged fit with the selected effects.
    """
    config = sets.config.select
    for _ in range(2 * config.most_effects):  # additions and removals
        tested = sets.screen_unrefuted(best, among)
        if among:
            tested = {n: f for n, f in tested.items() if n in among}
        _report(sets, best)
        if not tested or len(best.effects) == config.most_effects:
            break
        laws = {n: f for n, f in tested.items() if n not in sets.random}
        share = config.deterministic_share * _combined_gain(tested, best)
        if _combined_gain(laws, best) > max(sets.required_gain, share):
            tested = laws  # a stochastic force can replace a law, a law hardly replaces it
        tested = _with_enough_gain(sets, best, tested)
        if not tested:
            further = None if among else add_further_effects(sets, best)
            if further is None:
                break
            best = further
            continue
        name = max(tested, key=lambda n: tested[n].evidence)
        if sets.budget.is_spent:
            gain = tested[name].evidence - best.evidence
            sets.budget.record_skipped_attempt(_not_added(name, best, gain))
            break
        converged = sets.refit_from_assumed_disturbance(sets.converged_fit(tested[name]))
        further = merge_equal_errors(sets, _without_unnecessary(sets, converged))
        if set(further.effects) == set(best.effects):
            break  # the newest one was removed again
        best = further
    return best


def _with_enough_gain(sets: CandidateSets, best: Fit, tested: Mapping[str, Fit]) -> dict[str, Fit]:
    """Candidates that gain enough together, or those of physics that do; none if neither does."""
    physics = {name: fit for name, fit in tested.items() if name not in sets.measurement}
    for measurement, fits in ((True, tested), (False, physics)):
        least = max(sets.required_gain, sets.slight_gain(best, measurement=measurement))
        if _combined_gain(fits, best) >= least:
            return dict(fits)
    return {}


def _not_added(name: str, best: Fit, gain: float) -> str:
    """The statement that a candidate was not added."""
    where = f" {in_addition_to_phrase(best.effects)}" if best.effects else ""
    added = f"{name_without_prefixes(name)} was not added{where}"
    return f"{added}, although a first estimate of its evidence is {gain:.0f} nats"


def _report(sets: CandidateSets, best: Fit) -> None:
    """Report the best set so far."""
    names = ", ".join(map(name_without_prefixes, best.effects))
    done = END - (END - BEGIN) * REMAINS ** len(best.effects)
    gain = best.evidence - sets.base.evidence
    sets.report("selecting", done, f"best so far: {names} ({gain:.0f} nats)" if names else "")


def refit_from_baseline_noise_levels(sets: CandidateSets, other: Fit) -> Fit:
    """Refit the effects of a fit, starting from the noise levels of the vessel without effects.

    Args:
        sets: Cache of the fits of candidate sets, with the estimation problem.
        other: Fit whose effects are refitted, to the same recordings.
    """
    return sets.converged_fit(replace(other, levels=sets.base.levels, evidence=-np.inf))


def _combined_gain(fits: Mapping[str, Fit], best: Fit) -> float:
    """Evidence that any of several candidates gains on top of a set."""
    if not fits:
        return -np.inf
    return combined_gain(list(log_evidence_gains(fits, best).values()))


def _without_unnecessary(sets: CandidateSets, best: Fit) -> Fit:
    """The set without earlier effects that the newest one makes unnecessary."""
    keep = sets.config.select.keep_factor * sets.required_gain
    for name in best.effects[:-1]:
        if quadratic_evidence_gain(best, name) > keep:
            continue
        without = sets.fit_without(best, name)
        if without.evidence > best.evidence - sets.required_gain:
            best = without
    return best
