"""What evidence says: the price of an effect, its worth, and what the latent force still has to explain."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from boatsim.diagnosis.problem import Fit, Problem

# log of the odds, seven to one, at which an effect is named, where each of those tried is as likely
# before
ODDS = 2.0
CLOSE = 5.0  # candidates this near to the first [nats] are fitted in full,
HALF = 0.5  # and those with this share of its gain
UNKNOWN = 6.0  # [nats] it must gain for the cause to lie outside the library,
INEXACT = 0.05  # and so much of what was explained: nature's laws are never quite the entries'


def price(number: int) -> float:
    """Nats that an effect must gain, its look-alikes counted in, where so many were tried.

    Before the data each is as likely as another, and one of them as likely to be there as none.
    """
    return ODDS + float(np.log(max(number, 1)))


def told_from(explained: float, inexact: float = INEXACT) -> float:
    """Nats left over from which something is missing that the library has not, where its entries explained so many."""
    return UNKNOWN + inexact * max(explained, 0.0)


def together(gains: Sequence[float]) -> float:
    """Nats that one of several entries gains, whichever: the evidence that any is there, but for how many there are."""
    return float(np.logaddexp.reduce(np.array(gains, dtype=float)))


def worth(best: Fit, name: str) -> float:
    """Nats that a member gains by the curvature at a fit: half the square of its distance from not acting, in sds.

    That is far more than it gains where the latent force may take its place, which a curvature knows nothing of.
    """
    own = [i for i, f in enumerate(best.free) if f.effect == name and not f.relative]
    off = best.theta[own] - np.array([best.free[i].mean for i in own])
    return (
        0.5 * float(off @ np.linalg.solve(best.covariance[np.ix_(own, own)], off)) if own else 0.0
    )


def front(tried: Mapping[str, Fit], base: Fit) -> list[str]:
    """Candidates that may yet turn out the best, the best first: a quick look leaves out what the force levels take."""
    gains = {n: f.evidence - base.evidence for n, f in tried.items()}
    order = sorted(gains, key=lambda n: -gains[n])
    reach = max(CLOSE, HALF * gains[order[0]]) if order else 0.0
    return [n for n in order if gains[n] > gains[order[0]] - reach]


def left_over(problem: Problem, best: Fit) -> float:
    """Nats that the latent force gains beyond the tolerated level: what nothing in the library explains."""
    on = problem.program.switches(best.effects)
    held = replace(
        best.levels,
        force=np.minimum(
            best.levels.force, problem.config.locate.disturbance_factor * problem.ambient.force
        ),
    )
    free = problem.log_likelihood(best.free, best.theta, on, best.levels)
    return free - problem.log_likelihood(best.free, best.theta, on, held)
