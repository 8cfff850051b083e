"""Approach balance: propeller thrust less resistance, linear about the approach speed."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Force, Role, Wrench, param, wrench


@njit(inline="always")
def law(m: Any, q: Any, s: Any) -> Wrench:
    """Return the surge force -damping (u_r - gain speed n / shaft_rate) at shaft rate n.

    It is the difference of propeller thrust and resistance, linearised about the approach speed.

    Args:
        m: Motion of the hull: velocities [m/s], rates [rad/s], position [m], attitude [rad].
        q: Parameters of the effect, with the names and units of its class.
        s: Signals bound to the roles of the effect.

    Returns:
        Force [N] and moment [N m] in body axes.
    """
    return wrench(X=-q.damping * (m.ur - q.gain * q.speed * s.shaft / q.shaft_rate))


@dataclass(frozen=True)
class ApproachBalance(Force):
    """Balance of thrust and resistance near the approach speed, as a function of the shaft rate.

    X = -damping (u_r - gain U0 n / n0)

    At the shaft rate n the hull settles at the speed gain U0 n / n0. `damping` is -X_u [N s/m], U0
    the approach speed `speed` [m/s], n0 the `shaft_rate` [1/s].
    """

    formula: ClassVar[str] = r"X = -d_u \left(u_r - g \, U_0 \, \frac{n}{n_0}\right)"
    symbols: ClassVar = {"damping": "d_u", "speed": "U_0", "shaft_rate": "n_0", "gain": "g"}
    words: ClassVar[str] = "propeller and resistance hold the approach speed"
    shown_by: ClassVar[str] = "a straight run that starts at a slightly different speed"
    source: ClassVar[str] = (
        "M. A. Abkowitz, Lectures on Ship Hydrodynamics, 1964: the linear term in u - U0"
    )
    roles: ClassVar = {"shaft": Role("1/s", "shaft rate, positive ahead")}
    law: ClassVar = law

    damping: float = param(
        0.0,
        low=0.0,
        high=1e9,
        unit="N s/m",
        words="slope of resistance less thrust over speed, -X_u",
        calibrates="damping",
    )
    speed: float = param(1.0, low=0.01, high=50.0, unit="m/s", words="approach speed, U0")
    shaft_rate: float = param(
        1.0, low=0.01, high=1e3, unit="1/s", words="shaft rate at the approach speed, n0"
    )
    gain: float = param(
        1.0,
        low=0.1,
        high=5.0,
        unit="",
        words="speed reached over its specified value",
        calibrates="thrust",
    )
