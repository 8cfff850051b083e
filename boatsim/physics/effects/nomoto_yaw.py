"""First-order yaw model of Nomoto: yaw rate follows the steering angle with one time constant."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import UNSET, Force, Role, Wrench, param, wrench


@njit(inline="always")
def law(m: Any, q: Any, s: Any) -> Wrench:
    """Return the yaw moment I_z (K delta - r) / T of a first-order (Nomoto) yaw response.

    Gain K and time constant T are those at the present time.

    Args:
        m: Motion of the hull: velocities [m/s], rates [rad/s], position [m], attitude [rad].
        q: Parameters of the effect, with the names and units of its class.
        s: Signals bound to the roles of the effect.

    Returns:
        Force [N] and moment [N m] in body axes.
    """
    if q.time_constant <= 0.0:
        return wrench()
    way = min(max(m.t / q.duration, 0.0), 1.0)
    gain = q.gain + way * (q.gain_later - q.gain)
    time_constant = q.time_constant + way * (q.time_constant_later - q.time_constant)
    return wrench(N=q.inertia * (gain * s.angle - m.r) / time_constant)


@dataclass(frozen=True)
class NomotoYaw(Force):
    """First-order yaw response r' = (K delta - r) / T, in place of other yaw laws.

    N = I_z (K delta - r) / T

    K is `gain` [1/s], T the `assumed_correlation_time` [s]. Both change linearly over `duration` to
    `gain_later` and `time_constant_later`, for tests of adaptive control.
    """

    formula: ClassVar[str] = r"N = I_z \, \frac{K \delta - r}{T}"
    symbols: ClassVar = {"gain": "K", "time_constant": "T", "inertia": "I_z"}
    words: ClassVar[str] = "the yaw rate follows the jet angle with a first-order lag"
    shown_by: ClassVar[str] = "steering steps"
    source: ClassVar[str] = (
        "K. Nomoto et al., On the steering qualities of ships, Int. Shipbuild. Progr. 4, 1957"
    )
    roles: ClassVar = {
        "angle": Role("rad", "nozzle angle, positive turns to starboard going ahead")
    }
    law: ClassVar = law

    gain: float = param(
        0.0, low=-1e3, high=1e3, unit="1/s", words="K at the start", calibrates="thrust", axis="yaw"
    )
    gain_later: float = param(
        0.0,
        low=-1e3,
        high=1e3,
        unit="1/s",
        words="K from `duration` on",
        calibrates="thrust",
        axis="yaw",
    )
    time_constant: float = param(
        0.0, low=0.0, high=1e4, unit="s", words="T at the start; 0: no yaw moment"
    )
    time_constant_later: float = param(
        1.0, low=1e-3, high=1e4, unit="s", words="T from `duration` on"
    )
    duration: float = param(
        1.0, low=1e-3, high=1e6, unit="s", words="time over which K and T change"
    )
    inertia: float = param(
        UNSET,
        low=0.0,
        high=1e13,
        unit="kg m^2",
        words="yaw inertia I_z; default: that of the rigid body",
        follows="vessel.body.yaw_inertia",
    )
