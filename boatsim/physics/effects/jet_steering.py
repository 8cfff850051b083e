"""Jet steering: side force, roll and yaw moment of a deflected water jet, linear in its angle."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Force, Role, Wrench, param, wrench


@njit(inline="always")
def law(m: Any, q: Any, s: Any) -> Wrench:
    """Return side force, roll and yaw moment of a water jet, proportional to its nozzle angle.

    Args:
        m: Motion of the hull: velocities [m/s], rates [rad/s], position [m], attitude [rad].
        q: Parameters of the effect, with the names and units of its class.
        s: Signals bound to the roles of the effect.

    Returns:
        Force [N] and moment [N m] in body axes.
    """
    return wrench(Y=q.sway * s.angle, K=q.roll * s.angle, N=q.yaw * s.angle)


@dataclass(frozen=True)
class JetSteering(Force):
    """Linear steering force of a water jet at one speed.

    Y = Y_delta delta,  K = K_delta delta,  N = N_delta delta

    A positive angle delta turns the craft to starboard if `yaw` = N_delta is positive.
    """

    formula: ClassVar[str] = (
        r"Y = Y_\delta \delta, \quad K = K_\delta \delta, \quad N = N_\delta \delta"
    )
    symbols: ClassVar = {"sway": r"Y_\delta", "roll": r"K_\delta", "yaw": r"N_\delta"}
    words: ClassVar[str] = "the steering force of the jet is proportional to its angle"
    shown_by: ClassVar[str] = "a zig-zag"
    source: ClassVar[str] = (
        "C. Svendsen et al., L1 adaptive manoeuvring control, IFAC MCMC 2012, eq. 15"
    )
    roles: ClassVar = {
        "angle": Role("rad", "nozzle angle, positive turns to starboard going ahead")
    }
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
