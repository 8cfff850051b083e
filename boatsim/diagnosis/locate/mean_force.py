"""Mean of the force that a fit leaves unexplained: a constant force of the hull."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from boatsim.diagnosis.filter import MappedRecording, dof_in_state_order
from boatsim.diagnosis.locate.missing_force import FORCE_UNITS
from boatsim.diagnosis.locate.nominal_forces import full_thrust
from boatsim.diagnosis.locate.smoothing import LatentForce, latent_force, variance_of_mean
from boatsim.diagnosis.problem import Fit, Problem
from boatsim.physics.base import Array


@dataclass(frozen=True)
class MeanForce:
    """The mean force or moment along one body axis that a vessel model leaves unexplained."""

    mean: float  # [N, N m]
    sd: float  # [N, N m]
    unit: str
    share_of_full_thrust: float | None = None  # of a force, if drives push the vessel ahead


def mean_residual_force(
    problem: Problem, fit: Fit, recordings: Sequence[MappedRecording]
) -> dict[str, MeanForce]:
    """Return the constant part of the force that a fitted vessel model leaves unexplained.

    It is the mean of the smoothed latent force over all recordings.

    Args:
        problem: The problem; its settings and its assumed disturbance level are used.
        fit: Fit of the vessel model.
        recordings: Recordings mapped to the vessel program of the problem.

    Returns:
        Mean force or moment in body axes, by axis. Only axes are included on which the mean is
        significant and larger than the assumed disturbance level.
    """
    durations = np.array([float(np.ptp(mapped.times)) for mapped in recordings])
    weights = (durations / durations.sum())[:, None]
    means = []
    variances = []
    for mapped in recordings:
        force = latent_force(problem, fit, mapped, fit.levels)
        means.append(force.mean.mean(axis=0))
        variances.append(_variance(force))
    mean = (weights * np.array(means)).sum(axis=0)
    sd = np.sqrt((weights**2 * np.array(variances)).sum(axis=0))
    limit = np.maximum(problem.config.locate.mean_force_min_sds * sd, problem.ambient.force)
    thrust = full_thrust(recordings[0])
    found: dict[str, MeanForce] = {}
    for i, axis in enumerate(dof_in_state_order(problem.program.vessel)):
        if abs(mean[i]) > limit[i]:
            share = None
            if thrust > 0.0 and FORCE_UNITS[axis] == "N":
                share = float(abs(mean[i]) / thrust)
            found[axis] = MeanForce(float(mean[i]), float(sd[i]), FORCE_UNITS[axis], share)
    return found


def _variance(force: LatentForce) -> Array:
    """Variance (axes,) of the mean of a force whose expected value is zero.

    It is the sum of the variance of the smoothed mean and of the variance that a stochastic force
    has in a recording of this duration.
    """
    share = min(1.0, 2.0 * force.time_constant / float(np.ptp(force.times)))
    smoothed = variance_of_mean(force.covariances, force.gains, force.part)
    return np.asarray(smoothed + force.rms**2 * share)
