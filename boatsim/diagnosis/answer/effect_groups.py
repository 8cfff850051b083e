"""Groups of the identified effects: missing physics, refined numbers, possible effects."""

from collections.abc import Iterator, Mapping
from typing import NamedTuple

import numpy as np

from boatsim.diagnosis.answer.parameters import parameter_key, reported_sd
from boatsim.diagnosis.answer.schema import EffectEntry, PossibleEntry, RefinedEntry
from boatsim.diagnosis.candidates import FURTHER
from boatsim.diagnosis.open_set.refinement import (
    refines_estimated_number,
    vessel_number,
)
from boatsim.diagnosis.problem import Fit, FreeParameter, Problem
from boatsim.diagnosis.significance import distance_from_zero, jointly_differ_from_zero
from boatsim.physics.base import AXES, CoefficientChange, CoefficientRelease, Effect
from boatsim.physics.vessel import estimated_number_sd
from boatsim.view.formatting import format_parameter, join_words, name_in_words

BODY_UNITS = {"mass": "kg"}  # all other numbers of the body are inertias
INERTIA_UNIT = "kg m^2"


class EffectGroups(NamedTuple):
    """Identified effects of a diagnosis in three groups, as diagnosis.json has them.

    They are missing physics or measurement errors, refined numbers of the vessel file, and possible
    effects, whose size the recordings do not determine.
    """

    effects: list[EffectEntry]  # missing physics and errors of the measurement
    refined: list[RefinedEntry]
    also_possible: list[PossibleEntry]


class _Number(NamedTuple):
    """A number of the vessel before and after the diagnosis."""

    words: str
    before: float
    after: float
    sd: float
    unit: str

    def entry(self, name: str) -> RefinedEntry:
        off = None
        if self.before != 0.0:
            off = (self.after - self.before) / abs(self.before)
        return {
            "name": name,
            "number": self.words,
            "before": self.before,
            "after": self.after,
            "sd": self.sd,
            "unit": self.unit,
            "off": off,
        }


def classify_effects(
    problem: Problem, best: Fit, entries: Mapping[str, EffectEntry]
) -> EffectGroups:
    """Separate identified effects into missing physics, refined numbers and possible effects.

    An effect refines a number if the vessel file calls that number an estimate. An effect is
    only possible if all its strengths are smaller than their standard deviations.

    Args:
        problem: The estimation problem.
        best: The fit with all identified effects.
        entries: Their entries, by the name of the candidate.
    """
    groups = EffectGroups([], [], [])
    changed = set[tuple[str, str]]()
    for name, entry in entries.items():
        effect = problem.candidates[name]
        if not _has_known_size(problem, best, effect):
            groups.also_possible.append(_possible(best, effect, entry))
        elif not refines_estimated_number(problem, best, name):
            groups.effects.append(entry)
        else:
            for number in _refined_numbers(problem, best, effect):
                groups.refined.append({**entry, **number.entry(entry["name"])})
            changed |= {(change.owner, change.key) for change in _changes(problem, effect)}
    groups.refined.extend(_refined_coefficients(problem, best, changed))
    return groups


def _strengths(best: Fit, effect: Effect) -> list[FreeParameter]:
    """Fitted parameters that are zero, or another known value, if the effect is absent."""
    kind = type(effect)
    names = kind.strength or tuple(kind.params())
    return [f for f in _fitted(best, effect) if f.name in names]


def _fitted(best: Fit, effect: Effect) -> list[FreeParameter]:
    return [f for f in best.free if f.effect == effect.name and not f.relative]


def _exceeds_sd(problem: Problem, best: Fit, effect: Effect, name: str) -> bool:
    sd = reported_sd(best, effect, name, problem.config.answer)
    return distance_from_zero(best, effect, name) >= sd


def _has_known_size(problem: Problem, best: Fit, effect: Effect) -> bool:
    """Whether strengths exceed their standard deviation, or another parameter is well determined.

    Strengths may do so alone or together. A parameter that has no meaning without the effect shows
    that it acts, as in the selection.
    """
    strengths = _strengths(best, effect)
    if not strengths:
        return True
    for free in strengths:
        if _exceeds_sd(problem, best, effect, free.name):
            return True
    if type(effect).random:
        return False
    if jointly_differ_from_zero(best, effect.name, [f.name for f in strengths], certainty=1.0):
        return True
    for free in _fitted(best, effect):
        sd = best.value(effect.name, free.name)[1]
        if free not in strengths and sd < problem.config.select.determined_share * free.sd:
            return True
    return False


def _possible(best: Fit, effect: Effect, entry: EffectEntry) -> PossibleEntry:
    """Entry of an effect whose size is smaller than its standard deviation."""
    sizes = []
    for free in _strengths(best, effect):
        key = parameter_key(free.name, type(effect).params()[free.name].unit)
        value = entry["parameters"][key]
        sizes.append(" ".join(format_parameter(key, value["value"], value["unit"], value["sd"])))
    possible: PossibleEntry = {
        "name": entry["name"],
        "probability": entry["probability"],
        "gain_nats": entry["gain_nats"],
        "words": entry["words"],
        "why": f"these recordings do not determine its size: {join_words(sizes)}",
    }
    if "group" in entry:
        possible["group"] = entry["group"]
    if "same_recordings" in entry:
        possible["same_recordings"] = entry["same_recordings"]
    return possible


