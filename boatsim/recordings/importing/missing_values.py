"""Numbers that a logger writes in place of a missing measurement, such as -999 or 65535."""

import numpy as np

from boatsim.physics.base import Array

# Numbers that stand for "no value": nines, and the ends of whole numbers of 16 and 32 bits
PLACEHOLDERS = (
    *(sign * nines for nines in (999.0, 9999.0, 99999.0, 999999.0) for sign in (-1.0, 1.0)),
    *(32767.0, -32768.0, 65535.0, 2147483647.0, -2147483648.0, 4294967295.0),
)
MIN_MEASURED = 20  # other values, without which their range is not known
# A placeholder lies outside the range of all other values by at least this many of their ranges
MIN_DISTANCE = 1.0


def placeholder_rows(
    values: Array,
) -> dict[float, "np.ndarray[tuple[int, ...], np.dtype[np.bool_]]"]:
    """Return the rows of a column whose number stands for a missing value.

    Two signs are needed: the number is one that loggers use for this, and it lies far outside the
    range of all other values.

    Args:
        values: Values (N,) of a column.

    Returns:
        Number -> mask (N,) of its rows.
    """
    candidates = {}
    for number in PLACEHOLDERS:
        rows = values == number
        if rows.any():
            candidates[number] = rows
    if not candidates:
        return {}
    measured = np.isfinite(values) & ~np.any(list(candidates.values()), axis=0)
    if measured.sum() < MIN_MEASURED:
        return {}
    low, high = float(values[measured].min()), float(values[measured].max())
    margin = max(MIN_DISTANCE * (high - low), 1.0)
    found = {}
    for number, rows in candidates.items():
        if number < low - margin or number > high + margin:
            found[number] = rows
    return found
