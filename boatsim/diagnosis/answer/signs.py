"""Signs of stand-ins in diagnosis.json, and the reason why an effect is only possible."""

from math import hypot

from boatsim.diagnosis.answer.schema import (
    ConsistencyEntry,
    EffectSignsEntry,
    FactorEntry,
    SignsEntry,
    VariationEntry,
)
from boatsim.diagnosis.candidates import name_without_prefixes
from boatsim.diagnosis.open_set.consistency import Consistency, Factor, Variation
from boatsim.diagnosis.open_set.decision import Decision, Judgement
from boatsim.diagnosis.open_set.probability import exceeds_range, probability_beside_unknown


def cause_statistics_entry(decision: Decision) -> SignsEntry:
    """Return the statistics behind the probability of each identified effect, for diagnosis.json.

    They tell a true cause from a stand-in that only imitates an unmodelled cause.

    Args:
        decision: Decision on the identified effects, with their statistics.
    """
    effects: list[EffectSignsEntry] = []
    for one in decision.judgements:
        effects.append(
            {
                "name": name_without_prefixes(one.effect.name),
                "gain_nats": round(one.effect.gain, 2),
                "stochastic": one.stochastic,
                "refines": one.refines,
                "tied_with": list(map(name_without_prefixes, one.effect.tied_with)),
                "probability": round(one.probability, 4),
                "signs": _consistency(one.signs),
            }
        )
    log = decision.log
    return {
        "effects": effects,
        "log": {
            "coefficient_shift": round(log.coefficient_shift, 4),
            "force_ratio": round(log.force_ratio, 4),
            "unexplained": round(log.unexplained, 4),
            "structure_gain": round(log.structure_gain, 3),
            "effects_gain": round(log.effects_gain, 2),
            "effects": log.effects,
            "held_out_unexplained": round(log.held_out_unexplained, 4),
            "held_out_structure": round(log.held_out_structure, 3),
            "held_out_structured": log.held_out_structured,
            "unexplained_gain": round(log.unexplained_gain, 3),
            "structured": log.structured,
            "estimated": log.estimated,
        },
    }


def reason_for_doubt(judged: Judgement, decision: Decision) -> str:
    """Return the clearest reason, in words, to doubt that an effect is a true cause.

    The effect may be a stand-in that only imitates another, unmodelled cause.

    Args:
        judged: Statistics of the effect over the recordings.
        decision: Decision on all identified effects.
    """
    signs, config = judged.signs, decision.problem.config.decide
    held_out = signs.held_out
    tolerated = hypot(held_out.sd, config.size_tolerance)
    if abs(held_out.value - 1.0) > config.clear_deviation * tolerated:
        return (
            f"in held-out recordings it has {held_out.value:.2f} ± {held_out.sd:.2f} times the "
            "fitted size"
        )
    if signs.between_ranges.excess > config.clear_excess:
        return (
            f"its size is not the same at all values of {signs.quantity}: it varies by "
            f"{100.0 * signs.between_ranges.excess:.0f} %"
        )
    if signs.between_times.excess > config.clear_excess:
        return (
            "its size is not the same at all times: it varies by "
            f"{100.0 * signs.between_times.excess:.0f} %"
        )
    if judged.stochastic and signs.at_bound:
        return "its spectrum is at the end of the range that waves have"
    if decision.log.unexplained > config.clear_rest:
        return "much of the missing force remains even with this effect in the model"
    if exceeds_range(signs, config):
        return "its fitted size is at the end of the range of plausible values"
    least = probability_beside_unknown(config.least_probability, config)
    if decision.beside_unknown and judged.probability >= least:
        return "an unknown cause remains, and beside one such an effect is often a stand-in"
    return "several weak signs together make it more likely that it stands in for another cause"


def _consistency(signs: Consistency) -> ConsistencyEntry:
    """Signs of one effect."""
    return {
        "recordings": [_factor(one) for one in signs.recordings],
        "held_out": _factor(signs.held_out),
        "between_times": _variation(signs.between_times),
        "between_ranges": _variation(signs.between_ranges),
        "quantity": signs.quantity,
        "parts_that_gain": round(signs.parts_that_gain, 4),
        "held_out_gain": round(signs.held_out_gain, 3),
        "axes": list(signs.axes),
        "alternative_gain": round(signs.alternative_gain, 3),
        "prior_distance": round(signs.prior_distance, 4),
        "at_bound": signs.at_bound,
    }


def _factor(factor: Factor) -> FactorEntry:
    return {"value": round(factor.value, 4), "sd": round(factor.sd, 4)}


def _variation(variation: Variation) -> VariationEntry:
    return {
        "excess": round(variation.excess, 4),
        "chi_square": round(variation.chi_square, 3),
        "dof": variation.dof,
        "precision": round(variation.precision, 3),
    }
