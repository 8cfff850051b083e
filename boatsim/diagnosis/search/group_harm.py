"""Restricts an effect to some groups of recordings if it makes simulations of another one worse."""

from boatsim.diagnosis.free_runs import free_run_horizon
from boatsim.diagnosis.problem import Fit
from boatsim.diagnosis.search.candidate_sets import CandidateSets, Recordings
from boatsim.diagnosis.search.forward_selection import select_forward
from boatsim.diagnosis.search.generalization import (
    error_growth_by_group,
    harmed_groups,
    recordings_by_group,
)
from boatsim.diagnosis.search.pruning import IdentifiedEffect, prune
from boatsim.diagnosis.search.screening import screen
from boatsim.diagnosis.search.validation import generalizes_worse
from boatsim.physics.groups import group_of, name_in_group

Selected = tuple[Fit, tuple[IdentifiedEffect, ...]]


def remove_harm_to_groups(
    sets: CandidateSets, best: Fit, named: tuple[IdentifiedEffect, ...], held_out: Recordings
) -> Selected:
    """Remove effects with which a group of held-out recordings is simulated much worse.

    The effects of all recordings together may be wrong in a group that has few of them. The effect
    without which that group is simulated much better is tested in the other groups alone, or is
    removed. It stays if all held-out recordings together are simulated worse then.

    Args:
        sets: Fits of candidate sets; an effect that is removed is added to those refuted.
        best: Fit of the vessel model with some candidate effects.
        named: Identified effects of the fit, with their statistics.
        held_out: Held-out recordings, which no fit has used.

    Returns:
        The fit with the remaining effects, and the statistics of these effects.
    """
    if not recordings_by_group(held_out):
        return best, named
    examined = set[str]()
    while True:
        found = _most_harmful_effect(sets, best, held_out, examined)
        if found is None:
            return best, named
        name, group = found
        examined.add(name)
        sets.banned.add(name)
        other = _fit_in_other_groups(sets, best, name, group, held_out)
        further = prune(sets, select_forward(sets, other))
        if generalizes_worse(sets, best, further[0], held_out):
            sets.banned.remove(name)
            continue
        best, named = further


def _most_harmful_effect(
    sets: CandidateSets, best: Fit, held_out: Recordings, examined: set[str]
) -> tuple[str, str] | None:
    """The effect that harms a group of held-out recordings most, and that group; None: no harm."""
    problem, horizon = sets.problem, free_run_horizon(sets.problem, held_out)
    groups = harmed_groups(problem, sets.base, best, held_out, horizon)
    most, found = problem.config.validate.group_harm, None
    for name in best.effects:
        if not groups or name in examined:
            continue
        without = sets.fit_without(best, name)
        growth = error_growth_by_group(problem, without, best, held_out, horizon)
        for group in groups:
            if growth.get(group, 0.0) > most:
                most, found = growth[group], (name, group)
    return found


def _fit_in_other_groups(
    sets: CandidateSets, best: Fit, name: str, harmed: str, held_out: Recordings
) -> Fit:
    """The fit without an effect, or with the effect in the other group where it gains most."""
    without = sets.fit_without(best, name)
    if group_of(name):
        return without
    elsewhere = set(sets.problem.groups)
    for mapped in recordings_by_group(held_out)[harmed]:
        elsewhere.difference_update(mapped.groups)
    rivals = [name_in_group(name, group) for group in sorted(elsewhere)]
    rivals = [rival for rival in rivals if rival in sets.candidates and rival not in sets.banned]
    if not rivals:
        return without
    screened = screen(sets.problem, without, rivals)
    leading = max(screened.values(), key=lambda found: found.evidence)
    if not leading.evidence > without.evidence + sets.required_gain:
        return without
    return sets.converged_fit(leading)
