"""Quay: contact of the hull with a straight fixed wall, such as a quay or a pontoon."""

from dataclasses import dataclass
from math import cos, exp, log, sin, sqrt
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import UNSET, Boat, Force, Wrench, param, wrench

# [boat lengths] width of the transition from no contact to contact; fenders are softer
SOFT = 0.01
LARGEST_RATE = 4.0  # limits the share of the force by the speed, so that a fit cannot diverge


@njit(inline="always")
def fender_compression(depth: float, soft: float) -> float:
    """Return by how much hull or fender is compressed [m], smooth at the begin of the contact.

    Args:
        depth: How far the undeformed hull reaches into the wall [m]; negative: the distance.
        soft: Width of the transition [m].
    """
    z = depth / soft
    if z > 30.0:
        return depth
    return soft * log(1.0 + exp(z)) if z > -30.0 else 0.0


@njit(inline="always")
def law(m: Any, q: Any) -> Wrench:
    """Return the force of a straight wall on a hull with an elliptic waterline that touches it.

    Args:
        m: Motion of the hull: velocities [m/s], rates [rad/s], position [m], attitude [rad].
        q: Parameters of the effect, with the names and units of its class.

    Returns:
        Force [N] and moment [N m] in body axes.
    """
    to_north, to_east = cos(q.toward), sin(q.toward)
    # the same direction in body axes
    ahead = m.cos_psi * to_north + m.sin_psi * to_east
    aside = m.cos_psi * to_east - m.sin_psi * to_north
    # the point of the ellipse that is nearest to the wall, and its distance from the origin
    reach = sqrt((q.half_length * ahead) ** 2 + (q.half_beam * aside) ** 2)
    x = -q.half_length * q.half_length * ahead / reach
    y = -q.half_beam * q.half_beam * aside / reach
    track = sqrt((q.north_reach * to_north) ** 2 + (q.east_reach * to_east) ** 2)
    wall = to_north * q.north + to_east * q.east - track - q.half_beam + q.overlap
    depth = wall - (to_north * m.x + to_east * m.y - reach)
    speed = -(ahead * (m.u - y * m.r) + aside * (m.v + x * m.r))  # [m/s] into the wall
    damping = min(max(1.0 + q.damping * speed, 0.0), LARGEST_RATE)
    force = q.stiffness * fender_compression(depth, 2.0 * SOFT * q.half_length) * damping
    X, Y = force * ahead, force * aside
    return wrench(X=X, Y=Y, N=x * Y - y * X)


@dataclass(frozen=True)
class Quay(Force):
    """Elastic contact of the hull with a straight fixed wall: a quay, a pontoon or a pile wall.

    F = stiffness d (1 + damping dd/dt)  along the normal of the wall, where the hull touches it

    d is the depth to which the ellipse with the length and beam of the hull reaches into the wall.
    `toward` is the direction from the wall to the open water. The wall touches the side of a hull
    at that end of the track which is farthest against this direction, `overlap` deep. The track is
    an ellipse about (`north`, `east`) with the half axes `north_reach` and `east_reach`; with both
    0 the wall stands half a beam from (`north`, `east`). A diagnosis takes the track from the
    recordings, on request, where the boat stays within a few lengths.
    """

    formula: ClassVar[str] = (
        r"\begin{aligned} F &= k \, d \, (1 + c \, \dot d) \quad \text{for } d > 0, \quad "
        r"d = w + h - \mathbf{n} \cdot \mathbf{p}, \quad h = \sqrt{(\tfrac{L}{2} n_x)^2 + "
        r"(\tfrac{B}{2} n_y)^2} \\ X &= F n_x, \quad Y = F n_y, \quad N = x_c Y - y_c X, "
        r"\quad \mathbf{n} = (\cos\theta, \sin\theta) \end{aligned}"
    )
    symbols: ClassVar = {
        "stiffness": "k",
        "damping": "c",
        "toward": r"\theta",
        "overlap": "w",
        "half_length": r"\tfrac{L}{2}",
        "half_beam": r"\tfrac{B}{2}",
    }
    needs: ClassVar = ("surge", "sway")
    words: ClassVar[str] = "the hull touches a quay or another fixed wall"
    shown_by: ClassVar[str] = "approaching the wall slowly and leaving it again"
    source: ClassVar[str] = (
        "K. H. Hunt, F. R. E. Crossley, J. Applied Mechanics 42, 1975: contact force with damping "
        "in proportion to the indentation"
    )
    of_surroundings: ClassVar[bool] = True
    tied_to: ClassVar[str] = "the quay"
    confounded_with: ClassVar = ("tether",)  # a taut line to the other side pulls alike
    tried_last: ClassVar[bool] = True
    law: ClassVar = law
    strength: ClassVar = ("stiffness",)
    facts: ClassVar = {"track_m": ("north", "east", "north_reach", "east_reach")}
    # contact of the side at the end of the track, or of the bow
    starts: ClassVar = tuple(
        {"stiffness": 20.0, "damping": 2.0, "toward": 0.7854 * k, "overlap": overlap}
        for overlap in (0.03, -0.3)
        for k in range(-3, 5)
    )

    stiffness: float = param(
        0.0,
        low=0.0,
        high=1e8,
        unit="N/m",
        words="stiffness of hull and fenders",
        fit=True,
        spread=40.0,
    )
    damping: float = param(
        0.0,
        low=0.0,
        high=100.0,
        unit="s/m",
        words="share of the force per speed into the wall",
        fit=True,
        spread=4.0,
    )
    toward: float = param(
        0.0,
        low=-7.0,
        high=7.0,
        unit="rad",
        words="direction from the wall to the open water, clockwise from north",
        fit=True,
        spread=3.0,
    )
    overlap: float = param(
        0.0,
        low=-1e3,
        high=1e3,
        unit="m",
        words="depth of the side of the hull in the wall at the end of the track",
        fit=True,
        spread=0.2,
    )
    north: float = param(UNSET, low=-1e6, high=1e6, unit="m", words="middle of the track, north")
    east: float = param(UNSET, low=-1e6, high=1e6, unit="m", words="middle of the track, east")
    north_reach: float = param(
        UNSET, low=0.0, high=1e5, unit="m", words="half extent of the track, northward"
    )
    east_reach: float = param(
        UNSET, low=0.0, high=1e5, unit="m", words="half extent of the track, eastward"
    )
    half_length: float = param(
        UNSET, low=0.01, high=500.0, unit="m", words="half the length; default: that of the boat"
    )
    half_beam: float = param(
        UNSET, low=0.01, high=100.0, unit="m", words="half the beam; default: that of the boat"
    )

    def derived_parameters(self, vessel: Boat) -> dict[str, float]:
        """Return the half axes of the waterline, half the length and half the beam.

        Args:
            vessel: Vessel with a length and a beam [m].
        """
        return {"half_length": 0.5 * vessel.length, "half_beam": 0.5 * vessel.beam}
