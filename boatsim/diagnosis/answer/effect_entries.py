"""Entries of an answer on single effects: identified, possible, tested, and not found."""

from collections.abc import Iterable, Mapping

import numpy as np

from boatsim.control.base import wrap
from boatsim.diagnosis.answer.confirmation import effect_error_entry, reason_unconfirmed
from boatsim.diagnosis.answer.group_words import group_entry, group_in_words, groups_in_words
from boatsim.diagnosis.answer.parameters import parameter_key, reported_sd
from boatsim.diagnosis.answer.schema import (
    Acting,
    AddedEntry,
    CandidateEntry,
    EffectEntry,
    ParameterEntry,
    PossibleEntry,
)
from boatsim.diagnosis.answer.signs import reason_for_doubt
from boatsim.diagnosis.candidates import name_without_prefixes
from boatsim.diagnosis.open_set.decision import Decision
from boatsim.diagnosis.problem import Fit, FreeParameter, Problem
from boatsim.diagnosis.search.pruning import IdentifiedEffect
from boatsim.diagnosis.search.ranking import Ranking
from boatsim.physics.base import ChannelEffect, Effect
from boatsim.physics.groups import group_of, without_group
from boatsim.physics.vessel import Vessel
from boatsim.view.formatting import sentence_in_per_cent

CONTRADICTED = "simulations with the recorded commands follow the recordings better without it"


def effect_meanings(candidates: Iterable[Effect], vessel: Vessel) -> dict[str, str]:
    """Return the meaning in words of candidate effects and of their parameters.

    Keys are the name of the effect, and "effect.parameter".

    Args:
        candidates: Candidate effects.
        vessel: Vessel to whose numbers the values of some parameters are relative.
    """
    found, parameters = dict[str, str](), dict[str, str]()
    for effect in candidates:
        name, kind = name_without_prefixes(effect.name), type(effect)
        found[name] = kind.words
        for key, param in kind.params().items():
            if param.fit:
                parameters[f"{name}.{parameter_key(key, param.unit)}"] = param.words
    for effect in candidates:
        for key, (_, words) in effect.identifiable_ratios(vessel).items():
            parameters[f"{name_without_prefixes(effect.name)}.{key}"] = words
    return found | parameters


def effect_entry(
    problem: Problem, best: Fit, named: IdentifiedEffect, decision: Decision
) -> EffectEntry:
    """Return the entry of an identified effect.

    Args:
        problem: The estimation problem.
        best: The fit with all identified effects.
        named: The effect with its evidence and probability.
        decision: Statistics of all selected effects.
    """
    judged = decision.judgement_of_effect(named.name)
    effect = problem.candidates[named.name]
    kind = type(effect)
    acting: Acting = {}
    if effect.on:
        acting["on"] = list(effect.on)
    if named.tied_groups:
        acting["tied_groups"] = list(named.tied_groups)
    entry: EffectEntry = {
        "name": name_without_prefixes(named.name),
        **acting,
        "kind": kind.kind,
        "probability": round(named.probability, 4),
        "gain_nats": round(named.gain, 2),
        "words": _words(problem, best, effect),
        "tied_with": list(map(name_without_prefixes, named.tied_with)),
        "parameters": _parameters(problem, best, effect) | _ratios(problem, best, effect),
        "alone": effect_error_entry(judged.alone),
        "confirmed": judged.outcome == "confirmed",
    }
    return {**entry, **group_entry(problem, named.name)}


def added_entry(problem: Problem, best: Fit, name: str) -> AddedEntry:
    """Return the entry of an effect that only makes simulations better.

    Args:
        problem: The estimation problem.
        best: The fit of the corrected vessel.
        name: Name of the effect among the candidates.
    """
    effect = problem.candidates[name]
    return {
        "name": name_without_prefixes(name),
        **group_entry(problem, name),
        "kind": type(effect).kind,
        "words": _words(problem, best, effect),
        "parameters": _parameters(problem, best, effect),
    }


