"""Check for time stamps that stall, go backwards, or jump ahead while the boat does not move."""

import numpy as np
from numpy.typing import NDArray

from boatsim.diagnosis.checks.finding import MAX_LISTED, Finding, longest_uninterrupted_interval
from boatsim.diagnosis.config import ChecksConfig
from boatsim.diagnosis.priors import froude_time_scale
from boatsim.physics.base import Array
from boatsim.physics.vessel import Vessel
from boatsim.recordings.table import Recording


def check_clock(recording: Recording, vessel: Vessel, config: ChecksConfig) -> list[Finding]:
    """Find faulty time stamps: rows not later than the row before, and time jumps without motion.

    Args:
        recording: The recording as written in the file.
        vessel: The vessel; its length scales the durations.
        config: Thresholds of the quality checks.

    Returns:
        Findings "clock_stalls" and "clock_goes_back"; without them at most one "clock_leaps".
    """
    steps = np.diff(recording.t)
    found = []
    stalled = np.flatnonzero(steps == 0.0) + 1
    if len(stalled):
        found.append(_bad_rows(recording, "clock_stalls", stalled, "the same time as"))
    reversed_rows = np.flatnonzero(steps < 0.0) + 1
    if len(reversed_rows):
        found.append(_bad_rows(recording, "clock_goes_back", reversed_rows, "an earlier time than"))
    if found:
        return found
    jumps = _time_jumps(recording, steps, froude_time_scale(vessel), config)
    if len(jumps):
        found.append(_jump_finding(recording, steps, jumps, config))
    return found


def _bad_rows(recording: Recording, name: str, rows: NDArray[np.int64], comparison: str) -> Finding:
    listed = rows[:MAX_LISTED]
    numbers = ", ".join(map(str, (listed + 1).tolist()))
    times = recording.t[listed].tolist()
    return Finding(
        name,
        f"{len(rows)} of {len(recording)} rows have {comparison} the row before "
        f"(rows {numbers}, the header not counted)",
        spans=tuple(zip(times, times, strict=True)),
        remedy="write the time with all its digits, or leave those rows out",
    )


def _jump_finding(
    recording: Recording, steps: Array, jumps: NDArray[np.int64], config: ChecksConfig
) -> Finding:
    t = recording.t
    listed = jumps[:MAX_LISTED]
    places = ", ".join(f"{t[k]:g} s by {steps[k]:.4g} s" for k in listed)
    return Finding(
        "clock_leaps",
        f"the time jumps ahead at {places}, but the boat does not move in these intervals",
        probability=config.probability_strong,
        spans=tuple(zip(t[listed].tolist(), t[listed + 1].tolist(), strict=True)),
        use=longest_uninterrupted_interval(t, jumps),
    )


def _time_jumps(
    recording: Recording, steps: Array, time_scale: float, config: ChecksConfig
) -> NDArray[np.int64]:
    """Rows before a step of time in which the boat moved far less than its speed implies."""
    none = np.zeros(0, dtype=np.int64)
    if not {"x_m", "y_m"} <= recording.signals.keys() or len(steps) < config.clock_speed_rows:
        return none
    usual = float(np.median(steps))
    if not usual > 0.0:
        return none
    moved = np.hypot(np.diff(recording["x_m"]), np.diff(recording["y_m"]))
    known = moved[np.isfinite(moved)]
    if not len(known):
        return none
    distance = float(np.quantile(known, config.clock_jump_quantile))
    ratio = config.clock_jump_steps
    long = steps > ratio * max(usual, time_scale / ratio)
    near = moved < config.clock_jump_max_distance * distance
    speed = np.convolve(
        np.nan_to_num(moved / np.maximum(steps, usual)),
        np.ones(config.clock_speed_rows) / config.clock_speed_rows,
        "same",
    )
    expected_far = speed * steps > config.clock_jump_expected_distance * distance
    return np.flatnonzero(long & near & expected_far)
