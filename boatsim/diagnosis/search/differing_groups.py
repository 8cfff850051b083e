"""Restricts an effect of all recordings to one group, where every other group has its own value."""

import numpy as np

from boatsim.diagnosis.fit import unfitted_hypothesis
from boatsim.diagnosis.problem import Fit, Problem, free_parameter_values
from boatsim.diagnosis.search.candidate_sets import CandidateSets, Recordings
from boatsim.diagnosis.search.pruning import IdentifiedEffect, prune
from boatsim.diagnosis.search.validation import generalizes_worse
from boatsim.physics.groups import group_of, name_in_group, without_group

Selected = tuple[Fit, tuple[IdentifiedEffect, ...]]


def restrict_to_single_groups(
    sets: CandidateSets, best: Fit, named: tuple[IdentifiedEffect, ...], held_out: Recordings
) -> Selected:
    """Restrict effects of all recordings to one group, where all other groups have their own value.

    Of three days with three different winds, the search finds the wind of one day as common to all
    recordings, and two other winds in its place on the other days. No two groups share a value
    then, so that the effect is stated for its group alone. It stays common if held-out recordings,
    such as those of a further group, are simulated worse otherwise, and if it refines an estimated
    number of the vessel file, which is a number of the vessel on all days.

    Args:
        sets: Fits of candidate sets; an effect that is restricted is added to those refuted.
        best: Fit of the vessel model with some candidate effects.
        named: Identified effects of the fit, with their statistics.
        held_out: Held-out recordings, which no fit has used.

    Returns:
        The fit with effects of single groups, and the statistics of these effects.
    """
    examined = set(sets.refining)
    while True:
        name, group = _effect_of_one_group(sets.problem, best, examined)
        if not group:
            return best, named
        examined.add(name)
        sets.banned.add(name)
        restricted = restricted_fit(sets.problem, best, name, group)
        further = prune(sets, sets.converged_fit(restricted))
        if generalizes_worse(sets, best, further[0], held_out):
            sets.banned.remove(name)
            continue
        best, named = further


def group_without_own_value(problem: Problem, best: Fit, name: str) -> str:
    """Return the only group in which an effect of all recordings is not replaced or changed.

    Args:
        problem: The estimation problem.
        best: Fit of the vessel model with some candidate effects.
        name: Name of an effect that acts in all recordings.

    Returns:
        Name of the group; "" if the effect is unchanged in several groups, or in recordings that
        belong to none.
    """
    others = []
    for other in best.effects:
        if without_group(other) == name and group_of(other):
            others.append(group_of(other))
    if not others:
        return ""
    for group in problem.groups:
        if group not in others and problem.are_separate_and_complete([group, *others]):
            return group
    return ""


def _effect_of_one_group(problem: Problem, best: Fit, examined: set[str]) -> tuple[str, str]:
    """The first effect of all recordings that acts in one group alone, and that group, or ""."""
    for name in best.effects:
        if name in examined or group_of(name):
            continue
        if group := group_without_own_value(problem, best, name):
            return name, group
    return "", ""


def restricted_fit(problem: Problem, best: Fit, name: str, group: str) -> Fit:
    """Return the same model with an effect of all recordings in one group alone, not refitted.

    The effects of the other groups replace its numbers, or change them by a factor or a summand.
    Such a factor is multiplied by that of the effect, and such a summand is added to its own, so
    that the numbers of all fitted recordings stay the same, within the bounds of the parameters.

    Args:
        problem: The estimation problem.
        best: Fit of the vessel model with some candidate effects.
        name: Name of an effect that acts in all recordings.
        group: The group in which it will act alone.
    """
    alone = name_in_group(name, group)
    effects = list(best.effects)
    effects[effects.index(name)] = alone
    free = problem.free_parameters(effects)
    values = best.values()
    for parameter in free:
        key = parameter.effect, parameter.name
        common = values.get((name, parameter.name), parameter.mean)
        if parameter.effect == alone:
            values[key] = common
        elif without_group(parameter.effect) != name or parameter.how == "sets":
            continue
        elif parameter.how == "scales":
            values[key] *= common
        else:
            values[key] += common
    theta = free_parameter_values(free, values)
    low = np.array([parameter.low for parameter in free])
    high = np.array([parameter.high for parameter in free])
    return unfitted_hypothesis(tuple(effects), free, np.clip(theta, low, high), best.levels)
