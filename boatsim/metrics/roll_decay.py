"""Roll decay: period and damping ratio from successive peaks."""

from dataclasses import dataclass
from itertools import pairwise
from math import degrees, pi, sqrt
from math import log as ln
from typing import ClassVar

import numpy as np

from boatsim.recordings.table import Recording
from boatsim.simulate.metric import MetricSet, rows_between

# Peaks below this share of the release angle are ignored: noise and bias distort them.
SMALLEST_PEAK = 0.02


@dataclass(frozen=True)
class RollDecay(MetricSet):
    """Metric set of a free roll decay: period and damping ratio from the peaks of the roll angle.

    Peaks to both sides are used, half a cycle apart. The logarithmic decrement of half a cycle is
    pi zeta / sqrt(1 - zeta^2).
    """

    words: ClassVar[str] = (
        "period and damping ratio of a free roll, over its first and its last half cycle"
    )
    units: ClassVar = {"period": "s", "damping_first": "", "damping_mean": "", "damping_last": ""}

    def explain_missing_value(self, metric: str, log: Recording) -> str:
        """Explain in words why a roll decay has no metrics: no heel at the start or few peaks."""
        if not log["phi_rad"][0]:
            return "it was not heeled at the start"
        release = degrees(log["phi_rad"][0])
        share = 100.0 * SMALLEST_PEAK
        return f"fewer than 2 peaks beyond {share:g} % of the release of {release:.3g} deg"

    def values(self, log: Recording) -> dict[str, float]:
        """Return period and damping ratios of a roll decay, computed from the log of a run.

        The result is empty for a hull that does not oscillate or was not heeled at the start.
        """
        rows_between(log, least=3)
        t, phi = log.t, log["phi_rad"]
        inner = phi[1:-1]
        rows = 1 + np.flatnonzero((inner - phi[:-2]) * (inner - phi[2:]) > 0.0)
        rows = rows[np.abs(phi[rows]) > SMALLEST_PEAK * abs(phi[0])]
        if len(rows) < 2 or not phi[0]:
            return {}
        times, peaks = zip(
            *(_parabola_vertex(t[i - 1 : i + 2], phi[i - 1 : i + 2]) for i in rows), strict=True
        )
        heights = [abs(phi[0]), *map(abs, peaks)]
        zeta = [_damping_ratio(ln(a / b)) for a, b in pairwise(heights)]
        return {
            "period": 2.0 * float(np.mean(np.diff(times))),
            "damping_first": zeta[0],
            "damping_mean": _damping_ratio(ln(heights[0] / heights[-1]) / (len(heights) - 1)),
            "damping_last": zeta[-1],
        }


def _damping_ratio(decrement: float) -> float:
    """Damping ratio of a logarithmic decrement of half a cycle."""
    return decrement / sqrt(pi**2 + decrement**2)


def _parabola_vertex(t: np.ndarray, x: np.ndarray) -> tuple[float, float]:
    """Time and value of the extremum of the parabola through three points."""
    a, b, c = np.polyfit(t - t[1], x, 2)
    return float(t[1] - b / (2.0 * a)), float(c - b * b / (4.0 * a))
