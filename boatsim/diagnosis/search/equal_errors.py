"""Replaces equal errors of several drives by one error of all of them."""

from collections.abc import Iterator, Sequence

import numpy as np

from boatsim.diagnosis.fit import unfitted_hypothesis
from boatsim.diagnosis.problem import Fit, free_parameter_values
from boatsim.diagnosis.search.candidate_sets import CandidateSets
from boatsim.physics.groups import group_of, name_in_group, without_group


def merge_equal_errors(sets: CandidateSets, best: Fit) -> Fit:
    """Replace errors of several single drives by the same error of all drives, if these are equal.

    Equal errors of three drives are one cause, such as a slow bus, and not three. They count as
    equal if one value for all loses less evidence than an effect must gain: then the recordings do
    not require the further effects.

    Args:
        sets: Cache of the fits of candidate sets, with the estimation problem.
        best: Fit of the vessel model with some candidate effects.

    Returns:
        The fit with errors of all drives in the place of equal ones, or the given fit.
    """
    for singles in _errors_of_several_drives(sets, best):
        for common in _errors_of_all_drives(sets, singles[0]):
            if common in best.effects or sets.budget.is_spent:
                continue
            merged = sets.converged_fit(merged_fit(sets, best, singles, common))
            if merged.evidence > best.evidence - sets.required_gain:
                return merge_equal_errors(sets, merged)
    return best


def merged_fit(sets: CandidateSets, best: Fit, singles: Sequence[str], common: str) -> Fit:
    """Return the model with one error in the place of several single ones, not fitted.

    The parameters of the common error are the means of those of the single ones.

    Args:
        sets: Cache of the fits of candidate sets, with the estimation problem.
        best: Fit of the vessel model with some candidate effects.
        singles: Names of its effects that are replaced.
        common: Name of the effect that replaces them.
    """
    effects = [name for name in best.effects if name not in singles] + [common]
    free = sets.problem.free_parameters(effects)
    values = best.values()
    for parameter in free:
        if parameter.effect != common:
            continue
        found = [values[one, parameter.name] for one in singles if (one, parameter.name) in values]
        if found:
            mean = float(np.mean(found))
            values[common, parameter.name] = min(max(mean, parameter.low), parameter.high)
    theta = free_parameter_values(free, values)
    return unfitted_hypothesis(tuple(effects), free, theta, best.levels)


def _errors_of_several_drives(sets: CandidateSets, best: Fit) -> Iterator[list[str]]:
    """Yield the effects of a fit that are the same error of different drives, in one group."""
    found: dict[tuple[type, str], list[str]] = {}
    for name in best.effects:
        kind = type(sets.problem.candidates[without_group(name)])
        if kind.of_all:
            found.setdefault((kind, group_of(name)), []).append(name)
    for names in found.values():
        if len(names) > 1:
            yield names


def _errors_of_all_drives(sets: CandidateSets, single: str) -> Iterator[str]:
    """Yield the candidates that describe the same error of all drives, in the same group."""
    kind = type(sets.problem.candidates[without_group(single)])
    for name in kind.of_all:
        common = name_in_group(name, group_of(single)) if group_of(single) else name
        if common in sets.candidates and common not in sets.banned:
            yield common
