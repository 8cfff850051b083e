"""Check for times without new commands, over which a log repeats the last ones."""

import numpy as np
from numpy.typing import NDArray

from boatsim.diagnosis.checks.finding import MAX_LISTED, Finding
from boatsim.diagnosis.config import ChecksConfig
from boatsim.diagnosis.priors import froude_time_scale
from boatsim.physics.base import Array
from boatsim.physics.signals import POSE
from boatsim.physics.vessel import CommandChannel, Vessel
from boatsim.recordings.table import Recording


def check_held_commands(
    recording: Recording, vessel: Vessel, config: ChecksConfig
) -> list[Finding]:
    """Find times over which all commands stay exactly the same, although they change elsewhere.

    Commands that an automatic controller gives continuously change in nearly every row. Where their
    link to the logger is silent, the log holds the last ones, while poses go on. Such a time is
    several times longer than nearly all others between changes. Two or more commands change in most
    rows before it and are neither at rest nor at a limit in it; two or more leap at its end and
    change in most rows behind it. A pause or a step of a planned experiment has one of these signs,
    but not all.

    Args:
        recording: A prepared recording.
        vessel: The vessel with its commands; its length scales the longest time that counts.
        config: Thresholds of the quality checks.

    Returns:
        One finding, or none.
    """
    names = [name for name in vessel.commands if name in recording.signals]
    if len(names) < config.held_fewest:
        return []
    values = np.stack([recording[name] for name in names], axis=1)
    complete = np.isfinite(values).all(axis=1)
    if complete.sum() < config.held_changes:
        return []
    t, values = recording.t[complete], values[complete]
    span = np.ptp(values, axis=0)
    steps = np.abs(np.diff(values, axis=0)) / np.where(span > 0.0, span, 1.0)
    changed = np.flatnonzero(steps.max(axis=1) > 0.0) + 1
    if len(changed) < config.held_changes:
        return []
    # from these rows the commands stay the same up to the next change
    begins = np.append(0, changed[:-1])
    between = t[changed] - t[begins]
    usual = float(np.quantile(between, config.held_usual_share))
    longest = config.held_longest * froude_time_scale(vessel)
    leaps = np.sqrt(np.mean(steps[changed - 1] ** 2, axis=1))
    held = (between > config.held_times * usual) & (between < longest)
    held &= leaps > np.quantile(leaps, config.held_leap)
    new_poses = np.cumsum(_has_new_pose(recording)[complete])
    held &= new_poses[changed - 1] - new_poses[begins] >= config.held_poses
    may_rest = np.empty(values.shape, dtype=np.bool_)
    for c, name in enumerate(names):
        may_rest[:, c] = _may_rest(values[:, c], vessel.commands[name], config)
    spans = list[tuple[float, float]]()
    for begin, end in zip(begins[held].tolist(), changed[held].tolist(), strict=True):
        before = _share_of_changes(steps[:begin], config.held_poses, last=True)
        after = _share_of_changes(steps[end:], config.held_poses, last=False)
        moved = (before > config.held_moving) & ~may_rest[begin]
        fewest = min(moved.sum(), (after > config.held_moving).sum())
        if fewest >= config.held_fewest:
            spans.append((float(t[begin]), float(t[end])))
    if not spans:
        return []
    return [_finding(tuple(spans))]


def _may_rest(values: Array, command: CommandChannel, config: ChecksConfig) -> NDArray[np.bool_]:
    """Whether values (N,) of a command are at rest, at a limit or at an end of their range."""
    levels = (command.neutral, command.low, command.high, values.min(), values.max())
    near = config.held_rest * float(np.ptp(values))
    return np.asarray(np.abs(values[:, None] - np.array(levels)).min(axis=1) <= near)


def _share_of_changes(steps: Array, rows: int, *, last: bool) -> Array:
    """Share (C,) of the first or last steps (N, C) in which each command changes."""
    near = steps[-rows:] if last else steps[:rows]
    if not len(near):
        return np.zeros(steps.shape[1])
    return np.asarray(np.mean(near > 0.0, axis=0))


def _has_new_pose(recording: Recording) -> NDArray[np.bool_]:
    """Whether rows (N,) have a pose that the log did not have before."""
    found = np.zeros(len(recording.t), dtype=bool)
    for name in POSE:
        if name in recording.signals:
            measured = np.flatnonzero(np.isfinite(recording[name]))
            found[measured[1:]] |= np.diff(recording[name][measured]) != 0.0
    return found


def _finding(spans: tuple[tuple[float, float], ...]) -> Finding:
    """The finding of intervals [s] in which commands are held."""
    lengths = ", ".join(f"{end - begin:.3g} s" for begin, end in spans[:MAX_LISTED])
    return Finding(
        "commands_held",
        f"all commands stay exactly the same for {lengths} and then leap, while they change in "
        "nearly every row before and behind: no commands arrived, and the last ones are repeated",
        probability=0.9,
        spans=spans,
        remedy="the commands of these times are unknown: leave the times out (`use` in "
        "recording.toml), or log each command with its own time",
    )
