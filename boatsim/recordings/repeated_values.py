"""Values that a logger repeats until the next one comes: the repetitions are no measurements."""

import numpy as np
from numpy.typing import NDArray

FEWEST = 10  # fixes from which a rhythm is told from chance
# share of the gaps between fixes that are as long as the usual one, to a row or a tenth
REGULAR = 0.8


def repeats(fixes: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Rows (N,) that repeat the fix (N, C) before them, if new ones come with a rhythm; else none."""
    new = np.append(True, (np.diff(fixes, axis=0) != 0.0).any(axis=1))
    gaps = np.diff(np.flatnonzero(new))
    none = np.zeros(len(fixes), dtype=np.bool_)
    if len(gaps) < FEWEST or (usual := float(np.median(gaps))) < 2.0:
        return none
    regular = np.abs(gaps - usual) <= max(1.0, 0.1 * usual)
    return ~new if regular.mean() >= REGULAR else none
