"""Zig-zag with large heading changes: times of helm reversals, and extremes of the motion."""

from dataclasses import dataclass
from math import degrees
from typing import ClassVar

import numpy as np

from boatsim.physics.base import param
from boatsim.recordings.table import Recording
from boatsim.simulate.metric import MetricSet, rows_between

REVERSALS = 4


@dataclass(frozen=True)
class ZigzagSwings(MetricSet):
    """Metric set of a zig-zag with large heading changes: reversal times and motion extremes.

    Reversals are those of the command channel `signal`. The largest roll needs a vessel that rolls.
    """

    words: ClassVar[str] = (
        "times of helm reversals and largest heading, yaw rate, roll, sway and speed of a zig-zag"
    )
    units: ClassVar = {f"reversal_{i}": "s" for i in range(1, REVERSALS + 1)} | {
        "period": "s",
        "heading": "deg",
        "yaw_rate": "deg/s",
        "roll": "deg",
        "sway": "m/s",
        "speed": "m/s",
        "slowest": "m/s",
    }

    signal: str = "jet_rad"
    since: float = param(0.0, low=0.0, high=1e6, unit="s", words="start of the evaluated interval")

    def explain_missing_value(self, metric: str, log: Recording) -> str:
        """Explain in words why a zig-zag metric is missing: few reversals, or no such motion."""
        if metric in ("roll", "heading", "yaw_rate"):
            return "this craft has no such motion"
        count = int((np.diff(np.sign(log[self.signal][rows_between(log, self.since)])) != 0).sum())
        return f"{count} reversals of {self.signal}"

    def values(self, log: Recording) -> dict[str, float]:
        """Return the rudder's reversal times, the period and the largest motions of a zig-zag test.

        The period is the mean from the first reversal to the last. The extremes are those of
        heading, yaw rate, roll, sway and surge speed.
        """
        rows = rows_between(log, self.since)
        t, helm = log.t[rows], log[self.signal][rows]
        at = t[1:][np.diff(np.sign(helm)) != 0] - self.since
        found = {f"reversal_{i}": float(time) for i, time in enumerate(at[:REVERSALS], 1)}
        if len(at) > 2:
            found["period"] = float(at[-1] - at[0]) / (len(at) - 1) * 2.0
        angles = {"heading": "psi_rad", "yaw_rate": "r_radps", "roll": "phi_rad"}
        for name, signal in angles.items():
            if signal in log.signals:
                found[name] = degrees(float(np.abs(log[signal][rows]).max()))
        u = log["u_mps"][rows]
        return found | {
            "sway": float(np.abs(log["v_mps"][rows]).max()),
            "speed": float(u.max()),
            "slowest": float(u.min()),
        }
