"""Levels: where a signal comes to rest under commands that are held one after the other."""

from dataclasses import dataclass
from typing import ClassVar

from boatsim.physics.base import param
from boatsim.recordings.notes import unit_of
from boatsim.recordings.table import Recording
from boatsim.simulate.metric import MetricSet, rows_between

MOST = 12  # levels


@dataclass(frozen=True)
class Levels(MetricSet):
    """The signal at the end of every interval of `every` s."""

    words: ClassVar[str] = "value of a signal at the end of each interval"
    units: ClassVar = {f"level_{i}": "" for i in range(1, MOST + 1)}

    signal: str = "u_mps"
    every: float = param(10.0, low=1e-3, high=1e6, unit="s", words="length of an interval")

    def unit(self, metric: str) -> str:
        """That of the signal."""
        return unit_of(self.signal)

    def why(self, metric: str, log: Recording) -> str:
        """How many intervals there were."""
        return f"the run ends at {log.t[-1]:.4g} s, after {int((log.t[-1] + 1e-6) / self.every)} intervals"

    def values(self, log: Recording) -> dict[str, float]:
        """Of as many whole intervals as the log has."""
        rows_between(log)
        ends = [i * self.every for i in range(1, MOST + 1) if i * self.every <= log.t[-1] + 1e-6]
        rows = [int(abs(log.t - end).argmin()) for end in ends]
        return {f"level_{i}": float(log[self.signal][row]) for i, row in enumerate(rows, 1)}
