"""The results of a diagnosis whose fits diverge: an unknown cause, with its time and axis."""

from collections.abc import Sequence

import numpy as np

from boatsim.diagnosis.divergence import (
    find_divergences,
    first_rows_are_finite,
    raise_latent_force_level,
)
from boatsim.diagnosis.evaluation import Evaluation, sort_by_input_order
from boatsim.diagnosis.filter import MappedRecording, dof_in_state_order
from boatsim.diagnosis.free_runs import FreeRun, free_run_horizon, free_runs, rms_errors
from boatsim.diagnosis.locate.missing_force import MissingForce, residual_force
from boatsim.diagnosis.locate.residual_structure import CONSTANT, Structure
from boatsim.diagnosis.model_names import MODELS
from boatsim.diagnosis.problem import Fit, Problem
from boatsim.diagnosis.search.ranking import Ranking
from boatsim.errors import BadInput
from boatsim.recordings.table import HUGE

# [nats] limit of a gain of evidence in the answer: more is no more certain
LARGEST_GAIN = 1e9


def results_without_fit(
    problem: Problem, held_out: Sequence[MappedRecording], where: str
) -> tuple[Ranking, Evaluation]:
    """Return the results of a diagnosis in which the fits of the vessel model diverge.

    No parameter is fitted and no candidate effect is ranked. The vessel model as specified follows
    the recordings with a larger latent force, which is reported as a force of unknown cause.

    Args:
        problem: The estimation problem: recordings, vessel model, candidate effects and priors.
        held_out: Held-out recordings, which no fit has used.
        where: Name of the first recording, for the message.

    Raises:
        BadInput: The model cannot be evaluated at all.
    """
    everything = sort_by_input_order([*problem.recordings, *held_out])
    if not first_rows_are_finite(problem, everything):
        raise _not_evaluated(problem, where)
    with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
        fit = raise_latent_force_level(problem, everything)
        forces = _finite_forces(residual_force(problem, fit, everything))
        if not any(len(force.t) for force in forces):
            raise BadInput(
                f"{where}: {problem.program.vessel.name} moves so fast between two rows that its "
                "missing force cannot be estimated, not even with a larger disturbance; record "
                "at a higher rate"
            )
        places = find_divergences(problem, everything, forces)
        horizon = free_run_horizon(problem, held_out)
        runs = _finite_runs(problem, fit, held_out, horizon)
        before = problem.with_recordings(everything).log_likelihood(
            fit.free, fit.theta, problem.program.effect_switches(()), problem.ambient
        )
    gain = float(np.nan_to_num(fit.evidence - before, nan=LARGEST_GAIN, posinf=LARGEST_GAIN))
    nothing = Structure(dof_in_state_order(problem.program.vessel)[0], CONSTANT, 0.0, 1.0, 0, False)
    ranking = Ranking(
        nominal=fit,
        recalibrated=fit,
        best=fit,
        named=(),
        first={},
        last={},
        left_over=min(max(gain, 0.0), LARGEST_GAIN),
        structure=nothing,
        explained=0.0,
        told_from=0.0,
        structured=False,
        without={},
        divergences=places,
    )
    some = tuple(force for force in forces if len(force.t))
    evaluation = Evaluation(
        horizon=horizon,
        free_runs=runs,
        errors=rms_errors(runs),
        parts=(),
        uninformative=(),
        missing=some,
        remaining=some,
        mean_force={},
    )
    return ranking, evaluation


def _not_evaluated(problem: Problem, where: str) -> BadInput:
    name = problem.program.vessel.name
    return BadInput(
        f"{where}: the forces of {name} are not finite in the first seconds of the recordings; "
        "a number of its vessel file or the initial motion is far out of range"
    )


def _finite_forces(forces: Sequence[MissingForce]) -> list[MissingForce]:
    """The rows of the forces that are finite."""
    found = []
    for force in forces:
        rows = (np.isfinite(force.mean) & np.isfinite(force.sd)).all(axis=1)
        rows &= (np.abs(force.mean) < HUGE**2).all(axis=1)
        found.append(MissingForce(force.run, force.t[rows], force.mean[rows], force.sd[rows]))
    return found


def _finite_runs(
    problem: Problem, fit: Fit, held_out: Sequence[MappedRecording], horizon: float
) -> tuple[FreeRun, ...]:
    """Free runs of the vessel as written that stay finite, under the names of all models."""
    found = []
    for run in free_runs(problem, dict.fromkeys(MODELS, fit), held_out, horizon):
        channels = np.concatenate(list(run.channels[MODELS[0]].values()))
        if (np.abs(channels) < HUGE).all():
            found.append(run)
    return tuple(found)
