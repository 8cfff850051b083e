"""Detection of values that a logger repeats until the next measurement."""

import numpy as np
from numpy.typing import NDArray

MIN_GAPS = 10  # fewer gaps between new values do not show a regular period
# Share of the gaps that must be as long as the median one, to a row or a tenth
MIN_REGULAR_SHARE = 0.8


def repeated_rows(fixes: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Return a mask (N,) of the rows in which a logger repeated measured values (N, C).

    Rows count as repeated only if new values come at a regular period.
    """
    new = np.append(True, (np.diff(fixes, axis=0) != 0.0).any(axis=1))
    gaps = np.diff(np.flatnonzero(new))
    none = np.zeros(len(fixes), dtype=np.bool_)
    if len(gaps) < MIN_GAPS or (usual := float(np.median(gaps))) < 2.0:
        return none
    regular = np.abs(gaps - usual) <= max(1.0, 0.1 * usual)
    if regular.mean() < MIN_REGULAR_SHARE:
        return none
    return ~new
