"""Jet steering: a deflected water jet pushes the stern aside, turns the hull and heels it."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Force, Role, Wrench, param, wrench


@njit(inline="always")
def law(m: Any, q: Any, s: Any) -> Wrench:
    """Side force, roll and yaw moment in proportion to the deflection."""
    return wrench(Y=q.sway * s.angle, K=q.roll * s.angle, N=q.yaw * s.angle)


@dataclass(frozen=True)
class JetSteering(Force):
    """Linear steering of a jet drive at one speed; a positive angle turns to starboard where `yaw` is positive."""

    words: ClassVar[str] = "the deflected jet steers in proportion to its angle"
    shown_by: ClassVar[str] = "a zig-zag"
    source: ClassVar[str] = (
        "C. Svendsen et al., L1 adaptive manoeuvring control, IFAC MCMC 2012, eq. 15"
    )
    roles: ClassVar = {"angle": Role("rad", "the nozzle, positive turns to starboard going ahead")}
    law: ClassVar = law

    sway: float = param(
        0.0, low=-1e9, high=1e9, unit="N/rad", words="Y_delta", calibrates="thrust", axis="sway"
    )
    roll: float = param(
        0.0, low=-1e9, high=1e9, unit="N m/rad", words="K_delta", calibrates="thrust", axis="roll"
    )
    yaw: float = param(
        0.0, low=-1e9, high=1e9, unit="N m/rad", words="N_delta", calibrates="thrust", axis="yaw"
    )
