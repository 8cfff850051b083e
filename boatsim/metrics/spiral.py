"""Spiral test: hysteresis loop of rate of turn over helm angle.

A ship without straight-line stability has two rates of turn at the same small helm angle.
"""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from boatsim.recordings.table import Recording
from boatsim.simulate.metric import MetricSet, rows_between

SAME_ANGLE = 1e-6  # [rad] difference of two helm angles that count as equal; rounding only


@dataclass(frozen=True)
class Spiral(MetricSet):
    """Metric set of a spiral test: the hysteresis loop of rate of turn over helm angle."""

    words: ClassVar[str] = (
        "height and width of the loop in the curve of rate of turn over helm angle"
    )
    units: ClassVar = {
        "loop_height": "deg/s",
        "loop_width": "deg",
        "rate_at_largest": "deg/s",
        "rate_midships": "deg/s",
    }

    def explain_missing_value(self, metric: str, log: Recording) -> str:
        """Explain in words that a spiral test is incomplete, with its last helm angle."""
        last = np.degrees(log["reference_helm_rad"][-1])
        return f"the helm did not come back to its first angle: it ends at {last:.3g} deg"

    def values(self, log: Recording) -> dict[str, float]:
        """Return height and width of the hysteresis loop of a spiral test, and two rates of turn.

        The height is that at midships. The width spans the helm angles at which the rates of turn
        of outward and return sweep have opposite signs. The two rates of turn are those at the
        first helm angle and at midships. The result is empty unless the helm returned to its first
        angle.

        Args:
            log: Log of the run.
        """
        rows_between(log)
        helm = log["reference_helm_rad"]
        begin = int(np.argmax(helm != 0.0))
        ends = np.array(
            [*(begin + np.flatnonzero(np.abs(np.diff(helm[begin:])) > SAME_ANGLE)), len(helm) - 1]
        )
        angles, rates = helm[ends], np.degrees(log["r_radps"][ends])
        if len(ends) < 3 or abs(angles[-1] - angles[0]) > SAME_ANGLE:
            return {}
        # The helm angle is reversed at the largest distance from the first angle.
        turn = int(np.argmax(np.abs(angles - angles[0])))
        out, back = slice(0, turn + 1), slice(turn, len(ends))
        both = sorted(a for a in angles[out] if np.abs(angles[back] - a).min() < SAME_ANGLE)
        there = np.array([rates[out][np.argmin(np.abs(angles[out] - a))] for a in both])
        again = np.array([rates[back][np.argmin(np.abs(angles[back] - a))] for a in both])
        middle = int(np.argmin(np.abs(both)))
        loop = [a for a, x, y in zip(both, there, again, strict=True) if x * y < 0.0]
        return {
            "loop_height": float(abs(there[middle] - again[middle])),
            "loop_width": float(np.degrees(max(loop) - min(loop))) if loop else 0.0,
            "rate_at_largest": float(rates[0]),
            "rate_midships": float(there[middle]),
        }
