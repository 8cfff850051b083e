"""Coming to rest on a course: when a signal first crosses it, when it stays, where it ends, how far it still swings."""

from dataclasses import dataclass
from math import degrees, radians
from typing import ClassVar

import numpy as np

from boatsim.errors import BadInput, unknown_name
from boatsim.physics.base import param
from boatsim.recordings.notes import unit_of
from boatsim.recordings.table import Recording
from boatsim.simulate.metric import MetricSet, rows_between, why_not_reached


@dataclass(frozen=True)
class Settling(MetricSet):
    """An angle after an offset or a kick, in the columns of Martin's calm-water tables (1993, appendix VI).

    The end is the mean over the time after `late`: what the source prints as final angle lies near zero for limit
    cycles of 20 deg and more too, which no single last value would.
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
    target: float = param(0.0, low=-100.0, high=100.0, unit="rad", words="the angle to come to")
    band: float = param(
        radians(0.25), low=0.0, high=10.0, unit="rad", words="settled this near the end"
    )
    late: float = param(300.0, low=0.0, high=86400.0, unit="s", words="the end begins")

    def why(self, metric: str, log: Recording) -> str:
        """Where it ends, or that it is over too soon."""
        if log.t[-1] - log.t[0] < self.late:
            return f"the run ends at {log.t[-1] - log.t[0]:.4g} s, before {self.late:g} s, where its end begins"
        return why_not_reached(log[self.signal], self.target, unit_of(self.signal))

    def values(self, log: Recording) -> dict[str, float]:
        """rise: first crossing once off the target; settling: last time out of the band; extremes about the end."""
        if self.signal not in log.signals:
            raise BadInput(unknown_name("settling: signal", self.signal, log.signals))
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
        away = np.maximum.accumulate(np.abs(x) > self.band)  # a start on the target is no crossing
        crossed = np.nonzero(away[:-1] & (x[:-1] * x[1:] < 0.0))[0]
        return found | ({"rise": float(t[crossed[0] + 1])} if len(crossed) else {})
