"""Collects what the "What if" section of a report needs from a diagnosis."""

from collections.abc import Mapping, Sequence

import numpy as np

from boatsim.diagnosis.answer.described_terms import factors_in_words
from boatsim.diagnosis.answer.families import FAMILIES
from boatsim.diagnosis.answer.group_words import group_entry, group_in_words
from boatsim.diagnosis.answer.schema import Family
from boatsim.diagnosis.candidates import name_without_prefixes
from boatsim.diagnosis.filter import MappedRecording
from boatsim.diagnosis.free_runs import FAMILIES as SIGNALS_OF_FAMILY
from boatsim.diagnosis.free_runs import free_run_horizon
from boatsim.diagnosis.pipeline import Diagnosis
from boatsim.diagnosis.problem import Fit, FreeParameter, Problem
from boatsim.diagnosis.report.what_if import (
    AdjustableEffect,
    InstrumentDrift,
    ReplayedRecording,
    Slider,
    WhatIf,
)
from boatsim.physics.groups import without_group
from boatsim.view.formatting import name_in_words
from boatsim.webassembly.compiler import WasmCompiler
from boatsim.webassembly.program import compile_program

RANDOM = "it acts at random, so that it has no slider"
REACH = 2.0  # a slider extends this many prior sds, or changes by the fit, to both sides


def collect_what_if(found: Diagnosis, compiler: WasmCompiler) -> WhatIf | None:
    """Return the program of a diagnosed vessel for a browser, with its effects and recordings.

    Args:
        found: The diagnosis.
        compiler: A compiler for WebAssembly.

    Returns:
        Content of the section; None if no free run over a held-out recording exists.

    Raises:
        NotTranslatable: A law has no C form.
        NoWasmCompiler: The compiler fails.
    """
    problem, best, program = found.problem, found.ranking.best, found.problem.program
    if not found.findings.free_runs:
        return None
    horizon = free_run_horizon(problem, found.held_out)
    random = [name for name in best.effects if _is_stochastic(found, name)]
    recordings, signals = list[ReplayedRecording](), dict[str, int]()
    for mapped in found.held_out:
        one = _replayed(problem, best, mapped, horizon, random)
        if one.starts:
            recordings.append(one)
            signals |= _coordinates(mapped)
    return WhatIf(
        program=compile_program(program, compiler),
        nq=program.module.NQ,
        signals=dict(sorted(signals.items(), key=lambda item: item[1])),
        horizon=horizon,
        max_step=problem.config.filter.free_run_step,
        effects=tuple(_adjustable_effects(found)),
        links=problem.links,
        switches=program.effect_switches(random),
        families=_recorded_families(signals),
        recordings=tuple(recordings),
    )


def _recorded_families(signals: Mapping[str, int]) -> dict[Family, Sequence[str]]:
    """Return the families of which any signal was recorded, with these signals."""
    found = dict[Family, Sequence[str]]()
    for family in FAMILIES:
        if recorded := [name for name in SIGNALS_OF_FAMILY[family] if name in signals]:
            found[family] = recorded
    return found


def _coordinates(mapped: MappedRecording) -> dict[str, int]:
    """Return the recorded coordinates by column, with their channels of the program."""
    found = {}
    for name, code in zip(mapped.signals, mapped.codes.tolist(), strict=True):
        if code < mapped.program.module.NQ:
            found[name] = code
    return found


