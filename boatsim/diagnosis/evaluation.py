"""The validate stage: free runs of the models over recordings, and unexplained forces."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from boatsim.diagnosis.filter import MappedRecording
from boatsim.diagnosis.fit import gauss_newton
from boatsim.diagnosis.free_runs import FreeRun, free_run_horizon, free_runs, rms_errors
from boatsim.diagnosis.loading import recording_order
from boatsim.diagnosis.locate.mean_force import MeanForce, mean_residual_force
from boatsim.diagnosis.locate.missing_force import MissingForce, missing_force, residual_force
from boatsim.diagnosis.model_names import ALONE, MODELS
from boatsim.diagnosis.problem import Fit, Problem
from boatsim.diagnosis.search.ranking import Ranking


@dataclass(frozen=True)
class PartErrors:
    """Rms errors of several models' free runs over one recording, for one family of signals.

    A free run is a simulation with the recorded commands alone; a family is position, heading or
    roll.
    """

    name: str  # of the recording
    fitted: bool  # else held out
    family: str
    rms: Mapping[str, float]  # by model: those of `MODELS`, and `ALONE`


@dataclass(frozen=True)
class Evaluation:
    """Result of the validation: free runs over held-out recordings, their errors, remaining forces.

    The nominal, the recalibrated and the patched vessel model are compared.
    """

    horizon: float  # [s] of the free runs
    free_runs: tuple[FreeRun, ...]  # over held-out recordings
    errors: Mapping[str, Mapping[str, float]]  # of these: family -> model -> rms
    parts: tuple[PartErrors, ...]  # of all recordings; none where the patch adds nothing
    # names of fitted recordings that the nominal model, fitted to each alone, explains as well
    uninformative: tuple[str, ...]
    missing: tuple[MissingForce, ...]  # force missing on the recalibrated vessel, by recording
    remaining: tuple[MissingForce, ...]  # force missing on the patched vessel
    mean_force: Mapping[str, MeanForce]  # mean force that stays in the patched vessel, by axis


def compared_fits(ranking: Ranking) -> dict[str, Fit]:
    """Return the fits of the nominal, recalibrated and patched vessel model, by these names.

    Args:
        ranking: Result of the selection.
    """
    fits = (ranking.nominal, ranking.recalibrated, ranking.best)
    return dict(zip(MODELS, fits, strict=True))


def compare_models(
    problem: Problem, ranking: Ranking, held_out: Sequence[MappedRecording]
) -> Evaluation:
    """Compare the nominal, the recalibrated and the patched vessel model over all recordings.

    Free runs (simulations with the recorded commands alone) give the errors, and the smoothed
    latent force gives the force that each model leaves unexplained.

    Args:
        problem: The estimation problem: recordings, vessel model, candidate effects and priors.
        ranking: Result of the selection of effects, with the formula, if one was found.
        held_out: Held-out recordings, at least one.
    """
    horizon = free_run_horizon(problem, held_out)
    everything = sort_by_input_order([*problem.recordings, *held_out])
    missing = missing_force(problem, ranking.recalibrated, everything)
    remaining = residual_force(problem, ranking.best, everything)
    fits = compared_fits(ranking)
    runs = free_runs(problem, fits, held_out, horizon)
    parts = _errors_by_part(problem, fits, everything, horizon) if ranking.adds_effects else ()
    return Evaluation(
        horizon=horizon,
        free_runs=tuple(runs),
        errors=rms_errors(runs),
        parts=parts,
        uninformative=_uninformative(parts, problem.config.validate.alone_share),
        missing=tuple(missing),
        remaining=tuple(remaining),
        mean_force=mean_residual_force(problem, ranking.best, everything),
    )


def sort_by_input_order(recordings: Sequence[MappedRecording]) -> list[MappedRecording]:
    """Return mapped recordings in the order in which the user gave them.

    The thirds of a single recording that was split are returned in order of time.

    Args:
        recordings: Fitted and held-out recordings.
    """
    names = [mapped.name for mapped in recordings]
    order = recording_order(names, [float(mapped.times[0]) for mapped in recordings])
    return [recordings[i] for i in order]


def _errors_by_part(
    problem: Problem,
    fits: Mapping[str, Fit],
    recordings: Sequence[MappedRecording],
    horizon: float,
) -> tuple[PartErrors, ...]:
    """Errors of free runs over each recording, also of the nominal model fitted to it alone."""
    config, found = problem.config.fit, list[PartErrors]()
    for mapped in recordings:
        own = Problem([mapped], problem.ambient, problem.uncertainty, config=problem.config)
        alone = gauss_newton(own, fits["recalibrated"], config.part_steps, config.step_gain)
        runs = free_runs(problem, {**fits, ALONE: alone}, [mapped], horizon)
        fitted = any(mapped is one for one in problem.recordings)
        for family, rms in rms_errors(runs).items():
            found.append(PartErrors(mapped.name, fitted, family, rms))
    return tuple(found)


def _uninformative(parts: Sequence[PartErrors], share: float) -> tuple[str, ...]:
    """Fitted recordings of which the nominal model, fitted to each alone, explains as much."""
    explained: dict[str, bool] = {}
    for part in parts:
        if part.fitted:
            least = share * min(part.rms[ALONE], part.rms["recalibrated"])
            enough = part.rms["patched"] >= least
            explained[part.name] = explained.get(part.name, True) and enough
    return tuple(name for name, enough in explained.items() if enough)
