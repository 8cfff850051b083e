"""Roll decay: period, and damping as a share of the critical one from successive peaks, large ones and small ones."""

from dataclasses import dataclass
from itertools import pairwise
from math import degrees, pi, sqrt
from math import log as ln
from typing import ClassVar

import numpy as np

from boatsim.recordings.table import Recording
from boatsim.simulate.metric import MetricSet, rows_between

SMALLEST = 0.02  # share of the release below which peaks are left out


@dataclass(frozen=True)
class RollDecay(MetricSet):
    """Peaks to both sides; the logarithmic decrement of half a swing is pi zeta / sqrt(1 - zeta^2)."""

    words: ClassVar[str] = "period and damping of a free roll, at its first and at its last swings"
    units: ClassVar = {"period": "s", "damping_first": "", "damping_mean": "", "damping_last": ""}

    def why(self, metric: str, log: Recording) -> str:
        """Where it began."""
        if not log["phi_rad"][0]:
            return "it was not heeled at the start"
        return f"fewer than 2 peaks beyond {100.0 * SMALLEST:g} % of the release of {degrees(log['phi_rad'][0]):.3g} deg"

    def values(self, log: Recording) -> dict[str, float]:
        """None for a hull that does not swing or was not heeled."""
        rows_between(log, least=3)
        t, phi = log.t, log["phi_rad"]
        inner = phi[1:-1]
        rows = 1 + np.flatnonzero((inner - phi[:-2]) * (inner - phi[2:]) > 0.0)
        rows = rows[np.abs(phi[rows]) > SMALLEST * abs(phi[0])]
        if len(rows) < 2 or not phi[0]:
            return {}
        times, peaks = zip(
            *(_vertex(t[i - 1 : i + 2], phi[i - 1 : i + 2]) for i in rows), strict=True
        )
        heights = [abs(phi[0]), *map(abs, peaks)]
        zeta = [_share(ln(a / b)) for a, b in pairwise(heights)]
        return {
            "period": 2.0 * float(np.mean(np.diff(times))),
            "damping_first": zeta[0],
            "damping_mean": _share(ln(heights[0] / heights[-1]) / (len(heights) - 1)),
            "damping_last": zeta[-1],
        }


def _share(decrement: float) -> float:
    """Share of the critical damping of a decrement of half a swing."""
    return decrement / sqrt(pi**2 + decrement**2)


def _vertex(t: np.ndarray, x: np.ndarray) -> tuple[float, float]:
    """Time and height of the parabola through three points."""
    a, b, c = np.polyfit(t - t[1], x, 2)
    return float(t[1] - b / (2.0 * a)), float(c - b * b / (4.0 * a))
