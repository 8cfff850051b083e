"""Extra mass: something heavy on board that the model does not know of."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import (
    Boat,
    Change,
    Force,
    Inertia,
    Mass,
    Release,
    Wrench,
    mass,
    param,
    shift,
    wrench,
)
from boatsim.physics.particulars import GRAVITY


@njit(inline="always")
def inertia(q: Any) -> Mass:
    """A point mass on the centreline."""
    first = q.mass * q.x
    second = first * q.x
    return mass(
        surge=q.mass,
        sway=q.mass,
        heave=q.mass,
        pitch=second,
        yaw=second,
        heave_pitch=-first,
        sway_yaw=first,
    )


@njit(inline="always")
def law(m: Any, q: Any) -> Wrench:
    """Its Coriolis and centripetal force over ground at its place, and its weight, which sinks and trims the hull."""
    v, w = m.v + q.x * m.r, m.w - q.x * m.q
    X = q.mass * (v * m.r - w * m.q)
    Y = q.mass * (w * m.p - m.u * m.r)
    Z = q.mass * (m.u * m.q - v * m.p + GRAVITY)
    return wrench(X=X, Y=Y, Z=Z, M=-q.x * Z, N=q.x * Y)


@dataclass(frozen=True)
class ExtraMass(Inertia, Force):
    """A point mass fixed to the hull on its centreline, at the height of the origin."""

    needs: ClassVar = ("surge",)
    words: ClassVar[str] = "the boat carries a mass that the model does not know of"
    shown_by: ClassVar[str] = "sharp starts and stops in every axis"
    source: ClassVar[str] = (
        "T. I. Fossen, Handbook of Marine Craft Hydrodynamics, 2nd ed. 2021, section 3.3"
    )
    moves_with: ClassVar[str] = "hull"
    inertia: ClassVar = inertia
    law: ClassVar = law
    strength: ClassVar = ("mass",)
    starts: ClassVar = ({"mass": 0.7, "x": 0.2}, {"mass": 0.7, "x": -0.2})

    mass: float = param(
        0.0, low=0.0, high=1e9, unit="kg", words="its mass", fit=True, spread=1.5, within=(0.0, 4.6)
    )
    x: float = param(
        0.0,
        low=-250.0,
        high=250.0,
        unit="m",
        words="positive forward",
        fit=True,
        spread=0.3,
        within=(-0.6, 0.6),
    )


@dataclass(frozen=True)
class Payload(Release):
    """Mass spread over the hull like its own; the deeper draught that comes with it is an error of the added mass."""

    needs: ClassVar = (
        "surge",
        "sway",
    )  # a hull that only rolls shows no more than the ratio of moment to inertia
    words: ClassVar[str] = (
        "the whole boat is heavier than stated, or all that drives and brakes it is weaker alike"
    )
    shown_by: ClassVar[str] = "sharp starts and stops in every axis"
    source: ClassVar[str] = ExtraMass.source
    strength: ClassVar = ("mass",)

    mass: float = shift(
        "body.mass",
        "body.roll_inertia",
        "body.pitch_inertia",
        "body.yaw_inertia",
        words="more than stated",
        unit="kg",
        spread=1.5,
        low=-1e9,
        high=1e9,
        within=(-2.3, 4.6),
    )

    def changes(self, vessel: Boat) -> list[Change]:
        """A hull that does not pitch need not state its inertia in pitch."""
        return [c for c in super().changes(vessel) if getattr(vessel.body, c.key) is not None]

    def weights(self, vessel: Boat) -> dict[str, float]:
        """The hull's radii of gyration stay."""
        body = vessel.body
        inertias = (
            (f"body.{n}", getattr(body, n))
            for n in ("roll_inertia", "pitch_inertia", "yaw_inertia")
        )
        return {place: inertia / body.mass for place, inertia in inertias if inertia is not None}

    def ratios(self, vessel: Boat) -> dict[str, tuple[float, str]]:
        """Force to mass: a heavier hull moves as one that all its forces move less."""
        meaning = "of what the file has: no motion tells mass and forces apart, only a balance does"
        return {"force_per_mass": (vessel.body.mass / (vessel.body.mass + self.mass), meaning)}
