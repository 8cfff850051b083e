"""Evidence: what an effect must gain, what it gains, and what the latent force still explains."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from boatsim.diagnosis.config import DEFAULT, SelectConfig
from boatsim.diagnosis.problem import Fit, Problem, priors_of


def required_gain(number: int, config: SelectConfig = DEFAULT.select) -> float:
    """Return the evidence that an effect must gain, together with its look-alikes [nats].

    Before the data each candidate is as likely as another, and one of them as likely as none.

    Args:
        number: Number of candidates that are tested.
        config: Odds that are required.
    """
    return config.odds + float(np.log(max(number, 1)))


def unknown_threshold(
    config: SelectConfig, explained: float, model_error: float | None = None
) -> float:
    """Return the unexplained evidence from which a cause outside the candidates is reported [nats].

    Args:
        config: Settings of the selection.
        explained: Evidence that identified effects explain [nats].
        model_error: Share of it that their laws may be off by; None: the usual one.
    """
    share = config.model_error if model_error is None else model_error
    return config.unknown_gain + share * max(explained, 0.0)


def combined_gain(gains: Sequence[float]) -> float:
    """Return the evidence that any of several effects acts [nats].

    Args:
        gains: Evidence of each [nats].
    """
    return float(np.logaddexp.reduce(np.array(gains, dtype=float)))


def gain_by_curvature(best: Fit, name: str) -> float:
    """Return the evidence of an effect by the curvature at a fit [nats].

    This is half the squared distance from zero effect in standard deviations. It is far too large
    where the latent force may replace the effect, which a curvature does not show.

    Args:
        best: A fit.
        name: Name of one of its effects.
    """
    own = [i for i, f in enumerate(best.free) if f.effect == name and not f.relative]
    if not own:
        return 0.0
    off = best.theta[own] - priors_of(best.free).mean[own]
    return 0.5 * float(off @ np.linalg.solve(best.covariance[np.ix_(own, own)], off))


def gains_over(fits: Mapping[str, Fit], base: Fit) -> dict[str, float]:
    """Return the evidence that each of several fits gains over another one [nats].

    Args:
        fits: Fits by name.
        base: The fit that they are compared with.
    """
    return {name: found.evidence - base.evidence for name, found in fits.items()}


def fits_with_evidence_above(fits: Mapping[str, Fit], least: float) -> dict[str, Fit]:
    """Return the fits with more evidence than a limit.

    Args:
        fits: Fits by name.
        least: The limit [nats].
    """
    return {name: found for name, found in fits.items() if found.evidence > least}


def leading_candidates(
    fits: Mapping[str, Fit], base: Fit, config: SelectConfig = DEFAULT.select
) -> list[str]:
    """Return the candidates that a full fit may still show to be the best, the best first.

    A screening omits what a refit of the noise levels changes.

    Args:
        fits: Fits of candidates by name.
        base: The fit on top of which they were added.
        config: Distances from the best candidate.
    """
    gains = gains_over(fits, base)
    order = sorted(gains, key=lambda n: -gains[n])
    if not order:
        return []
    best = gains[order[0]]
    distance = max(config.near_front, config.front_share * best)
    return [n for n in order if gains[n] > best - distance]


def unexplained_evidence(problem: Problem, best: Fit) -> float:
    """Return the evidence that the latent force gains beyond the assumed level [nats].

    Args:
        problem: Recordings and priors.
        best: A fit.
    """
    factor = problem.config.locate.disturbance_factor
    on = problem.program.switches(best.effects)
    force = np.minimum(best.levels.force, factor * problem.ambient.force)
    held = replace(best.levels, force=force)
    free = problem.log_likelihood(best.free, best.theta, on, best.levels)
    return free - problem.log_likelihood(best.free, best.theta, on, held)
