"""Values of a signal at all rows, from those that were measured."""

import numpy as np

from boatsim.physics.base import Array


def filled(t: Array, values: Array) -> Array:
    """Return the values of a signal, interpolated where they were not measured.

    Args:
        t: Times (N,) [s] of the rows, increasing.
        values: Values (N,); nan where none was measured, but at least one was.
    """
    known = np.isfinite(values)
    return np.interp(t, t[known], values[known])
