"""Tether: a line from the boat to a fixed point."""

from dataclasses import dataclass
from math import exp, log, sqrt
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import UNSET, Boat, Force, Wrench, param, wrench

# [m] width of the transition from slack to taut; a wider one does not represent a short stiff line
SOFT = 0.02
NEAR = 0.05  # [m] regularises the direction of the pull at the anchor


@njit(inline="always")
def line_elongation(beyond: float) -> float:
    """Return the elongation of a tether line [m], as a smooth function where it becomes taut.

    Args:
        beyond: Distance between the ends of the line, less its length [m].
    """
    z = beyond / SOFT
    if z > 30.0:
        return beyond
    return SOFT * log(1.0 + exp(z)) if z > -30.0 else 0.0


@njit(inline="always")
def law(m: Any, q: Any) -> Wrench:
    """Return the force of a tether on the boat: the pull towards its anchor and the line's drag.

    Args:
        m: Motion of the hull: velocities [m/s], rates [rad/s], position [m], attitude [rad].
        q: Parameters of the effect, with the names and units of its class.

    Returns:
        Force [N] and moment [N m] in body axes.
    """
    north = q.north - m.x - q.at * m.cos_psi  # [m] from the attachment on the boat to the anchor
    east = q.east - m.y - q.at * m.sin_psi
    distance = sqrt(north * north + east * east + NEAR * NEAR)
    pull = (q.tension + q.stiffness * line_elongation(distance - q.length)) / distance
    X = pull * (m.cos_psi * north + m.sin_psi * east) - q.drag * m.ur
    Y = pull * (m.cos_psi * east - m.sin_psi * north) - q.drag * (m.vr + q.at * m.r)
    return wrench(X=X, Y=Y, N=q.at * Y)


@dataclass(frozen=True)
class Tether(Force):
    """Cable or line between the boat and a fixed point: constant tension, elasticity and drag.

    F = tension + stiffness max(distance - length, 0)  towards (north, east),  less drag times u

    The constant tension stands for the weight of the line. `at` [m] is the attachment ahead of the
    origin.
    """

    formula: ClassVar[str] = (
        r"\begin{aligned} F &= T_0 + k \max(d - l, 0) \quad \text{towards the anchor at "
        r"the distance } d \\ X &= F_x - c \, u_r, \quad Y = F_y - c \, (v_r + a r), "
        r"\quad N = a \, Y \end{aligned}"
    )
    symbols: ClassVar = {"tension": "T_0", "stiffness": "k", "length": "l", "drag": "c", "at": "a"}
    ruled_out_by: ClassVar = {"moored": (False,)}
    needs: ClassVar = ("surge", "sway")
    of_surroundings: ClassVar[bool] = True
    words: ClassVar[str] = "a line or cable pulls the boat towards a fixed point"
    shown_by: ClassVar[str] = "visiting the corners of the tank on several headings"
    tied_to: ClassVar[str] = "a fixed point"
    law: ClassVar = law
    strength: ClassVar = ("tension", "stiffness", "drag")
    starts: ClassVar = (
        *(
            {"tension": 0.05, "stiffness": 0.03, "length": 1.5, "north": north, "east": east}
            for north, east in ((3.0, 0.0), (-3.0, 0.0), (0.0, 2.5), (0.0, -2.5))
        ),
        # a short stiff line is a separate maximum of the likelihood, far from a long soft one
        *(
            {"tension": 0.0, "stiffness": 1.0, "length": 0.3, "north": north, "east": east}
            for north, east in ((0.5, 0.0), (-0.5, 0.0), (0.0, 0.5), (0.0, -0.5))
        ),
    )

    tension: float = param(
        0.0, low=0.0, high=1e6, unit="N", words="constant tension", fit=True, spread=0.15
    )
    stiffness: float = param(
        0.0, low=0.0, high=1e6, unit="N/m", words="stiffness of the line", fit=True, spread=0.5
    )
    length: float = param(
        0.0, low=0.0, high=1e4, unit="m", words="length of the slack line", fit=True, spread=3.0
    )
    drag: float = param(
        0.0,
        low=0.0,
        high=1e6,
        unit="N s/m",
        words="drag coefficient of the line in the water",
        fit=True,
        spread=0.5,
    )
    north: float = param(
        0.0, low=-1e4, high=1e4, unit="m", words="anchor, to the north", fit=True, spread=4.0
    )
    east: float = param(
        0.0, low=-1e4, high=1e4, unit="m", words="anchor, to the east", fit=True, spread=3.0
    )
    at: float = param(
        UNSET,
        low=-500.0,
        high=500.0,
        unit="m",
        words="attachment ahead of the origin; default: the stern",
    )

    def derived_parameters(self, vessel: Boat) -> dict[str, float]:
        """Return the default attachment point of a tether, the stern.

        It lies half a length behind the origin.

        Args:
            vessel: Vessel with a length [m].
        """
        return {"at": -0.5 * vessel.length}
