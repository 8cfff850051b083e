"""Towed drag: drag of something that the boat tows, such as a dinghy, a net or a drogue."""

from dataclasses import dataclass
from math import sqrt
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Force, Wrench, param, wrench


@njit(inline="always")
def law(m: Any, q: Any) -> Wrench:
    """Return the pull of a towed object on the boat, which opposes the motion of its attachment.

    Args:
        m: Motion of the hull: velocities [m/s], rates [rad/s], position [m], attitude [rad].
        q: Parameters of the effect, with the names and units of its class.

    Returns:
        Force [N] and moment [N m] in body axes.
    """
    ahead = m.ur - q.y * m.r  # [m/s] velocity of the attachment through the water
    aside = m.vr + q.x * m.r
    resistance = q.drag * sqrt(ahead * ahead + aside * aside)  # [N s/m]
    X, Y = -resistance * ahead, -resistance * aside
    return wrench(X=X, Y=Y, N=q.x * Y - q.y * X)


# Range of the attachment in a diagnosis [m], for the reference hull of 1.2 m: from the stern to the
# bow, and a tenth of a length beyond both for platforms and bowsprits. Farther out, the drag of
# something that is not attached to the hull describes whatever brakes its turning.
ON_HULL = (-0.72, 0.72)


@dataclass(frozen=True)
class TowedDrag(Force):
    """Quadratic drag of an object that the boat tows on a light line.

    X = -drag |V_P| u_P,  Y = -drag |V_P| v_P,  N = x Y - y X

    V_P = (u_P, v_P) is the velocity of the attachment at (`x`, `y`) through the water. The drag
    coefficient is half the density of the water times drag area. The object has no inertia of its
    own and follows the attachment at once: the line is short compared with the radius of a turn,
    and the mass of the object is small compared with that of the boat. The line is attached at the
    height of the origin. A drogue or a sea anchor is such an object, too: a boat that drifts in the
    wind turns its attachment against the drift.

    On a straight track it is additional quadratic damping in surge. Turns distinguish them: the
    attachment gets a sway force and a yaw moment.
    """

    formula: ClassVar[str] = (
        r"\begin{aligned} X &= -c \, |V_P| \, u_P, \quad Y = -c \, |V_P| \, v_P, \quad "
        r"N = x Y - y X \\ u_P &= u_r - y r, \quad v_P = v_r + x r, \quad "
        r"|V_P| = \sqrt{u_P^2 + v_P^2} \end{aligned}"
    )
    symbols: ClassVar = {"drag": "c", "x": "x", "y": "y"}
    needs: ClassVar = ("surge", "sway", "yaw")
    ruled_out_by: ClassVar = {"towing": (False,), "no_water": (True,)}
    words: ClassVar[str] = "the boat tows something that brakes it"
    shown_by: ClassVar[str] = "running straight ahead, and hard turns at speed"
    source: ClassVar[str] = (
        "S. F. Hoerner, Fluid-Dynamic Drag, 1965, chapter 1: drag in proportion to the square of "
        "the speed"
    )
    law: ClassVar = law
    strength: ClassVar = ("drag",)
    starts: ClassVar = ({"drag": 1.0, "x": -0.6}, {"drag": 1.0, "x": 0.6})  # stern and bow

    drag: float = param(
        0.0,
        low=0.0,
        high=1e9,
        unit="N s^2/m^2",
        words="drag coefficient: half the density of the water times drag area",
        fit=True,
        spread=8.0,  # twice that of quadratic damping: a drogue exceeds the drag of the hull
    )
    x: float = param(
        0.0,
        low=-500.0,
        high=500.0,
        unit="m",
        words="attachment ahead of the origin",
        fit=True,
        spread=0.6,
        within=ON_HULL,
    )
    y: float = param(
        0.0, low=-100.0, high=100.0, unit="m", words="attachment to starboard of the origin"
    )
