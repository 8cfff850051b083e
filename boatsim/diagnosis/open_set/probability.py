"""Probability that an identified effect is a true cause, and not a stand-in for another one.

The hypothesis "a cause that no candidate describes" has no likelihood that could be computed. Its
odds are estimated from signs instead: a logistic regression of right and wrong names of a campaign
of simulated logs with known causes, among them causes outside the candidates
(`python -m validation.calibration`).
"""

from math import exp, hypot, inf, log, log1p

from boatsim.diagnosis.config import DecideConfig
from boatsim.diagnosis.open_set.consistency import Consistency, Variation
from boatsim.diagnosis.open_set.log_signs import LogSigns
from boatsim.diagnosis.search.pruning import IdentifiedEffect


def logistic_features(
    effect: IdentifiedEffect,
    stochastic: bool,
    consistency: Consistency,
    log_signs: LogSigns,
    config: DecideConfig,
) -> dict[str, float]:
    """Return the features of a logistic regression: is an identified effect a true cause?

    Their weighted sum is the log of the odds that the effect, or one of its look-alikes, is true.
    They are limited, so that no single sign decides.

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
    least = config.least_reference_gain
    off = abs(held_out.value - 1.0) / hypot(held_out.sd, config.size_tolerance)
    times, ranges = consistency.between_times, consistency.between_ranges
    unexplained = _within(log_signs.unexplained, 0.0, config.largest_unexplained)
    # The alternative to a constant size is an error of form, which leaves unexplained force
    rough = unexplained / config.largest_unexplained
    off_chi_square = (held_out.value - 1.0) ** 2 / held_out.sd**2
    unseen = Variation(0.0, off_chi_square, 1, held_out.sd**-2)
    alternative = consistency.alternative_gain / max(effect.gain, least)
    structure = log_signs.structure_gain / max(log_signs.effects_gain, least)
    remains = max(log_signs.unexplained_gain, log_signs.structured * log_signs.structure_gain)
    remains = max(remains - config.law_error * max(log_signs.effects_gain, 0.0), 0.0)
    # A model with estimated numbers leaves force unexplained whether or not the effect is true
    remainder = 0.0 if log_signs.estimated else remains / (remains + max(effect.gain, least))
    held_out_gain = log(max(consistency.held_out_gain, config.least_held_out_gain))
    shift, most_shift = log_signs.coefficient_shift, config.largest_coefficient_shift
    return {
        "held_out_gain": held_out_gain,
        "held_out_significance": _within(
            held_out.significance, *config.held_out_significance_range
        ),
        "held_out_deviation": _within(off, 0.0, config.largest_held_out_deviation),
        "held_out_constant": rough * _log_odds_of_constant_size(unseen, config),
        "times_apart": _within(times.excess, 0.0, config.largest_variation),
        "times_constant": rough * _log_odds_of_constant_size(times, config),
        "ranges_apart": _within(ranges.excess, 0.0, config.largest_variation),
        "ranges_constant": rough * _log_odds_of_constant_size(ranges, config),
        "unexplained": unexplained,
        "remainder": remainder,
        "structure": _within(structure, 0.0, config.largest_structure),
        "alternative": _within(alternative, 0.0, config.largest_alternative),
        "prior_distance": log1p(consistency.prior_distance),
        "exceeds_range": float(exceeds_range(consistency, config)),
        "stochastic_at_bound": float(stochastic and consistency.at_bound),
        "stochastic_times": stochastic * _within(times.ratio - 1.0, 0.0, config.largest_ratio),
        "stochastic_ranges": stochastic * _within(ranges.ratio - 1.0, 0.0, config.largest_ratio),
        "look_alikes": float(len(effect.tied_with)),
        "coefficient_shift": _within(shift, 0.0, most_shift),
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
    most = config.largest_log_odds
    return 1.0 / (1.0 + exp(-_within(odds, -most, most)))


def probability_beside_unknown(probability: float, config: DecideConfig) -> float:
    """Return the probability of an effect where an unknown cause is reported beside it.

    Args:
        probability: Its probability by its own signs, above 0.
        config: Settings of the decision.
    """
    return 1.0 / (1.0 + (1.0 / probability - 1.0) * exp(-config.odds_beside_unknown))


def _log_odds_of_constant_size(variation: Variation, config: DecideConfig) -> float:
    """Limited log odds that the size of an effect is as constant as that of a true one.

    The alternative is a size that varies as that of a stand-in. Where the parts of the data do not
    determine the size, the odds are even, which a small excess alone does not tell. Odds against a
    constant size are not counted: the law of a real effect never has exactly the form of a
    candidate, so that its size varies, too, and the excess counts already.
    """

    def log_likelihood(sd: float) -> float:
        spread = 1.0 + variation.precision * sd**2
        return -0.5 * (variation.chi_square / spread + variation.dof * log(spread))

    odds = log_likelihood(config.size_tolerance) - log_likelihood(config.stand_in_variation)
    return _within(odds, 0.0, config.largest_constant)


def exceeds_range(consistency: Consistency, config: DecideConfig) -> bool:
    """Whether the recordings require a larger effect than its allowed range of parameters permits.

    A parameter is then at a bound of its range, and one recording requires more than the fitted
    size.

    Args:
        consistency: Statistics of the effect over the recordings.
        config: Settings of the decision.
    """
    sizes = [factor.value for factor in consistency.recordings]
    return consistency.at_bound and max(sizes, default=inf) > 1.0 + config.size_tolerance


def _within(value: float, low: float, high: float) -> float:
    """Limit a value; not a number becomes the lower bound."""
    return max(low, min(high, value)) if value == value else low
