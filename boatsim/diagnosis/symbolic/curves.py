"""The curve of a term over the quantity that it varies with, and the force estimated there."""

from collections.abc import Sequence

import numpy as np

from boatsim.diagnosis.description import Curve
from boatsim.diagnosis.symbolic.term_forces import NO_AVERAGE, FittedRecording
from boatsim.physics.base import Array
from boatsim.physics.described_laws import SymbolicTerm
from boatsim.physics.terms import RIPPLES, factor_codes, history_codes

BINS = 40  # of a curve; the figure of a report is not wider
FEWEST_ROWS = 3  # of a bin that is drawn; fewer show noise only


def term_force_curve(
    recordings: Sequence[FittedRecording], term: SymbolicTerm, coefficient: float, sd: float
) -> Curve | None:
    """Return the force of a fitted symbolic term as a curve over the variable it depends on.

    The force that the recordings require there is returned with it.

    Args:
        recordings: The recordings as the fit explains them.
        term: A term of the fit.
        coefficient: Its fitted coefficient.
        sd: Standard deviation of the coefficient.

    Returns:
        Means over bins; None for a term that is constant or acts in none of these recordings.
    """
    over = _over(term)
    acting = [r for r in recordings if term.run in ("", r.recording.name)]
    if not over or not acting:
        return None
    parts = [_along(r, term, over, coefficient) for r in acting]
    x, size, found, weight = map(np.concatenate, zip(*parts, strict=True))
    if not np.ptp(x) > 0.0:
        return None
    place = np.minimum((BINS * (x - x.min()) / np.ptp(x)).astype(int), BINS - 1)
    filled = np.flatnonzero(np.bincount(place, weight > 0.0, BINS) >= FEWEST_ROWS)
    if len(filled) < 2:
        return None
    total = np.bincount(place, weight, BINS)[filled]

    def weighted_bin_means(values: Array) -> Array:
        return np.asarray(np.bincount(place, weight * values, BINS)[filled] / total)

    law = weighted_bin_means(size)
    return Curve(
        over, weighted_bin_means(x), coefficient * law, sd * np.abs(law), weighted_bin_means(found)
    )


def _over(term: SymbolicTerm) -> str:
    """Return what a curve is drawn over: a factor, "product" of several, "time", or "" for none."""
    if not term.of:
        return "" if term.acts == "always" else "time"
    bases = set()
    for name in term.of:
        bases.add(name.removeprefix("abs_").removeprefix("sign_").removeprefix("beyond_"))
    if len(bases) > 1:
        return "product"
    return bases.pop()


def _along(
    fitted: FittedRecording, term: SymbolicTerm, over: str, coefficient: float
) -> tuple[Array, Array, Array, Array]:
    """Return abscissa, size of the term, estimated size and weight of each row, (N,) each.

    The size of a term is its force with a coefficient of 1, relative to that of a constant term.
    The estimate is the residual force of the fit plus the force of the term.
    """
    size, force = fitted.term_value(term), fitted.term_force(term)
    unit = fitted.term_force(term.with_values({"of": (), "acts": "always"}))
    weight = np.einsum("na,na->n", unit, unit)
    with np.errstate(divide="ignore", invalid="ignore"):
        found = np.einsum("na,na->n", fitted.residual + coefficient * force, unit) / weight
    x = _abscissa(fitted, term, over, size)
    return x, size, np.where(weight > 0.0, found, 0.0), weight


def _abscissa(fitted: FittedRecording, term: SymbolicTerm, over: str, size: Array) -> Array:
    """Return the quantity (N,) over which a curve is drawn."""
    if over == "time":
        return fitted.recording.times
    if over == "product":
        return size
    if over in RIPPLES:
        motion = fitted.motion
        return np.asarray(motion.x if over.endswith("north") else motion.y)
    signals = fitted.problem.program.vessel.described_signals
    code, *_ = factor_codes(term.name, (over,), signals)
    average = NO_AVERAGE
    looks_at, deviation = history_codes(term.name, (over,), signals)
    if looks_at:
        average = (looks_at, deviation, term.memory)
    return fitted.factor_value(code, (1.0, 0.0, 1.0, 0.0), average)
