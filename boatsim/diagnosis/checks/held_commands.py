"""Check for times without new commands, over which a log repeats the last ones."""

import numpy as np
from numpy.typing import NDArray

from boatsim.diagnosis.checks.finding import MAX_LISTED, Finding
from boatsim.diagnosis.config import ChecksConfig
from boatsim.diagnosis.priors import froude_time_scale
from boatsim.physics.signals import POSE
from boatsim.physics.vessel import Vessel
from boatsim.recordings.table import Recording


def check_held_commands(
    recording: Recording, vessel: Vessel, config: ChecksConfig
) -> list[Finding]:
    """Find times over which all commands stay exactly the same, although they change elsewhere.

    Commands that a helm or an automatic controller gives continuously change from row to row. Where
    their link to the logger is silent, the log holds the last ones, while poses go on. Two signs
    are needed: the times are several times longer than nearly all others between changes, and the
    commands leap behind them. Commands at rest or at their limits may stay the same for any time.

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
    span = np.ptp(values, axis=0)
    if not np.isfinite(values).all() or not (span > 0.0).any():
        return []
    steps = np.abs(np.diff(values, axis=0)) / np.where(span > 0.0, span, 1.0)
    changed = np.flatnonzero(steps.max(axis=1) > 0.0) + 1
    if len(changed) < config.held_changes:
        return []
    # from these rows the commands stay the same up to the next change
    begins = np.append(0, changed[:-1])
    between = recording.t[changed] - recording.t[begins]
    leaps = np.sqrt(np.mean(steps[changed - 1] ** 2, axis=1))
    usual = float(np.quantile(between, config.held_usual_share))
    if usual > config.held_rows * float(np.median(np.diff(recording.t))):
        return []
    longest = config.held_longest * froude_time_scale(vessel)
    held = (between > config.held_times * usual) & (between < longest)
    held &= leaps >= np.quantile(leaps, config.held_leap)
    moving = np.zeros(len(begins), dtype=np.int64)  # commands between rest and limit
    for c, name in enumerate(names):
        levels = (vessel.commands[name].neutral, values[:, c].min(), values[:, c].max())
        near = config.held_rest * span[c]
        moving += np.abs(values[begins, c, None] - levels).min(axis=1) > near
    held &= moving >= config.held_fewest
    new = np.cumsum(_has_new_pose(recording))
    held &= new[changed - 1] - new[begins] >= config.held_poses
    if not held.any():
        return []
    t = recording.t
    spans = tuple(zip(t[begins[held]].tolist(), t[changed[held]].tolist(), strict=True))
    return [_finding(recording, spans, usual, config)]


def _has_new_pose(recording: Recording) -> NDArray[np.bool_]:
    """Whether rows (N,) have a pose that the log did not have before."""
    found = np.zeros(len(recording.t), dtype=bool)
    for name in POSE:
        if name in recording.signals:
            measured = np.flatnonzero(np.isfinite(recording[name]))
            found[measured[1:]] |= np.diff(recording[name][measured]) != 0.0
    return found


def _finding(
    recording: Recording,
    spans: tuple[tuple[float, float], ...],
    usual: float,
    config: ChecksConfig,
) -> Finding:
    """The finding of intervals [s] in which commands are held, with the usual time between two."""
    lengths = ", ".join(f"{end - begin:.3g} s" for begin, end in spans[:MAX_LISTED])
    begins = [recording.t[0], *(end for _, end in spans)]
    ends = [*(begin for begin, _ in spans), recording.t[-1]]
    parts = list[str]()
    for begin, end in zip(begins, ends, strict=True):
        if end - begin > config.held_times * usual:
            parts.append(f"[{begin:g}, {end:g}]")
    return Finding(
        "commands_held",
        f"all commands stay exactly the same for {lengths} and then leap, while they change at "
        f"least every {usual:.2g} s elsewhere: no commands arrived, and the last ones are repeated",
        probability=0.9,
        spans=spans,
        remedy=f"write into recording.toml: use = [{', '.join(parts)}]",
    )