def _changes(problem: Problem, effect: Effect) -> list[CoefficientChange]:
    """Changes of the vessel's own numbers by an effect."""
    if isinstance(effect, CoefficientRelease):
        return effect.changes(problem.program.vessel)
    return []


def _refined_numbers(problem: Problem, best: Fit, effect: Effect) -> list[_Number]:
    """The numbers that an effect refines; those that differ by less than one sd are omitted."""
    strengths = _strengths(best, effect)
    certain = [f for f in strengths if _exceeds_sd(problem, best, effect, f.name)]
    numbers = []
    for free in certain or strengths:
        numbers.append(_refined_number(problem, best, effect, free.name))
    return numbers


def _refined_number(problem: Problem, best: Fit, effect: Effect, name: str) -> _Number:
    """The number that a parameter of an effect refines."""
    recording = problem.recordings[0]
    after = problem.parameter_vector(recording, best.free, best.theta)
    value, _ = best.value(effect.name, name)
    sd = reported_sd(best, effect, name, problem.config.answer)
    param = type(effect).params()[name]
    words = _words_of_parameter(effect, name, len(_strengths(best, effect)))
    number = type(effect).adds_to.get(name)
    if number is not None:
        before = vessel_number(problem, number)
        words = name_in_words(number.split(".")[1])
        return _Number(words, before, before + value, sd, param.unit)
    for change in _changes(problem, effect):
        if change.parameter != name:
            continue
        at = problem.index_of_parameter(change.owner, change.key)
        if change.how == "scales":
            sd *= abs(float(after[at]) / value)
        elif change.how == "shifts":
            sd *= abs(change.weight)
        unit = _unit(problem, change.owner, change.key)
        return _Number(words, float(recording.values[at]), float(after[at]), sd, unit)
    inactive = best.prior_mean(effect.name, name)
    own = problem.program.vessel.effect(type(effect).type_name())
    if own is None or not effect.name.startswith(FURTHER):
        return _Number(words, inactive, value, sd, param.unit)
    # The vessel has this effect already: the new one adds to its number
    at = problem.index_of_parameter(own.name, name)
    total = float(after[at]) + value - inactive
    return _Number(words, float(recording.values[at]), total, sd, param.unit)


def _refined_coefficients(
    problem: Problem, best: Fit, changed: set[tuple[str, str]]
) -> Iterator[RefinedEntry]:
    """Refitted coefficients that the vessel file calls estimates and that are clearly different.

    Numbers that an effect changes as well are listed with that effect.
    """
    vessel, config = problem.program.vessel, problem.config.answer
    recording = problem.recordings[0]
    after = problem.parameter_vector(recording, best.free, best.theta)
    sds = np.sqrt(np.diag(best.covariance))
    for free, factor, sd in zip(best.free, best.theta, sds, strict=True):
        owners = vessel.names_of(free.effect)
        if (
            not free.relative
            or estimated_number_sd(free.effect, free.name, vessel, vessel.estimated) is None
        ):
            continue
        if any((owner, free.name) in changed for owner in owners):
            continue
        if abs(factor - 1.0) <= max(config.refined_sds * sd, config.refined_share):
            continue
        at = free.at[0]
        before = float(recording.values[at])
        words = _words_of_number(name_in_words(free.effect), free.name)
        unit = _unit(problem, owners[0], free.name)
        number = _Number(words, before, float(after[at]), abs(before) * float(sd), unit)
        yield number.entry(f"{free.effect}.{free.name}")


def _unit(problem: Problem, owner: str, key: str) -> str:
    if owner == "body":
        return BODY_UNITS.get(key, INERTIA_UNIT)
    effect = next(e for e in problem.program.vessel.effects if e.name == owner)
    return type(effect).params()[key].unit


def _words_of_parameter(effect: Effect, name: str, count: int) -> str:
    """Words for a number: that of the effect if it has only one, else with axis or name."""
    kind = type(effect)
    if kind.kind == "measurement":
        return kind.params()[name].words
    words = name_in_words(type(effect).type_name()).removesuffix(" error")
    if count == 1 and name not in AXES:
        return words
    return _words_of_number(words, name)


def _words_of_number(words: str, name: str) -> str:
    """Words for one of several numbers: damping in surge, damping exponent in sway."""
    axis, _, rest = name.partition("_")
    if axis not in AXES:
        return f"{words}, {name_in_words(name)}"
    if not rest or rest == "factor" or rest in words:
        return f"{words} in {axis}"
    return f"{words} in {axis}, {name_in_words(rest)}"
