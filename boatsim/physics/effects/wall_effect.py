"""Wall effect: additional damping and suction near the walls of a tank."""

from dataclasses import dataclass
from math import exp
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import UNSET, Boat, Force, Wrench, param, wrench

REACH = 0.5  # [boat lengths] distance over which the effect of a wall falls to 37 %


@njit(inline="always")
def wall_proximity(at: float, low: float, high: float, reach: float) -> tuple[float, float]:
    """Return how near the hull is to two opposite tank walls, as exp(-distance / reach) of each.

    The first value belongs to the wall of the high coordinate, the second to that of the low one.

    Args:
        at: Position between the walls [m].
        low: Position of the low wall [m].
        high: Position of the high wall [m].
        reach: Distance over which the effect falls to 37 % [m].
    """
    return exp(-max(high - at, 0.0) / reach), exp(-max(at - low, 0.0) / reach)


@njit(inline="always")
def law(m: Any, q: Any) -> Wrench:
    """Return the additional damping and the suction near the walls of a tank.

    Both are exponential in the distance from the walls.

    Args:
        m: Motion of the hull: velocities [m/s], rates [rad/s], position [m], attitude [rad].
        q: Parameters of the effect, with the names and units of its class.

    Returns:
        Force [N] and moment [N m] in body axes.
    """
    n, s = wall_proximity(m.x, q.x_low, q.x_high, q.reach)
    e, w = wall_proximity(m.y, q.y_low, q.y_high, q.reach)
    rise = q.damping_rise * (n + s + e + w)
    north, east = q.pull * (n - s), q.pull * (e - w)  # [N]
    return wrench(
        X=m.cos_psi * north + m.sin_psi * east - rise * q.surge * m.ur,
        Y=m.cos_psi * east - m.sin_psi * north - rise * q.sway * m.vr,
        N=-rise * q.yaw * m.r,
    )


@dataclass(frozen=True)
class WallEffect(Force):
    """Additional damping and suction near the walls of a rectangular tank.

    n_w = exp(-distance / reach) for each of the four walls w
    damping times 1 + damping_rise sum(n_w),  pull n_w towards each wall

    The walls are given in the facts of a recording (`walls_m`) or in the table of the effect.
    """

    formula: ClassVar[str] = (
        r"\begin{aligned} X_E &= F (n_N - n_S), \quad Y_E = F (n_E - n_W), \quad n_w = "
        r"e^{-d_w / \lambda} \quad \text{for each wall } w \\ X &= X_E \cos\psi + Y_E "
        r"\sin\psi - \mu \, d_u u_r, \quad Y = Y_E \cos\psi - X_E \sin\psi - \mu \, d_v "
        r"v_r \\ N &= -\mu \, d_r r, \quad \mu = k \, (n_N + n_S + n_E + n_W) "
        r"\end{aligned}"
    )
    symbols: ClassVar = {
        "damping_rise": "k",
        "pull": "F",
        "reach": r"\lambda",
        "surge": "d_u",
        "sway": "d_v",
        "yaw": "d_r",
    }
    needs: ClassVar = ("surge", "sway")
    ruled_out_by: ClassVar = {"no_water": (True,)}
    words: ClassVar[str] = (
        "near the walls of the tank the damping increases and the boat is drawn towards them"
    )
    shown_by: ClassVar[str] = "approaching a wall slowly and leaving it again"
    source: ClassVar[str] = "assumption: exponential decay with a reach of half a boat length"
    tied_to: ClassVar[str] = "the walls"
    law: ClassVar = law
    strength: ClassVar = ("damping_rise", "pull")
    facts: ClassVar = {"walls_m": ("x_low", "x_high", "y_low", "y_high")}

    damping_rise: float = param(
        0.0,
        low=0.0,
        high=20.0,
        unit="",
        words="relative increase of the damping at a wall",
        fit=True,
        spread=2.0,
    )
    pull: float = param(
        0.0,
        low=-1e6,
        high=1e6,
        unit="N",
        words="force towards a wall, at the wall",
        fit=True,
        spread=0.1,
    )
    reach: float = param(
        UNSET,
        low=0.01,
        high=500.0,
        unit="m",
        words="distance over which it falls to 37 %; default: half the length of the boat",
    )
    x_low: float = param(UNSET, low=-1e5, high=1e5, unit="m", words="low wall across the x axis")
    x_high: float = param(
        UNSET, low=-1e5, high=1e5, unit="m", words="high wall across the same axis"
    )
    y_low: float = param(UNSET, low=-1e5, high=1e5, unit="m", words="low wall across the y axis")
    y_high: float = param(
        UNSET, low=-1e5, high=1e5, unit="m", words="high wall across the same axis"
    )
    surge: float = param(
        UNSET,
        low=0.0,
        high=1e9,
        unit="N s/m",
        words="linear damping of the vessel",
        follows="linear_damping.surge?",
    )
    sway: float = param(
        UNSET,
        low=0.0,
        high=1e9,
        unit="N s/m",
        words="linear damping of the vessel",
        follows="linear_damping.sway?",
    )
    yaw: float = param(
        UNSET,
        low=0.0,
        high=1e13,
        unit="N m s",
        words="linear damping of the vessel",
        follows="linear_damping.yaw?",
    )

    def derived_parameters(self, vessel: Boat) -> dict[str, float]:
        """Return the default reach of the wall effect, half the length of the boat.

        Args:
            vessel: Vessel with a length [m].
        """
        return {"reach": REACH * vessel.length}
