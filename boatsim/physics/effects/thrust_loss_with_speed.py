"""Thrust loss with speed: a propeller pushes less the faster the water already goes its way."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import UNSET, Force, Wrench, param


@njit(inline="always")
def law(m: Any, q: Any) -> Wrench:
    """Each outboard's thrust T loses loss |T| u: falls ahead, grows when it brakes."""
    port = -q.gain * q.loss * m.ur * abs(m.thrust_port_N)
    starboard = -q.gain * q.loss * m.ur * abs(m.thrust_starboard_N)
    port_X, starboard_X = port * m.cos_steer_port_rad, starboard * m.cos_steer_starboard_rad
    Y = port * m.sin_steer_port_rad + starboard * m.sin_steer_starboard_rad
    return Wrench(port_X + starboard_X, Y, 0.0, q.x * Y + q.half_spacing * (port_X - starboard_X))


@dataclass(frozen=True)
class ThrustLossWithSpeed(Force):
    """The thrust of a fixed command falls in proportion to the advance speed."""

    words: ClassVar[str] = "the propellers push less the faster the boat goes"
    shown_by: ClassVar[str] = "the same thrust command from rest and at full speed"
    source: ClassVar[str] = "T. I. Fossen, Handbook of Marine Craft Hydrodynamics, 2nd ed. 2021, section 9.3: K_T(J)"
    law: ClassVar = law

    loss: float = param(0.0, low=0.0, high=50.0, unit="s/m", words="share lost per speed ahead", fit=True, spread=0.5)
    x: float = param(UNSET, low=-500.0, high=500.0, unit="m", words="mounts", follows="outboards.x")
    half_spacing: float = param(
        UNSET, low=0.0, high=100.0, unit="m", words="mount to centreline", follows="outboards.half_spacing"
    )
    gain: float = param(UNSET, low=0.0, high=5.0, unit="", words="the vessel's", follows="outboards.gain")