def _replayed(
    problem: Problem,
    best: Fit,
    mapped: MappedRecording,
    horizon: float,
    random: Sequence[str],
) -> ReplayedRecording:
    """Return a recording with the starts of the corrected vessel's free runs.

    Its parameter values are those of the vessel file, with those of the random effects that act.
    """
    values = problem.parameter_vector(mapped, best.free, best.theta)
    program = problem.program
    begin = mapped.free_run_starts(
        values, program.effect_switches(best.effects), best.levels, horizon
    )
    names = [effect.name for effect in program.effects]
    drifts = []
    for drift in begin.drifts:
        time = program.parameter_index(drift.effect, "time")
        drifts.append(InstrumentDrift(names.index(drift.effect), time, drift.offsets))
    nominal = mapped.values.copy()
    for parameter, value in zip(best.free, best.theta.tolist(), strict=True):
        if parameter.effect in random and not parameter.relative:
            parameter.write_value(nominal, value)
    measured = {}
    for c, name in enumerate(mapped.signals):
        if mapped.codes[c] < program.module.NQ:
            measured[name] = mapped.measured[:, c]
    return ReplayedRecording(
        name=mapped.name,
        groups=mapped.groups,
        times=mapped.times,
        command_times=mapped.command_times,
        commands=mapped.command_values,
        measured=measured,
        values=nominal,
        starts=tuple(begin.starts.tolist()),
        ends=tuple(begin.ends.tolist()),
        states=begin.states,
        drifts=tuple(drifts),
    )


def _is_stochastic(found: Diagnosis, name: str) -> bool:
    """Whether a candidate is a random force or drift, whose size changes no free run."""
    return type(found.problem.candidates[name]).random


def _adjustable_effects(found: Diagnosis) -> list[AdjustableEffect]:
    """Return coefficients, found effects in their order, and candidates, best evidence first."""
    ranking = found.ranking
    effects = list[AdjustableEffect]()
    coefficients = _sliders(found, ranking.best, "")
    if coefficients:
        effects.append(AdjustableEffect("Coefficients", "", True, True, -1, coefficients))
    for name in ranking.best.effects:
        effects.append(_adjustable_effect(found, ranking.best, name, True))
    others = sorted(ranking.last, key=lambda name: (-ranking.last[name].evidence, name))
    for name in others:
        if name not in ranking.best.effects and not _is_stochastic(found, name):
            effects.append(_adjustable_effect(found, ranking.last[name], name, False))
    return effects


def _adjustable_effect(found: Diagnosis, fit: Fit, name: str, identified: bool) -> AdjustableEffect:
    """Return a candidate with its sliders; one that is random has none."""
    shown = name_in_words(without_group(name_without_prefixes(name)))
    if where := group_in_words(group_entry(found.problem, name)):
        shown = f"{shown} {where}"
    words = found.findings.words.get(name_without_prefixes(name), "")
    if name in found.ranking.described_terms:
        factors = factors_in_words(found.ranking.described_terms[name])
        words = f"a term of the formula, which varies with {factors}"
    if _is_stochastic(found, name):
        return AdjustableEffect(shown, f"{words}; {RANDOM}", identified, False, -1, ())
    names = [effect.name for effect in found.problem.program.effects]
    owner, switch = without_group(name), -1
    if owner in names:
        switch = names.index(owner)
    return AdjustableEffect(shown, words, identified, False, switch, _sliders(found, fit, name))


def _sliders(found: Diagnosis, fit: Fit, effect: str) -> tuple[Slider, ...]:
    """Return sliders of an effect's parameters, or with "" of the vessel's own coefficients."""
    sliders = []
    for parameter, value in zip(fit.free, fit.theta.tolist(), strict=True):
        if parameter.relative and not effect:
            words, unit = f"{parameter.effect}: {parameter.name}", ""
        elif not parameter.relative and parameter.effect == effect:
            about = type(found.problem.candidates[effect]).params()[parameter.name]
            words, unit = parameter.name, about.unit
            if about.words:
                words = f"{words} ({about.words})"
        else:
            continue
        low, high = _slider_range(parameter, value)
        slider = Slider(
            words=name_in_words(words),
            unit=unit,
            low=low,
            high=high,
            off=parameter.mean,
            found=value,
            at=parameter.at,
            how=parameter.how,
            weights=parameter.weights,
            group=parameter.group,
        )
        sliders.append(slider)
    return tuple(sliders)


def _slider_range(parameter: FreeParameter, value: float) -> tuple[float, float]:
    """Return the ends of a slider, which contain the fitted value and that without the effect."""
    reach = REACH * max(parameter.sd, abs(value - parameter.mean))
    low = max(parameter.low, min(value, parameter.mean) - reach)
    high = min(parameter.high, max(value, parameter.mean) + reach)
    return float(np.minimum(low, value)), float(np.maximum(high, value))
