"""Which members of a set are named: what each gains on top of the others, and how its rivals do in its place."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from boatsim.diagnosis.candidates import REORDERED, called
from boatsim.diagnosis.fit import log_prior
from boatsim.diagnosis.problem import Fit
from boatsim.diagnosis.search.candidate_sets import Sets
from boatsim.diagnosis.search.evidence import HALF, UNKNOWN, front, left_over, together, told_from
from boatsim.diagnosis.search.forward_selection import SLIGHT, selected

ALIKE = 3.0  # [nats] entries this close to the winner are its look-alikes
RIVALS = 3  # fitted in the place of what was named
TOLD = 0.1  # of what was allowed before the data, within which they tell a parameter
SURE, SURE_RANDOM = 1.0, 2.0  # sds from not acting at which an effect acts
WORTH = 4.0  # [nats] that an effect must gain by itself
# of what two explain together, which each explains alone where they are much alike
ALIKE_SHARE = 0.5


@dataclass(frozen=True)
class Named:
    """An effect the data call for."""

    name: str
    gain: float  # [nats] on top of the others named
    shared: (
        float  # [nats] that it and its rivals gain together: that one of them is there, whichever
    )
    probability: float
    tied_with: tuple[str, ...]  # look-alikes, at most three
    rivals: Mapping[str, Fit]  # fits with the next best suspects in its place


def settled(sets: Sets, best: Fit) -> tuple[Fit, tuple[Named, ...]]:
    """The set without members that gain too little on top of the others, and what is to be said of the rest.

    A member in whose place another does better makes way for it, unless that leads back to where it was.
    """
    seen = set()
    while True:
        seen.add(frozenset(best.effects))
        named = tuple(_named(sets, best, n) for n in best.effects)
        rivals = [(n.name, r, f) for n in named for r, f in n.rivals.items()]
        fair = [r for r in rivals if r[0] in sets.random or r[1] not in sets.random]
        better = [
            f
            for name, rival, f in fair
            if f.evidence > best.evidence + _ahead(name, rival, sets.config.fit.refit_gain)
        ]
        further = selected(sets, max(better, key=lambda f: f.evidence)) if better else best
        if frozenset(further.effects) not in seen:
            best = further
            continue
        little = [n for n in named if _little(sets, best, n) or _mends(sets, best, n)]
        calm = [n for n in named if n not in little and not _foreseen(sets, best, n)]
        if not little and not calm:
            return best, named
        out = min(little + calm, key=lambda n: n.gain)
        if out in calm:
            sets.banned.add(out.name)
        best = sets.without(best, out.name)


def _ahead(name: str, rival: str, settled: float) -> float:
    """Nats by which a rival must be ahead: on the other side of an actuator than usual only where recordings tell."""
    if name.removeprefix(REORDERED) == rival.removeprefix(REORDERED):
        return -ALIKE if name.startswith(REORDERED) else ALIKE
    return settled


def _little(sets: Sets, best: Fit, named: Named) -> bool:
    """Whether a member gains too little to be named."""
    slight = SLIGHT * (sets.explained(best) - named.gain)
    return (
        named.gain < max(WORTH, slight)
        or named.shared < sets.price
        or not there(sets, best, named.name)
    )


def _mends(sets: Sets, best: Fit, named: Named) -> bool:
    """Whether a member but mends the shape of another: each alone explains most of what both do, together little more.

    A square and a cube of one speed may both be asked for where nature's law is neither.
    """
    if named.gain > told_from(sets.explained(best)):
        return False
    alone = sets.without(best, named.name)
    for other in alone.effects:
        neither, instead = sets.without(alone, other), sets.without(best, other)
        both = best.evidence - neither.evidence
        alike = min(alone.evidence, instead.evidence) - neither.evidence > ALIKE_SHARE * both
        if alike and named.gain < told_from(both):
            return True
    return False


def _foreseen(sets: Sets, best: Fit, named: Named) -> bool:
    """Whether a member makes what was recorded likelier, sensors and water as noisy with it as without.

    What it gains besides is that less was to be expected: more damping keeps the hull still where nothing moves it, and
    forgets the sooner how a recording began. In calm water that is no merit of a law. Where an unsteady force
    acts, which takes up what a law foresaw, the water is not calm.
    """
    problem, seen = sets.problem, []
    if (
        named.name in sets.random
        or sets.unsteady & set(best.effects)
        or left_over(problem, best) > UNKNOWN
    ):
        return True
    for found in (best, sets.without(best, named.name)):
        on = problem.program.switches(found.effects)
        passes = problem.filter(found.free, found.theta, on, best.levels)
        likelihood = passes.log_likelihood - passes.log_density
        seen.append(likelihood + log_prior(found.free, found.theta))
    return not seen[0] - seen[1] < WORTH


def there(sets: Sets, best: Fit, name: str) -> bool:
    """Whether an effect is more than a standard deviation from not acting: if not, only the search gained by it.

    Of a random one more than two: sizes lie on one side of zero, where the search alone makes something of nothing.
    It acts too where recordings tell, to within `TOLD` of what was allowed, another of its parameters than those which
    are zero without it: a craft that never comes near the speed from which it planes shows by how much it is held back,
    not that speed. (The rhythm of a random force is told by what little of it there seems to be.)
    """
    kind = next(type(e) for e in sets.problem.program.candidates if e.name == name)
    own = {f.name: f for f in best.free if f.effect == name and not f.relative}
    params, found = kind.params(), {n: best.value(name, n) for n in own}
    strength = [n for n in own if n in (kind.strength or params)]
    sure = SURE_RANDOM if kind.random else SURE
    return (
        not strength
        or any(abs(found[n][0] - params[n].absent) > sure * found[n][1] for n in strength)
        or not kind.random
        and any(found[n][1] < TOLD * own[n].sd for n in own if n not in strength)
    )


def _named(sets: Sets, best: Fit, name: str) -> Named:
    """Gain of one effect on top of the others, and how its rivals do in its place."""
    without = sets.without(best, name)
    gain = best.evidence - without.evidence
    tried = sets.tried(without, [n for n in sets.hopeful(without) if n != name])
    others = {n: f for n, f in tried.items() if n not in best.effects}
    ahead = {n: others[n] for n in front(others, without)[:RIVALS]}
    key = frozenset(without.effects)
    poor = {
        n
        for n, f in ahead.items()
        if (key, n) in sets.full and f.evidence < without.evidence + HALF * gain
    }
    return beside(
        name, best, without, {n: f if n in poor else sets.converged(f) for n, f in ahead.items()}
    )


def beside(name: str, best: Fit, without: Fit, rivals: Mapping[str, Fit]) -> Named:
    """What is to be said of a member of a set, given the fit without it and those of its rivals in its place."""
    gain = best.evidence - without.evidence
    gains = {n: f.evidence - without.evidence for n, f in rivals.items()}
    weights = np.exp(np.array([0.0, gain, *gains.values()]) - max(gain, 0.0, *gains.values()))
    same = np.array(
        [False, True, *(called(n) == called(name) for n in gains)]
    )  # on either side of an actuator
    order = sorted(gains, key=lambda n: -gains[n])
    tied = tuple(n for n in order if gains[n] > gain - ALIKE and called(n) != called(name))[:3]
    probability = float(weights[same].sum() / weights.sum())
    return Named(
        name,
        gain,
        together([gain, *gains.values()]),
        probability,
        tied,
        {n: rivals[n] for n in order},
    )