def possible_entry(
    problem: Problem,
    best: Fit,
    doubtful: IdentifiedEffect,
    decision: Decision,
    contradicted: bool = False,
) -> PossibleEntry:
    """Return the entry of an effect that is probably a stand-in for another cause.

    Args:
        problem: The estimation problem.
        best: The fit with all identified effects.
        doubtful: The effect with its evidence and probability.
        decision: Statistics of all selected effects.
        contradicted: Whether free runs are clearly more probable without it.
    """
    effect = problem.candidates[doubtful.name]
    judged = decision.judgement_of_effect(doubtful.name)
    why = reason_for_doubt(judged, decision)
    if contradicted:
        why = CONTRADICTED
    elif judged.outcome == "unconfirmed":
        why = reason_unconfirmed(judged)
    entry: PossibleEntry = {
        "name": name_without_prefixes(doubtful.name),
        "probability": round(doubtful.probability, 4),
        "gain_nats": round(doubtful.gain, 2),
        "words": _words(problem, best, effect),
        "why": why,
        "in_patch": doubtful.name in best.effects,
        "parameters": _parameters(problem, best, effect),
        "alone": effect_error_entry(judged.alone),
        "confirmed": judged.outcome == "confirmed",
    }
    balanced = decision.ranking.balanced
    if doubtful.name in balanced:
        (other,) = [name for name in balanced if name != doubtful.name]
        entry["together_with"] = name_without_prefixes(other)
    return {**entry, **group_entry(problem, doubtful.name)}


def _parameters(problem: Problem, best: Fit, effect: Effect) -> dict[str, ParameterEntry]:
    """Return the entries of the fitted parameters of an effect by their keys."""
    params, found = type(effect).params(), {}
    for name in _fitted_parameters(best, effect):
        key = parameter_key(name, params[name].unit)
        found[key] = _parameter(problem, best, effect, name)
    return found


def _fitted_parameters(best: Fit, effect: Effect) -> dict[str, FreeParameter]:
    """Return the fitted parameters of an effect by name."""
    return {f.name: f for f in best.free if f.effect == effect.name and not f.relative}


def _ratios(problem: Problem, best: Fit, effect: Effect) -> dict[str, ParameterEntry]:
    """Return the ratios of parameters, where the recordings determine only ratios."""
    vessel = problem.program.vessel
    own = _fitted_parameters(best, effect)
    fitted = {name: best.value(effect.name, name)[0] for name in own}

    def ratios_after_step(name: str, step: float) -> Mapping[str, tuple[float, str]]:
        value = np.clip(fitted[name] + step, own[name].low, own[name].high)
        return effect.with_values(fitted | {name: float(value)}).identifiable_ratios(vessel)

    found = effect.with_values(fitted).identifiable_ratios(vessel)
    variance = dict.fromkeys(found, 0.0)
    if found:
        for name in fitted:
            sd = _parameter(problem, best, effect, name)["sd"]
            low, high = ratios_after_step(name, -0.5 * sd), ratios_after_step(name, 0.5 * sd)
            for key in variance:
                variance[key] += (high[key][0] - low[key][0]) ** 2
    entries: dict[str, ParameterEntry] = {}
    for key, (value, _) in found.items():
        entries[key] = {"value": value, "sd": float(np.sqrt(variance[key])), "unit": ""}
    return entries


def _words(problem: Problem, best: Fit, effect: Effect) -> str:
    """Return the meaning of an effect, or of its opposite where its factor is above 1."""
    kind = type(effect)
    words, own = kind.words, list(_fitted_parameters(best, effect))
    if own and kind.words_above:
        inactive = kind.params()[own[0]].inactive_value
        if best.value(effect.name, own[0])[0] > inactive:
            words = kind.words_above
    if isinstance(effect, ChannelEffect) and effect.other_side:
        where = "already in the command"
        if kind.stage < 0:
            where = "in the actuator and not in its command"
        words = f"{words}, {where}"
    if kind.once_per and effect.on:
        words = f"{words}: {', '.join(effect.on)}"
    if where := group_in_words(group_entry(problem, effect.name)):
        words = f"{where}, {words}"
    return words


