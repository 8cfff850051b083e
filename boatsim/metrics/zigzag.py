"""Zig-zag test: overshoot angles, their times, and the first reversal (ITTC 7.5-04-02-01)."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from boatsim.physics.base import param
from boatsim.recordings.table import Recording
from boatsim.simulate.metric import MetricSet, distance_travelled, rows_between

COUNT = ("first", "second", "third")


@dataclass(frozen=True)
class Zigzag(MetricSet):
    """Metric set of a zig-zag test: overshoot angles, and time and track to the first reversal.

    An overshoot is the largest heading change after a helm reversal minus the heading change at
    which the helm is reversed.
    """

    words: ClassVar[str] = "overshoots of a zig-zag and the track to the first reversal"
    units: ClassVar = {
        **{f"{n}_overshoot": "deg" for n in COUNT},
        **{f"{n}_overshoot_at": "s" for n in COUNT},
        "time_to_reversal": "s",
        "track_to_reversal": "L",
    }

    execute: float = param(
        0.0, low=0.0, high=1e6, unit="s", words="time at which the helm is first put over"
    )
    heading: float = param(
        0.175, low=0.001, high=3.0, unit="rad", words="heading change at which the helm is reversed"
    )
    length: float = param(1.0, low=0.001, high=1e3, unit="m", words="length of the ship")

    def explain_missing_value(self, metric: str, log: Recording) -> str:
        """Explain in words that a zig-zag is incomplete: its reversals and heading change."""
        count = int((np.diff(np.sign(log["reference_helm_rad"])) != 0.0).sum()) - 1
        turned = np.degrees(np.abs(log["psi_rad"] - log["psi_rad"][0]).max())
        reversals = f"{max(count, 0)} reversals of the helm"
        return f"{reversals}; the heading changed by at most {turned:.3g} deg"

    def values(self, log: Recording) -> dict[str, float]:
        """Return the overshoots of a zig-zag test after each completed helm reversal.

        The times of the overshoots, and the time and track up to the first reversal are returned
        too.
        """
        rows_between(log)
        helm, psi = log["reference_helm_rad"], log["psi_rad"] - log["psi_rad"][0]
        reversals = 1 + np.flatnonzero(np.sign(helm[1:]) * np.sign(helm[:-1]) < 0.0)
        if not len(reversals):
            return {}
        # rows between which the reversal heading was reached
        last = slice(reversals[0] - 1, reversals[0] + 1)
        reached = float(np.interp(self.heading, np.sign(helm[last][0]) * psi[last], log.t[last]))
        travelled = np.interp([self.execute, reached], log.t, distance_travelled(log))
        found = {
            "time_to_reversal": reached - self.execute,
            "track_to_reversal": float(travelled[1] - travelled[0]) / self.length,
        }
        for name, start, end in zip(COUNT, reversals, reversals[1:], strict=False):
            part = float(np.sign(helm[start - 1])) * psi[start : end + 1]
            row = int(np.argmax(part))
            found[f"{name}_overshoot"] = float(np.degrees(part[row] - self.heading))
            found[f"{name}_overshoot_at"] = float(log.t[start + row] - self.execute)
        return found
