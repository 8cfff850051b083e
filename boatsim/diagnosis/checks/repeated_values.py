"""Values that a logger repeats until the next one: the repetitions are not measurements.

If they were used, the boat would seem to stand still and then to jump, many times a second, and a
held velocity would seem to be late.
"""

from dataclasses import replace

import numpy as np

from boatsim.physics.recorded_channels import INSTRUMENT_CHANNELS
from boatsim.recordings.repeated_values import repeated_rows
from boatsim.recordings.table import Recording

FIXES = (("x_m", "y_m"), ("psi_rad",))  # columns of one fix
# phrases in the remarks, by which findings recognize them
FIX_REPEATED, VALUE_REPEATED = "repeat each fix", "repeats each value"


def drop_repeated_values(recording: Recording) -> Recording:
    """Return a recording in which values that the logger only repeated are replaced by nan.

    A logger that writes faster than a sensor measures repeats the last value.

    Args:
        recording: A prepared recording.

    Returns:
        The recording; a remark per fix type or channel counts the repetitions.
    """
    signals = dict(recording.signals)
    remarks = list(recording.remarks)
    words = _words_by_columns()
    for names in words:
        if not set(names) <= signals.keys():
            continue
        repeated = repeated_rows(np.column_stack([signals[n] for n in names]))
        if repeated.any():
            remarks.append(
                f"{recording.origin}: {words[names]} until the next. "
                f"{int(repeated.sum())} of {len(recording)} rows are repetitions and are not used"
            )
            signals |= {n: np.where(repeated, np.nan, signals[n]) for n in names}
    return replace(recording, signals=signals, remarks=tuple(remarks))


def _words_by_columns() -> dict[tuple[str, ...], str]:
    """Columns that one instrument measures together, and the start of a remark about them."""
    found: dict[tuple[str, ...], str] = {}
    for names in FIXES:
        found[names] = f"{', '.join(names)} {FIX_REPEATED}"
    for channel in INSTRUMENT_CHANNELS:
        words = f"the recorded {channel.words} ({channel.column}) {VALUE_REPEATED}"
        found.setdefault((channel.column,), words)
    return found
