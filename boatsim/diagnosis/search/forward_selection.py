"""Forward selection: suspects added one by one, each time the one by which the evidence rises most."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from boatsim.diagnosis.candidates import called
from boatsim.diagnosis.problem import Fit
from boatsim.diagnosis.search.candidate_sets import Sets
from boatsim.diagnosis.search.evidence import together, worth

MOST = 8  # effects in one answer: further ones would have next to no data of their own
SELECTING, SLOWER = (
    (0.5, 0.8),
    0.7,
)  # of a ranking, by experience; what is left to select after each further member
LAWFUL = 0.5  # share of the gain of a random force from which a law is taken in its place
# prices that an effect is worth by the curvature at a fit, from where it stays without a fit
# without it
CLEAR = 40.0
# of what the others explain, below which an effect may be what their laws are off by
SLIGHT = 0.025


def selected(sets: Sets, best: Fit) -> Fit:
    """The best set from one on: suspects added one by one, earlier ones dropped that a newer one makes needless."""
    for _ in range(2 * MOST):  # additions and prunings together
        tried = sets.tried(best)
        _tell(sets, best)
        if not tried or len(best.effects) == MOST:
            break
        laws = {n: f for n, f in tried.items() if n not in sets.random}
        if _gained(laws, best) > max(sets.price, LAWFUL * _gained(tried, best)):
            tried = laws  # a random force can stand for a law, a law hardly for it
        if _gained(tried, best) < max(sets.price, SLIGHT * sets.explained(best)):
            break
        name = max(tried, key=lambda n: tried[n].evidence)
        further = _pruned(sets, sets.trusted(sets.converged(tried[name])))
        if set(further.effects) == set(best.effects):
            break  # the newest made way again
        best = further
    return best


def _tell(sets: Sets, best: Fit) -> None:
    """What is the best so far."""
    names, gain = ", ".join(map(called, best.effects)), best.evidence - sets.base.evidence
    done = SELECTING[1] - (SELECTING[1] - SELECTING[0]) * SLOWER ** len(best.effects)
    sets.report("selecting", done, f"best so far: {names} ({gain:.0f} nats)" if names else "")


def begun(sets: Sets, other: Fit) -> Fit:
    """The set of a fit to the same recordings with other levels, fitted anew."""
    return sets.converged(replace(other, levels=sets.base.levels, evidence=-np.inf))


def _gained(tried: Mapping[str, Fit], best: Fit) -> float:
    """Nats that one of several entries gains on top of a set, whichever."""
    return together([f.evidence - best.evidence for f in tried.values()]) if tried else -np.inf


def _pruned(sets: Sets, best: Fit) -> Fit:
    """Without the earlier effects that the newest one has made needless."""
    for name in best.effects[:-1]:
        if worth(best, name) > CLEAR * sets.price:
            continue
        without = sets.without(best, name)
        if without.evidence > best.evidence - sets.price:
            best = without
    return best
