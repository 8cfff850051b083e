"""Crash stop: distances and time from full astern until the ship has stopped."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from boatsim.physics.base import param
from boatsim.recordings.table import Recording
from boatsim.simulate.metric import MetricSet, distance_travelled, value_at


@dataclass(frozen=True)
class CrashStop(MetricSet):
    """Metric set of a crash stop: time and distances until the surge speed is zero.

    Distances are in ship lengths.
    """

    words: ClassVar[str] = "track, head and side reach and time of a crash stop"
    units: ClassVar = {
        "track_reach": "L",
        "head_reach": "L",
        "side_reach": "L",
        "time_to_stop": "s",
    }

    execute: float = param(0.0, low=0.0, high=1e6, unit="s", words="time of the order full astern")
    length: float = param(1.0, low=0.001, high=1e3, unit="m", words="length of the ship")

    def explain_missing_value(self, metric: str, log: Recording) -> str:
        """Explain in words that a ship did not stop in a crash stop, with its lowest speed."""
        u = log["u_mps"]
        slowest = u[log.t > self.execute].min(initial=u[-1])
        return f"never stopped: lowest speed {slowest:.4g} m/s ahead"

    def values(self, log: Recording) -> dict[str, float]:
        """Return track, head and side reach and time of a crash stop from the log of a run.

        The result is empty if the ship never stopped.
        """
        stopped = np.flatnonzero((log.t > self.execute) & (log["u_mps"] <= 0.0))
        if not len(stopped):
            return {}
        rows = [int(stopped[0]), int(stopped[0]) - 1]
        end = float(np.interp(0.0, log["u_mps"][rows], log.t[rows]))
        psi0 = value_at(log, self.execute, "psi_rad")
        dx, dy = (
            value_at(log, end, name) - value_at(log, self.execute, name) for name in ("x_m", "y_m")
        )
        travelled = np.interp([self.execute, end], log.t, distance_travelled(log))
        return {
            "track_reach": float(travelled[1] - travelled[0]) / self.length,
            "head_reach": float(np.cos(psi0) * dx + np.sin(psi0) * dy) / self.length,
            "side_reach": float(np.cos(psi0) * dy - np.sin(psi0) * dx) / self.length,
            "time_to_stop": end - self.execute,
        }
