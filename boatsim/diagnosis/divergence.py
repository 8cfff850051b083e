"""Recordings that the nominal model cannot follow: from which time on, and along which axis.

An unknown cause of enormous effect leaves prediction errors of thousands of standard deviations. A
fit of parameters then diverges. A latent force that is large enough follows the recording.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from boatsim.diagnosis.filter import FilterPass, MappedRecording, dof_in_state_order
from boatsim.diagnosis.locate.missing_force import FORCE_UNITS, MissingForce
from boatsim.diagnosis.problem import FilterPasses, Fit, Problem
from boatsim.physics.base import Array
from boatsim.physics.kernel.correction import GATE

OUTLIER = 0.99 * GATE  # [sd] least error of a row that an outlier may have


@dataclass(frozen=True)
class Divergence:
    """The time and axis at which the nominal vessel model stops following a recording.

    Attributes:
        run: Name of the recording.
        from_s: Time from which the prediction errors stay far outside [s].
        axis: Axis of the largest missing force there, in its standard deviations.
        rms: Missing force of that axis from then on [N, N m].
        unit: Unit of `rms`.
    """

    run: str
    from_s: float
    axis: str
    rms: float
    unit: str


def cannot_follow_recordings(problem: Problem, fit: Fit) -> bool:
    """Return whether a fitted vessel model cannot follow the recordings it was fitted to.

    Also true if its evidence or covariance is not finite.

    Args:
        problem: The estimation problem: recordings, vessel model, candidate effects and priors.
        fit: Fit of the vessel model.
    """
    if not (np.isfinite(fit.evidence) and np.isfinite(fit.covariance).all()):
        return True
    return not _follows(problem, _passes(problem, fit))


def raise_latent_force_level(problem: Problem, recordings: Sequence[MappedRecording]) -> Fit:
    """Return the nominal vessel model with a latent force large enough to follow recordings.

    No parameter is fitted. The level of the latent (unmodelled) force is raised step by step, each
    time on the axis where it gains most likelihood.

    Args:
        problem: The estimation problem, with its priors and settings.
        recordings: Recordings mapped to the vessel program of the problem.
    """
    everything = problem.with_recordings(recordings)
    fit = problem.nominal_hypothesis()
    passes = _passes(everything, fit)
    for _ in range(problem.config.fit.lost_raises * len(fit.levels.force)):
        if _follows(problem, passes):
            break
        tried = []
        for raised in _raised(problem, fit):
            tried.append((_finite_or_lowest(_passes(everything, raised)), raised))
        fit = max(tried, key=lambda one: one[0])[1]
        passes = _passes(everything, fit)
    return replace(fit, evidence=passes.log_likelihood)


def find_divergences(
    problem: Problem, recordings: Sequence[MappedRecording], forces: Sequence[MissingForce]
) -> tuple[Divergence, ...]:
    """Return the time and axis at which the nominal vessel model stops following each recording.

    The latent force of the filter has the assumed disturbance level. If all recordings are
    followed, the one with the largest errors is returned.

    Args:
        problem: The estimation problem, with its priors and settings.
        recordings: Recordings mapped to the vessel program of the problem.
        forces: Missing force of each recording.
    """
    passes = _passes(problem.with_recordings(recordings), problem.nominal_hypothesis()).passes
    config = problem.config.fit
    lasting = []
    for mapped, passed in zip(recordings, passes, strict=True):
        lasting.append(_lasting_errors(problem, mapped, passed))
    largest = max(float(errors.max()) for errors in lasting)
    if largest == 0.0:  # no outliers: the fit diverges for another reason
        lasting = []
        for mapped, passed in zip(recordings, passes, strict=True):
            lasting.append(_by_row(mapped, passed).max(axis=1))
        largest = max(float(errors.max()) for errors in lasting)
    limit = min(config.lost_sds, config.lost_largest_share * largest)
    found = []
    for mapped, passed, errors, force in zip(recordings, passes, lasting, forces, strict=True):
        outside = np.flatnonzero(errors > limit)
        if len(outside):
            found.append(_divergence(problem, mapped, passed, force, int(outside[0])))
    return tuple(found)


def first_rows_are_finite(problem: Problem, recordings: Sequence[MappedRecording]) -> bool:
    """Return whether the nominal vessel model has finite forces in the first seconds of recordings.

    Args:
        problem: The estimation problem, with its priors and settings.
        recordings: Recordings mapped to the vessel program of the problem.
    """
    passes = _passes(problem.with_recordings(recordings), problem.nominal_hypothesis()).passes
    for mapped, passed in zip(recordings, passes, strict=True):
        last = int(np.searchsorted(mapped.times, mapped.times[0] + _window(problem), side="right"))
        if np.isfinite(_by_row(mapped, passed)[:last]).all():
            return True
    return False


def _passes(problem: Problem, fit: Fit) -> FilterPasses:
    on = problem.program.effect_switches(fit.effects)
    with np.errstate(over="ignore", invalid="ignore"):
        return problem.filter(fit.free, fit.theta, on, fit.levels)


def _follows(problem: Problem, passes: FilterPasses) -> bool:
    """Whether the whitened errors of each recording have an rms of ordinary size."""
    if not np.isfinite(passes.log_likelihood):
        return False
    with np.errstate(over="ignore", invalid="ignore"):
        for one in passes.passes:
            count = max(1, int(np.count_nonzero(one.scale)))
            rms = float(np.sqrt(np.sum(one.whitened**2) / count))
            if not rms < problem.config.fit.lost_rms:
                return False
    return True


def _finite_or_lowest(passes: FilterPasses) -> float:
    likelihood = passes.log_likelihood
    return float(likelihood) if np.isfinite(likelihood) else -np.inf


def _raised(problem: Problem, fit: Fit) -> list[Fit]:
    """The fit with the latent force of all axes raised, and with that of each axis."""
    factor = problem.config.fit.lost_raise
    count = len(fit.levels.force)
    raised = []
    for factors in (*(1.0 + (factor - 1.0) * np.eye(count)), np.full(count, factor)):
        force = fit.levels.force * factors
        initial = fit.levels.initial_force * factors
        raised.append(replace(fit, levels=replace(fit.levels, force=force, initial_force=initial)))
    return raised[::-1]


def _window(problem: Problem) -> float:
    """Time [s] over which errors must stay outside."""
    return problem.config.fit.lost_window * problem.ambient.time_constant


def _by_row(mapped: MappedRecording, passed: FilterPass) -> Array:
    """(N, C) sizes of the whitened errors."""
    errors = passed.whitened.reshape(len(mapped.times), -1)
    return np.asarray(np.abs(errors), dtype=float)


def _lasting_errors(problem: Problem, mapped: MappedRecording, passed: FilterPass) -> Array:
    """(N,) rms of the largest errors over a window from each outlier on, 0 at other rows.

    The filter ignores a few outliers before it follows them, so that not every error is large.
    """
    errors = np.nan_to_num(_by_row(mapped, passed), nan=np.inf).max(axis=1)
    recorded = np.asarray(np.isfinite(mapped.measured).any(axis=1))
    ends = np.searchsorted(mapped.times, mapped.times + _window(problem), side="right")
    lasting = np.zeros(len(errors))
    for i in np.flatnonzero(recorded & (errors > OUTLIER)).tolist():
        part = errors[i : ends[i]][recorded[i : ends[i]]]
        lasting[i] = float(np.sqrt(np.mean(part**2)))
    return lasting


def _divergence(
    problem: Problem, mapped: MappedRecording, passed: FilterPass, force: MissingForce, row: int
) -> Divergence:
    """The axis and the size of the missing force from a row on."""
    axes = dof_in_state_order(problem.program.vessel)
    since = float(mapped.times[row])
    window = _window(problem)
    before = problem.config.fit.lost_lead * window
    near = (force.t > since - before) & (force.t < since + window)
    if near.any():
        i = int(np.argmax(np.mean((force.mean[near] / force.sd[near]) ** 2, axis=0)))
    else:
        channel = int(np.argmax(np.nan_to_num(_by_row(mapped, passed)[row], nan=np.inf)))
        i = int(mapped.codes[channel]) % len(axes)
    later = force.mean[force.t >= since, i]
    rms = float(np.sqrt(np.mean(later**2))) if len(later) else 0.0
    return Divergence(mapped.name, since, axes[i], rms, FORCE_UNITS[axes[i]])
