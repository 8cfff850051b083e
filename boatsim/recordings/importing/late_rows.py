"""Remark on messages that a program logged long after they had been sent."""

from collections.abc import Collection, Mapping

import numpy as np

from boatsim.physics.base import Array
from boatsim.recordings.importing.clocks import (
    hardly_decreases,
    is_called_a_time,
    times_in_seconds,
)

MAX_OFFSET = 10.0  # [s] between two clocks of one row; of another clock nothing follows
LATE_STEPS = 5.0  # usual steps of the rows by which a late one differs
MIN_LATE = 0.05  # [s] shorter delays are usual for a program that reads messages in turn


def late_rows_remark(
    columns: Mapping[str, Array], t: Array, names: Collection[str]
) -> tuple[str, ...]:
    """Return the remark on rows whose two times differ for a short while by much more than usual.

    Two clocks of the same rows, such as the stamp of a message and the time when it was logged,
    differ by about the same time in all rows. If messages pile up, the later clock shows it.

    Args:
        columns: Name -> values (N,).
        t: Times (N,) [s] that are used.
        names: Columns from which these follow.

    Returns:
        One remark; none without a second clock, or if it agrees.
    """
    step = float(np.median(np.diff(t))) if len(t) > 1 else 0.0
    least = max(LATE_STEPS * step, MIN_LATE)
    for name, values in columns.items():
        if name in names or not is_called_a_time(name) or not hardly_decreases(values):
            continue
        off = times_in_seconds(name, values) - t
        usual = float(np.nanmedian(off))
        if not abs(usual) < MAX_OFFSET:
            continue
        late, early = np.nanmax(off) - usual, usual - np.nanmin(off)
        if late < least and early < least:
            continue
        used = " and ".join(names)
        if late >= early:
            at = t[np.flatnonzero(off - usual >= least)[0]] - t[0]
            return (
                f"column {name} is up to {late:.3g} s later than usual after the times used "
                f"({used}), first {at:.3f} s after the log begins: messages were logged late there",
            )
        at = t[np.flatnonzero(usual - off >= least)[0]] - t[0]
        return (
            f"the times used ({used}) are up to {early:.3g} s later than usual after column "
            f"{name}, first {at:.3f} s after the log begins: if that column is the time of the "
            "measurement, name it with `time` in the map",
        )
    return ()
