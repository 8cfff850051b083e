"""Prop walk: a turning propeller pushes the stern sideways, most of all astern."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import UNSET, Force, Wrench, param


@njit(inline="always")
def side_force(thrust: float, q: Any) -> float:
    """Starboard force of one propeller [N]."""
    return q.side_force_per_thrust * thrust * (q.ahead_share if thrust > 0.0 else 1.0)


@njit(inline="always")
def law(m: Any, q: Any) -> Wrench:
    """Both propellers turn the same way, so their side forces at the stern add up."""
    Y = side_force(m.thrust_port_N, q) + side_force(m.thrust_starboard_N, q)
    return Wrench(0.0, Y, 0.0, q.x * Y)


@dataclass(frozen=True)
class PropWalk(Force):
    """Side force in proportion to the thrust: to starboard ahead and to port astern for a positive value."""

    words: ClassVar[str] = "the propellers walk the stern sideways, most of all astern"
    shown_by: ClassVar[str] = "straight astern, then straight ahead"
    source: ClassVar[str] = "J. Brix (ed.), Manoeuvring Technical Manual, 1993; a third of it ahead is an assumption"
    law: ClassVar = law

    side_force_per_thrust: float = param(
        0.0, low=-0.6, high=0.6, unit="", words="starboard force per thrust, astern", fit=True, spread=0.1
    )
    ahead_share: float = param(1.0 / 3.0, low=0.0, high=1.0, unit="", words="of it ahead")
    x: float = param(UNSET, low=-500.0, high=500.0, unit="m", words="the vessel's thrusters", follows="outboards.x")
