"""Prunes effects with insufficient evidence, and compares the others with their rivals."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from boatsim.diagnosis.candidates import REORDERED, name_without_prefixes
from boatsim.diagnosis.config import DEFAULT, SelectConfig
from boatsim.diagnosis.fit import log_prior
from boatsim.diagnosis.problem import Fit
from boatsim.diagnosis.search.candidate_sets import CandidateSets
from boatsim.diagnosis.search.evidence import (
    combined_gain,
    leading_candidates,
    log_evidence_gains,
    quadratic_evidence_gain,
    unexplained_evidence,
    unknown_cause_threshold,
)
from boatsim.diagnosis.search.forward_selection import select_forward
from boatsim.diagnosis.significance import distance_from_zero, jointly_differ_from_zero
from boatsim.physics.groups import group_of, without_group


@dataclass(frozen=True)
class IdentifiedEffect:
    """An effect that the recordings require, with its evidence, probability and rivals.

    Rivals are fits with another candidate effect in its place.
    """

    name: str
    gain: float  # [nats] on top of the other effects
    shared: float  # [nats] that any of it and its rivals gains
    probability: float
    tied_with: tuple[str, ...]  # names of its look-alikes
    rivals: Mapping[str, Fit]  # fits with the best other candidates in its place
    # groups of recordings in which the same effect explains them as well in its place
    tied_groups: tuple[str, ...] = ()


def prune(sets: CandidateSets, best: Fit) -> tuple[Fit, tuple[IdentifiedEffect, ...]]:
    """Remove effects with insufficient evidence from a fit.

    An effect in whose place another one is better is replaced, unless that leads back to a set that
    was examined before, or the budget of the search is spent.

    Args:
        sets: Cache of the fits of candidate sets, with the estimation problem.
        best: Fit of the vessel model with some candidate effects.

    Returns:
        The fit with the remaining effects, and the statistics of these effects.
    """
    examined = set()
    while True:
        examined.add(frozenset(best.effects))
        named = tuple(_compare_with_rivals(sets, best, name) for name in best.effects)
        better = _better_rivals(sets, best, named)
        further = best
        if better and sets.budget.is_spent:
            sets.budget.record_skipped_attempt(
                _not_replaced(best, max(better, key=lambda f: f.evidence))
            )
        elif better:
            further = select_forward(sets, max(better, key=lambda f: f.evidence))
        if frozenset(further.effects) not in examined:
            best = further
            continue
        weak, calming = list[IdentifiedEffect](), list[IdentifiedEffect]()
        for one in named:
            if _too_weak(sets, best, one) or _corrects_shape(sets, best, one):
                weak.append(one)
        for one in named:
            if one not in weak and not _improves_prediction(sets, best, one):
                calming.append(one)
        if not weak and not calming:
            return best, named
        removed = min(weak + calming, key=lambda n: n.gain)
        if removed in calming:
            sets.banned.add(removed.name)
        without = sets.fit_without(best, removed.name)
        if _may_have_hidden_others(sets, best, removed):
            sets.banned.add(removed.name)
            without = select_forward(sets, without)
        best = without


def _may_have_hidden_others(sets: CandidateSets, best: Fit, removed: IdentifiedEffect) -> bool:
    """Whether an effect gains much although its size may be zero.

    A stochastic force of uncertain size can take the place of a law, which was not selected then.
    """
    return removed.gain > sets.required_gain and not differs_from_zero(sets, best, removed.name)


def _not_replaced(best: Fit, better: Fit) -> str:
    """The statement that a better set with another effect was not examined."""
    gain = better.evidence - best.evidence
    old = ", ".join(
        name_without_prefixes(name) for name in best.effects if name not in better.effects
    )
    new = ", ".join(
        name_without_prefixes(name) for name in better.effects if name not in best.effects
    )
    return f"{new} did not replace {old}, although that gains {gain:.0f} nats"


def _better_rivals(
    sets: CandidateSets, best: Fit, named: tuple[IdentifiedEffect, ...]
) -> list[Fit]:
    """Fits with a rival in the place of an effect that are clearly better."""
    better = []
    for one in named:
        for rival, found in one.rivals.items():
            fair = one.name in sets.random or rival not in sets.random
            if fair and found.evidence > best.evidence + _required_lead(sets, one, rival):
                better.append(found)
    return better


def _required_lead(sets: CandidateSets, one: IdentifiedEffect, rival: str) -> float:
    """Evidence by which a rival must be ahead.

    A better value of an estimated number is expected before any missing physics, so that another
    effect must explain clearly more. Whether an effect acts before or after an actuator's lag
    deviates from the usual order only if the recordings show it.
    """
    name, alike = one.name, sets.config.select.alike
    refines = name in sets.refining
    if refines != (rival in sets.refining):
        lead = max(alike, sets.config.select.refining_lead * one.gain)
        return lead if refines else -lead
    if name.removeprefix(REORDERED) == rival.removeprefix(REORDERED):
        return -alike if name.startswith(REORDERED) else alike
    return sets.config.fit.refit_gain


def _too_weak(sets: CandidateSets, best: Fit, named: IdentifiedEffect) -> bool:
    """Whether an effect gains too little."""
    config = sets.config.select
    slight = sets.slight_gain(best, named.gain, named.name in sets.measurement)
    if named.gain < max(config.least_gain, slight) or named.shared < sets.required_gain:
        return True
    return not differs_from_zero(sets, best, named.name)


def _corrects_shape(sets: CandidateSets, best: Fit, named: IdentifiedEffect) -> bool:
    """Whether an effect only corrects the shape of another one.

    Each alone then explains most of what both explain. A square and a cube of one speed may both
    seem to be required where nature's law is neither.
    """
    config = sets.config.select
    if named.gain > unknown_cause_threshold(config, sets.explained_evidence(best)):
        return False
    alone = sets.fit_without(best, named.name)
    for other in alone.effects:
        if sets.skips_thorough_search and not may_only_correct_other_effect(
            best, named, other, config
        ):
            continue
        neither, instead = sets.fit_without(alone, other), sets.fit_without(best, other)
        both = best.evidence - neither.evidence
        least = min(alone.evidence, instead.evidence) - neither.evidence
        if least > config.alike_share * both and named.gain < unknown_cause_threshold(config, both):
            return True
    return False


def may_only_correct_other_effect(
    best: Fit, named: IdentifiedEffect, other: str, config: SelectConfig
) -> bool:
    """Whether an effect may only correct the shape of another one, by the covariance of both.

    Effects with independent parameters explain together the sum of what each explains. Then the
    fits without both, and without the other one, need not be computed.

    Args:
        best: Fit of the vessel model with some candidate effects.
        named: One of its effects.
        other: Name of another one.
        config: Settings of the selection.
    """
    both = quadratic_evidence_gain(best, named.name, other)
    larger = max(quadratic_evidence_gain(best, named.name), quadratic_evidence_gain(best, other))
    alike = larger < (1.0 - config.alike_share) * both
    return alike and named.gain < unknown_cause_threshold(config, both)


def _improves_prediction(sets: CandidateSets, best: Fit, named: IdentifiedEffect) -> bool:
    """Whether an effect makes the recording more likely with the noise levels held.

    Otherwise it only gains because less motion is expected: more damping keeps the hull still where
    nothing moves it, and forgets the initial state sooner. In calm water that is no merit of a law.
    Where a stochastic force acts, which absorbs what a law predicts, the water is not calm.
    """
    problem, config, found = sets.problem, sets.config.select, []
    rough = sets.unsteady & set(best.effects)
    if (
        named.name in sets.random
        or rough
        or unexplained_evidence(problem, best) > config.unknown_gain
    ):
        return True
    for one in (best, sets.fit_without(best, named.name)):
        on = problem.program.effect_switches(one.effects)
        passes = problem.filter(one.free, one.theta, on, best.levels)
        residual = passes.log_likelihood - passes.log_density_at_predictions
        found.append(residual + log_prior(one.free, one.theta))
    return not found[0] - found[1] < config.least_gain


def differs_from_zero(sets: CandidateSets, best: Fit, name: str) -> bool:
    """Whether the size of an effect in a fit is significantly different from zero.

    Several parameters may differ from zero together although none of them does alone. An effect
    acts, too, if the recordings determine one of its parameters that has no meaning without it. A
    craft that never reaches its planing speed shows by how much it is slowed, but not that speed.
    (The frequency of a stochastic force is determined by any trace of it.)

    Args:
        sets: Cache of the fits of candidate sets, with the estimation problem.
        best: Fit of the vessel model with some candidate effects.
        name: Name of one of its effects.
    """
    config = sets.config.select
    effect = sets.problem.candidates[name]
    kind = type(effect)
    own = {f.name: f for f in best.free if f.effect == name and not f.relative}
    params = kind.params()
    strength = [n for n in own if n in (kind.strength or params)]
    if not strength:
        return True
    for parameter in strength:
        sd = best.value(name, parameter)[1]
        if distance_from_zero(best, effect, parameter) > config.certainty * sd:
            return True
    if kind.random:
        return False
    if jointly_differ_from_zero(best, name, strength, config.certainty):
        return True
    for parameter, free in own.items():
        narrow = best.value(name, parameter)[1] < config.determined_share * free.sd
        if parameter not in strength and narrow:
            return True
    return False


def _compare_with_rivals(sets: CandidateSets, best: Fit, name: str) -> IdentifiedEffect:
    """Evidence of one effect on top of the others, and of its rivals in its place."""
    config = sets.config.select
    without = sets.fit_without(best, name)
    gain = best.evidence - without.evidence
    tested = _tested_instead(sets, best, name, without, gain)
    others = {n: f for n, f in tested.items() if n not in best.effects}
    key, rivals = frozenset(without.effects), {}
    leading = leading_candidates(others, without, config)[: config.most_rivals]
    for i, rival in enumerate(leading):
        if sets.budget.is_spent:
            sets.budget.record_skipped_candidates(
                len(leading) - i, f"refitted in place of {name_without_prefixes(name)}"
            )
            break
        found = others[rival]
        poor = found.evidence < without.evidence + config.front_share * gain
        if not poor or (key, rival) not in sets.fitted_in_full:
            found = sets.converged_fit(found)
        rivals[rival] = found
    return compare_rivals(name, best, without, rivals, config)


def _tested_instead(
    sets: CandidateSets, best: Fit, name: str, without: Fit, gain: float
) -> Mapping[str, Fit]:
    """Screenings of promising candidates in the place of an effect that gains some evidence.

    There are none without a budget.
    """
    promising = [n for n in sets.promising_candidates(without) if n != name]
    if not sets.budget.is_spent:
        return sets.screen_unrefuted(without, promising, gain)
    others = set(promising) - sets.banned - set(best.effects)
    sets.budget.record_skipped_candidates(
        len(others), f"refitted in place of {name_without_prefixes(name)}"
    )
    return {}


def _idea(name: str) -> str:
    """The effect of the library that a candidate stands for, whatever its place or group."""
    return name_without_prefixes(without_group(name))


def compare_rivals(
    name: str,
    best: Fit,
    without: Fit,
    rivals: Mapping[str, Fit],
    config: SelectConfig = DEFAULT.select,
) -> IdentifiedEffect:
    """Compare an effect with rival candidates: return its evidence, probability and look-alikes.

    Look-alikes are rivals whose evidence is nearly as large. The same effect in another group of
    recordings is none: the cause is known then, and only the group is not.

    Args:
        name: Name of the effect.
        best: Fit with the effect.
        without: Fit without the effect.
        rivals: Fits with other candidates in its place.
        config: Distance within which rivals are look-alikes, and their largest number.
    """
    gain = best.evidence - without.evidence
    gains = log_evidence_gains(rivals, without)
    weights = np.exp(np.array([0.0, gain, *gains.values()]) - max(gain, 0.0, *gains.values()))
    # the same effect on the other side of an actuator's lag, or of the other group, counts as this
    same = np.array([False, True, *(_idea(n) == _idea(name) for n in gains)])
    order = sorted(gains, key=lambda n: -gains[n])
    close = gain - config.alike
    tied, groups = list[str](), list[str]()
    for rival in order:
        if gains[rival] > close and _idea(rival) != _idea(name):
            tied.append(rival)
        elif gains[rival] > close and group_of(rival) not in ("", group_of(name)):
            groups.append(group_of(rival))
    probability = float(weights[same].sum() / weights.sum())
    return IdentifiedEffect(
        name,
        gain,
        combined_gain([gain, *gains.values()]),
        probability,
        tuple(tied[: config.most_look_alikes]),
        {n: rivals[n] for n in order},
        tuple(groups) if group_of(name) else (),
    )
