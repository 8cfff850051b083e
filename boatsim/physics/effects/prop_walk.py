"""Prop walk: side force of a turning propeller at the stern, largest astern."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Force, Wrench, param, wrench


@njit(inline="always")
def law(m: Any, q: Any, s: Any, t: Any) -> Wrench:
    """Return the side force (prop walk) of one propeller, proportional to its thrust.

    All propellers turn the same way, so their forces add up.

    Args:
        m: Motion of the hull: velocities [m/s], rates [rad/s], position [m], attitude [rad].
        q: Parameters of the effect, with the names and units of its class.
        s: Signals of the thruster on which the effect acts.
        t: Parameters of that thruster.

    Returns:
        Force [N] and moment [N m] in body axes.
    """
    Y = q.side_force_per_thrust * s.thrust * (q.ahead_share if s.thrust > 0.0 else 1.0)
    return wrench(Y=Y, N=t.x * Y)


@dataclass(frozen=True)
class PropWalk(Force):
    """Side force at the propeller proportional to its thrust.

    Y = c T  astern,  Y = ahead_share c T  ahead,  N = x Y

    c = `side_force_per_thrust`: a positive value acts to starboard ahead and to port astern. x is
    the mount.
    """

    formula: ClassVar[str] = (
        r"Y = \begin{cases} c \, T & T \le 0 \\ s \, c \, T & T > 0 \end{cases}, \quad N "
        r"= x \, Y"
    )
    symbols: ClassVar = {"side_force_per_thrust": "c", "ahead_share": "s"}
    needs: ClassVar = ("sway",)
    ruled_out_by: ClassVar = {"no_water": (True,)}
    words: ClassVar[str] = "the propellers push the stern sideways, most of all astern"
    shown_by: ClassVar[str] = "straight astern, then straight ahead"
    source: ClassVar[str] = (
        "J. Brix (ed.), Manoeuvring Technical Manual, 1993; a third of it ahead is an assumption"
    )
    per_instance_of: ClassVar[str] = "thruster"
    law: ClassVar = law

    side_force_per_thrust: float = param(
        0.0,
        low=-0.6,
        high=0.6,
        unit="",
        words="side force to starboard over thrust, astern",
        fit=True,
        spread=0.1,
        in_per_cent="going astern, the side force to starboard is {share} of the thrust",
    )
    ahead_share: float = param(
        1.0 / 3.0, low=0.0, high=1.0, unit="", words="share of that side force when going ahead"
    )
