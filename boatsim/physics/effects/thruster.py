"""Thruster: a thrust at a place on the hull, fixed or steered."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Force, Release, Role, Wrench, factor, param, wrench


@njit(inline="always")
def at_mount(thrust: float, s: Any, q: Any) -> Wrench:
    """A force of this size along the thruster's axis, at its mount."""
    X, Y = thrust * s.cos_angle, thrust * s.sin_angle
    return wrench(X=X, Y=Y, K=-q.z * Y, M=q.z * X, N=q.x * Y - q.y * X)


@njit(inline="always")
def law(m: Any, q: Any, s: Any) -> Wrench:
    """T (cos a, sin a) at (x, y, z)."""
    return at_mount(q.gain * s.thrust, s, q)


@dataclass(frozen=True)
class Thruster(Force):
    """One of any number; without a steering channel its angle is a number, 0 straight ahead."""

    words: ClassVar[str] = "a thruster pushes, and steers where it can be turned"
    shown_by: ClassVar[str] = "any manoeuvre"
    source: ClassVar[str] = (
        "T. I. Fossen, Handbook of Marine Craft Hydrodynamics, 2nd ed. 2021, section 11.2"
    )
    roles: ClassVar = {
        "thrust": Role("N", "its thrust, ahead positive"),
        "angle": Role("rad", "where it pushes, 0 ahead, positive to starboard", fixed=0.0),
    }
    law: ClassVar = law

    x: float = param(
        0.0, low=-500.0, high=500.0, unit="m", words="mount ahead of the origin of motion"
    )
    y: float = param(0.0, low=-100.0, high=100.0, unit="m", words="to starboard of it")
    z: float = param(0.0, low=-100.0, high=100.0, unit="m", words="below it")
    gain: float = param(
        1.0, low=0.1, high=5.0, unit="", words="thrust per commanded thrust", calibrates="thrust"
    )


@dataclass(frozen=True)
class ThrustGainError(Release):
    """All thrust is off by one factor, by more than the stated uncertainty of the thrust coefficient."""

    words: ClassVar[str] = "all thrust is stronger or weaker than stated by one factor"
    shown_by: ClassVar[str] = "runs at several thrust levels"

    factor: float = factor(
        "thruster.gain",
        "propeller.gain",
        "mmg_propeller.gain",
        "mmg_low_speed_propeller.gain",
        "water_jet.gain",
        words="thrust per stated thrust",
        spread=0.3,
        low=0.2,
        high=3.0,
    )
