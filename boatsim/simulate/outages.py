"""Times at which a sensor gives no reading, at random."""

from math import inf

import numpy as np


class Outages:
    """Outages with exponentially distributed lengths and times between them."""

    def __init__(self, interval: float, length: float, rng: np.random.Generator) -> None:
        """Begin without an outage at t = 0.

        Args:
            interval: Mean time between two outages [s]; 0 for none.
            length: Mean length of an outage [s].
            rng: Random generator of the times.
        """
        self._interval, self._length, self._rng = interval, length, rng
        self._out = False
        self._next = rng.exponential(interval) if interval > 0.0 else inf

    def at(self, t: float) -> bool:
        """Return whether there is an outage at a time, which is not before that of the last call.

        Args:
            t: Time [s].
        """
        while t >= self._next:
            self._out = not self._out
            self._next += self._rng.exponential(self._length if self._out else self._interval)
        return self._out