def _parameter(problem: Problem, best: Fit, effect: Effect, name: str) -> ParameterEntry:
    """Return value, sd and unit of a fitted parameter; angles are within half a turn."""
    config = problem.config.answer
    param = type(effect).params()[name]
    value, _ = best.value(effect.name, name)
    entry: ParameterEntry = {
        "value": value,
        "sd": reported_sd(best, effect, name, config),
        "unit": param.unit,
    }
    if param.unit == "rad":
        entry["value"] = wrap(value)
    free = _fitted_parameters(best, effect)[name]
    for end in (free.low, free.high):
        if end != free.mean and abs(value - end) <= config.at_bound * abs(end):
            entry["at_bound"] = True
    sentence = sentence_in_per_cent(param.in_per_cent, value, entry["sd"], param.inactive_value)
    if sentence and type(effect).once_per and effect.on:
        sentence = f"{', '.join(effect.on)}: {sentence}"
    if sentence and (group := group_of(effect.name)):
        sentence = f"in group {group}, {sentence}; {_others(problem, best, effect, name)}"
    if sentence:
        entry["statement"] = sentence
    return entry


def _others(problem: Problem, best: Fit, effect: Effect, name: str) -> str:
    """The value of a ratio in the groups that an effect does not concern, in words."""
    common = without_group(effect.name)
    own = []  # groups that have their own value, too
    for other in best.effects:
        if other != effect.name and without_group(other) == common and group_of(other):
            own.append(group_of(other))
    if own and problem.are_separate_and_complete([group_of(effect.name), *own]):
        return f"{groups_in_words(own)} {'have' if len(own) > 1 else 'has'} another value"
    words = _common_value(best, effect, name)
    if own:
        return f"{words}, except {groups_in_words(own)}"
    return words


def _common_value(best: Fit, effect: Effect, name: str) -> str:
    """The value of a ratio in all groups that have none themselves, in words."""
    param = type(effect).params()[name]
    common = without_group(effect.name)
    value = param.inactive_value
    if common in best.effects:
        value = best.value(common, name)[0]
    if param.how == "scales":
        return "this is relative to the others"
    if value == 0.0:
        return "the others show none of it"
    return f"in the others it is {100.0 * value:.3g} %"


def candidate_entries(ranking: Ranking) -> list[CandidateEntry]:
    """Return each candidate alone, best first, with its probability against the others and none.

    A candidate with which the simulation diverges at every starting point has no evidence, and is
    omitted.

    Args:
        ranking: The selection, with the evidence of each candidate.
    """
    finite = {name: gain for name, gain in ranking.first.items() if np.isfinite(gain)}
    names = sorted(finite, key=lambda n: -finite[n])
    gains = [0.0]
    for name in names:
        gains.append(ranking.first[name])
    weights = np.exp(np.array(gains) - np.max(gains))
    weights /= weights.sum()
    # an effect that was tested in two places is listed with the larger gain
    found: dict[str, CandidateEntry] = {}
    for name, gain, weight in zip(names, gains[1:], weights[1:], strict=True):
        entry: CandidateEntry = {
            "name": name_without_prefixes(name),
            "gain_nats": round(float(gain), 2),
            "probability": round(float(weight), 4),
        }
        found.setdefault(name_without_prefixes(name), entry)
    return list(found.values())


def parameter_limits(
    problem: Problem, fitted: Fit, name: str
) -> tuple[dict[str, float], dict[str, float]]:
    """Return limits (95 %) of the parameters of an effect that was not found.

    They are upper limits of the distance from zero effect, and lower limits of parameters that are
    limits themselves, such as that of a rate.

    Args:
        problem: The estimation problem.
        fitted: The fit with this effect.
        name: Name of the effect.

    Returns:
        Upper and lower limits by key of the parameter.
    """
    config = problem.config.answer
    kind = type(problem.candidates[name])
    params = kind.params()
    upper, lower = dict[str, float](), dict[str, float]()
    for f in fitted.free:
        if f.effect != name or f.relative or f.name not in (kind.strength or params):
            continue
        value, sd = fitted.value(name, f.name)
        if sd >= config.limit_share * f.sd:
            continue
        key, margin = parameter_key(f.name, params[f.name].unit), config.limit_quantile * sd
        if f.name not in kind.limits:
            upper[key] = float(f"{abs(value - f.mean) + margin:.3g}")
        elif value > margin:
            lower[key] = float(f"{value - margin:.3g}")
    return upper, lower
