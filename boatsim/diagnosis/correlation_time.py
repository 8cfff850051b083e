"""Chooses the correlation time of the latent force by one rule, from the fitted recordings alone.

A model is judged by free runs. The correlation time decides how much of a misfit the coefficients
have to explain and how much is attributed to the latent force, which a free run omits; the
evidence of an incomplete model prefers to attribute much to it. Therefore each half of the
recordings is predicted by a fit to the other half, identified effects included. The usual value
for a hull of this length is halved, or doubled, as long as that predicts clearly better.
"""

from collections.abc import Sequence
from dataclasses import replace
from math import log, sqrt

import numpy as np

from boatsim.diagnosis.config import DEFAULT, DiagnosisConfig
from boatsim.diagnosis.filter import MappedRecording
from boatsim.diagnosis.fit import fit
from boatsim.diagnosis.free_runs import free_runs, rms_errors
from boatsim.diagnosis.problem import Fit, Problem
from boatsim.diagnosis.search.budget import SearchBudget
from boatsim.physics.base import Array

EXACT = 1e-12  # [m, rad] lower bound of an error, so that its logarithm is finite


def select_correlation_time(
    problem: Problem, found: Fit, budget: SearchBudget | None = None
) -> Problem:
    """Return an estimation problem with the latent force's correlation time that predicts best.

    The latent force is the unmodelled force that the Kalman filter estimates. Cross-validation
    decides between correlation times, for the candidate effects of a fit.

    Args:
        problem: The estimation problem: recordings, vessel model, candidate effects and priors.
        found: Converged fit of the vessel model with some candidate effects.
        budget: Work that may be done; when it is spent, no further correlation time is tried.

    Returns:
        The same object if the correlation time does not change.
    """
    seconds = cross_validated_correlation_time(problem, found, budget)
    if seconds == problem.ambient.time_constant:
        return problem
    return problem_with_correlation_time(problem, problem.recordings, seconds, problem.horizon)


def problem_with_correlation_time(
    problem: Problem, recordings: Sequence[MappedRecording], seconds: float, horizon: float
) -> Problem:
    """Return an estimation problem for other recordings and another correlation time.

    The correlation time is that of the latent (unmodelled) force. The priors are kept.

    Args:
        problem: Problem with the priors.
        recordings: Recordings of the new problem.
        seconds: Correlation time of the latent force in the new problem [s].
        horizon: Its length of free runs [s].
    """
    ambient = problem.ambient.with_other_correlation_time(seconds)
    return Problem(
        recordings,
        ambient,
        problem.uncertainty,
        horizon,
        problem.config,
    )


def cross_validated_correlation_time(
    problem: Problem, found: Fit, budget: SearchBudget | None = None
) -> float:
    """Return the correlation time [s] of the latent (unmodelled) force that predicts best.

    Half and double the usual time are tried by cross-validation, and further multiples if they
    predict clearly better.

    Args:
        problem: The estimation problem: recordings, vessel model, candidate effects and priors.
        found: A converged fit; without effects it attributes nothing to the latent force that
            coefficients could explain, and the usual value stays.
        budget: Work that may be done; when it is spent, no further correlation time is tried.
    """
    usual = problem.ambient.time_constant
    if not found.effects:
        return usual
    at_usual = cross_validation_errors(problem, found, usual)
    for factor in (0.5, 2.0):
        seconds, before = usual, at_usual
        for _ in range(problem.config.fit.correlation_time_steps):
            if budget is not None and budget.is_spent:
                break
            after = cross_validation_errors(problem, found, factor * seconds)
            if not errors_clearly_fell(after, before, problem.config):
                break
            seconds, before = factor * seconds, after
        if seconds != usual:
            return seconds
    return usual


def split_in_halves(
    recordings: Sequence[MappedRecording],
) -> tuple[list[MappedRecording], list[MappedRecording]]:
    """Split recordings into two halves for cross-validation.

    The first half holds every second recording and the second half the others. A single recording
    is cut in the middle of its duration.

    Args:
        recordings: At least one recording.
    """
    if len(recordings) > 1:
        return list(recordings[0::2]), list(recordings[1::2])
    whole = recordings[0]
    count = len(whole.times)
    return [slice_rows(whole, 0, count // 2)], [slice_rows(whole, count // 2, count)]


def slice_rows(mapped: MappedRecording, begin: int, end: int) -> MappedRecording:
    """Return a mapped recording that is cut to a range of rows.

    Args:
        mapped: The mapped recording.
        begin: First row.
        end: Row after the last one.
    """
    times = np.ascontiguousarray(mapped.times[begin:end])
    first = max(int(np.searchsorted(mapped.command_times, times[0], side="right")) - 1, 0)
    return replace(
        mapped,
        times=times,
        measured=np.ascontiguousarray(mapped.measured[begin:end]),
        commands=np.ascontiguousarray(mapped.commands[begin:end]),
        command_times=mapped.command_times[first:].copy(),
        command_values=mapped.command_values[first:].copy(),
    )


def errors_clearly_fell(after: Array, before: Array, config: DiagnosisConfig = DEFAULT) -> bool:
    """Whether the simulation errors of one model are clearly smaller than those of another.

    The errors are those of free runs (simulations with the recorded commands alone). The mean of
    the logarithms of their ratios is compared with its standard error and with a limit.

    Args:
        after: (S,) errors of the new model; nan where nothing was recorded, which is ignored.
        before: (S,) errors of the old model over the same free runs.
        config: Standard errors and ratio that are required.
    """
    ratio = np.log(after / before)
    ratio = ratio[~np.isnan(ratio)]
    if not len(ratio):
        return False
    scatter = 0.0
    if len(ratio) > 1:
        deviation = float(np.std(ratio, ddof=1))
        scatter = config.fit.correlation_time_certainty * deviation / sqrt(len(ratio))
    return bool(np.mean(ratio) < min(-log(config.validate.worse), -scatter))


def cross_validation_errors(problem: Problem, start: Fit, seconds: float) -> Array:
    """Return the errors (S,) of free runs in two-fold cross-validation with a correlation time.

    The vessel model is fitted to one half of the recordings and simulated over the other half, with
    a given correlation time of the latent force.

    Args:
        problem: The estimation problem: recordings, vessel model, candidate effects and priors.
        start: Start of the fits.
        seconds: Correlation time of the latent force [s].

    Returns:
        Geometric mean of the rms of position [m] and of heading or roll [rad]; nan where one was
        not recorded.
    """
    levels = start.levels.with_other_correlation_time(seconds)
    begin = replace(start, levels=levels, evidence=-np.inf)
    first, second = split_in_halves(problem.recordings)
    durations = [float(np.ptp(mapped.times)) for mapped in (*first, *second)]
    horizon = min(problem.horizon, *durations)
    runs = []
    for fitted, held_out in ((first, second), (second, first)):
        half = problem_with_correlation_time(problem, fitted, seconds, horizon)
        runs += free_runs(half, {"": fit(half, begin)}, held_out, horizon)
    found = []
    for run in runs:
        by_family = np.maximum([error[""] for error in rms_errors([run]).values()], EXACT)
        found.append(np.exp(np.mean(np.log(by_family))))
    return np.array(found)
