"""Collects the results of a diagnosis that the report shows."""

from os.path import commonprefix

import numpy as np

from boatsim.diagnosis.answer import before_after
from boatsim.diagnosis.answer.effect_entries import effect_meanings
from boatsim.diagnosis.answer.findings import Findings, MissingForceCurve
from boatsim.diagnosis.answer.schema import Answer
from boatsim.diagnosis.answer.stages import Stages
from boatsim.diagnosis.candidates import FURTHER, REORDERED, name_without_prefixes
from boatsim.diagnosis.evaluation import Evaluation
from boatsim.diagnosis.experiment_design.next_experiment import command_steps
from boatsim.diagnosis.filter import dof_in_state_order
from boatsim.diagnosis.loading import LoadedRecordings
from boatsim.diagnosis.locate.missing_force import FORCE_UNITS
from boatsim.diagnosis.problem import Fit
from boatsim.diagnosis.question import Question
from boatsim.diagnosis.search.ranking import Ranking
from boatsim.physics.base import Array
from boatsim.physics.vessel import Vessel


def collect_findings(
    answer: Answer,
    loaded: LoadedRecordings,
    question: Question,
    stages: Stages,
) -> Findings:
    """Collect all results of a diagnosis that the report shows: the answer and its curves.

    Args:
        answer: Content of diagnosis.json.
        loaded: Recordings and vessels.
        question: Held-out recordings.
        stages: Results of the stages.
    """
    vessel, problem = loaded.vessel, stages.decision.problem
    ranking, evaluation = stages.ranking, stages.evaluation
    table = before_after.error_table(evaluation)
    return Findings(
        answer=answer,
        vessel=vessel.name,
        runs=tuple(mapped.name for mapped in problem.recordings),
        held_out=tuple(mapped.name for mapped in question.held_out),
        held_out_note=loaded.note,
        missing=_missing(vessel, evaluation),
        free_runs=evaluation.free_runs,
        remarks=before_after.limitation_sentences(problem, ranking, evaluation),
        coefficients=_coefficients(ranking.recalibrated),
        extra_tables=(table,) if table else (),
        words=effect_meanings(problem.candidates.values(), problem.program.vessel),
        described=ranking.description.terms if ranking.description else (),
        steps=command_steps(stages.plan),
        size=(vessel.length, vessel.beam),
        names=_names(loaded),
        corrected_coefficients=_coefficients(ranking.best),
        further_gains=_further_gains(ranking),
        own_effects=_own_effects(ranking),
    )


def _own_effects(ranking: Ranking) -> frozenset[str]:
    """Return the names of the candidates of which the vessel has an effect already."""
    own = set[str]()
    for name in ranking.last:
        if name.removeprefix(REORDERED).startswith(FURTHER):
            own.add(name_without_prefixes(name))
    return frozenset(own)


def _further_gains(ranking: Ranking) -> dict[str, float]:
    """Return the evidence [nats] that each candidate gains on top of the best set, by its name."""
    gains: dict[str, float] = {}
    for name, fitted in ranking.last.items():
        gain = float(fitted.evidence - ranking.best.evidence)
        gains[name_without_prefixes(name)] = max(
            gain, gains.get(name_without_prefixes(name), -np.inf)
        )
    return gains


def _names(loaded: LoadedRecordings) -> dict[str, str]:
    """Return the names of the recordings by the paths of their files."""
    names: dict[str, str] = {}
    for recording in (*loaded.fitted, *loaded.held_out):
        if recording.path is not None:
            path = str(recording.path)
            names[path] = commonprefix([names.get(path, recording.name), recording.name])
    return {path: name.rstrip(" (") for path, name in names.items()}  # parts: "run (first third)"


def _missing(vessel: Vessel, evaluation: Evaluation) -> tuple[MissingForceCurve, ...]:
    """Return the missing force of each recording, by axis."""
    axes = dof_in_state_order(vessel)
    units = {axis: FORCE_UNITS[axis] for axis in axes}

    def arrays_by_axis(values: Array) -> dict[str, Array]:
        return dict(zip(axes, values.T, strict=True))

    found = []
    for force, remaining in zip(evaluation.missing, evaluation.remaining, strict=True):
        mean, sd, rest = (
            arrays_by_axis(force.mean),
            arrays_by_axis(force.sd),
            arrays_by_axis(remaining.mean),
        )
        found.append(MissingForceCurve(force.run, force.t, mean, sd, dict(units), rest))
    return tuple(found)


def _coefficients(fitted: Fit) -> dict[str, tuple[float, float]]:
    """Return the factor of each coefficient of a fit, and its standard deviation."""
    sd = np.sqrt(np.maximum(np.diag(fitted.covariance), 0.0))
    found = {}
    for f, x, s in zip(fitted.free, fitted.theta, sd, strict=True):
        if f.relative:
            found[f"{f.effect}.{f.name}"] = float(x), float(s)
    return found
