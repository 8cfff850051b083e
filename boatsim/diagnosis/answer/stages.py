"""Results of the stages of a diagnosis, from which its answer is composed."""

from dataclasses import dataclass

from boatsim.diagnosis.evaluation import Evaluation
from boatsim.diagnosis.experiment_design.next_experiment import Plan
from boatsim.diagnosis.locate.location import Location
from boatsim.diagnosis.open_set.decision import Decision
from boatsim.diagnosis.search.ranking import Ranking


@dataclass(frozen=True)
class Stages:
    """Results of the stages of a diagnosis, from which its answer is composed.

    Attributes:
        decision: Probabilities of the identified effects, and the problem with its correlation
            time.
        ranking: The decided selection of effects, with the formula, if one was found.
        evaluation: Free runs over held-out recordings, and unexplained forces.
        location: Axes, times and conditions of the missing force.
        plan: The next experiment; None if no manoeuvre would add evidence.
    """

    decision: Decision
    ranking: Ranking
    evaluation: Evaluation
    location: Location
    plan: Plan | None = None
