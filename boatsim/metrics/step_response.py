"""Step response: how a signal answers a step of what is wanted of it."""

from dataclasses import dataclass
from math import inf
from typing import ClassVar

import numpy as np

from boatsim.physics.base import Array, param
from boatsim.recordings.notes import unit_of
from boatsim.recordings.table import Recording
from boatsim.simulate.metric import MetricSet, rows_between

BAND = 0.05  # of the step: what counts as settled


@dataclass(frozen=True)
class StepResponse(MetricSet):
    """From the time of the step to `until`; the step leads from where the signal then is to `target`."""

    words: ClassVar[str] = "times of a step response, its overshoot and its end error"
    units: ClassVar = {
        "time_50": "s",
        "time_63": "s",
        "time_90": "s",
        "time_95": "s",
        "rise": "s",
        "settle": "s",
        "overshoot": "%",
        "end_error": "%",
        "end": "",
    }

    signal: str = "psi_rad"
    target: float = param(
        0.0, low=-1e9, high=1e9, unit="", words="value wanted, in the signal's unit"
    )
    since: float = param(0.0, low=0.0, high=1e6, unit="s", words="time of the step")
    until: float = param(
        0.0, low=0.0, high=1e6, unit="s", words="end of what is looked at; 0: of the log"
    )

    def unit(self, metric: str) -> str:
        """The value at the end has the signal's unit."""
        return unit_of(self.signal) if metric == "end" else self.units[metric]

    def why(self, metric: str, log: Recording) -> str:
        """How much of the step it made."""
        y = log[self.signal][rows_between(log, self.since, self.until or inf, least=2)]
        if y[0] == self.target:
            return f"there is no step: it begins at its target, {self.target:.4g} {unit_of(self.signal)}".rstrip()
        done = (y - y[0]) / (self.target - y[0])
        if metric == "settle":
            return f"ends {100.0 * abs(done[-1] - 1.0):.3g} % of the step off; settled is {100.0 * BAND:g} %"
        return f"made at most {100.0 * done.max():.3g} % of the step"

    def values(self, log: Recording) -> dict[str, float]:
        """Times from the step on, interpolated between rows; `rise` from 10 to 90 %; errors in per cent of the step."""
        rows = rows_between(log, self.since, self.until or inf, least=2)
        t, y = log.t[rows] - self.since, log[self.signal][rows]
        if y[0] == self.target:  # no step
            return {"end": float(y[-1])}
        done = (y - y[0]) / (self.target - y[0])
        found = {f"time_{share}": first(t, done, 0.01 * share) for share in (50, 90, 95)}
        found["time_63"] = first(t, done, 1.0 - np.exp(-1.0))
        begun = first(t, done, 0.1)
        found["rise"] = (
            found["time_90"] - begun if found["time_90"] is not None and begun is not None else None
        )
        found["settle"] = settled(t, done)
        errors = {
            "overshoot": 100.0 * float(max(done.max() - 1.0, 0.0)),
            "end_error": 100.0 * float(1.0 - done[-1]),
        }
        return (
            {name: time for name, time in found.items() if time is not None}
            | errors
            | {"end": float(y[-1])}
        )


def first(t: Array, done: Array, share: float) -> float | None:
    """When the signal first has this share of its step behind it."""
    beyond = np.nonzero(done >= share)[0]
    if len(beyond) == 0:
        return None
    i = max(int(beyond[0]), 1)
    return float(np.interp(share, done[i - 1 : i + 1], t[i - 1 : i + 1]))


def settled(t: Array, done: Array) -> float | None:
    """When the signal last comes into the band about its target; none if it is outside at the end."""
    outside = np.nonzero(abs(done - 1.0) > BAND)[0]
    if len(outside) == 0:
        return 0.0
    if (i := int(outside[-1])) == len(t) - 1:
        return None
    off = abs(done[i : i + 2] - 1.0)
    return float(np.interp(-BAND, -off, t[i : i + 2]))
