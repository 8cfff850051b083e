"""Where the mismatch is: the missing force of each axis over time with its band, and when zero lies outside it.

The missing force is what the vessel as written would need besides its own forces to move as it was recorded. The
smoother follows the recording with a recalibrated vessel (or any other fit of the vessel's own coefficients), because
what a coefficient error leaves out jumps with the commands and a slowly varying force can not; what the recalibration
changed is then added back, with its uncertainty. Forces are averages over the correlation time of the ambient force.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from boatsim.diagnosis.filter import MappedRecording, NoiseLevels, axes_of
from boatsim.diagnosis.locate.nominal_forces import coefficient_forces
from boatsim.diagnosis.locate.smoothing import averaged_rows, running_average, variance_of_average
from boatsim.diagnosis.noise_levels import fit_time_constant
from boatsim.diagnosis.problem import Fit, Problem
from boatsim.diagnosis.report.schema import StrengthEntry
from boatsim.physics.signals import COMPONENTS, Array

BAND = 2.0  # [sd] zero outside this band counts as missing
SHORTEST = 0.5  # [averages] a shorter excursion is not worth an interval
BRIDGE = 1.0  # [averages] a shorter gap does not end one
STEP = 0.1  # [sd] of a coefficient, for derivatives by it
UNITS = {axis: "N m" if component.endswith("Nm") else "N" for axis, component in COMPONENTS.items()}


@dataclass(frozen=True)
class Force:
    """Missing force of one run: running averages over the time constant of the ambient force."""

    run: str
    t: Array  # (N,) s
    mean: Array  # (N, axes) [N, N m] body axes
    sd: Array  # (N, axes)


@dataclass(frozen=True)
class Interval:
    """A stretch of time in which a force is missing."""

    run: str
    from_s: float
    to_s: float
    axis: str


def missing_force(problem: Problem, found: Fit, tracks: Sequence[MappedRecording]) -> list[Force]:
    """Force missing on the vessel as written. `found` fits its coefficients and names no suspects."""
    levels = fit_time_constant(problem, found)
    return [_on_the_nominal(problem, found, track, levels) for track in tracks]


def force_left(problem: Problem, found: Fit, tracks: Sequence[MappedRecording]) -> list[Force]:
    """Force that a fitted hypothesis, whatever its suspects, itself leaves over at its own force levels."""
    out = []
    for track in tracks:
        mean, variance, _ = _latent(problem, found, found.theta, track, found.levels)
        out.append(_with_ambient(problem, track, mean, variance))
    return out


def _latent(
    problem: Problem, found: Fit, theta: Array, track: MappedRecording, levels: NoiseLevels
) -> tuple[Array, Array, Array]:
    """Averages of the smoothed latent force (N, axes), their variance, and the smoothed states (N, 2 NQ)."""
    on, nq = problem.program.switches(found.effects), problem.program.module.NQ
    states, covariances, gains = track.smooth(problem.values(track, found.free, theta), on, levels)
    latent = slice(2 * nq, 3 * nq)
    rows = averaged_rows(track.times, problem.ambient.time_constant)
    variance = variance_of_average(covariances, gains, latent, rows)
    return running_average(states[:, latent], rows), variance, states[:, : 2 * nq]


def _average(
    problem: Problem, found: Fit, theta: Array, track: MappedRecording, levels: NoiseLevels
) -> Array:
    """Averages of the smoothed latent force (N, axes) alone: their variance costs far more."""
    on, nq = problem.program.switches(found.effects), problem.program.module.NQ
    states = track.smooth(problem.values(track, found.free, theta), on, levels).means
    return running_average(
        states[:, 2 * nq : 3 * nq], averaged_rows(track.times, problem.ambient.time_constant)
    )


def _on_the_nominal(
    problem: Problem, found: Fit, track: MappedRecording, levels: NoiseLevels
) -> Force:
    """What a recalibrated vessel leaves over and what the recalibration changed."""
    left, variance, states = _latent(problem, found, found.theta, track, levels)
    rows = averaged_rows(track.times, problem.ambient.time_constant)
    parts = [running_average(p, rows) for p in coefficient_forces(problem, found, track, states)]
    mean, slopes = left.copy(), np.zeros((len(parts), *left.shape))
    for j, (free, part) in enumerate(zip(found.free, parts, strict=True)):
        mean += (found.theta[j] - 1.0) * part
        moved = found.theta.copy()
        moved[j] += STEP * free.sd
        slopes[j] = part + (_average(problem, found, moved, track, levels) - left) / (
            STEP * free.sd
        )
    variance = variance + np.einsum("ita,ij,jta->ta", slopes, found.covariance, slopes)
    return _with_ambient(problem, track, mean, variance)


def _with_ambient(problem: Problem, track: MappedRecording, mean: Array, variance: Array) -> Force:
    """What is tolerated is not missing: where zero lies outside the band, the force exceeds the ambient one."""
    return Force(
        track.name, track.times, mean, np.sqrt(variance + (problem.ambient.force / BAND) ** 2)
    )


def intervals(problem: Problem, forces: Sequence[Force]) -> list[Interval]:
    """Stretches in which zero lies outside the band, per run and axis."""
    found, span = [], problem.ambient.time_constant
    for force in forces:
        for i, axis in enumerate(axes_of(problem.program.vessel)):
            outside = np.abs(force.mean[:, i]) > BAND * force.sd[:, i]
            for begin, end in _stretches(force.t, outside, BRIDGE * span):
                if end - begin >= SHORTEST * span:
                    found.append(Interval(force.run, begin, end, axis))
    return found


def _stretches(t: Array, outside: NDArray[np.bool_], bridge: float) -> list[tuple[float, float]]:
    """Begin and end [s] of what is flagged, gaps shorter than `bridge` [s] closed."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], outside.astype(np.int8), [0]])))
    out: list[tuple[float, float]] = []
    for begin, end in zip(t[edges[::2]].tolist(), t[edges[1::2] - 1].tolist(), strict=True):
        if out and begin - out[-1][1] < bridge:
            out[-1] = (out[-1][0], end)
        else:
            out.append((begin, end))
    return out


def strength(problem: Problem, forces: Sequence[Force]) -> dict[str, StrengthEntry]:
    """Rms of the missing force per axis over all runs, with the rms of its standard deviation."""
    mean = np.concatenate([f.mean for f in forces])
    sd = np.concatenate([f.sd for f in forces])
    return {
        axis: {
            "rms": float(np.sqrt(np.mean(mean[:, i] ** 2))),
            "sd": float(np.sqrt(np.mean(sd[:, i] ** 2))),
            "unit": UNITS[axis],
        }
        for i, axis in enumerate(axes_of(problem.program.vessel))
    }
