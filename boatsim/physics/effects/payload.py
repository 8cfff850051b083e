"""Payload: the boat is loaded heavier than stated, spread like its own mass."""

from dataclasses import dataclass, replace
from math import sqrt
from typing import Any, ClassVar, Self

from numba import njit

from boatsim.physics.base import Force, Inertia, Mass, Wrench, param


@njit(inline="always")
def inertia(q: Any) -> Mass:
    """More mass with the hull's radius of gyration."""
    return Mass(q.mass, q.mass, 0.0, q.mass * q.gyradius * q.gyradius, 0.0, 0.0, 0.0)


@njit(inline="always")
def law(m: Any, q: Any) -> Wrench:
    """Its Coriolis and centripetal force over ground."""
    return Wrench(q.mass * m.v * m.r, -q.mass * m.u * m.r, 0.0, 0.0)


@dataclass(frozen=True)
class Payload(Inertia, Force):
    """Mass spread over the hull; the deeper draught that comes with it is an error of the added mass."""

    words: ClassVar[str] = "the whole boat is heavier than stated"
    shown_by: ClassVar[str] = "sharp starts and stops in every axis"
    source: ClassVar[str] = "T. I. Fossen, Handbook of Marine Craft Hydrodynamics, 2nd ed. 2021, section 3.3"
    moves_with: ClassVar[str] = "hull"
    inertia: ClassVar = inertia
    law: ClassVar = law
    strength: ClassVar = ("mass",)

    mass: float = param(0.0, low=-1e9, high=1e9, unit="kg", words="more than stated", fit=True, spread=1.5)
    gyradius: float = param(0.0, low=0.0, high=500.0, unit="m", words="radius of gyration; 0: the hull's in yaw")

    def completed(self, vessel: Any) -> Self:
        """The hull's own radius of gyration filled in."""
        return replace(self, gyradius=self.gyradius or sqrt(vessel.body.yaw_inertia / vessel.body.mass))
