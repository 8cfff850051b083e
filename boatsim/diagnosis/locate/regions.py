"""Regions of the state in which a force is missing, such as thrust astern or nearness to a wall.

Each candidate is tested in addition to the coefficients that a recalibration changes and to the
other regions found. p-values are corrected for the number of candidates tested (Bonferroni).
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from boatsim.diagnosis.filter import MappedRecording
from boatsim.diagnosis.locate.nominal_forces import coefficient_forces
from boatsim.diagnosis.locate.periodicity import most_significant_peak
from boatsim.diagnosis.locate.region_candidates import region_candidates
from boatsim.diagnosis.locate.region_tests import ScoreStatistics, ScoreTest, sum_statistics
from boatsim.diagnosis.locate.smoothing import latent_force
from boatsim.diagnosis.problem import Fit, Problem
from boatsim.physics.base import Array

COEFFICIENTS = "coefficients"  # name of the shapes that a recalibration explains
Sentence = Callable[[Array], str]


@dataclass(frozen=True)
class Region:
    """A condition under which a force is significantly missing, such as thrust astern."""

    variable: str
    statement: str
    p_value: float  # corrected for the number of tests


def find_missing_force_conditions(problem: Problem, fit: Fit) -> list[Region]:
    """Find the conditions under which the vessel model lacks a force, such as thrust astern.

    Conditions are added one by one by score tests of the smoothed latent force; a test for a
    periodic force completes them.

    Args:
        problem: The estimation problem.
        fit: The recalibrated vessel: its coefficients are fitted, and no candidate acts.

    Returns:
        Significant conditions, the most significant first.
    """
    statistics, sentences = _score_statistics(problem, fit)
    tests = 1  # the test for a period
    for name in sentences:
        tests += statistics.is_informative(name)
    results = _select(problem, statistics, list(sentences), tests)
    found = []
    for name, result in results.items():
        statement = sentences[name](result.factors)
        found.append(_region(name, statement, result.p_value * tests))
    found += _periodic_region(problem, fit, tests)
    return sorted(found, key=lambda region: region.p_value)


def _score_statistics(problem: Problem, fit: Fit) -> tuple[ScoreStatistics, Mapping[str, Sentence]]:
    """Statistics of all runs together, and the sentences of the candidates that all runs have."""
    statistics = []
    sentences: dict[str, Sentence] = {}
    for k, mapped in enumerate(problem.recordings):
        force = latent_force(problem, fit, mapped, fit.levels)
        parts = coefficient_forces(problem, fit, mapped, force.states)
        damping = _damping_force(problem, fit, parts)
        candidates = region_candidates(mapped, force.states, damping, problem.config.locate)
        shapes = {COEFFICIENTS: tuple(parts)}
        shapes |= {candidate.variable: candidate.shapes for candidate in candidates}
        statistics.append(ScoreStatistics.from_latent_force(shapes, force))
        if k == 0:
            sentences = {candidate.variable: candidate.sentence for candidate in candidates}
        else:
            sentences = {name: each for name, each in sentences.items() if name in shapes}
    return sum_statistics(statistics, [COEFFICIENTS, *sentences]), sentences


def _damping_force(problem: Problem, fit: Fit, parts: Array) -> Array:
    """(N, axes) damping of the vessel as specified; parts (F, N, axes) are its coefficients'."""
    params = {}
    for effect in problem.program.effects:
        params[effect.name] = type(effect).params()
        params[type(effect).type_name()] = type(effect).params()
    is_damping = np.zeros(len(fit.free))
    for j, parameter in enumerate(fit.free):
        is_damping[j] = params[parameter.effect][parameter.name].calibrates == "damping"
    return np.asarray(np.tensordot(is_damping, parts, axes=1))


def _select(
    problem: Problem, statistics: ScoreStatistics, names: Sequence[str], tests: int
) -> dict[str, ScoreTest]:
    """Select regions one by one, each significant and larger than the disturbance level."""
    max_p = problem.config.locate.region_max_p
    chosen: list[str] = []
    while True:
        p_values = {}
        for name in names:
            if name in chosen:
                continue
            result = statistics.score_test(name, [COEFFICIENTS, *chosen])
            if result.p_value * tests < max_p and (result.rms > problem.ambient.force).any():
                p_values[name] = result.p_value
        if not p_values:
            break
        chosen.append(min(p_values, key=lambda name: p_values[name]))
    results = {}
    for name in chosen:
        others = chosen.copy()
        others.remove(name)
        results[name] = statistics.score_test(name, [COEFFICIENTS, *others])
    return results


def _periodic_region(problem: Problem, fit: Fit, tests: int) -> list[Region]:
    """A period of the prediction errors that neither the hull nor its commands have."""
    config = problem.config.locate
    if "roll" in problem.program.vessel.dof:
        return []  # a hull that rolls has a natural period
    errors = [(mapped.times, _whitened(problem, fit, mapped)) for mapped in problem.recordings]
    peak = most_significant_peak(errors, config)
    if peak is None or peak.p_value * tests >= config.region_max_p:
        return []
    commands = [(mapped.times, mapped.commands) for mapped in problem.recordings]
    commanded = most_significant_peak(commands, config)
    if commanded and commanded.p_value < config.region_max_p:
        if abs(np.log(commanded.period / peak.period)) < np.log(config.periodicity_band):
            return []
    sentence = f"the missing force is periodic, with a period of about {peak.period:.2g} s"
    return [_region("period", sentence, peak.p_value * tests)]


def _whitened(problem: Problem, fit: Fit, mapped: MappedRecording) -> Array:
    """(N, C) whitened prediction errors."""
    values = problem.parameter_vector(mapped, fit.free, fit.theta)
    passed = mapped.filter(values, problem.program.effect_switches(fit.effects), fit.levels)
    return passed.whitened.reshape(len(mapped.times), -1)


def _region(variable: str, sentence: str, p_value: float) -> Region:
    p_value = min(p_value, 1.0)
    text = "p < 1e-6" if p_value < 1e-6 else f"p = {p_value:.1g}"
    return Region(variable, f"{sentence}; {text}", float(f"{p_value:.2g}"))
