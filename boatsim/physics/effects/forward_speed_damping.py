"""Forward speed damping: damping of sway, roll and yaw that grows with the speed ahead."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Force, Wrench, param, wrench


@njit(inline="always")
def law(m: Any, q: Any) -> Wrench:
    """|u| v, |u| p and |u| r: lift of hull and fins at a small angle to the flow, astern at the hull's other end."""
    speed, ends = abs(m.ur), m.ur * q.at
    return wrench(
        Y=-q.sway * (speed * m.vr + ends * m.r),
        K=-q.roll * speed * m.p,
        N=-q.sway * (ends * m.vr + speed * q.at * q.at * m.r) - q.yaw * speed * m.r,
    )


@dataclass(frozen=True)
class ForwardSpeedDamping(Force):
    """Linear damping in proportion to the forward speed."""

    needs: ClassVar = ("surge",)
    words: ClassVar[str] = "damping of sway, roll and yaw grows with the forward speed"
    shown_by: ClassVar[str] = "the same turns at two forward speeds"
    source: ClassVar[str] = (
        "M. Blanke, Ship Propulsion Losses, PhD, DTU 1981: terms Y_|u|v, K_|u|p, N_|u|r; those of a force at a place: "
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
        words="where the sway force acts, ahead of the mass centre",
        calibrates="damping",
        axis="yaw",
    )
