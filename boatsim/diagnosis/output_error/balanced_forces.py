"""Finds a spring to the ground together with the force that it balances.

A steady force moves a vessel away unless something holds it, and a spring holds nothing unless a
force acts. Neither makes simulations better without the other one, so that a search which adds one
effect at a time finds neither. Both act slowly. A Kalman filter ascribes a slow force to its latent
force, so that the pair gains little of the evidence that faster forces explain. Therefore free runs
over whole recordings take part in the decision.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace

from boatsim.diagnosis.candidates import name_without_prefixes
from boatsim.diagnosis.filter import MappedRecording
from boatsim.diagnosis.fit import converge, remove_effect
from boatsim.diagnosis.output_error.search import (
    BalancedPair,
    OutputErrorSearch,
    with_coefficients_of_file,
)
from boatsim.diagnosis.problem import Fit, Problem
from boatsim.diagnosis.search.evidence import required_gain
from boatsim.diagnosis.search.pruning import IdentifiedEffect, compare_rivals
from boatsim.diagnosis.search.ranking import Ranking, with_further_effects
from boatsim.diagnosis.search.screening import add_effect
from boatsim.diagnosis.stage_budgets import pair_budget
from boatsim.physics.base import Effect, Force
from boatsim.physics.groups import group_of
from boatsim.progress import Report, ignore_progress


def add_balanced_forces(
    problem: Problem,
    ranking: Ranking,
    candidates: Sequence[str],
    held_out: Sequence[MappedRecording],
    report: Report = ignore_progress,
) -> Ranking:
    """Add a spring to the ground and the force that it balances, where the recordings require both.

    By the evidence of the Kalman filter the pair must gain twice what a single effect needs. That
    evidence may be small relative to what the other effects explain, so that the pair could only
    correct the shape of their laws (`select.slight_share`). Therefore free runs over the fitted and
    over the held-out recordings must be more probable with the pair, too, and more so than with
    either effect alone. Each effect of the pair, added to the other one, must gain by the filter
    and by free runs, and by one of both what a single effect needs: the filter sees little of a
    slow force, and free runs little of a fast motion.

    Args:
        problem: The estimation problem: recordings, vessel model, candidate effects and priors.
        ranking: Result of the selection, which adds effects one by one.
        candidates: Names of the candidates that are tested.
        held_out: Held-out recordings, which no fit has used.
        report: Receives the progress.

    Returns:
        The ranking with both effects; the same one if no pair is required, or if no candidate is a
        spring to the ground.
    """
    best = ranking.best
    addable = _addable_forces(problem, best, candidates)
    springs = [name for name in addable if is_spring_to_ground(problem, name)]
    room = problem.config.select.most_effects - len(best.effects)
    if not springs or not held_out or room < 2 or not ranking.has_unexplained_force_or_cause:
        return ranking
    report("looking for forces that balance each other", 0.0)
    search = OutputErrorSearch(problem, best, held_out, budget=pair_budget(problem))
    search.start_from(with_coefficients_of_file(best))
    search.drop_effects()
    required = required_gain(len(candidates), problem.config.select)
    others = [name for name in addable if name not in springs]
    for spring in springs:
        pair = search.most_probable_pair(spring, others)
        if pair is None:
            continue
        both = _fit_of_filter(problem, best, pair)
        if both.evidence <= best.evidence + 2.0 * required:
            continue
        without = {
            name: converge(problem, remove_effect(problem, both, name)) for name in pair.gains
        }
        if _is_each_needed(both, without, pair, required):
            without |= _fits_without_others(problem, ranking, both, pair)
            named = _statistics(problem, both, without, ranking.named)
            found = with_further_effects(problem, ranking, both, named, without)
            return replace(found, balanced=tuple(pair.gains))
    return ranking


def is_spring_to_ground(problem: Problem, name: str) -> bool:
    """Whether a candidate is a linear spring between the vessel and the ground.

    Args:
        problem: The estimation problem with the vessel and its candidates.
        name: Name of the candidate.
    """
    effect = problem.candidates[name]
    if not isinstance(effect, Force) or not effect.tied_to:
        return False
    dof = problem.program.vessel.dof
    fitted = [p for p in type(effect).params().values() if p.fit and p.axis in dof]
    return bool(fitted) and all(p.calibrates == "restoring" for p in fitted)


def _is_force(effect: Effect) -> bool:
    """Whether an effect is a deterministic force that is no placeholder of a formula."""
    kind = type(effect)
    return isinstance(effect, Force) and not (kind.random or kind.described)


def _addable_forces(problem: Problem, best: Fit, candidates: Sequence[str]) -> list[str]:
    """Forces that act in all recordings and that a fit does not have."""
    present = set(map(name_without_prefixes, best.effects))
    found = []
    for name in candidates:
        absent = name_without_prefixes(name) not in present and not group_of(name)
        if absent and _is_force(problem.candidates[name]):
            found.append(name)
    return found


def _fit_of_filter(problem: Problem, best: Fit, pair: BalancedPair) -> Fit:
    """The converged fit of the Kalman filter with the pair in addition to the selected effects.

    It starts from the sizes of the pair in the free runs.
    """
    return converge(problem, _with_pair(problem, best, pair, pair.model))


def _with_pair(problem: Problem, start: Fit, pair: BalancedPair, sizes: Fit) -> Fit:
    """A fit with the effects of a pair in addition, which have the sizes of another fit."""
    values = sizes.values()
    for name in pair.gains:
        own = {parameter: x for (effect, parameter), x in values.items() if effect == name}
        start = add_effect(problem, start, name, own)
    return start


def _fits_without_others(
    problem: Problem, ranking: Ranking, both: Fit, pair: BalancedPair
) -> dict[str, Fit]:
    """Converged fits with a pair, and without one of the effects selected before, by its name.

    They start from the fits without that effect which the ranking has.
    """
    found = {}
    for name in ranking.best.effects:
        start = remove_effect(problem, both, name)
        if name in ranking.without:
            start = _with_pair(problem, ranking.without[name], pair, both)
        found[name] = converge(problem, start)
    return found


def _is_each_needed(
    both: Fit, without: Mapping[str, Fit], pair: BalancedPair, required: float
) -> bool:
    """Whether each effect of a pair, added to the other one, gains what a single effect needs.

    Args:
        both: Converged fit of the Kalman filter with the pair.
        without: Converged fits without one of its effects, by the name of the effect.
        pair: The pair with its gains by free runs, which are positive.
        required: What a single effect needs [nats].
    """
    for name, in_free_runs in pair.gains.items():
        in_filter = float(both.evidence - without[name].evidence)
        if in_filter <= 0.0 or max(in_filter, in_free_runs) < required:
            return False
    return True


def _statistics(
    problem: Problem,
    both: Fit,
    without: dict[str, Fit],
    named: Sequence[IdentifiedEffect],
) -> tuple[IdentifiedEffect, ...]:
    """Statistics of all effects of a fit; those that were known keep their rivals."""
    known = {one.name: one for one in named}
    found = []
    for name in both.effects:
        if name in known:
            one = known[name]
            change = float(both.evidence - without[name].evidence) - one.gain
            found.append(replace(one, gain=one.gain + change, shared=one.shared + change))
        else:
            found.append(compare_rivals(name, both, without[name], {}, problem.config.select))
    return tuple(found)
