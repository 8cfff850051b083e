"""Step response: rise and settling times, overshoot and final error."""

from dataclasses import dataclass
from math import inf
from typing import ClassVar

import numpy as np

from boatsim.physics.base import Array, param
from boatsim.recordings.notes import unit_of
from boatsim.recordings.table import Recording
from boatsim.simulate.metric import MetricSet, rows_between

BAND = 0.05  # share of the step within which a signal counts as settled, the usual 5 % criterion


@dataclass(frozen=True)
class StepResponse(MetricSet):
    """Metric set of the step response of a signal: response times, overshoot and final error.

    The step leads from the value at the time `since` to the value `target`. Rows of the log from
    `since` to `until` are evaluated.
    """

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
        0.0, low=-1e9, high=1e9, unit="", words="target value, in the signal's unit"
    )
    since: float = param(0.0, low=0.0, high=1e6, unit="s", words="time of the step")
    until: float = param(
        0.0, low=0.0, high=1e6, unit="s", words="end of the evaluated interval; 0: end of the log"
    )

    def unit(self, metric: str) -> str:
        """Return the unit of a step-response metric; the final value has the unit of the signal."""
        return unit_of(self.signal) if metric == "end" else self.units[metric]

    def explain_missing_value(self, metric: str, log: Recording) -> str:
        """Explain in words why a step response lacks a metric, with the percentage it reached."""
        y = log[self.signal][rows_between(log, self.since, self.until or inf, least=2)]
        if y[0] == self.target:
            target = f"{self.target:.4g} {unit_of(self.signal)}".rstrip()
            return f"there is no step: the signal starts at its target, {target}"
        done = (y - y[0]) / (self.target - y[0])
        if metric == "settle":
            error = 100.0 * abs(done[-1] - 1.0)
            return f"final error {error:.3g} % of the step; settled means {100.0 * BAND:g} %"
        return f"made at most {100.0 * done.max():.3g} % of the step"

    def values(self, log: Recording) -> dict[str, float]:
        """Return response times, overshoot and final error of a signal's step response in a log.

        Times count from the step and are interpolated between rows; overshoot and error are in % of
        the step. `rise` is the time from 10 to 90 %, `settle` that until the signal stays within 5
        %.

        Args:
            log: Log of the run.
        """
        rows = rows_between(log, self.since, self.until or inf, least=2)
        t, y = log.t[rows] - self.since, log[self.signal][rows]
        if y[0] == self.target:  # no step
            return {"end": float(y[-1])}
        done = (y - y[0]) / (self.target - y[0])
        found = {f"time_{share}": time_to_fraction(t, done, 0.01 * share) for share in (50, 90, 95)}
        found["time_63"] = time_to_fraction(t, done, 1.0 - np.exp(-1.0))
        found["rise"] = rise_time(t, done)
        found["settle"] = settling_time(t, done)
        errors = {
            "overshoot": 100.0 * float(max(done.max() - 1.0, 0.0)),
            "end_error": 100.0 * float(1.0 - done[-1]),
        }
        return (
            {name: time for name, time in found.items() if time is not None}
            | errors
            | {"end": float(y[-1])}
        )


def time_to_fraction(t: Array, done: Array, share: float) -> float | None:
    """Return the time at which a step response first reaches a given fraction of the step.

    None if it never does.

    Args:
        t: Times (N,) since the step [s].
        done: Fraction of the step (N,) reached at these times.
        share: The fraction, such as 0.9.
    """
    beyond = np.nonzero(done >= share)[0]
    if len(beyond) == 0:
        return None
    i = max(int(beyond[0]), 1)
    return float(np.interp(share, done[i - 1 : i + 1], t[i - 1 : i + 1]))


def rise_time(t: Array, done: Array) -> float | None:
    """Return the rise time of a step response, from 10 to 90 % of the step.

    None if the signal does not reach 90 %.

    Args:
        t: Times (N,) since the step [s].
        done: Fraction of the step (N,) reached at these times.
    """
    tenth = time_to_fraction(t, done, 0.1)
    most = time_to_fraction(t, done, 0.9)
    if tenth is None or most is None:
        return None
    return most - tenth


def settling_time(t: Array, done: Array) -> float | None:
    """Return the time from which a step response stays within 5 % of its target, or None.

    Args:
        t: Times (N,) since the step [s].
        done: Fraction of the step (N,) reached at these times.
    """
    outside = np.nonzero(abs(done - 1.0) > BAND)[0]
    if len(outside) == 0:
        return 0.0
    if (i := int(outside[-1])) == len(t) - 1:
        return None
    off = abs(done[i : i + 2] - 1.0)
    return float(np.interp(-BAND, -off, t[i : i + 2]))
