"""The resolution to which the values of a log are written, as a power of ten."""

import numpy as np

from boatsim.physics.base import Array

# largest second difference of a straight line in units of the last digit: three rounded values
ROUNDED_DIGITS = 2.1
TOLERANCE = 1e-3  # of a multiple of the last digit, in units of it: floats are not decimal


def decimal_step(values: Array, most_decimals: int) -> float:
    """Return the largest power of ten below 1 of which all values are multiples.

    Args:
        values: Values (N,).
        most_decimals: Number of decimals of the smallest power of ten that is tried.

    Returns:
        The power of ten; 0 if there is none.
    """
    for decimals in range(1, most_decimals + 1):
        unit = 10.0**-decimals
        if np.abs(values / unit - np.round(values / unit)).max() < TOLERANCE:
            return float(unit)
    return 0.0
