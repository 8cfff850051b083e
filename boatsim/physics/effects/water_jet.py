"""Water jet: a shaft power that the throttle sets, so the thrust falls with the speed it drives."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import UNSET, Force, Role, Wrench, param, wrench

IDLE = 1.0  # throttle of a handle nobody touches
PLANES = 2.0  # throttle at which the first branch of the power curve ends
FLAT = 4.0  # throttle at which the second one ends


@njit(inline="always")
def power(throttle: float, q: Any) -> float:
    """Shaft power per unit mass [m^2/s^3] of a throttle handle from 1 (idle) to 7 (full), three branches."""
    if throttle < PLANES:
        return q.m1 * max(throttle, IDLE) + q.q1
    if throttle < FLAT:
        return q.s0 + q.s1 * throttle + q.s2 * throttle * throttle
    return q.m2 * throttle + q.q2


@njit(inline="always")
def law(m: Any, q: Any, s: Any) -> Wrench:
    """Thrust = power / speed ahead."""
    return wrench(X=q.gain * q.mass * power(s.throttle, q) / max(m.ur, q.slowest))


@dataclass(frozen=True)
class WaterJet(Force):
    """Thrust of a jet drive whose engine gives a power that belongs to the handle, whatever the speed."""

    words: ClassVar[str] = "a water jet pushes with the power that the throttle sets"
    shown_by: ClassVar[str] = "throttle steps"
    source: ClassVar[str] = (
        "C. Svendsen et al., L1 adaptive manoeuvring control, IFAC MCMC 2012, eq. 10 and Table 2"
    )
    roles: ClassVar = {"throttle": Role("", "the handle, 1 idle to 7 full")}
    law: ClassVar = law

    m1: float = param(
        12.10, low=0.0, high=1e3, unit="m^2/s^3", words="throttle below 2: per throttle"
    )
    q1: float = param(-11.30, low=-1e3, high=1e3, unit="m^2/s^3", words="throttle below 2: at 0")
    s0: float = param(-21.1, low=-1e3, high=1e3, unit="m^2/s^3", words="throttle 2 to 4: at 0")
    s1: float = param(
        -20.0, low=-1e3, high=1e3, unit="m^2/s^3", words="throttle 2 to 4: per throttle"
    )
    s2: float = param(
        18.5, low=-1e3, high=1e3, unit="m^2/s^3", words="throttle 2 to 4: per throttle squared"
    )
    m2: float = param(
        10.00, low=0.0, high=1e3, unit="m^2/s^3", words="throttle from 4: per throttle"
    )
    q2: float = param(
        154.9, low=-1e3, high=1e3, unit="m^2/s^3", words="throttle from 4: at 0; printed 164.5"
    )
    slowest: float = param(
        0.5, low=0.01, high=100.0, unit="m/s", words="below this speed the thrust rises no more"
    )
    gain: float = param(
        1.0, low=0.0, high=20.0, unit="", words="power per stated power", calibrates="thrust"
    )
    mass: float = param(
        UNSET,
        low=0.0,
        high=1e9,
        unit="kg",
        words="the curve is per unit mass; if not given, the vessel's own",
        follows="vessel.body.mass",
    )
