"""Slope: the surface on which a craft floats on air is not level, so that its weight pulls it."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import UNSET, Force, Wrench, param, wrench
from boatsim.physics.particulars import GRAVITY


@njit(inline="always")
def law(m: Any, q: Any) -> Wrench:
    """Return the part of the weight that acts along an inclined surface.

    Args:
        m: Motion of the hull: velocities [m/s], rates [rad/s], position [m], attitude [rad].
        q: Parameters of the effect, with the names and units of its class.

    Returns:
        Force [N] in body axes.
    """
    north, east = q.mass * GRAVITY * q.north, q.mass * GRAVITY * q.east
    return wrench(
        X=north * m.cos_psi + east * m.sin_psi,
        Y=east * m.cos_psi - north * m.sin_psi,
    )


@dataclass(frozen=True)
class Slope(Force):
    """Weight of a craft along a surface that is inclined by small angles, such as an air table.

    X = m g (a cos psi + b sin psi),  Y = m g (b cos psi - a sin psi)

    a is `north` and b `east` [rad], positive where the surface falls in that direction.
    """

    formula: ClassVar[str] = (
        r"X = m g \, (a \cos\psi + b \sin\psi), \quad Y = m g \, (b \cos\psi - a \sin\psi)"
    )
    symbols: ClassVar = {"north": "a", "east": "b", "mass": "m"}
    needs: ClassVar = ("surge", "sway")
    required_facts: ClassVar = {"no_water": True}
    of_surroundings: ClassVar[bool] = True
    words: ClassVar[str] = "the surface is not level, and the weight of the craft pulls it downhill"
    shown_by: ClassVar[str] = "floating without thrust"
    source: ClassVar[str] = "weight on an inclined plane"
    law: ClassVar = law
    strength: ClassVar = ("north", "east")

    north: float = param(
        0.0,
        low=-0.5,
        high=0.5,
        unit="rad",
        words="downward slope to the north",
        fit=True,
        spread=0.01,
    )
    east: float = param(
        0.0,
        low=-0.5,
        high=0.5,
        unit="rad",
        words="downward slope to the east",
        fit=True,
        spread=0.01,
    )
    mass: float = param(
        UNSET, low=0.0, high=1e9, unit="kg", words="mass of the craft", follows="vessel.body.mass"
    )
