"""Prop walk: a turning propeller pushes the stern sideways, most of all astern."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Force, Wrench, param, wrench


@njit(inline="always")
def law(m: Any, q: Any, s: Any, t: Any) -> Wrench:
    """All propellers turn the same way, so their side forces add up."""
    Y = q.side_force_per_thrust * s.thrust * (q.ahead_share if s.thrust > 0.0 else 1.0)
    return wrench(Y=Y, N=t.x * Y)


@dataclass(frozen=True)
class PropWalk(Force):
    """Side force in proportion to the thrust: to starboard ahead and to port astern for a positive value."""

    needs: ClassVar = ("sway",)
    words: ClassVar[str] = "the propellers walk the stern sideways, most of all astern"
    shown_by: ClassVar[str] = "straight astern, then straight ahead"
    source: ClassVar[str] = (
        "J. Brix (ed.), Manoeuvring Technical Manual, 1993; a third of it ahead is an assumption"
    )
    rides: ClassVar[str] = "thruster"
    law: ClassVar = law

    side_force_per_thrust: float = param(
        0.0,
        low=-0.6,
        high=0.6,
        unit="",
        words="starboard force per thrust, astern",
        fit=True,
        spread=0.1,
    )
    ahead_share: float = param(1.0 / 3.0, low=0.0, high=1.0, unit="", words="of it ahead")
