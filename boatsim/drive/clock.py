"""Keeps a run at the pace of the clock and counts the control periods that began late."""

import time
from collections.abc import Callable

from boatsim.simulate.real_time_pace import Pace

LATE = 0.5  # share of a period by which its control may begin behind its time


class Clock(Pace):
    """Real time for a controller with a period [s]."""

    def __init__(self, period: float) -> None:
        super().__init__(1.0)
        self.period = period
        self.late = self.periods = 0  # how many began late, and how many there were
        self.worst = 0.0  # [s] behind its time
        self.began: float | None = None  # when the simulated time 0 was [s since 1970]
        self._due = period  # the first control comes before the clock begins

    def wait(self, t: float, stop: Callable[[], bool] = bool) -> None:
        """Return when `t` [s] is due; where control is due too, see how late it is."""
        if self.began is None:
            self.began = time.time() - t
        before = self.behind(t)  # one that is far behind sets the clock back
        super().wait(t, stop)
        if t < self._due - 1e-9:
            return
        self._due += self.period
        behind = max(before, self.behind(t))
        self.periods += 1
        self.late += behind > LATE * self.period
        self.worst = max(self.worst, behind)
