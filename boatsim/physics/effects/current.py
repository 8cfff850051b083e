"""Current: the water itself moves over the ground."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Flow, param


@njit(inline="always")
def flow(q: Any) -> tuple[float, float]:
    """Velocity of the water over the ground."""
    return q.north, q.east


@dataclass(frozen=True)
class Current(Flow):
    """A uniform, steady current."""

    ruled_out_by: ClassVar = {"still_water": (True,)}
    needs: ClassVar = ("surge", "sway")
    words: ClassVar[str] = "the water moves over the ground and carries the boat along"
    shown_by: ClassVar[str] = "drifting, and runs on opposite headings"
    flow: ClassVar = flow

    north: float = param(
        0.0, low=-5.0, high=5.0, unit="m/s", words="water velocity along x", fit=True, spread=0.06
    )
    east: float = param(
        0.0, low=-5.0, high=5.0, unit="m/s", words="water velocity along y", fit=True, spread=0.06
    )
