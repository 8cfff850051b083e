"""Speed-scaled steering: hull and rudder forces that change with the speed through the water."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import UNSET, Force, Role, Wrench, param, wrench


@njit(inline="always")
def law(m: Any, q: Any, s: Any) -> Wrench:
    """Return the change of the linear hull and rudder forces with the forward speed.

    It is the difference from their values at the approach speed U0. Hull forces scale with u / U0,
    rudder forces with its square. Going astern the flow meets the rudder from behind and its force
    changes sign; damping stays damping.

    Args:
        m: Motion of the hull: velocities [m/s], rates [rad/s], position [m], attitude [rad].
        q: Parameters of the effect, with the names and units of its class.
        s: Signals bound to the roles of the effect.

    Returns:
        Force [N] and moment [N m] in body axes.
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
    """Change of a linear hull and rudder with the forward speed; zero at the approach speed.

    dY = hull_sway ((|e| - 1) Y_v v_r + (e - 1) Y_r r) + rudder_sway (e |e| - 1) Y_delta delta
    dN = hull_yaw ((e - 1) N_v v_r + (|e| - 1) N_r r) + rudder_yaw (e |e| - 1) N_delta delta

    e = u_r / U0.
    """

    formula: ClassVar[str] = (
        r"\begin{aligned} Y &= h_Y \left((|e| - 1) Y_v v_r + (e - 1) Y_r r\right) + c_Y "
        r"(e |e| - 1) Y_\delta \delta \\ N &= h_N \left((e - 1) N_v v_r + (|e| - 1) N_r "
        r"r\right) + c_N (e |e| - 1) N_\delta \delta, \quad e = u_r / U_0 \end{aligned}"
    )
    symbols: ClassVar = {
        "hull_sway": "h_Y",
        "hull_yaw": "h_N",
        "rudder_sway": "c_Y",
        "rudder_yaw": "c_N",
        "speed": "U_0",
        "sway": "-Y_v",
        "sway_by_yaw": "-Y_r",
        "yaw_by_sway": "-N_v",
        "yaw": "-N_r",
        "steer_sway": r"Y_\delta",
        "steer_yaw": r"N_\delta",
    }
    words: ClassVar[str] = (
        "hull and rudder forces change with the forward speed instead of staying constant"
    )
    shown_by: ClassVar[str] = "zig-zags in which the ship loses much of its speed"
    source: ClassVar[str] = (
        "T. I. Fossen, Handbook of Marine Craft Hydrodynamics, 2nd ed. 2021, chapters 6 and 9"
    )
    roles: ClassVar = {
        "angle": Role("rad", "rudder angle; the signs of the coefficients define its sense")
    }
    law: ClassVar = law

    hull_sway: float = param(
        0.0,
        low=-5.0,
        high=5.0,
        unit="",
        words="share of the sway force of the hull that scales with u",
        fit=True,
        spread=1.0,
    )
    hull_yaw: float = param(
        0.0,
        low=-5.0,
        high=5.0,
        unit="",
        words="share of the yaw moment of the hull that scales with u",
        fit=True,
        spread=1.0,
    )
    rudder_sway: float = param(
        0.0,
        low=-5.0,
        high=5.0,
        unit="",
        words="share of the sway force of the rudder that scales with u^2",
        fit=True,
        spread=1.0,
    )
    rudder_yaw: float = param(
        0.0,
        low=-5.0,
        high=5.0,
        unit="",
        words="share of the yaw moment of the rudder that scales with u^2",
        fit=True,
        spread=1.0,
    )
    speed: float = param(
        UNSET,
        low=0.01,
        high=50.0,
        unit="m/s",
        words="approach speed, U0",
        follows="approach_balance.speed",
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
