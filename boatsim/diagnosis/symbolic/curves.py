"""A described term as a curve over what it goes with, beside what the recordings call for there."""

from collections.abc import Sequence

import numpy as np

from boatsim.diagnosis.description import Curve
from boatsim.diagnosis.symbolic.term_forces import NEVER, Way
from boatsim.physics.base import Array
from boatsim.physics.described_laws import Described
from boatsim.physics.terms import RIPPLES, codes, looks

BINS = 40  # of a curve
FEWEST = 3  # rows of a bin that is drawn


def curve(ways: Sequence[Way], term: Described, coefficient: float, sd: float) -> Curve | None:
    """The curve of a term of the fit that the recordings are seen by; None of what is always the same."""
    over = _over(term)
    near = [w for w in ways if term.run in ("", w.track.name)]
    if not over or not near:
        return None
    parts = [_along(w, term, over, coefficient) for w in near]
    x, size, found, weight = (np.concatenate(column) for column in zip(*parts, strict=True))
    if not np.ptp(x) > 0.0:
        return None
    place = np.minimum((BINS * (x - x.min()) / np.ptp(x)).astype(int), BINS - 1)
    there = np.flatnonzero(np.bincount(place, weight > 0.0, BINS) >= FEWEST)
    total = np.bincount(place, weight, BINS)[there]

    def mean(values: Array) -> Array:
        return np.asarray(np.bincount(place, weight * values, BINS)[there] / total)

    law = mean(size)
    return (
        Curve(over, mean(x), coefficient * law, sd * np.abs(law), mean(found))
        if len(there) > 1
        else None
    )


def _over(term: Described) -> str:
    """What a term is drawn over: the only thing that it goes with, the product of several, or time."""
    if not term.of:
        return "" if term.acts == "always" else "time"
    bases = {
        name.removeprefix("abs_").removeprefix("sign_").removeprefix("beyond_") for name in term.of
    }
    return bases.pop() if len(bases) == 1 else "product"


def _along(
    way: Way, term: Described, over: str, coefficient: float
) -> tuple[Array, Array, Array, Array]:
    """(N,) each: what it is drawn over, the term with a coefficient of one, what is called for, and how much it says.

    The force that all terms leave over, and this one's own, in shares of the force that goes with a size of one.
    """
    size, whole = way.size(term), way.along(term)
    ones = way.along(term.having({"of": (), "acts": "always"}))
    weight = np.einsum("na,na->n", ones, ones)
    with np.errstate(divide="ignore", invalid="ignore"):
        found = np.einsum("na,na->n", way.left + coefficient * whole, ones) / weight
    return _values(way, term, over, size), size, np.where(weight > 0.0, found, 0.0), weight


def _values(way: Way, term: Described, over: str, size: Array) -> Array:
    if over == "time":
        return way.track.times
    if over == "product":
        return size
    if over in RIPPLES:
        return np.asarray(way.motion.x if over.endswith("north") else way.motion.y)
    held = way.problem.program.vessel.described_signals
    (number, *_), late = codes(term.name, (over,), held), looks(term.name, (over,), held)
    return way.factor(number, (1.0, 0.0, 1.0, 0.0), (*late, term.memory) if late[0] else NEVER)
