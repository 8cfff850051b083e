"""Evidence: what an effect must gain, what it gains, and what the latent force still explains."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from boatsim.diagnosis.config import DEFAULT, SelectConfig
from boatsim.diagnosis.problem import Fit, Problem, prior_arrays


def required_gain(number: int, config: SelectConfig = DEFAULT.select) -> float:
    """Return the log evidence that an effect must gain to be identified [nats].

    Before the data each candidate is as likely as another, and one of them as likely as none. The
    gain is that of the effect together with its look-alikes.

    Args:
        number: Number of candidates that are tested.
        config: Settings of the selection, with the required log odds.
    """
    return config.odds + float(np.log(max(number, 1)))


def unknown_cause_threshold(
    config: SelectConfig, explained: float, model_error: float | None = None
) -> float:
    """Return the evidence of unexplained force from which an unknown cause is reported [nats].

    An unknown cause is one that no candidate effect describes. The threshold increases with the
    evidence that the identified effects explain, because their laws are approximate.

    Args:
        config: Settings of the selection.
        explained: Evidence that identified effects explain [nats].
        model_error: Share of that evidence by which their laws may be wrong; None: the usual one.
    """
    share = config.model_error if model_error is None else model_error
    return config.unknown_gain + share * max(explained, 0.0)


def combined_gain(gains: Sequence[float]) -> float:
    """Return the log evidence that any one of several effects acts [nats].

    Args:
        gains: Evidence of each [nats].
    """
    return float(np.logaddexp.reduce(np.array(gains, dtype=float)))


def quadratic_evidence_gain(best: Fit, *names: str) -> float:
    """Return a quadratic approximation of the evidence that effects gain together in a fit [nats].

    This is half the squared distance of their parameters from zero effect in standard deviations.
    It is far too large where the latent (unmodelled) force may replace the effects, which a
    curvature does not show.

    Args:
        best: Fit of the vessel model with some candidate effects.
        *names: Names of some of its effects.
    """
    own = [i for i, f in enumerate(best.free) if f.effect in names and not f.relative]
    if not own:
        return 0.0
    off = best.theta[own] - prior_arrays(best.free).mean[own]
    return 0.5 * float(off @ np.linalg.solve(best.covariance[np.ix_(own, own)], off))


def log_evidence_gains(fits: Mapping[str, Fit], base: Fit) -> dict[str, float]:
    """Return the log evidence of each of several fits minus that of a reference fit [nats].

    A fit that diverges gains minus infinity, also if the reference fit diverges.

    Args:
        fits: Fits by name.
        base: The fit that they are compared with.
    """
    gains = {}
    for name, found in fits.items():
        diverges = not np.isfinite(found.evidence)
        gains[name] = -np.inf if diverges else found.evidence - base.evidence
    return gains


def fits_with_evidence_above(fits: Mapping[str, Fit], least: float) -> dict[str, Fit]:
    """Return those of several fits whose log evidence exceeds a limit.

    Args:
        fits: Fits by name.
        least: The limit [nats].
    """
    return {name: found for name, found in fits.items() if found.evidence > least}


def leading_candidates(
    fits: Mapping[str, Fit], base: Fit, config: SelectConfig = DEFAULT.select
) -> list[str]:
    """Return the candidate effects that are near enough to the best one to be fitted in full.

    Their rough fits (screenings) omit what a refit of the noise levels changes, so that the order
    may still change. The best is first.

    Args:
        fits: Rough fits with one candidate added, by its name.
        base: Fit to which the candidates were added.
        config: Settings of the selection, with the allowed distances from the best candidate.
    """
    gains = log_evidence_gains(fits, base)
    order = sorted(gains, key=lambda n: -gains[n])
    if not order:
        return []
    best = gains[order[0]]
    distance = max(config.near_front, config.front_share * best)
    return [n for n in order if gains[n] > best - distance]


def unexplained_evidence(problem: Problem, best: Fit) -> float:
    """Return the evidence for an unmodelled force beyond the assumed disturbance level [nats].

    It is the log likelihood that a fit loses if its latent force is limited to that level.

    Args:
        problem: The estimation problem: recordings, vessel model, candidate effects and priors.
        best: Fit of the vessel model with some candidate effects.
    """
    factor = problem.config.locate.disturbance_factor
    on = problem.program.effect_switches(best.effects)
    force = np.minimum(best.levels.force, factor * problem.ambient.force)
    held = replace(best.levels, force=force)
    free = problem.log_likelihood(best.free, best.theta, on, best.levels)
    return free - problem.log_likelihood(best.free, best.theta, on, held)
