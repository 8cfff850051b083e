"""Check for permanent jumps of the position or heading within one row."""

import numpy as np
from numpy.typing import NDArray

from boatsim.diagnosis.checks.finding import MAX_LISTED, Finding, longest_uninterrupted_interval
from boatsim.diagnosis.config import DEFAULT, ChecksConfig
from boatsim.physics.base import Array
from boatsim.physics.vessel import Vessel
from boatsim.recordings.table import Recording

SIGNALS = (
    ("position_leaps", ("x_m", "y_m"), "m"),
    ("heading_leaps", ("psi_rad",), "rad"),
)


def check_position_jumps(recording: Recording, _: Vessel, config: ChecksConfig) -> list[Finding]:
    """Find permanent jumps of the recorded position or heading within one row.

    The longest part of the recording between two jumps can be used. A jump that a later one takes
    back is none of them: the values in between are dropped as outliers.

    Args:
        recording: A prepared recording.
        config: Thresholds of the quality checks.

    Returns:
        Findings "position_leaps" and "heading_leaps".
    """
    found = []
    for name, columns, unit in SIGNALS:
        if set(columns) <= recording.signals.keys():
            found += _check_columns(recording, name, columns, unit, config)
    return found


def _check_columns(
    recording: Recording, name: str, columns: tuple[str, ...], unit: str, config: ChecksConfig
) -> list[Finding]:
    values = np.column_stack([recording[c] for c in columns])
    known = np.flatnonzero(np.isfinite(values).all(axis=1))
    t = recording.t[known]
    values = values[known]
    rows = jump_rows(t, values, config)
    for begin, end in excursions(t, values, rows, config):
        rows = rows[(rows != begin) & (rows != end)]
    if not len(rows):
        return []
    listed = rows[:MAX_LISTED].tolist()
    sizes = np.linalg.norm(values[rows + 1] - values[rows], axis=1)
    places = [
        f"{size:.3g} {unit} at {t[k + 1]:g} s" for k, size in zip(listed, sizes, strict=False)
    ]
    return [
        Finding(
            name,
            f"{', '.join(columns)} jump permanently: {', '.join(places)}",
            probability=config.probability_strong,
            spans=tuple(zip(t[rows].tolist(), t[rows + 1].tolist(), strict=True))[:MAX_LISTED],
            use=longest_uninterrupted_interval(t, rows),
        )
    ]


def jump_rows(t: Array, values: Array, config: ChecksConfig = DEFAULT.checks) -> NDArray[np.int64]:
    """Return the rows of a signal after which it jumps by more than its usual steps allow.

    Steps and slopes around the row determine how much is usual.

    Args:
        t: Times (N,) [s].
        values: Values (N, C), complete.
        config: Thresholds of the quality checks.

    Returns:
        Indices (K,) of the rows before a jump.
    """
    n = len(t)
    side = config.jump_course_rows
    if n < config.jump_min_rows * side:
        return np.zeros(0, dtype=np.int64)
    step = np.diff(values, axis=0)
    per_row = np.maximum(np.diff(t) / float(np.median(np.diff(t))), 1.0)[:, None]
    size = np.linalg.norm(step / per_row, axis=1)
    high = float(np.quantile(size, config.jump_step_quantile))
    large = np.flatnonzero(size > config.jump_min_step * high)
    most = n // config.jump_min_spacing + config.jump_spare_steps
    if not len(large) or len(large) > most:
        return np.zeros(0, dtype=np.int64)
    sampled = range(side, n - side - 1, max(1, n // config.jump_sampled_rows))
    usual = float(np.median([_course_gap(t, values, k, side) for k in sampled]))
    found = []
    for k in large.tolist():
        if not side <= k < n - side - 1:
            continue
        gap = _course_gap(t, values, k, side)
        permanent = gap > config.jump_min_share * float(np.linalg.norm(step[k]))
        if permanent and gap > config.jump_min_gap * usual:
            found.append(k)
    return np.array(found, dtype=np.int64)


def excursions(
    t: Array, values: Array, rows: NDArray[np.int64], config: ChecksConfig = DEFAULT.checks
) -> list[tuple[int, int]]:
    """Return pairs of jumps of which the second takes back the first.

    The values in between are wrong if they are the smaller part of the recording.

    Args:
        t: Times (N,) [s].
        values: Values (N, C), complete.
        rows: Rows (K,) before a jump.
        config: Thresholds of the quality checks.

    Returns:
        Rows before the jump away and before the jump back, for each pair.
    """
    found = []
    open_row: int | None = None
    longest = config.excursion_max_share * float(t[-1] - t[0])
    for row in rows.tolist():
        if open_row is not None:
            away = values[open_row + 1] - values[open_row]
            rest = np.linalg.norm(away + values[row + 1] - values[row])
            near = rest < config.excursion_max_rest * np.linalg.norm(away)
            if near and t[row] - t[open_row] < longest:
                found.append((open_row, row))
                open_row = None
                continue
        open_row = row
    return found


def _course_gap(t: Array, values: Array, k: int, side: int) -> float:
    """Distance between the courses before and after row k, half-way to the next row."""
    middle = 0.5 * (t[k] + t[k + 1])
    ends = []
    for rows in (slice(k - side + 1, k + 1), slice(k + 1, k + 1 + side)):
        since = t[rows] - t[rows].mean()
        speed = since @ (values[rows] - values[rows].mean(axis=0)) / float(since @ since)
        centre = np.median(values[rows] - since[:, None] * speed, axis=0)
        ends.append(centre + speed * (middle - t[rows].mean()))
    return float(np.linalg.norm(ends[1] - ends[0]))
