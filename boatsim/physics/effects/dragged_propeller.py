"""Dragged propeller: a thruster that works against the way adds only what exceeds its own idle drag."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Force, Wrench, param
from boatsim.physics.effects.thruster import at_mount


@njit(inline="always")
def missing(thrust: float, speed: float, drag: float) -> float:
    """What a thrust against the way of its propeller lacks: the drag D that this has when idle, or all of it below D.

    Idle, the propeller drags D as part of the hull, and that ends when it turns the other way.
    """
    if thrust * speed >= 0.0:
        return 0.0
    idle = drag * speed * abs(speed)
    return idle if abs(idle) < abs(thrust) else -thrust


@njit(inline="always")
def law(m: Any, q: Any, s: Any, t: Any) -> Wrench:
    """Each thruster for itself, at the speed of its own mount along its own axis."""
    along, across = m.ur - t.y * m.r, m.vr + t.x * m.r
    return at_mount(
        missing(t.gain * s.thrust, along * s.cos_angle + across * s.sin_angle, q.drag), s, t
    )


@dataclass(frozen=True)
class DraggedPropeller(Force):
    """The drag of an idle propeller is part of the hull's: a thrust against the way takes its place."""

    words: ClassVar[str] = (
        "a propeller that turns against the way adds only what exceeds the drag it has when idle"
    )
    shown_by: ClassVar[str] = "one thruster astern while the boat has way on, and from rest"
    source: ClassVar[str] = "drag of a disc across the flow, 0.5 rho A C_D u^2"
    rides: ClassVar[str] = "thruster"
    law: ClassVar = law

    drag: float = param(
        0.0,
        low=0.0,
        high=1e6,
        unit="N s^2/m^2",
        words="of one idle propeller",
        fit=True,
        spread=1.0,
    )
