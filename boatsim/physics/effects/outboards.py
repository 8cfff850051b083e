"""Twin outboards: two thrusts that steer."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Force, Release, Wrench, factor, param


@njit(inline="always")
def law(m: Any, q: Any) -> Wrench:
    """Sum of two forces (T cos a, T sin a) at (x, -half_spacing) and (x, +half_spacing)."""
    port_X = q.gain * m.thrust_port_N * m.cos_steer_port_rad
    port_Y = q.gain * m.thrust_port_N * m.sin_steer_port_rad
    starboard_X = q.gain * m.thrust_starboard_N * m.cos_steer_starboard_rad
    starboard_Y = q.gain * m.thrust_starboard_N * m.sin_steer_starboard_rad
    X, Y = port_X + starboard_X, port_Y + starboard_Y
    return Wrench(X, Y, 0.0, q.x * Y + q.half_spacing * (port_X - starboard_X))


@dataclass(frozen=True)
class Outboards(Force):
    """Two steered thrusters at the stern; thrust and angle come from the actuator channels."""

    words: ClassVar[str] = "two outboards push and steer"
    shown_by: ClassVar[str] = "any manoeuvre"
    source: ClassVar[str] = "J. A. Bayless, Adaptive Control of Joystick Steering, 2017, eq. 16 in its general form"
    law: ClassVar = law

    x: float = param(-0.6, low=-500.0, high=500.0, unit="m", words="mounts ahead of the origin of motion")
    half_spacing: float = param(0.19, low=0.0, high=100.0, unit="m", words="mount to centreline, B")
    gain: float = param(1.0, low=0.1, high=5.0, unit="", words="thrust per commanded thrust", calibrates="thrust")


@dataclass(frozen=True)
class ThrustGainError(Release):
    """All thrust is off by one factor, by more than the stated uncertainty of the thrust coefficient."""

    words: ClassVar[str] = "all thrust is stronger or weaker than stated by one factor"
    shown_by: ClassVar[str] = "runs at several thrust levels"

    factor: float = factor(
        "outboards.gain", "azimuth_thruster.gain", words="thrust per stated thrust", spread=0.3, low=0.2, high=3.0
    )
