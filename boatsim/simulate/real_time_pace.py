"""Holds a run back so that somebody can watch it."""

import time
from collections.abc import Callable

# [s] by which a run may be late and still catch up; one that is later goes on from where it is
BEHIND = 0.25
NAP = 0.05  # [s] at most between two questions whether to stop


class Pace:
    """Waits until the clock has come as far as the run, so many times as fast as real time."""

    def __init__(
        self,
        speed: float,
        clock: Callable[[], float] = time.monotonic,
        sleep: Callable[[float], None] = time.sleep,
    ) -> None:
        """`speed` is simulated seconds a second, more than 0; the clock begins with the first wait."""
        self.speed, self._clock, self._sleep = speed, clock, sleep
        self._begin: float | None = None  # when the simulated time 0 was

    def behind(self, t: float) -> float:
        """How long ago the simulated time `t` [s] was due [s]; 0 before the clock begins."""
        return 0.0 if self._begin is None else self._clock() - self._begin - t / self.speed

    def wait(self, t: float, stop: Callable[[], bool] = bool) -> None:
        """Return when the simulated time `t` [s] is due, or at once if it is over or somebody wants to `stop`."""
        due = t / self.speed
        if self._begin is None or self.behind(t) > BEHIND:
            self._begin = self._clock() - due
        while (ahead := self._begin + due - self._clock()) > 0.0 and not stop():
            self._sleep(min(ahead, NAP))
