"""Wall effect: the boat drags more and is drawn aside where the water between hull and wall is narrow."""

from dataclasses import dataclass
from math import exp
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import UNSET, Boat, Force, Wrench, param, wrench

REACH = 0.5  # [boat lengths] over which what a wall does falls to 37 %


@njit(inline="always")
def nearness(at: float, low: float, high: float, reach: float) -> tuple[float, float]:
    """Nearness exp(-distance / reach) of the high and of the low wall of a pair, no nearer than touching."""
    return exp(-max(high - at, 0.0) / reach), exp(-max(at - low, 0.0) / reach)


@njit(inline="always")
def law(m: Any, q: Any) -> Wrench:
    """Linear damping grows and a pull towards the wall appears, both falling off exponentially with the distance."""
    n, s = nearness(m.x, q.x_low, q.x_high, q.reach)
    e, w = nearness(m.y, q.y_low, q.y_high, q.reach)
    rise = q.damping_rise * (n + s + e + w)
    north, east = q.pull * (n - s), q.pull * (e - w)  # [N]
    return wrench(
        X=m.cos_psi * north + m.sin_psi * east - rise * q.surge * m.ur,
        Y=m.cos_psi * east - m.sin_psi * north - rise * q.sway * m.vr,
        N=-rise * q.yaw * m.r,
    )


@dataclass(frozen=True)
class WallEffect(Force):
    """More damping and suction near the walls of a rectangular tank, told by a recording's facts or its own table."""

    needs: ClassVar = ("surge", "sway")
    words: ClassVar[str] = (
        "near the walls of the tank the boat drags more and is drawn towards them"
    )
    shown_by: ClassVar[str] = "approaching a wall slowly and leaving it again"
    source: ClassVar[str] = "assumption: exponential fall-off; its reach is half a boat length"
    anchored: ClassVar[str] = "the walls"
    law: ClassVar = law
    strength: ClassVar = ("damping_rise", "pull")
    facts: ClassVar = {"walls_m": ("x_low", "x_high", "y_low", "y_high")}

    damping_rise: float = param(
        0.0,
        low=0.0,
        high=20.0,
        unit="",
        words="relative rise of the damping at a wall",
        fit=True,
        spread=2.0,
    )
    pull: float = param(
        0.0, low=-1e6, high=1e6, unit="N", words="towards a wall, at it", fit=True, spread=0.1
    )
    reach: float = param(
        UNSET,
        low=0.01,
        high=500.0,
        unit="m",
        words="distance over which it falls to 37 %; else half the boat's length",
    )
    x_low: float = param(
        UNSET, low=-1e5, high=1e5, unit="m", words="wall across the x axis, at its low end"
    )
    x_high: float = param(UNSET, low=-1e5, high=1e5, unit="m", words="at its high end")
    y_low: float = param(
        UNSET, low=-1e5, high=1e5, unit="m", words="wall across the y axis, at its low end"
    )
    y_high: float = param(UNSET, low=-1e5, high=1e5, unit="m", words="at its high end")
    surge: float = param(
        UNSET,
        low=0.0,
        high=1e9,
        unit="N s/m",
        words="the vessel's",
        follows="linear_damping.surge?",
    )
    sway: float = param(
        UNSET, low=0.0, high=1e9, unit="N s/m", words="the vessel's", follows="linear_damping.sway?"
    )
    yaw: float = param(
        UNSET, low=0.0, high=1e13, unit="N m s", words="the vessel's", follows="linear_damping.yaw?"
    )

    def rules(self, vessel: Boat) -> dict[str, float]:
        """The reach by the boat's length."""
        return {"reach": REACH * vessel.length}
