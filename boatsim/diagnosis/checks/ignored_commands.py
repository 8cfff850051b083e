"""Check for times in which a vessel moves, but not by its recorded commands.

Another person may steer by a second remote control, or the drives may be off while the boat is
towed or drifts. The motion then shows none of the commanded forces, although it shows them at other
times of the same recordings. A fit of the whole would take the drives for weak, so these rows are
cut out, and the recording becomes several.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from boatsim.diagnosis.checks.cut_recordings import (
    TEXT_DIGITS,
    Interval,
    format_interval,
    parts_outside_intervals,
)
from boatsim.diagnosis.checks.finding import Finding
from boatsim.diagnosis.config import ChecksConfig
from boatsim.diagnosis.filter import MappedRecording, dof_in_state_order
from boatsim.diagnosis.loading import LoadedRecordings
from boatsim.diagnosis.locate.nominal_forces import actuator_states, body_forces
from boatsim.diagnosis.problem import Fit, Problem
from boatsim.physics.base import Array
from boatsim.recordings.table import Recording

Rows = NDArray[np.bool_]


@dataclass(frozen=True)
class _Response:
    """How much of the commanded forces the motion shows around each row.

    Attributes:
        share: Shares (N, 2), in surge alone, and in surge and yaw together: 1 where the motion
            needs just the commanded forces. Both are asked, because a moment that the hull resists
            much more than the vessel file says outweighs the surge force.
        size: Rms (N,) of the commanded surge force, in its usual size.
        speed: Rms (N,) of the speed [m/s].
    """

    share: Array
    size: Array
    speed: Array


def check_ignored_commands(
    problem: Problem, fit: Fit, recordings: Sequence[MappedRecording], names: Sequence[str]
) -> list[Finding]:
    """Find the times in which vessels move, but not by their commands.

    Args:
        problem: Problem whose recordings show how the vessel usually answers.
        fit: The vessel as specified, with fitted noise levels.
        recordings: Recordings that are tested.
        names: Their files, for the findings.

    Returns:
        At most one finding "commands_ignored" for each recording.
    """
    config = problem.config.checks
    if not {"surge", "yaw"} <= set(problem.program.vessel.dof):
        return []
    scale = _usual_forces(problem.recordings)
    if not np.all(scale > 0.0):
        return []
    usual = [_response(problem, fit, one, scale) for one in problem.recordings]
    driven = np.vstack([r.share[r.size > config.ignored_least_force] for r in usual])
    speeds = np.concatenate([r.speed for r in usual])
    if not len(driven):
        return []
    share = np.median(driven, axis=0)
    if np.any(share < config.ignored_usual_share):
        return []  # the drives of the file are wrong throughout
    found = []
    for mapped, name in zip(recordings, names, strict=True):
        answer = _response(problem, fit, mapped, scale)
        ignored = np.all(np.abs(answer.share) < config.ignored_share * share, axis=1)
        ignored &= answer.size > config.ignored_least_force
        ignored &= answer.speed > config.ignored_least_speed * float(np.median(speeds))
        spans = _spans(mapped.times, ignored, _window(problem))
        if spans:
            found.append(_finding(spans, name, config))
    return found


def recordings_that_follow_commands(
    loaded: LoadedRecordings, problem: Problem, findings: Sequence[Finding]
) -> LoadedRecordings:
    """Return recordings without the times in which vessels move, but not by their commands.

    Args:
        loaded: The recordings.
        problem: The same recordings, mapped.
        findings: Findings "commands_ignored" about them.
    """
    spans = dict[str, list[Interval]]()
    for finding in findings:  # a recording that was cut before has several
        spans.setdefault(finding.run, []).extend(finding.spans)
    # a mean over a window falls below the limit only well inside the time
    margin = 0.5 * _window(problem)

    def parts(recordings: Sequence[Recording]) -> list[Recording]:
        found = []
        for recording in recordings:
            own = sorted(spans.get(recording.origin, ()))
            pieces = parts_outside_intervals(recording, _widened(own, margin))
            found += pieces or [recording]
        return found

    return replace(loaded, fitted=parts(loaded.fitted), held_out=parts(loaded.held_out))


def _widened(spans: Sequence[Interval], margin: float) -> list[Interval]:
    """Intervals [s] with a margin on both sides, joined where they then overlap."""
    found = list[Interval]()
    for begin, end in spans:
        first, last = begin - margin, end + margin
        if found and first <= found[-1][1]:
            found[-1] = (found[-1][0], last)
        else:
            found.append((first, last))
    return found


def _window(problem: Problem) -> float:
    """Time [s] over which forces are compared."""
    return problem.config.checks.ignored_window * problem.ambient.time_constant


def _commanded(mapped: MappedRecording) -> Array:
    """Forces (N, axes) of the drives at rest, beyond those that act without commands."""
    program = mapped.program
    rest = np.zeros((len(mapped.times), 2 * program.module.NQ))
    act, memory = np.zeros(program.actuator_signal_size), np.zeros(program.memory_size)
    neutral = {name: c.neutral for name, c in program.vessel.commands.items()}
    on = program.effect_switches()
    commands = program.command_array(neutral)
    program.estimation_functions.settle_actuators(commands, memory, mapped.values, on, act)
    idle = body_forces(mapped, rest[:1], act[None], mapped.values)
    return body_forces(mapped, rest, actuator_states(mapped), mapped.values) - idle


def _usual_forces(recordings: Sequence[MappedRecording]) -> Array:
    """Rms of the commanded forces along surge and yaw over all recordings."""
    forces = np.vstack([_commanded(mapped) for mapped in recordings])
    axes = _axes(recordings[0])
    return np.asarray(np.sqrt(np.mean(forces[:, axes] ** 2, axis=0)))


def _axes(mapped: MappedRecording) -> list[int]:
    """Places of surge and yaw among the forces."""
    dof = dof_in_state_order(mapped.program.vessel)
    return [dof.index("surge"), dof.index("yaw")]


def _response(problem: Problem, fit: Fit, mapped: MappedRecording, scale: Array) -> _Response:
    """How much of the commanded forces the motion of a recording shows.

    The motion needs the commanded force and the latent one that the filter adds.
    """
    nq, axes = problem.program.module.NQ, _axes(mapped)
    values = problem.parameter_vector(mapped, fit.free, fit.theta)
    on = problem.program.effect_switches(fit.effects)
    means = mapped.smooth(values, on, fit.levels).means
    commanded = _commanded(mapped)[:, axes] / scale
    needed = commanded + means[:, 2 * nq : 3 * nq][:, axes] / scale
    horizontal = np.isin(dof_in_state_order(problem.program.vessel), ("surge", "sway"))
    speed = np.sum(means[:, nq : 2 * nq][:, horizontal] ** 2, axis=1)
    products, squares = np.cumsum(needed * commanded, axis=1), np.cumsum(commanded**2, axis=1)
    columns = np.column_stack([products, squares, speed])
    mean = _running_mean(mapped.times, columns, _window(problem))
    shares = mean[:, :2] / np.maximum(mean[:, 2:4], np.finfo(float).tiny)
    return _Response(shares, np.sqrt(mean[:, 2]), np.sqrt(mean[:, 4]))


def _running_mean(t: Array, values: Array, window: float) -> Array:
    """Means (N, C) of columns over a window [s] around each row."""
    total = np.vstack([np.zeros(values.shape[1]), np.cumsum(values, axis=0)])
    begin = np.searchsorted(t, t - 0.5 * window)
    end = np.searchsorted(t, t + 0.5 * window, side="right")
    return np.asarray((total[end] - total[begin]) / (end - begin)[:, None])


def _spans(t: Array, rows: Rows, least: float) -> list[tuple[float, float]]:
    """Intervals [s] of true rows of at least some length, widened to an end of the log nearby."""
    edges = np.diff(np.concatenate(([0], rows.astype(np.int64), [0])))
    found = []
    for begin, end in zip(np.flatnonzero(edges == 1), np.flatnonzero(edges == -1), strict=True):
        first, last = float(t[begin]), float(t[end - 1])
        if last - first < least:
            continue
        if first - t[0] < 0.5 * least:
            first = float(t[0])
        if t[-1] - last < 0.5 * least:
            last = float(t[-1])
        found.append((first, last))
    return found


def _finding(spans: list[tuple[float, float]], name: str, config: ChecksConfig) -> Finding:
    """The finding about one recording."""
    texts = ", ".join(format_interval(begin, end, TEXT_DIGITS) for begin, end in spans)
    return Finding(
        "commands_ignored",
        f"from {texts} the boat moves, but its motion shows none of the commanded forces, which it "
        "shows at other times; the diagnosis leaves these rows out",
        kind="mended",
        probability=config.probability_likely,
        spans=tuple(spans),
        words="commands that the drives did not follow",
        run=name,
    )
