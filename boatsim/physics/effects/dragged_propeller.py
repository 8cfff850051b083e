"""Dragged propeller: a thruster that works against the way adds only what exceeds its own idle drag."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import UNSET, Force, Wrench, param


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
def law(m: Any, q: Any) -> Wrench:
    """Each outboard for itself, at the speed of its own mount along its own axis."""
    port_c, port_s = m.cos_steer_port_rad, m.sin_steer_port_rad
    starboard_c, starboard_s = m.cos_steer_starboard_rad, m.sin_steer_starboard_rad
    across, swing = m.vr + q.x * m.r, q.half_spacing * m.r
    port = missing(q.gain * m.thrust_port_N, (m.ur + swing) * port_c + across * port_s, q.drag)
    starboard = missing(q.gain * m.thrust_starboard_N, (m.ur - swing) * starboard_c + across * starboard_s, q.drag)
    port_X, starboard_X = port * port_c, starboard * starboard_c
    Y = port * port_s + starboard * starboard_s
    return Wrench(port_X + starboard_X, Y, 0.0, q.x * Y + q.half_spacing * (port_X - starboard_X))


@dataclass(frozen=True)
class DraggedPropeller(Force):
    """The drag of an idle propeller is part of the hull's: a thrust against the way takes its place."""

    words: ClassVar[str] = "a propeller that turns against the way adds only what exceeds the drag it has when idle"
    shown_by: ClassVar[str] = "one thruster astern while the boat has way on, and from rest"
    source: ClassVar[str] = "drag of a disc across the flow, 0.5 rho A C_D u^2"
    law: ClassVar = law

    drag: float = param(0.0, low=0.0, high=1e6, unit="N s^2/m^2", words="of one idle propeller", fit=True, spread=1.0)
    x: float = param(UNSET, low=-500.0, high=500.0, unit="m", words="mounts", follows="outboards.x")
    half_spacing: float = param(
        UNSET, low=0.0, high=100.0, unit="m", words="mount to centreline", follows="outboards.half_spacing"
    )
    gain: float = param(UNSET, low=0.0, high=5.0, unit="", words="the vessel's", follows="outboards.gain")
