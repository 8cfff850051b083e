"""Holds a run back to the pace of a clock, so that it can be watched or driven."""

import time
from collections.abc import Callable

# [s] of delay that a run catches up with; after a longer one the clock is set back
BEHIND = 0.25
NAP = 0.05  # [s] of sleep at most before `stop` is asked again


class Pace:
    """Slows a simulation down to a clock, at a multiple of real time.

    Attributes:
        speed: Ratio of simulated time and real time.
    """

    def __init__(
        self,
        speed: float,
        clock: Callable[[], float] = time.monotonic,
        sleep: Callable[[float], None] = time.sleep,
    ) -> None:
        """Prepare; the clock starts at the first wait.

        Args:
            speed: Simulated time by real time, more than 0.
            clock: Returns the real time [s].
            sleep: Waits for a time [s].
        """
        self.speed, self._clock, self._sleep = speed, clock, sleep
        self._begin: float | None = None  # real time [s] of the simulated time 0

    def seconds_behind(self, t: float) -> float:
        """Return by how much a simulation is behind the clock at the simulated time `t` [s], in s.

        The result is 0 before the first wait.
        """
        if self._begin is None:
            return 0.0
        return self._clock() - self._begin - t / self.speed

    def wait_until(self, t: float, stop: Callable[[], bool] = bool) -> None:
        """Wait until the clock reaches a simulated time.

        Args:
            t: The simulated time [s].
            stop: Ends the wait when it returns True.
        """
        due = t / self.speed
        if self._begin is None or self.seconds_behind(t) > BEHIND:
            self._begin = self._clock() - due
        while (ahead := self._begin + due - self._clock()) > 0.0 and not stop():
            self._sleep(min(ahead, NAP))
