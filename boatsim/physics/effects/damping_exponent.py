"""Damping exponent: resistance grows with another power of the speed than the first."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Force, Wrench, param

# a start too strong in one axis spoils the others, so only one of them leaves the linear law
NEARLY_LINEAR = {"surge_exponent": 1.001, "sway_exponent": 1.001, "yaw_exponent": 1.001}


@njit(inline="always")
def more(speed: float, exponent: float, equal: float) -> float:
    """By how much (|speed|/equal)^(exponent - 1) speed exceeds the speed itself."""
    return speed * ((abs(speed) / equal) ** (exponent - 1.0) - 1.0)


@njit(inline="always")
def law(m: Any, q: Any) -> Wrench:
    """The difference of d sign(v) |v|^a to the vessel's own d v, axis by axis."""
    return Wrench(
        -q.surge * more(m.ur, q.surge_exponent, q.surge_equal),
        -q.sway * more(m.vr, q.sway_exponent, q.sway_equal),
        0.0,
        -q.yaw * more(m.r, q.yaw_exponent, q.yaw_equal),
    )


@dataclass(frozen=True)
class DampingExponent(Force):
    """A power law in place of the vessel's linear damping; both agree at one speed of each axis."""

    words: ClassVar[str] = "damping follows another power of the speed than the first, in place of the linear one"
    shown_by: ClassVar[str] = "the same motion at a large and at a small amplitude"
    source: ClassVar[str] = "Y. Huang and Z. Ji, Autonomous boat dynamics, eqs 4-6: d sign(x) |x|^a"
    law: ClassVar = law
    strength: ClassVar = ("surge_exponent", "sway_exponent", "yaw_exponent")
    starts: ClassVar = tuple(
        {**NEARLY_LINEAR, f"{axis}_exponent": 2.0, f"{axis}_equal": equal}
        for axis, equal in (("surge", 1.0), ("sway", 1.0), ("sway", 0.3), ("sway", 0.1), ("yaw", 1.0))
    )

    surge_exponent: float = param(
        1.0, low=1.0, high=3.0, unit="", words="surge", fit=True, spread=0.5, axis="surge", absent=1.0
    )
    sway_exponent: float = param(
        1.0, low=1.0, high=3.0, unit="", words="sway", fit=True, spread=0.5, axis="sway", absent=1.0
    )
    yaw_exponent: float = param(
        1.0, low=1.0, high=3.0, unit="", words="yaw", fit=True, spread=0.5, axis="yaw", absent=1.0
    )
    surge_equal: float = param(
        1.0, low=0.01, high=20.0, unit="m/s", words="both laws agree", fit=True, spread=0.5, axis="surge", absent=1.0
    )
    sway_equal: float = param(
        1.0, low=0.01, high=20.0, unit="m/s", words="both laws agree", fit=True, spread=0.5, axis="sway", absent=1.0
    )
    yaw_equal: float = param(
        1.0, low=0.01, high=20.0, unit="rad/s", words="both laws agree", fit=True, spread=0.5, axis="yaw", absent=1.0
    )
    surge: float = param(0.0, low=0.0, high=1e9, unit="N s/m", words="the vessel's", follows="linear_damping.surge")
    sway: float = param(0.0, low=0.0, high=1e9, unit="N s/m", words="the vessel's", follows="linear_damping.sway")
    yaw: float = param(0.0, low=0.0, high=1e13, unit="N m s", words="the vessel's", follows="linear_damping.yaw")
