"""The decide stage: which identified effects are stated as causes, and how surely."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from boatsim.diagnosis.filter import MappedRecording
from boatsim.diagnosis.open_set.confirmation import (
    Errors,
    Outcome,
    confirmation_outcome,
    held_out_effect_errors,
)
from boatsim.diagnosis.open_set.consistency import Consistency, effect_consistency
from boatsim.diagnosis.open_set.log_signs import NO_SIGNS, LogSigns, unknown_cause_indicators
from boatsim.diagnosis.open_set.probability import (
    logistic_features,
    probability_beside_unknown,
    probability_of_true_cause,
)
from boatsim.diagnosis.open_set.refinement import refines_estimated_number
from boatsim.diagnosis.problem import Fit, Problem
from boatsim.diagnosis.search.evidence import required_gain, unknown_cause_threshold
from boatsim.diagnosis.search.pruning import IdentifiedEffect
from boatsim.diagnosis.search.ranking import Ranking
from boatsim.physics.base import RandomForce


@dataclass(frozen=True)
class Judgement:
    """Whether an identified effect is stated as a cause: its statistics and probability.

    Attributes:
        effect: The effect with its statistics among the candidates.
        stochastic: Whether it is a stochastic force.
        refines: Whether it only refines a number that the vessel file calls estimated.
        signs: Statistics that tell a true cause from a stand-in for another one.
        probability: Probability that it, or one of its look-alikes, is a true cause.
        alone: Errors of free runs over held-out recordings without and with it, by family.
        outcome: What held-out recordings show of it.
    """

    effect: IdentifiedEffect
    stochastic: bool
    refines: bool
    signs: Consistency
    probability: float
    alone: Mapping[str, Errors]
    outcome: Outcome


@dataclass(frozen=True)
class Decision:
    """Result of deciding which identified effects are stated as causes, and how probable they are.

    Attributes:
        problem: The problem with its correlation time.
        ranking: The selection; its `named` effects are stated as causes, with their probability,
            and its `doubtful` ones are only possible.
        judgements: Statistics and probability of all these effects.
        log: Statistics of the recordings as a whole that indicate an unmodelled cause.
        beside_unknown: Whether the probabilities are those beside an unknown cause.
    """

    problem: Problem
    ranking: Ranking
    judgements: tuple[Judgement, ...]
    log: LogSigns
    beside_unknown: bool = False

    def judgement_of_effect(self, name: str) -> Judgement:
        """Return the statistics and probability of one identified effect.

        Args:
            name: Name of the effect.
        """
        return next(one for one in self.judgements if one.effect.name == name)


def decide(
    problem: Problem, ranking: Ranking, held_out: Sequence[MappedRecording], candidates: int
) -> Decision:
    """Decide which selected effects are stated as causes, with their probabilities.

    An effect that is probably a stand-in for another cause, or that held-out recordings do not
    confirm, is not stated as a cause. It stays in the patched vessel, because it describes the
    data, and if it explains much the cause is reported as unknown. So it is if held-out recordings
    require a force that no identified effect gives. Beside an unknown cause an effect is less
    probable, because it is more often a stand-in. An effect that only refines an estimated number
    of the vessel file is not a cause, so that held-out recordings alone decide about it.

    Args:
        problem: The estimation problem: recordings, vessel model, candidate effects and priors.
        ranking: Result of the selection of effects.
        held_out: Held-out recordings, which no fit has used.
        candidates: Number of candidates that were tested.
    """
    config = problem.config
    of_log = unknown_cause_indicators(problem, ranking, held_out)
    signs = effect_consistency(problem, ranking.best, ranking.without, held_out)
    alone = held_out_effect_errors(problem, ranking.best, ranking.without, held_out)
    judgements = []
    for one in ranking.named:
        own, errors = signs[one.name], alone[one.name]
        judgements.append(_judge(problem, ranking.best, one, own, of_log, errors))
    unseen = of_log.held_out_unexplained > config.decide.held_out_share
    ranking = replace(ranking, held_out_remains=unseen and of_log.held_out_structured)
    decided = _stated(problem, ranking, judgements, candidates)
    beside_unknown = decided.has_unexplained_force_or_cause and not of_log.estimated
    if beside_unknown:
        for i, judged in enumerate(judgements):
            probability = probability_beside_unknown(judged.probability, config.decide)
            judgements[i] = replace(judged, probability=probability)
        decided = _stated(problem, ranking, judgements, candidates)
    return Decision(problem, decided, tuple(judgements), of_log, beside_unknown)


def _stated(
    problem: Problem, ranking: Ranking, judgements: Sequence[Judgement], candidates: int
) -> Ranking:
    """Divide the effects into named and possible ones, and mark unnamed ones that explain much."""
    config = problem.config
    named, doubtful = list[IdentifiedEffect](), list[IdentifiedEffect]()
    stands_in = False
    for judged in judgements:
        probability = judged.probability * judged.effect.probability
        stated = replace(judged.effect, probability=probability)
        probable = judged.probability >= config.decide.least_probability
        if (probable or judged.refines) and judged.outcome != "unconfirmed":
            named.append(stated)
            continue
        doubtful.append(stated)
        others = ranking.explained - stated.gain
        remains = unknown_cause_threshold(config.select, others)
        least = required_gain(candidates, config.select) + remains
        stands_in = stands_in or bool(stated.shared > least)
    return replace(ranking, named=tuple(named), doubtful=tuple(doubtful), stands_in=stands_in)


def decision_without_fit(problem: Problem, ranking: Ranking) -> Decision:
    """Return the decision for recordings that no model could be fitted to: no effect is identified.

    Args:
        problem: The estimation problem: recordings, vessel model, candidate effects and priors.
        ranking: Result of the selection, without identified effects.
    """
    return Decision(problem, ranking, (), NO_SIGNS)


def _judge(
    problem: Problem,
    best: Fit,
    effect: IdentifiedEffect,
    signs: Consistency,
    of_log: LogSigns,
    alone: Mapping[str, Errors],
) -> Judgement:
    """Signs, probability and confirmation of one effect."""
    config = problem.config.decide
    candidate = problem.candidates[effect.name]
    stochastic = isinstance(candidate, RandomForce)
    found = logistic_features(effect, stochastic, signs, of_log, config)
    probability = probability_of_true_cause(found, config)
    outcome = confirmation_outcome(candidate, alone, signs, config)
    refines = refines_estimated_number(problem, best, effect.name)
    return Judgement(effect, stochastic, refines, signs, probability, alone, outcome)
