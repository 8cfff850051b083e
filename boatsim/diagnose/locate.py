"""Where the mismatch is: the missing force of each axis over time with its band, and when zero lies outside it."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from boatsim.base import Array
from boatsim.diagnose.filter import Track, axes_of
from boatsim.diagnose.levels import fit_time_constant
from boatsim.diagnose.problem import Fit, Problem

BAND = 2.0  # [sd] zero outside this band counts as missing
SHORTEST = 0.5  # [s] a shorter excursion is not worth an interval
BRIDGE = 1.5  # [s] a shorter gap does not end one
UNITS = {"surge": "N", "sway": "N", "roll": "N m", "yaw": "N m"}


@dataclass(frozen=True)
class Force:
    """Missing force of one run."""

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


def missing_force(problem: Problem, found: Fit, tracks: Sequence[Track]) -> list[Force]:
    """Smoothed latent force under a fitted hypothesis, its level and correlation time refitted for the band."""
    on = problem.program.switches(found.suspects)
    levels = fit_time_constant(problem, found)
    nq = problem.program.module.NQ
    out = []
    for track in tracks:
        means, covariances = track.smoothed(problem.values(track, found.free, found.theta), on, levels)
        variance = np.diagonal(covariances, axis1=1, axis2=2)[:, 2 * nq : 3 * nq]
        out.append(Force(track.name, track.times, means[:, 2 * nq : 3 * nq], np.sqrt(np.maximum(variance, 0.0))))
    return out


def intervals(problem: Problem, forces: Sequence[Force]) -> list[Interval]:
    """Stretches in which zero lies outside the band and the force exceeds the ambient one, per run and axis."""
    found = []
    for force in forces:
        for i, axis in enumerate(axes_of(problem.program.vessel)):
            size = np.abs(force.mean[:, i])
            outside = (size > BAND * force.sd[:, i]) & (size > problem.ambient.force[i])
            for begin, end in _stretches(force.t, outside):
                if end - begin >= SHORTEST:
                    found.append(Interval(force.run, begin, end, axis))
    return found


def _stretches(t: Array, outside: NDArray[np.bool_]) -> list[tuple[float, float]]:
    """Begin and end [s] of what is flagged, short gaps bridged."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], outside.astype(np.int8), [0]])))
    out: list[tuple[float, float]] = []
    for begin, end in zip(t[edges[::2]].tolist(), t[edges[1::2] - 1].tolist(), strict=True):
        if out and begin - out[-1][1] < BRIDGE:
            out[-1] = (out[-1][0], end)
        else:
            out.append((begin, end))
    return out


def strength(problem: Problem, forces: Sequence[Force]) -> dict[str, dict[str, float | str]]:
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
