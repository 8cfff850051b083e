"""Levels: values of a signal at the ends of intervals with constant commands."""

from dataclasses import dataclass
from typing import ClassVar

from boatsim.physics.base import param
from boatsim.recordings.notes import unit_of
from boatsim.recordings.table import Recording
from boatsim.simulate.metric import MetricSet, rows_between

MOST_LEVELS = 12


@dataclass(frozen=True)
class Levels(MetricSet):
    """Metric set with the values of a signal at the ends of consecutive intervals of equal length.

    The length of an interval is `every` [s].
    """

    words: ClassVar[str] = "value of a signal at the end of each interval"
    units: ClassVar = {f"level_{i}": "" for i in range(1, MOST_LEVELS + 1)}

    signal: str = "u_mps"
    every: float = param(10.0, low=1e-3, high=1e6, unit="s", words="length of an interval")

    def unit(self, metric: str) -> str:
        """Return the unit of the metrics, which is that of the sampled signal."""
        return unit_of(self.signal)

    def explain_missing_value(self, metric: str, log: Recording) -> str:
        """Explain in words that a run ended before an interval did, with its complete intervals."""
        complete = int((log.t[-1] + 1e-6) / self.every)
        return f"the run ends at {log.t[-1]:.4g} s, after {complete} intervals"

    def values(self, log: Recording) -> dict[str, float]:
        """Return the value of a signal of the log at the end of each complete interval."""
        rows_between(log)
        found = {}
        for i in range(1, MOST_LEVELS + 1):
            end = i * self.every
            if end <= log.t[-1] + 1e-6:
                row = int(abs(log.t - end).argmin())
                found[f"level_{i}"] = float(log[self.signal][row])
        return found
