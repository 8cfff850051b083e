"""Time at which a signal crosses a level."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from boatsim.physics.base import param
from boatsim.recordings.notes import unit_of
from boatsim.recordings.table import Recording
from boatsim.simulate.metric import MetricSet, describe_closest_value


@dataclass(frozen=True)
class Crossing(MetricSet):
    """Metric set with one time: when a signal first crosses a level, upwards or downwards.

    The search starts at the time `since`, from which the result counts.
    """

    words: ClassVar[str] = "time until a signal first passes a level"
    units: ClassVar = {"time": "s"}

    signal: str = "u_mps"
    level: float = param(0.0, low=-1e9, high=1e9, unit="", words="in the signal's unit")
    since: float = param(
        0.0, low=0.0, high=1e6, unit="s", words="start of the search, from which the time counts"
    )

    def explain_missing_value(self, metric: str, log: Recording) -> str:
        """Explain in words that a signal never crossed its level, with its closest value."""
        return describe_closest_value(
            log[self.signal][log.t >= self.since - 1e-9], self.level, unit_of(self.signal)
        )

    def values(self, log: Recording) -> dict[str, float]:
        """Return the time at which a signal of the log crosses a level, interpolated between rows.

        The result is empty if the signal never crosses the level.
        """
        seen = log.t >= self.since - 1e-9
        t, above = log.t[seen] - self.since, log[self.signal][seen] - self.level
        passed = np.nonzero(above[:-1] * above[1:] <= 0.0)[0]
        if len(passed) == 0:
            return {}
        i = int(passed[0])
        drop = above[i] - above[i + 1] or 1.0
        return {"time": float(t[i] + (t[i + 1] - t[i]) * above[i] / drop)}
