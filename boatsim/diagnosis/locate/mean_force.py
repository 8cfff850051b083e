"""A mean force that stays in a fitted vessel: one that pushes the same way all along, which no unsteady water does."""

from collections.abc import Sequence

import numpy as np

from boatsim.diagnosis.filter import MappedRecording, axes_of
from boatsim.diagnosis.locate.missing_force import UNITS
from boatsim.diagnosis.locate.nominal_forces import full_thrust
from boatsim.diagnosis.locate.smoothing import variance_of_mean
from boatsim.diagnosis.problem import Fit, Problem
from boatsim.diagnosis.report.schema import MeanEntry
from boatsim.physics.base import Array

CLEAR = 3.0  # [sd] that a mean is away from zero


def mean_left(
    problem: Problem, found: Fit, tracks: Sequence[MappedRecording]
) -> dict[str, MeanEntry]:
    """Mean of the force that a fit leaves over all recordings, in axes of the hull, by axis.

    Only where it is clearly not zero and more than the vessel tolerates of an unsteady force.
    """
    seconds = np.array([float(np.ptp(t.times)) for t in tracks])
    weights = (seconds / seconds.sum())[:, None]
    each = [_mean(problem, found, t) for t in tracks]
    mean = (weights * np.array([m for m, _ in each])).sum(axis=0)
    sd = np.sqrt((weights**2 * np.array([v for _, v in each])).sum(axis=0))
    thrust, tolerated = full_thrust(tracks[0]), problem.ambient.force
    out: dict[str, MeanEntry] = {}
    for i, axis in enumerate(axes_of(problem.program.vessel)):
        if abs(mean[i]) > max(CLEAR * sd[i], tolerated[i]):
            out[axis] = {"mean": float(mean[i]), "sd": float(sd[i]), "unit": UNITS[axis]}
            if thrust > 0.0 and UNITS[axis] == "N":
                out[axis]["share_of_full_thrust"] = float(f"{abs(mean[i]) / thrust:.3g}")
    return out


def _mean(problem: Problem, found: Fit, track: MappedRecording) -> tuple[Array, Array]:
    """Mean (axes,) of the smoothed force over a recording, and the variance that one has which is zero on average.

    Beside what the noise leaves open, so short a stretch of an unsteady force has a mean of its own by chance.
    """
    on, nq, levels = (
        problem.program.switches(found.effects),
        problem.program.module.NQ,
        found.levels,
    )
    values, latent = problem.values(track, found.free, found.theta), slice(2 * nq, 3 * nq)
    states, covariances, gains = track.smooth(values, on, levels)
    by_chance = min(1.0, 2.0 * levels.time_constant / float(np.ptp(track.times)))
    rms, _ = track.latent_force_rms(values, on, levels)
    return states[:, latent].mean(axis=0), variance_of_mean(
        covariances, gains, latent
    ) + rms**2 * by_chance
