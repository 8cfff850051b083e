"""In which state region a force is missing: only while thrust is astern, near a wall, with speed, with a rhythm.

Each idea of what the missing force would be there (`region_ideas`) is tested beside what a recalibration would change
and beside the other regions found. p-values are corrected for the number of regions tried (Bonferroni).
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from boatsim.diagnosis.filter import MappedRecording
from boatsim.diagnosis.locate.nominal_forces import coefficient_forces
from boatsim.diagnosis.locate.periodicity import BAND, rhythm
from boatsim.diagnosis.locate.region_candidates import ideas
from boatsim.diagnosis.locate.region_tests import Evidence, Result, joint
from boatsim.diagnosis.problem import Fit, Problem
from boatsim.physics.base import Array

LIKELY = 0.01  # corrected p-value below which a region is worth a sentence
KNOWN = "coefficients"  # what a recalibration explains


@dataclass(frozen=True)
class Region:
    """A state region in which a force is missing."""

    variable: str
    statement: str
    p_value: float  # corrected


def regions(problem: Problem, found: Fit) -> list[Region]:
    """Regions that explain the missing force of the fitted runs, the likeliest first; none where nothing is missing.

    `found` fits the coefficients of the vessel as written and names no suspects.
    """
    evidence, sentences = _evidence(problem, found)
    tests = sum(evidence.speaks_of(n) for n in sentences) + 1  # and the rhythm
    results = _selected(evidence, list(sentences), tests, problem.ambient.force)
    out = [_region(n, sentences[n](r.factors), r.p_value * tests) for n, r in results.items()]
    return sorted([*out, *_rhythm(problem, found, tests)], key=lambda r: r.p_value)


def _evidence(problem: Problem, found: Fit) -> tuple[Evidence, dict[str, Callable[[Array], str]]]:
    """What all runs together say of every idea that can be tried on all of them, and how to say the ideas."""
    nq, levels = problem.program.module.NQ, found.levels
    on, latent = problem.program.switches(found.effects), slice(2 * nq, 3 * nq)
    evidence, sentences = [], []
    for track in problem.recordings:
        values = problem.values(track, found.free, found.theta)
        z, covariances, gains = track.smooth(values, on, levels)
        states = np.ascontiguousarray(z[:, : 2 * nq])
        parts = coefficient_forces(problem, found, track, states)
        tried = ideas(track, states, _damping(problem, found, parts))
        shapes = {KNOWN: tuple(parts)} | {i.variable: i.shapes for i in tried}
        prior = *track.latent_force_rms(values, on, levels), levels.time_constant
        evidence.append(
            Evidence.of(shapes, z[:, latent], track.times, covariances, gains, latent, *prior)
        )
        sentences.append({i.variable: i.sentence for i in tried})
    names = [n for n in sentences[0] if all(n in s for s in sentences)]
    return joint(evidence, [KNOWN, *names]), {n: sentences[0][n] for n in names}


def _damping(problem: Problem, found: Fit, parts: Array) -> Array:
    """(N, axes) damping of the vessel as written."""
    kinds = {n: type(e).params() for e in problem.program.effects for n in (e.name, type(e).idea())}
    own = np.array(
        [kinds[f.effect][f.name].calibrates == "damping" for f in found.free], dtype=float
    )
    return np.asarray(np.tensordot(own, parts, axes=1))


def _selected(
    evidence: Evidence, names: Sequence[str], tests: int, ambient: Array
) -> dict[str, Result]:
    """Regions one after the other, each likely on top of those before and more than the ambient force."""
    chosen: list[str] = []
    while True:
        rest = {n: evidence.test(n, [KNOWN, *chosen]) for n in names if n not in chosen}
        told = {
            n: r for n, r in rest.items() if r.p_value * tests < LIKELY and (r.rms > ambient).any()
        }
        if not told:
            break
        chosen.append(min(told, key=lambda n: told[n].p_value))
    return {n: evidence.test(n, [KNOWN, *(m for m in chosen if m != n)]) for n in chosen}


def _rhythm(problem: Problem, found: Fit, tests: int) -> list[Region]:
    """Whether what the filter did not expect has a period that neither the hull nor its commands have."""
    if "roll" in problem.program.vessel.dof:
        # a hull that rolls has a period of its own, and so has whatever depends on its roll
        return []
    found_in = rhythm([(t.times, _unexpected(problem, found, t)) for t in problem.recordings])
    if found_in is None or found_in.p_value * tests >= LIKELY:
        return []
    commanded = rhythm([(t.times, t.commands) for t in problem.recordings])
    if (
        commanded
        and commanded.p_value < LIKELY
        and abs(np.log(commanded.period / found_in.period)) < np.log(BAND)
    ):
        return []
    sentence = f"the missing force comes and goes about every {found_in.period:.2g} s"
    return [_region("period", sentence, found_in.p_value * tests)]


def _unexpected(problem: Problem, found: Fit, track: MappedRecording) -> Array:
    """(N, C) whitened prediction errors."""
    on = problem.program.switches(found.effects)
    values = problem.values(track, found.free, found.theta)
    return track.filter(values, on, found.levels).whitened.reshape(len(track.times), -1)


def _region(variable: str, sentence: str, p: float) -> Region:
    sure = "p < 1e-6" if p < 1e-6 else f"p = {min(p, 1.0):.1g}"
    return Region(variable, f"{sentence}; {sure}", float(f"{min(p, 1.0):.2g}"))
