"""Headings that a logger interpolated across the jump from a full turn to zero.

Linear interpolation of an angle between 359 and 1 degrees gives 270, 180 and 90 degrees: directions
to which the vessel never pointed. Such rows are not measurements.
"""

import numpy as np
from numpy.typing import NDArray

from boatsim.physics.base import Array

# phrase in a remark, by which the finding recognizes it
ACROSS_WRAP = (
    "lie between both ends of the circle, interpolated across a full turn, and are not used"
)
TURN = 2.0 * np.pi
USUAL_QUANTILE = 0.9  # of the steps between rows; a vessel may turn in few rows only
LARGE = 6.0  # times the usual step: a step that is no motion
MIN_STEP = 0.05  # [rad] smaller steps are not examined
MAX_MISFIT = 0.6  # [rad] by which the steps of one wrap together may differ from a full turn
MAX_ROWS = 60  # of one wrap


def interpolated_wrap_rows(angle: Array, turn: float = TURN) -> NDArray[np.bool_]:
    """Return which rows of an angle lie between both ends of the circle by interpolation.

    An angle within one turn jumps by a full turn in one step. Here several steps in one direction,
    each far larger than usual, add up to a full turn. The rows between them, and one row on each
    side that may lie between two samples too, are no measurements.

    Args:
        angle: Angle (N,) as written, not unwrapped.
        turn: A full turn in the unit of the angle.

    Returns:
        True (N,) for rows that are not measured.
    """
    rows = np.zeros(len(angle), dtype=np.bool_)
    known = np.flatnonzero(np.isfinite(angle))
    values = angle[known] * (TURN / turn)
    if len(values) < 4 or np.ptp(values) > 1.01 * TURN or np.ptp(values) < 0.8 * TURN:
        return rows
    steps = np.diff(values)
    short = np.abs(np.remainder(steps + np.pi, TURN) - np.pi)
    usual = float(np.quantile(np.minimum(np.abs(steps), short), USUAL_QUANTILE))
    limit = max(LARGE * usual, MIN_STEP)
    large = np.abs(steps) > limit
    for begin, end in _groups(large, np.sign(steps)):
        total = abs(float(values[end + 1] - values[begin]))
        is_wrap = abs(total - TURN) < MAX_MISFIT
        if end > begin and is_wrap and end - begin < MAX_ROWS:
            rows[known[begin : end + 2]] = True
    return rows


def empty_across_wrap(angle: Array) -> NDArray[np.bool_]:
    """Return which rows of an angle are empty between two that lie about a full turn apart.

    Args:
        angle: Angle (N,) [rad] as written, not unwrapped; nan where it is empty.

    Returns:
        True (N,) for these rows.
    """
    known = np.flatnonzero(np.isfinite(angle))
    rows = np.zeros(len(angle), dtype=np.bool_)
    jumps = np.abs(np.diff(angle[known])) > 0.5 * TURN
    for before, after in zip(known[:-1][jumps], known[1:][jumps], strict=True):
        rows[before + 1 : after] = True
    return rows


def _groups(large: NDArray[np.bool_], sign: Array) -> list[tuple[int, int]]:
    """First and last step of the groups of neighbouring large steps in one direction."""
    found = list[tuple[int, int]]()
    for k in np.flatnonzero(large).tolist():
        if found and found[-1][1] == k - 1 and sign[k] == sign[k - 1]:
            found[-1] = (found[-1][0], k)
        else:
            found.append((k, k))
    return found


def without_interpolated_wraps(angle: Array) -> tuple[Array, int]:
    """Return an angle (N,) [rad] without rows that were interpolated across a full turn.

    Those rows are nan, which is not measured.

    Args:
        angle: Angle (N,) [rad] as written.

    Returns:
        The angle, and the number of rows that are not used.
    """
    rows = interpolated_wrap_rows(angle)
    return np.where(rows, np.nan, angle), int(rows.sum())
