"""Speed hold: the surge speed is kept, as linear manoeuvring models take it for granted."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import UNSET, Force, Wrench, param, wrench


@njit(inline="always")
def law(m: Any, q: Any) -> Wrench:
    """-m v r - gain (u - speed), through the water: with no other surge force u stays at the speed exactly."""
    return wrench(X=-q.mass * m.vr * m.r - q.gain * (m.ur - q.speed))


@dataclass(frozen=True)
class SpeedHold(Force):
    """An ideal propulsion that takes up the rigid body's Coriolis force and every deviation of the speed."""

    words: ClassVar[str] = "the speed ahead through the water is held constant"
    shown_by: ClassVar[str] = "turning hard at constant power"
    source: ClassVar[str] = (
        "T. I. Fossen, Handbook of Marine Craft Hydrodynamics, 2nd ed. 2021, section 6.5: u = u0"
    )
    law: ClassVar = law

    speed: float = param(0.0, low=-50.0, high=50.0, unit="m/s", words="that is held")
    gain: float = param(0.0, low=0.0, high=1e9, unit="N s/m", words="force per deviation")
    mass: float = param(
        UNSET,
        low=0.0,
        high=1e12,
        unit="kg",
        words="rigid mass; if not given, the vessel's own",
        follows="vessel.body.mass",
    )
