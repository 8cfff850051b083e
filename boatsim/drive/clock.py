"""Keeps a run at real time and counts the control periods that start late."""

import time
from collections.abc import Callable

from boatsim.simulate.real_time_pace import Pace

# Delay, as a share of the control period, from which a control step counts as late: beyond half a
# period the commands belong to the next period rather than to their own.
LATE = 0.5


class Clock(Pace):
    """Real-time clock of a run with a driver, with statistics of control periods that start late.

    Attributes:
        period: Control period [s].
        periods: Number of control periods so far.
        late: Number of periods that started late.
        worst: Largest delay of the start of a period [s].
        began: Unix time at simulated time 0 [s]; None before the run.
    """

    def __init__(self, period: float) -> None:
        """Create a clock.

        Args:
            period: Control period [s].
        """
        super().__init__(1.0)
        self.period = period
        self.periods = 0
        self.late = 0
        self.worst = 0.0
        self.began: float | None = None
        self._due = period  # The first control step comes before the clock starts.

    def wait_until(self, t: float, stop: Callable[[], bool] = bool) -> None:
        """Wait until a simulated time is due in real time; measure how late a control step starts.

        Args:
            t: Simulated time [s].
            stop: Returns whether to stop waiting.
        """
        if self.began is None:
            self.began = time.time() - t
        before = self.seconds_behind(t)  # before `wait_until` resets a clock that is far behind
        super().wait_until(t, stop)
        if t < self._due - 1e-9:
            return
        self._due += self.period
        delay = max(before, self.seconds_behind(t))
        self.periods += 1
        self.late += delay > LATE * self.period
        self.worst = max(self.worst, delay)
