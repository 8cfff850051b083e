"""Extra mass: something heavy on board that the model does not know of."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Boat, Force, Inertia, Mass, Release, Wrench, mass, param, shift, wrench


@njit(inline="always")
def inertia(q: Any) -> Mass:
    """A point mass on the centreline."""
    first = q.mass * q.x
    return mass(surge=q.mass, sway=q.mass, sway_yaw=first, yaw=first * q.x)


@njit(inline="always")
def law(m: Any, q: Any) -> Wrench:
    """Its Coriolis and centripetal force over ground: (v + x r) r and -u r at its place."""
    across, along = q.mass * (m.v + q.x * m.r), q.mass * m.u
    return wrench(X=across * m.r, Y=-along * m.r, N=-q.x * along * m.r)


@dataclass(frozen=True)
class ExtraMass(Inertia, Force):
    """A point mass fixed to the hull on its centreline."""

    words: ClassVar[str] = "the boat carries a mass that the model does not know of"
    shown_by: ClassVar[str] = "sharp starts and stops in every axis"
    source: ClassVar[str] = "T. I. Fossen, Handbook of Marine Craft Hydrodynamics, 2nd ed. 2021, section 3.3"
    moves_with: ClassVar[str] = "hull"
    inertia: ClassVar = inertia
    law: ClassVar = law
    strength: ClassVar = ("mass",)
    starts: ClassVar = ({"mass": 0.7, "x": 0.2}, {"mass": 0.7, "x": -0.2})

    mass: float = param(0.0, low=0.0, high=1e9, unit="kg", words="its mass", fit=True, spread=1.5)
    x: float = param(0.0, low=-250.0, high=250.0, unit="m", words="positive forward", fit=True, spread=0.3)


@dataclass(frozen=True)
class Payload(Release):
    """Mass spread over the hull like its own; the deeper draught that comes with it is an error of the added mass."""

    words: ClassVar[str] = "the whole boat is heavier than stated"
    shown_by: ClassVar[str] = "sharp starts and stops in every axis"
    source: ClassVar[str] = ExtraMass.source
    strength: ClassVar = ("mass",)

    mass: float = shift(
        "body.mass", "body.roll_inertia", "body.yaw_inertia", words="more than stated", unit="kg", spread=1.5,
        low=-1e9, high=1e9,
    )  # fmt: skip

    def weights(self, vessel: Boat) -> dict[str, float]:
        """The hull's radii of gyration stay."""
        body = vessel.body
        return {f"body.{name}": getattr(body, name) / body.mass for name in ("roll_inertia", "yaw_inertia")}
