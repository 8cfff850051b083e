"""Turning circle: advance, transfer, tactical diameter and steady turn (ITTC 7.5-04-02-01)."""

from dataclasses import dataclass
from math import pi
from typing import ClassVar

import numpy as np

from boatsim.physics.base import param
from boatsim.recordings.table import Recording
from boatsim.simulate.metric import MetricSet, rows_between, value_at


@dataclass(frozen=True)
class TurningCircle(MetricSet):
    """Metric set of a turning circle: advance, transfer, tactical diameter and steady turn.

    Distances are in ship lengths, along and across the approach course, from the position at which
    the helm was put over.
    """

    words: ClassVar[str] = (
        "advance, transfer, tactical diameter and steady turn of a turning circle"
    )
    units: ClassVar = {
        "advance": "L",
        "transfer": "L",
        "tactical_diameter": "L",
        "steady_radius": "L",
        "steady_speed": "m/s",
        "steady_rate": "deg/s",
        "steady_drift": "deg",
        "time_to_90": "s",
    }

    execute: float = param(
        0.0, low=0.0, high=1e6, unit="s", words="time at which the helm is put over"
    )
    course: float = param(
        -1.0,
        low=-1.0,
        high=1e6,
        unit="s",
        words="time that defines the approach course; below 0: execute",
    )
    length: float = param(1.0, low=0.001, high=1e3, unit="m", words="length of the ship")

    def explain_missing_value(self, metric: str, log: Recording) -> str:
        """Explain in words that a turning circle is incomplete, with its largest heading change."""
        needed = 90 if metric in ("advance", "transfer", "time_to_90") else 180
        line = self.execute if self.course < 0.0 else self.course
        turned = np.degrees(np.abs(log["psi_rad"] - value_at(log, line, "psi_rad")).max())
        return f"never turned {needed} deg: at most {turned:.3g}"

    def values(self, log: Recording) -> dict[str, float]:
        """Return the metrics of a turning circle, as far as the turn got, from the log of a run.

        Advance and transfer need a heading change of 90 degrees, the tactical diameter and the
        steady turn one of 180 degrees.
        """
        rows_between(log)
        line = self.execute if self.course < 0.0 else self.course
        psi0 = value_at(log, line, "psi_rad")
        c, s = np.cos(psi0), np.sin(psi0)
        ahead = c * (log["x_m"] - value_at(log, self.execute, "x_m")) + s * (
            log["y_m"] - value_at(log, self.execute, "y_m")
        )
        aside = c * (log["y_m"] - value_at(log, line, "y_m")) - s * (
            log["x_m"] - value_at(log, line, "x_m")
        )
        side = float(np.sign(log["psi_rad"][-1] - psi0))
        turned = side * (log["psi_rad"] - psi0)
        found = {}
        if turned.max() >= pi / 2:
            found = {
                "advance": _value_at_heading_change(pi / 2, turned, ahead) / self.length,
                "transfer": side * _value_at_heading_change(pi / 2, turned, aside) / self.length,
                "time_to_90": _value_at_heading_change(pi / 2, turned, log.t) - self.execute,
            }
        if turned.max() >= pi:
            u, v, r = (float(log[n][-1]) for n in ("u_mps", "v_mps", "r_radps"))
            speed = float(np.hypot(u, v))
            found |= {
                "tactical_diameter": side
                * _value_at_heading_change(pi, turned, aside)
                / self.length,
                "steady_radius": speed / abs(r) / self.length,
                "steady_speed": speed,
                "steady_rate": abs(float(np.degrees(r))),
                "steady_drift": side * float(np.degrees(np.arctan2(-v, u))),
            }
        return found


def _value_at_heading_change(angle: float, turned: np.ndarray, values: np.ndarray) -> float:
    """Value of a signal when the heading change first reaches an angle, interpolated."""
    i = int(np.argmax(turned >= angle))
    share = (angle - turned[i - 1]) / (turned[i] - turned[i - 1])
    return float(values[i - 1] + share * (values[i] - values[i - 1]))
