"""Remark on messages that a program logged long after they had been sent."""

from collections.abc import Collection, Mapping

import numpy as np
from scipy.ndimage import median_filter

from boatsim.physics.base import Array
from boatsim.recordings.importing.clocks import (
    MIN_TIMES,
    hardly_decreases,
    is_called_a_time,
    times_in_seconds,
)

MAX_OFFSET = 10.0  # [s] between two clocks of one row; of another clock nothing follows
WINDOW = 201  # rows whose median is the usual difference: drift and steps of a clock are slower
LATE_STEPS = 5.0  # usual steps of the rows by which a late one differs
MIN_LATE = 0.05  # [s] shorter delays are usual for a program that reads messages in turn
MAX_LATE_SHARE = 0.05  # share of the rows; more are a clock of coarse steps
FEWEST_LATE = 3  # rows; one or two are wrong cells


def late_rows_remark(
    columns: Mapping[str, Array], t: Array, names: Collection[str]
) -> tuple[str, ...]:
    """Return the remark on rows whose two times differ for a short while by much more than usual.

    Two clocks of the same rows, such as the stamp of a message and the time when it was logged,
    differ by nearly the same time in neighbouring rows. If messages pile up, the later clock shows
    it.

    Args:
        columns: Name -> values (N,).
        t: Times (N,) [s] that are used.
        names: Columns from which these follow.

    Returns:
        One remark; none without a second clock, or if it agrees.
    """
    for name, values in columns.items():
        if name in names or not is_called_a_time(name) or not hardly_decreases(values):
            continue
        off = times_in_seconds(name, values) - t
        known = np.isfinite(off)
        known[known] &= np.abs(off[known] - np.median(off[known])) < MAX_OFFSET
        if known.sum() < MIN_TIMES or abs(float(np.median(off[known]))) > MAX_OFFSET:
            continue
        times, off = t[known], off[known]
        excess = off - median_filter(off, min(WINDOW, len(off)), mode="nearest")
        least = max(LATE_STEPS * float(np.median(np.diff(times))), MIN_LATE)
        is_late, is_early = excess >= least, excess <= -least
        far = is_late | is_early
        if not FEWEST_LATE <= far.sum() <= MAX_LATE_SHARE * len(far):
            continue
        used = " and ".join(names)
        begin = t[np.isfinite(t)][0]
        if is_late.sum() >= is_early.sum():
            return (
                f"column {name} is up to {excess.max():.3g} s later than usual after the times "
                f"used ({used}), first {times[is_late][0] - begin:.3f} s after the log begins: "
                "messages were logged late there",
            )
        return (
            f"the times used ({used}) are up to {-excess.min():.3g} s later than usual after "
            f"column {name}, first {times[is_early][0] - begin:.3f} s after the log begins: if "
            "that column is the time of the measurement, name it with `time` in the map",
        )
    return ()
