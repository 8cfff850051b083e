"""Water jet: thrust from a shaft power that the throttle sets."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import UNSET, Force, Role, Wrench, param, wrench

IDLE = 1.0  # throttle at idle
PLANES = 2.0  # throttle at which the first branch of the power curve ends
FLAT = 4.0  # throttle at which the second one ends


@njit(inline="always")
def specific_shaft_power(throttle: float, q: Any) -> float:
    """Return the shaft power of a jet drive per mass of the craft [m^2/s^3] at a throttle setting.

    Args:
        throttle: Position of the handle, from 1 (idle) to 7 (full).
        q: Parameters of the three branches of the curve.
    """
    if throttle < PLANES:
        return q.m1 * max(throttle, IDLE) + q.q1
    if throttle < FLAT:
        return q.s0 + q.s1 * throttle + q.s2 * throttle * throttle
    return q.m2 * throttle + q.q2


@njit(inline="always")
def law(m: Any, q: Any, s: Any) -> Wrench:
    """Return the thrust of a jet drive: the shaft power set by the throttle over the forward speed.

    Args:
        m: Motion of the hull: velocities [m/s], rates [rad/s], position [m], attitude [rad].
        q: Parameters of the effect, with the names and units of its class.
        s: Signals bound to the roles of the effect.

    Returns:
        Force [N] and moment [N m] in body axes.
    """
    return wrench(X=q.gain * q.mass * specific_shaft_power(s.throttle, q) / max(m.ur, q.slowest))


@dataclass(frozen=True)
class WaterJet(Force):
    """Thrust of a jet drive with a shaft power that is set by the throttle.

    The power does not depend on the speed.

    X = gain m P(throttle) / max(u_r, slowest)

    P is the shaft power per unit mass [m^2/s^3]: linear below throttle 2 (m1, q1), quadratic from 2
    to 4 (s0, s1, s2), linear above (m2, q2).
    """

    formula: ClassVar[str] = (
        r"X = g \, \frac{m \, P(h)}{\max(u_r, u_0)}, \quad P(h) = \begin{cases} m_1 "
        r"\max(h, 1) + q_1 & h < 2 \\ s_0 + s_1 h + s_2 h^2 & 2 \le h < 4 \\ m_2 h + q_2 "
        r"& h \ge 4 \end{cases}"
    )
    symbols: ClassVar = {
        "m1": "m_1",
        "q1": "q_1",
        "s0": "s_0",
        "s1": "s_1",
        "s2": "s_2",
        "m2": "m_2",
        "q2": "q_2",
        "slowest": "u_0",
        "gain": "g",
        "mass": "m",
    }
    words: ClassVar[str] = "the thrust of a water jet follows from the power that the throttle sets"
    shown_by: ClassVar[str] = "throttle steps"
    source: ClassVar[str] = (
        "C. Svendsen et al., L1 adaptive manoeuvring control, IFAC MCMC 2012, eq. 10 and Table 2"
    )
    roles: ClassVar = {"throttle": Role("", "throttle handle, 1 idle to 7 full")}
    law: ClassVar = law

    m1: float = param(
        12.10, low=0.0, high=1e3, unit="m^2/s^3", words="throttle below 2: power per throttle"
    )
    q1: float = param(
        -11.30,
        low=-1e3,
        high=1e3,
        unit="m^2/s^3",
        words="throttle below 2: power extrapolated to 0",
    )
    s0: float = param(
        -21.1, low=-1e3, high=1e3, unit="m^2/s^3", words="throttle 2 to 4: power extrapolated to 0"
    )
    s1: float = param(
        -20.0, low=-1e3, high=1e3, unit="m^2/s^3", words="throttle 2 to 4: power per throttle"
    )
    s2: float = param(
        18.5,
        low=-1e3,
        high=1e3,
        unit="m^2/s^3",
        words="throttle 2 to 4: power per throttle squared",
    )
    m2: float = param(
        10.00, low=0.0, high=1e3, unit="m^2/s^3", words="throttle from 4: power per throttle"
    )
    q2: float = param(
        154.9,
        low=-1e3,
        high=1e3,
        unit="m^2/s^3",
        words="throttle from 4: power extrapolated to 0; the source prints 164.5",
    )
    slowest: float = param(
        0.5, low=0.01, high=100.0, unit="m/s", words="speed below which the thrust is constant"
    )
    gain: float = param(
        1.0,
        low=0.0,
        high=20.0,
        unit="",
        words="power over its specified value",
        calibrates="thrust",
    )
    mass: float = param(
        UNSET,
        low=0.0,
        high=1e9,
        unit="kg",
        words="mass for the curve per unit mass; default: that of the vessel",
        follows="vessel.body.mass",
    )
