"""Position wander: fixes that are off by an error which comes and goes slowly."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Wander, Wandering, param


@njit(inline="always")
def wander(q: Any) -> Wander:
    """North and east alike, each for itself."""
    return Wander(q.position, q.heading, q.time)


@dataclass(frozen=True)
class PositionWander(Wandering):
    """Satellite fixes wander with clocks, atmosphere and reflections; a compass with its card."""

    alone: ClassVar[bool] = True
    of_columns: ClassVar = ("x_m", "y_m")
    needs: ClassVar = ("surge", "sway")
    ruled_out_by: ClassVar = {"position_fix": ("camera", "tracking")}
    words: ClassVar[str] = (
        "recorded positions wander: their error comes and goes slowly (not physics)"
    )
    shown_by: ClassVar[str] = "lying still, moored between two posts"
    source: ClassVar[str] = (
        "J. Rankin, An error model for sensor simulation: GPS and differential GPS, IEEE PLANS 1994 (Gauss-Markov)"
    )
    wander: ClassVar = wander
    strength: ClassVar = ("position", "heading")
    starts: ClassVar = tuple(
        {"position": sd, "time": t} for sd in (4.0, 20.0) for t in (6.0, 20.0, 60.0)
    )

    # starts and spreads of both errors are in the noise of a single fix or heading
    position: float = param(
        0.0, low=0.0, high=100.0, unit="m", words="rms error north and east", fit=True, spread=10.0
    )
    heading: float = param(
        0.0, low=0.0, high=1.0, unit="rad", words="rms error of the heading", fit=True, spread=3.0
    )
    time: float = param(
        20.0,
        low=5.0,
        high=1000.0,
        unit="s",
        words="over which the error is alike",
        fit=True,
        spread=20.0,
        absent=20.0,
    )
