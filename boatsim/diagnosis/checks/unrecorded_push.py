"""Check for short external forces that no channel records, such as a hand that pushes a rig.

Where the forces on a body are measured, the rest is friction and small errors. A force far beyond
these for a short time is a push that was not recorded. It would be fitted as noise everywhere, so
the rows of the push are cut out, and the recording becomes several.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from boatsim.diagnosis.checks.cut_recordings import (
    TEXT_DIGITS,
    format_interval,
    parts_outside_intervals,
)
from boatsim.diagnosis.checks.finding import Finding
from boatsim.diagnosis.config import ChecksConfig
from boatsim.diagnosis.filter import MappedRecording, dof_in_state_order
from boatsim.diagnosis.loading import LoadedRecordings
from boatsim.diagnosis.locate.missing_force import FORCE_UNITS
from boatsim.diagnosis.problem import Fit, Problem
from boatsim.physics.base import Array
from boatsim.physics.vessel import Vessel
from boatsim.recordings.table import Recording

NORMAL_MEDIAN = 0.6745  # median of the size of a standard normal variable


@dataclass(frozen=True)
class Push:
    """A short external force that was not recorded.

    Attributes:
        begin: Time of the first row of the recording in which it acts [s].
        end: Time of the last one [s].
        axis: Degree of freedom along which it is largest, relative to its uncertainty.
        force: Its largest size along this axis [N], about an axis [N m].
    """

    begin: float
    end: float
    axis: str
    force: float


def has_measured_input(vessel: Vessel) -> bool:
    """Return whether a measured force or moment drives the vessel."""
    return any(type(effect).measures_input for effect in vessel.effects)


def find_pushes(
    problem: Problem, fit: Fit, recordings: Sequence[MappedRecording], config: ChecksConfig
) -> list[list[Push]]:
    """Return the pushes in each recording, by the force that the fitted vessel leaves unexplained.

    Args:
        problem: Problem whose recordings define the usual size of the unexplained force.
        fit: Fit of the vessel.
        recordings: Recordings in which pushes are searched.
        config: Thresholds of the check.
    """
    axes = dof_in_state_order(problem.program.vessel)
    usual = np.vstack([np.abs(_latent_force(problem, fit, one)) for one in problem.recordings])
    scale = np.maximum(np.median(usual, axis=0) / NORMAL_MEDIAN, problem.ambient.force)
    found = []
    for mapped in recordings:
        excess = np.abs(_latent_force(problem, fit, mapped)) / scale
        pushes = []
        for rows in _intervals(excess.max(axis=1), mapped.times, config):
            axis = int(np.argmax(excess[rows].max(axis=0)))
            force = float(excess[rows, axis].max() * scale[axis])
            t = mapped.times[rows]
            pushes.append(Push(float(t[0]), float(t[-1]), axes[axis], force))
        found.append(pushes)
    return found


def _latent_force(problem: Problem, fit: Fit, mapped: MappedRecording) -> Array:
    """Smoothed force (N, NQ) that a fitted vessel leaves unexplained."""
    nq = problem.program.module.NQ
    values = problem.parameter_vector(mapped, fit.free, fit.theta)
    on = problem.program.effect_switches(fit.effects)
    return mapped.smooth(values, on, fit.levels).means[:, 2 * nq : 3 * nq]


def _intervals(excess: Array, t: Array, config: ChecksConfig) -> list[NDArray[np.intp]]:
    """Rows of each push: where the excess (N,) passes the threshold, until it falls to the edge."""
    outside = np.append(np.append(False, excess > config.push_edge), False)
    starts = np.flatnonzero(outside[1:] & ~outside[:-1])
    ends = np.flatnonzero(outside[:-1] & ~outside[1:])
    found = []
    for a, b in zip(starts, ends, strict=True):
        if excess[a:b].max() > config.push_threshold:
            begin = max(int(a) - config.push_margin_rows, 0)
            end = min(int(b) + config.push_margin_rows, len(t))
            found.append(np.arange(begin, end, dtype=np.intp))
    rows = sum(len(one) for one in found)
    if rows > config.push_longest_share * len(t):
        return []
    return found


def cut_pushes(
    loaded: LoadedRecordings, fitted: Sequence[Sequence[Push]], held_out: Sequence[Sequence[Push]]
) -> LoadedRecordings:
    """Return the recordings without the rows of their pushes, and a finding for each recording.

    Args:
        loaded: The recordings.
        fitted: Pushes of each fitted recording.
        held_out: Pushes of each held-out recording.
    """
    findings = list(loaded.findings)
    parts: list[list[Recording]] = [[], []]
    for side, (recordings, pushes) in enumerate(
        ((loaded.fitted, fitted), (loaded.held_out, held_out))
    ):
        for recording, own in zip(recordings, pushes, strict=True):
            pieces = parts_outside_intervals(recording, [(push.begin, push.end) for push in own])
            parts[side] += pieces or [recording]
            if own and pieces:
                findings.append(push_finding(recording, own))
    return replace(loaded, fitted=parts[0], held_out=parts[1], findings=findings)


def push_finding(recording: Recording, pushes: Sequence[Push]) -> Finding:
    """Return the finding that states the pushes of a recording."""
    texts = []
    for push in pushes:
        unit = FORCE_UNITS[push.axis]
        span = format_interval(push.begin, push.end, TEXT_DIGITS)
        texts.append(f"{span} ({push.force:.2g} {unit} in {push.axis})")
    return Finding(
        "unrecorded_push",
        "a force that no channel records acts from " + ", ".join(texts) + "; the diagnosis leaves "
        "these rows out",
        kind="mended",
        spans=tuple((push.begin, push.end) for push in pushes),
        words="a push that was not recorded",
        run=recording.origin,
    )


def recordings_without_pushes(
    loaded: LoadedRecordings,
    problem: Problem,
    held_out: Sequence[MappedRecording],
    fit: Fit,
) -> LoadedRecordings | None:
    """Return recordings without pushes, or None if there are none or no force was measured.

    Args:
        loaded: The recordings.
        problem: The same recordings, mapped.
        held_out: The held-out recordings, mapped.
        fit: Fit of the vessel.
    """
    if not has_measured_input(loaded.vessel):
        return None
    config = problem.config.checks
    fitted = find_pushes(problem, fit, problem.recordings, config)
    tested = find_pushes(problem, fit, held_out, config)
    if not any((*fitted, *tested)):
        return None
    return cut_pushes(loaded, fitted, tested)
