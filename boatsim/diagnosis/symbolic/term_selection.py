"""Chooses the terms of a description: weighed quickly, the best tried in the filter, made finer, judged by evidence."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from boatsim.diagnosis.filter import MappedRecording
from boatsim.diagnosis.fit import converge, fit, gauss_newton, remove_effect
from boatsim.diagnosis.problem import Fit, Problem
from boatsim.diagnosis.search.evidence import price
from boatsim.diagnosis.search.forward_selection import SLIGHT
from boatsim.diagnosis.search.pruning import ALIKE_SHARE, WORTH
from boatsim.diagnosis.symbolic.grammar import FINER, FINEST, neighbours, terms
from boatsim.diagnosis.symbolic.slots import free_slot, write
from boatsim.diagnosis.symbolic.term_forces import ways
from boatsim.diagnosis.symbolic.term_scores import Weighed, varying, weighed
from boatsim.physics.described_laws import Described
from boatsim.progress import Report, silent

MOST = 5  # terms
TRIED = 4  # of those that promise most, in the filter
TOLD = 0.1  # [nats] by which a move must gain
TURNS = 4  # of moving a term by the filter and fitting all else
ROUNDS = 3  # moves of a term's times or wavelength at one fineness


@dataclass(frozen=True)
class Chosen:
    """A description so far: the fit, and the term that stands in each slot, in the order in which they came."""

    fit: Fit
    terms: dict[str, Described]


def chosen(
    problem: Problem, best: Fit, held_out: Sequence[MappedRecording], report: Report = silent
) -> Chosen:
    """Terms added one by one to a set, each time the one by which the evidence rises most, while one is worth it."""
    report("describing what is left over")
    begun = so_far = Chosen(best, {})
    everywhere, refused = [*problem.recordings, *held_out], set[Likeness]()
    while len(so_far.terms) < MOST:
        seen = ways(problem, so_far.fit)
        ordered = weighed(
            seen, list(terms(problem.program.vessel, problem.recordings, *varying(seen)))
        )
        ahead = [
            w for w in best_of_each(ordered) if w.gain > 0.0 and likeness(w.term) not in refused
        ][:TRIED]
        tried = [made for w in ahead if (made := _with(problem, so_far, w, everywhere))]
        if not tried:
            break
        slot, found, w = max(tried, key=lambda t: t[1].evidence)
        write(problem, slot, w.term, everywhere)  # others were tried in this slot after it
        problem.spreads[slot] = w.spread
        term, found = _finer(problem, so_far, slot, w, found, everywhere)
        found = converge(problem, found)
        gained = so_far.fit.evidence - begun.fit.evidence
        if found.evidence - so_far.fit.evidence < max(price(len(ordered)), SLIGHT * gained):
            break
        further = Chosen(found, so_far.terms | {slot: term})
        if _said_already(problem, so_far, further):
            refused.add(likeness(w.term))
            continue
        so_far = _pruned(problem, further)
        if len(so_far.terms) > 1:
            so_far = _beside(problem, so_far, everywhere)
        gain = found.evidence - best.evidence
        report(
            "describing what is left over",
            len(so_far.terms) / MOST,
            f"{len(so_far.terms)} terms ({gain:.0f} nats)",
        )
    return so_far


Likeness = tuple[object, ...]


def likeness(term: Described) -> Likeness:
    """What terms share that differ in no more than when they act, or in a wavelength."""
    return (
        type(term),
        term.of,
        term.acts,
        term.run,
        *(getattr(term, n, "") for n in ("axis", "side", "sense")),
    )


def best_of_each(ordered: Sequence[Weighed]) -> list[Weighed]:
    """Of terms that differ in no more than when they act, or in a wavelength, the best: it is made finer later."""
    found: dict[Likeness, Weighed] = {}
    for w in ordered:
        found.setdefault(likeness(w.term), w)
    return list(found.values())


def _with(
    problem: Problem, so_far: Chosen, w: Weighed, tracks: Sequence[MappedRecording]
) -> tuple[str, Fit, Weighed] | None:
    """The fit with one more term, in its slot; None where no slot is free or the boat runs away."""
    slot = free_slot(problem, type(w.term), list(so_far.terms))
    if not slot:
        return None
    write(problem, slot, w.term, tracks)
    problem.spreads[slot] = w.spread
    base = so_far.fit
    free = problem.parameters((*base.effects, slot))
    known = {(f.effect, f.name): x for f, x in zip(base.free, base.theta, strict=True)}
    theta = np.array([known.get((f.effect, f.name), w.coefficient) for f in free])
    start = Fit(
        (*base.effects, slot), free, theta, np.diag([f.sd**2 for f in free]), base.levels, -np.inf
    )
    found = gauss_newton(problem, start, 4, problem.config.fit.refit_gain)
    return (slot, fit(problem, found), w) if np.isfinite(found.evidence) else None


def _finer(
    problem: Problem,
    so_far: Chosen,
    slot: str,
    w: Weighed,
    found: Fit,
    tracks: Sequence[MappedRecording],
) -> tuple[Described, Fit]:
    """The term with its times or its wavelength moved to where they explain most, and the fit with it."""
    if not neighbours(w.term, problem.recordings, FINER[0]):
        return w.term, found
    seen, best = ways(problem, so_far.fit), w
    for by in FINER:
        for _ in range(ROUNDS):
            near = weighed(seen, neighbours(best.term, problem.recordings, by))
            if not near or near[0].gain <= best.gain:
                break
            best = near[0]
    if best.term != w.term:
        made = _with(problem, so_far, best, tracks)
        if made and made[1].evidence > found.evidence:
            w, found = best, made[1]
        else:
            write(problem, slot, w.term, tracks)
            problem.spreads[slot] = w.spread
    return _polished(problem, slot, w.term, found, tracks)


def _polished(
    problem: Problem, slot: str, term: Described, found: Fit, tracks: Sequence[MappedRecording]
) -> tuple[Described, Fit]:
    """The same by the filter itself, all else held, and the fit then made: what is left over says it but roughly.

    In turns, for what is held may go along: a force that follows more slowly must be the stronger one.
    """
    for _ in range(TURNS if neighbours(term, problem.recordings, FINEST[0]) else 0):
        moved = _moved(problem, slot, term, found, tracks)
        if moved == term:
            break
        again = fit(problem, found)
        if not again.evidence > found.evidence:
            write(problem, slot, term, tracks)
            break
        term, found = moved, again
    return term, found


def _beside(problem: Problem, so_far: Chosen, tracks: Sequence[MappedRecording]) -> Chosen:
    """All terms moved once more, each beside the others: the first ones stood for a part of those that came later."""
    terms, found = dict(so_far.terms), so_far.fit
    for slot, term in terms.items():
        terms[slot], found = _polished(problem, slot, term, found, tracks)
    return so_far if found is so_far.fit else Chosen(converge(problem, found), terms)


def _moved(
    problem: Problem, slot: str, term: Described, found: Fit, tracks: Sequence[MappedRecording]
) -> Described:
    """A term, written into its slot, moved to where the filter finds the recordings likeliest, the fit held."""
    on = problem.program.switches(found.effects)

    def likelihood(one: Described) -> float:
        write(problem, slot, one, tracks)
        return problem.log_likelihood(found.free, found.theta, on, found.levels)

    best = likelihood(term)
    for by in FINEST:
        for _ in range(ROUNDS):
            scores = [
                (likelihood(t), i, t)
                for i, t in enumerate(neighbours(term, problem.recordings, by))
            ]
            score, _, ahead = max(scores, key=lambda s: s[:2])
            if not score > best + TOLD:
                break
            term, best = ahead, score
    write(problem, slot, term, tracks)
    return term


def _said_already(problem: Problem, before: Chosen, further: Chosen) -> bool:
    """Whether the newest term would take the place of an entry that alone explains most of what the term does.

    A law of the library with a name, a little off, is the better answer: a wind, not a side force with the heading.
    """
    for name in (n for n in before.fit.effects if n not in before.terms):
        without = less(problem, further, name).fit
        if without.evidence > further.fit.evidence - WORTH:
            neither = less(problem, before, name).fit.evidence
            if before.fit.evidence - neither > ALIKE_SHARE * (without.evidence - neither):
                return True
    return False


def _pruned(problem: Problem, so_far: Chosen) -> Chosen:
    """Without what the newest term has made needless: an earlier term, or an entry that but stood for it."""
    for name in so_far.fit.effects[:-1]:
        without = converge(problem, remove_effect(problem, so_far.fit, name))
        if without.evidence > so_far.fit.evidence - WORTH:
            so_far = Chosen(without, {n: t for n, t in so_far.terms.items() if n != name})
    return so_far


def less(problem: Problem, so_far: Chosen, name: str) -> Chosen:
    """A description without one of its terms."""
    found = converge(problem, remove_effect(problem, so_far.fit, name))
    return replace(so_far, fit=found, terms={n: t for n, t in so_far.terms.items() if n != name})
