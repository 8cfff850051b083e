"""Speed-scaled steering: forces of hull and rudder belong to the speed of the water, not to the approach speed."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import UNSET, Force, Role, Wrench, param, wrench


@njit(inline="always")
def law(m: Any, q: Any, s: Any) -> Wrench:
    """What linear hull (by u / U0) and rudder (by its square) gain over their values at the approach speed U0.

    Astern the water meets the blade from behind and pushes it the other way; damping goes on damping.
    """
    ratio = m.ur / q.speed
    couples, damps, rudder = ratio - 1.0, abs(ratio) - 1.0, ratio * abs(ratio) - 1.0
    Y = -q.hull_sway * (damps * q.sway * m.vr + couples * q.sway_by_yaw * m.r)
    N = -q.hull_yaw * (couples * q.yaw_by_sway * m.vr + damps * q.yaw * m.r)
    return wrench(
        Y=Y + q.rudder_sway * rudder * q.steer_sway * s.angle,
        N=N + q.rudder_yaw * rudder * q.steer_yaw * s.angle,
    )


@dataclass(frozen=True)
class SpeedScaledSteering(Force):
    """The change of a linear hull and rudder with the speed ahead; nothing at the approach speed itself."""

    words: ClassVar[str] = (
        "hull and rudder forces change with the speed ahead instead of staying those of the approach"
    )
    shown_by: ClassVar[str] = "zig-zags in which the ship loses much of its speed"
    source: ClassVar[str] = (
        "T. I. Fossen, Handbook of Marine Craft Hydrodynamics, 2nd ed. 2021, chapters 6 and 9"
    )
    roles: ClassVar = {"angle": Role("rad", "the rudder, positive where its coefficients say")}
    law: ClassVar = law

    hull_sway: float = param(
        0.0,
        low=-5.0,
        high=5.0,
        unit="",
        words="share of the hull's sway force that goes with u",
        fit=True,
        spread=1.0,
    )
    hull_yaw: float = param(
        0.0,
        low=-5.0,
        high=5.0,
        unit="",
        words="share of its yaw moment that goes with u",
        fit=True,
        spread=1.0,
    )
    rudder_sway: float = param(
        0.0,
        low=-5.0,
        high=5.0,
        unit="",
        words="share of the rudder's sway force with u^2",
        fit=True,
        spread=1.0,
    )
    rudder_yaw: float = param(
        0.0,
        low=-5.0,
        high=5.0,
        unit="",
        words="share of its yaw moment with u^2",
        fit=True,
        spread=1.0,
    )
    speed: float = param(
        UNSET, low=0.01, high=50.0, unit="m/s", words="U0", follows="approach_balance.speed"
    )
    sway: float = param(
        UNSET, low=0.0, high=1e9, unit="N s/m", words="-Y_v", follows="linear_damping.sway"
    )
    yaw: float = param(
        UNSET, low=0.0, high=1e13, unit="N m s", words="-N_r", follows="linear_damping.yaw"
    )
    sway_by_yaw: float = param(
        UNSET, low=-1e11, high=1e11, unit="N s", words="-Y_r", follows="linear_damping.sway_by_yaw"
    )
    yaw_by_sway: float = param(
        UNSET, low=-1e11, high=1e11, unit="N s", words="-N_v", follows="linear_damping.yaw_by_sway"
    )
    steer_sway: float = param(
        UNSET, low=-1e11, high=1e11, unit="N/rad", words="Y_delta", follows="rudder.sway"
    )
    steer_yaw: float = param(
        UNSET, low=-1e13, high=1e13, unit="N m/rad", words="N_delta", follows="rudder.yaw"
    )
