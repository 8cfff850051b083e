"""The missing force of each axis over time with its band, and the intervals where it is not zero.

The missing force is what the vessel as specified lacks to move as recorded. The smoother follows
the recording with a recalibrated vessel, because the error of a coefficient changes abruptly with
the commands and a slowly varying force cannot follow it. The change by the recalibration is then
added with its uncertainty. Forces are averages over the correlation time of the disturbance.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from boatsim.diagnosis.filter import MappedRecording, NoiseLevels, dof_in_state_order
from boatsim.diagnosis.locate.nominal_forces import coefficient_forces
from boatsim.diagnosis.locate.smoothing import (
    averaging_window_length,
    latent_force,
    running_average,
    variance_of_average,
)
from boatsim.diagnosis.noise_levels import fit_latent_force_spectrum
from boatsim.diagnosis.problem import Fit, Problem
from boatsim.physics.signals import COMPONENTS, Array

FORCE_UNITS = {axis: "N m" if name.endswith("Nm") else "N" for axis, name in COMPONENTS.items()}


@dataclass(frozen=True)
class MissingForce:
    """Force over time that a vessel model leaves unexplained in one recording, with its deviation.

    Both are running averages over the correlation time of the assumed disturbance, in body axes.
    """

    run: str
    t: Array  # (N,) s
    mean: Array  # (N, axes) [N, N m] body axes
    sd: Array  # (N, axes)


@dataclass(frozen=True)
class ForceStrength:
    """Rms of a missing force along one axis over all recordings, and of its deviation."""

    rms: float  # [N, N m]
    sd: float  # [N, N m]
    unit: str


@dataclass(frozen=True)
class Interval:
    """A time interval of a recording in which the vessel model lacks a force along one axis."""

    run: str
    from_s: float
    to_s: float
    axis: str


def missing_force(
    problem: Problem, fit: Fit, recordings: Sequence[MappedRecording]
) -> list[MissingForce]:
    """Estimate the force over time that the vessel model as specified lacks in each recording.

    The smoothed latent force of the Kalman filter is averaged, and its standard deviation includes
    the uncertainty of the coefficients.

    Args:
        problem: The estimation problem.
        fit: The recalibrated vessel: its coefficients are fitted, and no candidate acts.
        recordings: Recordings mapped to the vessel program of the problem.

    Returns:
        One missing force per recording.
    """
    levels = fit_latent_force_spectrum(problem, fit)
    return [_missing_in_nominal(problem, fit, mapped, levels) for mapped in recordings]


def residual_force(
    problem: Problem, fit: Fit, recordings: Sequence[MappedRecording]
) -> list[MissingForce]:
    """Estimate the force over time that a fitted vessel model leaves unexplained in each recording.

    The latent force has the level and correlation time of the fit.

    Args:
        problem: The estimation problem.
        fit: Fit of the vessel model with any candidate effects.
        recordings: Recordings mapped to the vessel program of the problem.

    Returns:
        One force per recording.
    """
    forces = []
    for mapped in recordings:
        averages = _averages(problem, fit, mapped, fit.levels)
        forces.append(_with_disturbance(problem, mapped, averages.mean, averages.variance))
    return forces


@dataclass(frozen=True)
class _Averages:
    """Running averages of the smoothed latent force."""

    mean: Array  # (N, axes)
    variance: Array  # (N, axes)
    states: Array  # (N, 2 NQ) smoothed states, not averaged


def _averages(
    problem: Problem, fit: Fit, mapped: MappedRecording, levels: NoiseLevels
) -> _Averages:
    force = latent_force(problem, fit, mapped, levels)
    rows = averaging_window_length(mapped.times, problem.ambient.time_constant)
    variance = variance_of_average(force.covariances, force.gains, force.part, rows)
    return _Averages(running_average(force.mean, rows), variance, force.states)


def _mean_average(
    problem: Problem, fit: Fit, theta: Array, mapped: MappedRecording, levels: NoiseLevels
) -> Array:
    """Averages (N, axes) of the smoothed latent force without their variance, which costs more."""
    nq = problem.program.module.NQ
    on = problem.program.effect_switches(fit.effects)
    means = mapped.smooth(problem.parameter_vector(mapped, fit.free, theta), on, levels).means
    rows = averaging_window_length(mapped.times, problem.ambient.time_constant)
    return running_average(means[:, 2 * nq : 3 * nq], rows)


def _missing_in_nominal(
    problem: Problem, fit: Fit, mapped: MappedRecording, levels: NoiseLevels
) -> MissingForce:
    """Add the force that the recalibration changed to the force that it leaves unexplained."""
    residual = _averages(problem, fit, mapped, levels)
    rows = averaging_window_length(mapped.times, problem.ambient.time_constant)
    parts = coefficient_forces(problem, fit, mapped, residual.states)
    mean = residual.mean.copy()
    slopes = np.zeros((len(parts), *mean.shape))
    for j, parameter in enumerate(fit.free):
        part = running_average(parts[j], rows)
        mean += (fit.theta[j] - 1.0) * part
        slopes[j] = part  # all that is known if the model diverges with either change below
        step = problem.config.locate.coefficient_step * parameter.sd
        for change in (step, -step):
            theta = fit.theta.copy()
            theta[j] += change
            changed = _mean_average(problem, fit, theta, mapped, levels)
            if np.isfinite(changed).all():
                slopes[j] += (changed - residual.mean) / change
                break
    variance = residual.variance + np.einsum("ita,ij,jta->ta", slopes, fit.covariance, slopes)
    return _with_disturbance(problem, mapped, mean, variance)


def _with_disturbance(
    problem: Problem, mapped: MappedRecording, mean: Array, variance: Array
) -> MissingForce:
    """Widen the band by the disturbance level: a force outside it exceeds the disturbance."""
    level = problem.ambient.force / problem.config.locate.band_sds
    return MissingForce(mapped.name, mapped.times, mean, np.sqrt(variance + level**2))


def significant_intervals(problem: Problem, forces: Sequence[MissingForce]) -> list[Interval]:
    """Return the time intervals in which a missing force is significant, by recording and axis.

    There zero lies outside the band of the estimated force.

    Args:
        problem: The problem; its settings and the correlation time of its disturbance are used.
        forces: Missing forces.
    """
    config = problem.config.locate
    span = problem.ambient.time_constant
    found = []
    for force in forces:
        for i, axis in enumerate(dof_in_state_order(problem.program.vessel)):
            outside = np.abs(force.mean[:, i]) > config.band_sds * force.sd[:, i]
            for begin, end in _merged_intervals(force.t, outside, config.interval_max_gap * span):
                if end - begin >= config.interval_min_duration * span:
                    found.append(Interval(force.run, begin, end, axis))
    return found


def _merged_intervals(
    t: Array, outside: NDArray[np.bool_], max_gap: float
) -> list[tuple[float, float]]:
    """Begin and end [s] of the flagged rows; intervals with gaps below `max_gap` [s] are merged."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], outside.astype(np.int8), [0]])))
    merged: list[tuple[float, float]] = []
    for begin, end in zip(t[edges[::2]].tolist(), t[edges[1::2] - 1].tolist(), strict=True):
        if merged and begin - merged[-1][1] < max_gap:
            merged[-1] = (merged[-1][0], end)
        else:
            merged.append((begin, end))
    return merged


def missing_force_rms(problem: Problem, forces: Sequence[MissingForce]) -> dict[str, ForceStrength]:
    """Return the rms over all recordings of the missing force of each axis, and of its deviation.

    Args:
        problem: The problem, for the axes of its vessel.
        forces: Missing forces.
    """
    mean = np.concatenate([f.mean for f in forces])
    sd = np.concatenate([f.sd for f in forces])
    strengths: dict[str, ForceStrength] = {}
    for i, axis in enumerate(dof_in_state_order(problem.program.vessel)):
        strengths[axis] = ForceStrength(
            rms=float(np.sqrt(np.mean(mean[:, i] ** 2))),
            sd=float(np.sqrt(np.mean(sd[:, i] ** 2))),
            unit=FORCE_UNITS[axis],
        )
    return strengths
