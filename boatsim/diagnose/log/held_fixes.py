"""Fixes that a logger repeats until the next one comes: the repetitions are no measurements.

Taken for measurements they would say that the boat stood still and then leapt, ten times a second.
"""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from boatsim.recordings.table import Recording

TOGETHER = (("x_m", "y_m"), ("psi_rad",))  # columns that come with one fix
FEWEST = 10  # fixes from which a rhythm is told from chance
REGULAR = 0.8  # share of the gaps between fixes that are as long as the usual one, to a row or a tenth


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


def repeats(fixes: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Rows (N,) that repeat the fix (N, C) before them, if new ones come with a rhythm; else none."""
    new = np.append(True, (np.diff(fixes, axis=0) != 0.0).any(axis=1))
    gaps = np.diff(np.flatnonzero(new))
    none = np.zeros(len(fixes), dtype=np.bool_)
    if len(gaps) < FEWEST or (usual := float(np.median(gaps))) < 2.0:
        return none
    regular = np.abs(gaps - usual) <= max(1.0, 0.1 * usual)
    return ~new if regular.mean() >= REGULAR else none
