"""Crash stop: how far and how long a ship runs on after her engines went astern."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from boatsim.base import param
from boatsim.measure import Measure
from boatsim.recording import Recording


@dataclass(frozen=True)
class CrashStop(Measure):
    """Until the ship has no way on; distances in lengths."""

    words: ClassVar[str] = "track, head and side reach and time of a crash stop"
    units: ClassVar = {"track_reach": "L", "head_reach": "L", "side_reach": "L", "time_to_stop": "s"}

    execute: float = param(0.0, low=0.0, high=1e6, unit="s", words="when the engines went astern")
    length: float = param(1.0, low=0.001, high=1e3, unit="m", words="of the ship")

    def values(self, log: Recording) -> dict[str, float]:
        """None if she never stopped."""
        begin = int(np.searchsorted(log.t, self.execute - 1e-9))
        stopped = np.flatnonzero(log["u_mps"][begin:] <= 0.0)
        if not len(stopped):
            return {}
        end = begin + int(stopped[0])
        x, y, psi0 = log["x_m"][begin : end + 1], log["y_m"][begin : end + 1], log["psi_rad"][begin]
        dx, dy = x[-1] - x[0], y[-1] - y[0]
        return {
            "track_reach": float(np.hypot(np.diff(x), np.diff(y)).sum()) / self.length,
            "head_reach": float(np.cos(psi0) * dx + np.sin(psi0) * dy) / self.length,
            "side_reach": float(np.cos(psi0) * dy - np.sin(psi0) * dx) / self.length,
            "time_to_stop": float(log.t[end] - log.t[begin]),
        }
