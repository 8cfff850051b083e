"""Forward speed damping: damping of sway, roll and yaw proportional to the forward speed."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Force, Wrench, param, wrench


@njit(inline="always")
def law(m: Any, q: Any) -> Wrench:
    """Return the damping of sway, roll and yaw by the lift of hull and fins at a small drift angle.

    It is proportional to the forward speed. Going astern the sway force acts at the opposite end of
    the hull.

    Args:
        m: Motion of the hull: velocities [m/s], rates [rad/s], position [m], attitude [rad].
        q: Parameters of the effect, with the names and units of its class.

    Returns:
        Force [N] and moment [N m] in body axes.
    """
    speed, ends = abs(m.ur), m.ur * q.at
    return wrench(
        Y=-q.sway * (speed * m.vr + ends * m.r),
        K=-q.roll * speed * m.p,
        N=-q.sway * (ends * m.vr + speed * q.at * q.at * m.r) - q.yaw * speed * m.r,
    )


@dataclass(frozen=True)
class ForwardSpeedDamping(Force):
    """Linear damping of sway, roll and yaw proportional to |u_r|: lift of hull and fins.

    Y = -d_v (|u_r| v_r + a u_r r),  K = -d_p |u_r| p
    N = -d_v (a u_r v_r + a^2 |u_r| r) - d_r |u_r| r

    d_v = -Y_|u|v, d_p = -K_|u|p, d_r = -N_|u|r; a is the place `at` [m] at which the sway force
    acts.
    """

    formula: ClassVar[str] = (
        r"\begin{aligned} Y &= -d_v \left(|u_r| v_r + a \, u_r r\right), \quad K = -d_p "
        r"|u_r| p \\ N &= -d_v \left(a \, u_r v_r + a^2 |u_r| r\right) - d_r |u_r| r "
        r"\end{aligned}"
    )
    symbols: ClassVar = {"sway": "d_v", "roll": "d_p", "yaw": "d_r", "at": "a"}
    needs: ClassVar = ("surge",)
    ruled_out_by: ClassVar = {"no_water": (True,)}
    words: ClassVar[str] = "damping of sway, roll and yaw grows with the forward speed"
    refines: ClassVar[str] = "damping"
    shown_by: ClassVar[str] = "the same turns at two forward speeds"
    source: ClassVar[str] = (
        "M. Blanke, Ship Propulsion Losses, PhD, DTU 1981: terms Y_|u|v, K_|u|p, N_|u|r; those "
        "of a force at a place: "
        "R. T. Jones, NACA report 835, 1946"
    )
    law: ClassVar = law

    sway: float = param(
        0.0,
        low=0.0,
        high=1e9,
        unit="N s^2/m^2",
        words="-Y_|u|v",
        fit=True,
        spread=20.0,
        axis="sway",
        calibrates="damping",
    )
    roll: float = param(
        0.0,
        low=0.0,
        high=1e13,
        unit="N s^2",
        words="-K_|u|p",
        fit=True,
        spread=0.02,
        axis="roll",
        calibrates="damping",
    )
    yaw: float = param(
        0.0,
        low=0.0,
        high=1e13,
        unit="N s^2",
        words="-N_|u|r",
        fit=True,
        spread=2.0,
        axis="yaw",
        calibrates="damping",
    )
    at: float = param(
        0.0,
        low=-500.0,
        high=500.0,
        unit="m",
        words="place of the sway force, ahead of the mass centre",
        calibrates="damping",
        axis="yaw",
    )
