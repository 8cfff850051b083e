"""Probability that an identified effect is a true cause, and not a stand-in for another one.

The hypothesis "a cause that no candidate describes" has no likelihood that could be computed. Its
odds are estimated from signs instead: a logistic regression of right and wrong names of a campaign
of simulated logs with known causes, among them causes outside the candidates
(`python -m validation.calibration`).
"""

from math import exp, hypot, log, log1p

from boatsim.diagnosis.config import DecideConfig
from boatsim.diagnosis.open_set.consistency import Consistency
from boatsim.diagnosis.open_set.log_signs import LogSigns
from boatsim.diagnosis.search.pruning import IdentifiedEffect

# bounds of features, so that no single sign decides: beyond them the campaign has few examples
MOST_SIGNIFICANT = 10.0
MOST_DEVIATION = 8.0
MOST_EXCESS = 2.0
LEAST_GAIN = 0.1  # [nats] on held-out recordings; less is no evidence
MOST_LOG_ODDS = 30.0  # beyond it the probability is 0 or 1 in every printed digit


def logistic_features(
    effect: IdentifiedEffect,
    stochastic: bool,
    consistency: Consistency,
    log_signs: LogSigns,
    config: DecideConfig,
) -> dict[str, float]:
    """Return the features of a logistic regression: is an identified effect a true cause?

    Their weighted sum is the log of the odds that the effect, or one of its look-alikes, is true.

    Args:
        effect: The effect with its evidence and its look-alikes.
        stochastic: Whether it is a stochastic force.
        consistency: Statistics of the effect that tell a true cause from a stand-in.
        log_signs: Statistics of the recordings as a whole.
        config: Settings of the decision.

    Returns:
        Features by the name of their weight in `DecideConfig`.
    """
    held_out = consistency.held_out
    off = abs(held_out.value - 1.0) / hypot(held_out.sd, config.law_error)
    alternative = consistency.alternative_gain / max(effect.gain, 1.0)
    structure = log_signs.structure_gain / max(log_signs.effects_gain, 1.0)
    held_out_gain = log(max(consistency.held_out_gain, LEAST_GAIN))
    return {
        "held_out_gain": held_out_gain,
        "held_out_significance": _within(held_out.significance, -3.0, MOST_SIGNIFICANT),
        "held_out_deviation": _within(off, 0.0, MOST_DEVIATION),
        "times_apart": _within(consistency.between_times.excess, 0.0, MOST_EXCESS),
        "ranges_apart": _within(consistency.between_ranges.excess, 0.0, MOST_EXCESS),
        "unexplained": _within(log_signs.unexplained, 0.0, 4.0),
        "structure": _within(structure, 0.0, 1.0),
        "alternative": _within(alternative, 0.0, 2.0),
        "prior_distance": log1p(consistency.prior_distance),
        "at_bound": float(exceeds_range(consistency, config)),
        "stochastic": float(stochastic),
        "stochastic_gain": float(stochastic) * held_out_gain,
        "look_alikes": float(len(effect.tied_with)),
        "coefficient_shift": _within(log_signs.coefficient_shift, 0.0, 4.0),
        "effects": log(max(log_signs.effects, 1)),
    }


def probability_of_true_cause(found: dict[str, float], config: DecideConfig) -> float:
    """Return the probability that an identified effect, or one of its look-alikes, is a true cause.

    It is the result of a logistic regression.

    Args:
        found: Features of the effect.
        config: Their weights.
    """
    odds = config.intercept
    for name, value in found.items():
        odds += getattr(config, name) * value
    return 1.0 / (1.0 + exp(-_within(odds, -MOST_LOG_ODDS, MOST_LOG_ODDS)))


def exceeds_range(consistency: Consistency, config: DecideConfig) -> bool:
    """Whether the recordings require a larger effect than its allowed range of parameters permits.

    A parameter is then at a bound of its range, and one recording requires more than the fitted
    size.

    Args:
        consistency: Statistics of the effect over the recordings.
        config: Settings of the decision.
    """
    sizes = [factor.value for factor in consistency.recordings]
    return consistency.at_bound and max(sizes, default=2.0) > 1.0 + config.law_error


def _within(value: float, low: float, high: float) -> float:
    """Limit a value; not a number becomes the lower bound."""
    return max(low, min(high, value)) if value == value else low
