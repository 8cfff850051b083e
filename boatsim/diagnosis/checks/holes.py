"""Check for intervals without rows, over which a model is simulated with commands of long ago."""

import numpy as np
from numpy.typing import NDArray

from boatsim.diagnosis.checks.clock import check_clock
from boatsim.diagnosis.checks.finding import Finding
from boatsim.diagnosis.config import ChecksConfig
from boatsim.diagnosis.priors import froude_time_scale
from boatsim.physics.base import Array
from boatsim.physics.vessel import Vessel
from boatsim.recordings.table import Recording


def check_holes(recording: Recording, vessel: Vessel, config: ChecksConfig) -> list[Finding]:
    """Find long intervals without rows, and propose to use the parts between them.

    Args:
        recording: A prepared recording.
        vessel: The vessel; its length scales the duration from which an interval is a hole.
        config: Thresholds of the quality checks.

    Returns:
        One finding, or none.
    """
    t = recording.t
    holes = rows_before_holes(t, vessel, config)
    if not len(holes):
        return []
    if check_clock(recording, vessel, config):  # the time is wrong, and no rows are missing
        return []
    spans = tuple(zip(t[holes].tolist(), t[holes + 1].tolist(), strict=True))
    lengths = ", ".join(f"{end - begin:.3g} s" for begin, end in spans)
    parts = ", ".join(f"[{part[0]:g}, {part[-1]:g}]" for part in np.split(t, holes + 1))
    return [
        Finding(
            "hole",
            f"the log has no rows for {lengths}, so that commands and motion there are unknown",
            spans=spans,
            remedy=f"write into recording.toml: use = [{parts}]",
        )
    ]


def rows_before_holes(t: Array, vessel: Vessel, config: ChecksConfig) -> NDArray[np.int64]:
    """Return the rows after which a log has a long interval without rows.

    Args:
        t: Times (N,) [s].
        vessel: The vessel; its length scales the duration from which an interval is a hole.
        config: Thresholds of the quality checks.

    Returns:
        Indices (K,) of rows.
    """
    return np.flatnonzero(np.diff(t) > config.hole_duration * froude_time_scale(vessel))


def part_before_first_hole(recording: Recording, vessel: Vessel, config: ChecksConfig) -> Recording:
    """Return the first part of a recording without a hole that has enough rows.

    Args:
        recording: The recording.
        vessel: Its vessel.
        config: Thresholds of the quality checks.

    Returns:
        The part; the longest one if all are short.
    """
    holes = rows_before_holes(recording.t, vessel, config)
    parts = np.split(recording.t, holes + 1)
    enough = [part for part in parts if len(part) >= config.hole_min_rows]
    chosen = enough[0] if enough else max(parts, key=len)
    return recording.between(float(chosen[0]), float(chosen[-1]))
