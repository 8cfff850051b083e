"""Fixes that a logger repeats until the next one: the repetitions are not measurements.

If they were used, the boat would seem to stand still and then to jump, many times a second.
"""

from dataclasses import replace

import numpy as np

from boatsim.recordings.repeated_values import repeated_rows
from boatsim.recordings.table import Recording

COLUMNS_OF_ONE_FIX = (("x_m", "y_m"), ("psi_rad",))


def drop_repeated_positions(recording: Recording) -> Recording:
    """Return the recording with repeated fixes replaced by nan.

    Args:
        recording: A prepared recording.

    Returns:
        The recording; a remark per fix type counts the repetitions.
    """
    signals = dict(recording.signals)
    remarks = list(recording.remarks)
    for names in COLUMNS_OF_ONE_FIX:
        if not set(names) <= signals.keys():
            continue
        repeated = repeated_rows(np.column_stack([signals[n] for n in names]))
        if repeated.any():
            remarks.append(
                f"{recording.path or recording.name}: {', '.join(names)} repeat each fix until the "
                f"next. {int(repeated.sum())} of {len(recording)} rows are repetitions and are not "
                "used"
            )
            signals |= {n: np.where(repeated, np.nan, signals[n]) for n in names}
    return replace(recording, signals=signals, remarks=tuple(remarks))
