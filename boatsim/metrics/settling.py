"""Settling of an angle: first crossing, settling time, final value and remaining oscillation."""

from dataclasses import dataclass
from math import degrees, radians
from typing import ClassVar

import numpy as np

from boatsim.errors import BadInput, unknown_name_message
from boatsim.physics.base import param
from boatsim.recordings.notes import unit_of
from boatsim.recordings.table import Recording
from boatsim.simulate.metric import MetricSet, describe_closest_value, rows_between


@dataclass(frozen=True)
class Settling(MetricSet):
    """Metric set of an angle that settles after an offset or an impulse.

    It follows Martin (1993), appendix VI. The final angle is the mean over the time after `late`:
    the source prints final angles near zero also for limit cycles of 20 deg and more, whose last
    values would differ from zero.
    """

    words: ClassVar[str] = "first crossing, settling time, end and late extremes of an angle"
    units: ClassVar = {
        "rise": "s",
        "settling": "s",
        "final": "deg",
        "lowest": "deg",
        "highest": "deg",
    }

    signal: str = "psi_rad"
    target: float = param(0.0, low=-100.0, high=100.0, unit="rad", words="target angle")
    band: float = param(
        radians(0.25), low=0.0, high=10.0, unit="rad", words="band about the final angle"
    )
    late: float = param(300.0, low=0.0, high=86400.0, unit="s", words="start of the final interval")

    def explain_missing_value(self, metric: str, log: Recording) -> str:
        """Explain in words why an angle has no settling metrics: a short run, or a missed target.

        For an angle that never crossed its target the text contains the closest value.
        """
        if log.t[-1] - log.t[0] < self.late:
            end = log.t[-1] - log.t[0]
            return f"the run ends at {end:.4g} s, before the final interval from {self.late:g} s"
        return describe_closest_value(log[self.signal], self.target, unit_of(self.signal))

    def values(self, log: Recording) -> dict[str, float]:
        """Return how an angle settles in a log: crossing, settling time and final oscillation.

        The metrics are the time of the first crossing of the target, the time after which the angle
        stays in a band about its final mean, that mean relative to the target, and the lowest and
        highest deviation from it in the final interval.
        """
        if self.signal not in log.signals:
            raise BadInput(unknown_name_message("settling: signal", self.signal, log.signals))
        rows_between(log)
        t, x = log.t - log.t[0], log[self.signal] - self.target
        if not (t >= self.late).any():
            return {}
        end = x[t >= self.late]
        off = np.nonzero(np.abs(x - end.mean()) > self.band)[0]
        found = {
            "settling": float(t[min(off[-1] + 1, len(t) - 1)]) if len(off) else 0.0,
            "final": degrees(end.mean()),
            "lowest": degrees(end.min() - end.mean()),
            "highest": degrees(end.max() - end.mean()),
        }
        # A start on the target is not a crossing.
        away = np.maximum.accumulate(np.abs(x) > self.band)
        crossed = np.nonzero(away[:-1] & (x[:-1] * x[1:] < 0.0))[0]
        if len(crossed):
            found["rise"] = float(t[crossed[0] + 1])
        return found
