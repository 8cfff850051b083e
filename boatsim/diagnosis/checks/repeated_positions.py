"""Fixes that a logger repeats until the next one comes: the repetitions are no measurements.

Taken for measurements they would say that the boat stood still and then leapt, ten times a second.
"""

from dataclasses import replace

import numpy as np

from boatsim.recordings.repeated_values import repeats
from boatsim.recordings.table import Recording

TOGETHER = (("x_m", "y_m"), ("psi_rad",))  # columns that come with one fix


def without_repeats(recording: Recording) -> Recording:
    """The recording with repeated fixes left out (nan); a remark says how many."""
    signals, remarks = dict(recording.signals), list(recording.remarks)
    for names in TOGETHER:
        there = [n for n in names if n in signals]
        if len(there) < len(names):
            continue
        repeated = repeats(np.column_stack([signals[n] for n in there]))
        if repeated.any():
            remarks.append(
                f"{recording.path or recording.name}: {', '.join(there)} repeat each fix until the next; "
                f"{int(repeated.sum())} of {len(recording)} rows are repetitions and are not used"
            )
            signals |= {n: np.where(repeated, np.nan, signals[n]) for n in there}
    return replace(recording, signals=signals, remarks=tuple(remarks))
