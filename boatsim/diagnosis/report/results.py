"""Collects the results of a diagnosis that the report shows."""

import numpy as np

from boatsim.diagnosis.evaluation import Evaluation
from boatsim.diagnosis.experiment_design import next_experiment
from boatsim.diagnosis.filter import axes_of
from boatsim.diagnosis.loading import Loaded
from boatsim.diagnosis.locate.missing_force import FORCE_UNITS
from boatsim.diagnosis.problem import Fit, Problem
from boatsim.diagnosis.question import Question
from boatsim.diagnosis.report import before_after
from boatsim.diagnosis.report.answer import effect_meanings
from boatsim.diagnosis.report.findings import Findings, MissingForceCurve
from boatsim.diagnosis.report.schema import Answer
from boatsim.diagnosis.search.ranking import Ranking
from boatsim.physics.base import Array
from boatsim.physics.vessel import Vessel


def findings_of(
    answer: Answer,
    loaded: Loaded,
    question: Question,
    problem: Problem,
    ranking: Ranking,
    evaluation: Evaluation,
    plan: next_experiment.Plan | None,
) -> Findings:
    """Collect all results of a diagnosis that the report shows: the answer and its curves.

    Args:
        answer: Content of diagnosis.json.
        loaded: Recordings and vessels.
        question: Held-out recordings.
        problem: The estimation problem: recordings, vessel model, candidate effects and priors.
        ranking: Result of the selection of effects, with the formula, if one was found.
        evaluation: Free runs and unexplained forces.
        plan: The next experiment.
    """
    vessel = loaded.vessel
    table = before_after.error_table(evaluation)
    return Findings(
        answer,
        vessel.name,
        tuple(mapped.name for mapped in problem.recordings),
        tuple(mapped.name for mapped in question.held_out),
        loaded.note,
        _missing(vessel, evaluation),
        evaluation.free_runs,
        before_after.limitation_sentences(problem, ranking, evaluation),
        _coefficients(ranking.recalibrated),
        (table,) if table else (),
        effect_meanings(problem.program.candidates, problem.program.vessel),
        ranking.description.terms if ranking.description else (),
        next_experiment.command_steps(plan),
        (vessel.length, vessel.beam),
    )


def _missing(vessel: Vessel, evaluation: Evaluation) -> tuple[MissingForceCurve, ...]:
    """Return the missing force of each recording, by axis."""
    axes = axes_of(vessel)
    units = {axis: FORCE_UNITS[axis] for axis in axes}

    def by_axis(values: Array) -> dict[str, Array]:
        return dict(zip(axes, values.T, strict=True))

    found = []
    for force, remaining in zip(evaluation.missing, evaluation.remaining, strict=True):
        mean, sd, rest = by_axis(force.mean), by_axis(force.sd), by_axis(remaining.mean)
        found.append(MissingForceCurve(force.run, force.t, mean, sd, dict(units), rest))
    return tuple(found)


def _coefficients(recalibrated: Fit) -> dict[str, tuple[float, float]]:
    """Return the factor of each recalibrated coefficient, and its standard deviation."""
    sd = np.sqrt(np.diag(recalibrated.covariance))
    found = {}
    for f, x, s in zip(recalibrated.free, recalibrated.theta, sd, strict=True):
        found[f"{f.effect}.{f.name}"] = float(x), float(s)
    return found
