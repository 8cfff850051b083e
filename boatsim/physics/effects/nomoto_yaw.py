"""First-order yaw: the reduced model on which steering loops are designed, its numbers fixed or changing in time."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import UNSET, Force, Role, Wrench, param, wrench


@njit(inline="always")
def law(m: Any, q: Any, s: Any) -> Wrench:
    """Inertia times (gain delta - r) / time constant; both numbers go in a straight line to their later values."""
    if q.time_constant <= 0.0:
        return wrench()
    way = min(max(m.t / q.duration, 0.0), 1.0)
    gain = q.gain + way * (q.gain_later - q.gain)
    time_constant = q.time_constant + way * (q.time_constant_later - q.time_constant)
    return wrench(N=q.inertia * (gain * s.angle - m.r) / time_constant)


@dataclass(frozen=True)
class NomotoYaw(Force):
    """Yaw rate follows the jet's deflection with one lag, r' = (K delta - r) / T; takes the place of other yaw laws."""

    words: ClassVar[str] = "the yaw rate follows the jet with one lag"
    shown_by: ClassVar[str] = "steering steps"
    source: ClassVar[str] = (
        "K. Nomoto et al., On the steering qualities of ships, Int. Shipbuild. Progr. 4, 1957"
    )
    roles: ClassVar = {"angle": Role("rad", "the nozzle, positive turns to starboard going ahead")}
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
        0.0, low=0.0, high=1e4, unit="s", words="T at the start; 0: the law is not there"
    )
    time_constant_later: float = param(
        1.0, low=1e-3, high=1e4, unit="s", words="T from `duration` on"
    )
    duration: float = param(1.0, low=1e-3, high=1e6, unit="s", words="time in which they change")
    inertia: float = param(
        UNSET,
        low=0.0,
        high=1e13,
        unit="kg m^2",
        words="if not given, the rigid hull's own",
        follows="vessel.body.yaw_inertia",
    )
