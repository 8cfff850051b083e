"""Probability that an identified effect is a true cause, and not a stand-in for another one.

The hypothesis "a cause that no candidate describes" has no likelihood that could be computed. Its
odds are estimated from signs instead: a logistic regression of right and wrong names of a campaign
of simulated logs with known causes, among them causes outside the candidates
(`python -m validation.calibration`).
"""

from math import exp, hypot, log, log1p

from boatsim.diagnosis.config import DecideConfig
from boatsim.diagnosis.open_set.consistency import Consistency, Variation
from boatsim.diagnosis.open_set.log_signs import LogSigns

# bounds of features, so that no single sign decides: beyond them the campaign has few examples
MOST_SIGNIFICANT = 10.0
MOST_DEVIATION = 8.0
MOST_EXCESS = 2.0
LEAST_RATIO = 0.2
LAW_ERROR = 0.1  # share of an effect by which a true law may differ from the candidate's
MOST_LOG_ODDS = 30.0  # beyond it the probability is 0 or 1 in every printed digit


def features(
    gain: float, stochastic: bool, consistency: Consistency, log_signs: LogSigns
) -> dict[str, float]:
    """Return the numbers whose weighted sum is the log of the odds that a name is right.

    Args:
        gain: Evidence of the effect on top of the others [nats].
        stochastic: Whether it is a stochastic force, or the drift of an instrument.
        consistency: Signs of the effect.
        log_signs: Signs of the log.

    Returns:
        Features by the name of their weight in `DecideConfig`.
    """
    held_out = consistency.held_out
    sizes = [factor.value for factor in consistency.recordings]
    significance = [factor.significance for factor in consistency.recordings]
    off = abs(held_out.value - 1.0) / hypot(held_out.sd, LAW_ERROR)
    total = max(log_signs.effects_gain, 1.0)
    return {
        "gain": log(max(gain, 1.0)),
        "held_out_significance": _within(held_out.significance, -3.0, MOST_SIGNIFICANT),
        "held_out_deviation": _within(off, 0.0, MOST_DEVIATION),
        "weakest_recording": _within(min(significance, default=0.0), -3.0, MOST_SIGNIFICANT),
        "recordings_apart": _within(max(sizes) - min(sizes), 0.0, 3.0) if sizes else 0.0,
        "parts_that_gain": consistency.parts_that_gain,
        "times_apart": _within(consistency.between_times.excess, 0.0, MOST_EXCESS),
        "times_ratio": _log_ratio(consistency.between_times),
        "ranges_apart": _within(consistency.between_ranges.excess, 0.0, MOST_EXCESS),
        "ranges_ratio": _log_ratio(consistency.between_ranges),
        "alternative": _within(consistency.alternative_gain / max(gain, 1.0), 0.0, 2.0),
        "prior_distance": log1p(consistency.prior_distance),
        "at_bound": float(exceeds_range(consistency)),
        "stochastic": float(stochastic),
        "coefficient_shift": _within(log_signs.coefficient_shift, 0.0, 4.0),
        "force_ratio": _within(log(max(log_signs.force_ratio, 0.1)), -1.0, 4.0),
        "unexplained": _within(log_signs.unexplained, 0.0, 4.0),
        "structure": _within(log_signs.structure_gain / total, 0.0, 1.0),
        "structure_gain": log1p(log_signs.structure_gain),
        "effects": float(log_signs.effects - 1),
    }


def probability_of_true_cause(found: dict[str, float], config: DecideConfig) -> float:
    """Return the probability that an effect, or one of its look-alikes, is a true cause.

    Args:
        found: Features of the effect.
        config: Their weights.
    """
    odds = config.intercept
    for name, value in found.items():
        odds += getattr(config, name) * value
    return 1.0 / (1.0 + exp(-_within(odds, -MOST_LOG_ODDS, MOST_LOG_ODDS)))


def exceeds_range(consistency: Consistency) -> bool:
    """Whether a parameter is at a bound of its range, and a recording requires more than that.

    Args:
        consistency: Signs of an effect.
    """
    sizes = [factor.value for factor in consistency.recordings]
    return consistency.at_bound and max(sizes, default=2.0) > 1.0 + LAW_ERROR


def _within(value: float, low: float, high: float) -> float:
    """Limit a value; not a number becomes the lower bound."""
    return max(low, min(high, value)) if value == value else low


def _log_ratio(variation: Variation) -> float:
    """Log of the chi-square per degree of freedom."""
    return log(max(variation.ratio, LEAST_RATIO))
