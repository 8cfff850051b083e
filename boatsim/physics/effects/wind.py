"""Wind: steady wind force in earth axes on a hull of unknown areas."""

from dataclasses import dataclass
from math import cos, pi, sin, sqrt
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Force, Wrench, param, wrench


@njit(inline="always")
def law(m: Any, q: Any) -> Wrench:
    """Return the force and yaw moment of a steady wind on the hull.

    The force is full abeam and reduced to a share of it end-on. It grows with the square of the
    speed of the air relative to the hull.

    Args:
        m: Motion of the hull: velocities [m/s], rates [rad/s], position [m], attitude [rad].
        q: Parameters of the effect, with the names and units of its class.

    Returns:
        Force [N] and moment [N m] in body axes.
    """
    north, east = cos(q.toward), sin(q.toward)
    along = m.cos_psi * north + m.sin_psi * east - q.inverse_speed * m.u
    across = m.cos_psi * east - m.sin_psi * north - q.inverse_speed * m.v
    relative = sqrt(along * along + across * across)  # relative to the wind at rest
    Y = q.force * relative * across
    arm = q.arm + (q.swing * along / relative if relative > 0.0 else 0.0)
    return wrench(X=q.end_on * q.force * relative * along, Y=Y, N=arm * Y)


@dataclass(frozen=True)
class Wind(Force):
    """Force of a steady wind, for a hull whose areas are not known.

    X = end_on force a c,  Y = force b c,  N = (arm + swing a / c) Y
    a = cos g - inverse_speed u,  b = sin g - inverse_speed v,  c = sqrt(a^2 + b^2)

    g is the angle between the bow and the direction `toward` of the wind; (a, b) is the velocity of
    the air past the hull over that of the wind. With inverse_speed = 0 the wind is much faster than
    the hull, whose motion then does not change the force.
    """

    formula: ClassVar[str] = (
        r"\begin{aligned} X &= e \, F a c, \quad Y = F b c, \quad N = (l + l_1 a / c) \, Y \\ "
        r"a &= \cos\gamma - w u, \quad b = \sin\gamma - w v, \quad c = \sqrt{a^2 + b^2}, \quad "
        r"\gamma = \gamma_\mathrm{to} - \psi \end{aligned}"
    )
    symbols: ClassVar = {
        "force": "F",
        "toward": r"\gamma_\mathrm{to}",
        "arm": "l",
        "swing": "l_1",
        "end_on": "e",
        "inverse_speed": "w",
    }
    ruled_out_by: ClassVar = {"indoors": (True,)}
    needs: ClassVar = ("surge", "sway")
    of_surroundings: ClassVar[bool] = True
    exogenous: ClassVar = ("force", "toward")
    words: ClassVar[str] = "a steady wind pushes the hull in one direction of the world"
    shown_by: ClassVar[str] = "turning through all headings while holding the thrust"
    source: ClassVar[str] = (
        "T. I. Fossen, Handbook of Marine Craft Hydrodynamics, 2nd ed. 2021, section 10.1"
    )
    law: ClassVar = law
    of_air: ClassVar = True
    tied_to: ClassVar[str] = "the air"
    strength: ClassVar = ("force",)
    # a light breeze from each quarter: fits from there reach weak and strong winds
    starts: ClassVar = tuple(
        {"force": 0.2, "toward": quarter * pi / 2} for quarter in (-1, 0, 1, 2)
    )

    force: float = param(
        0.0,
        low=0.0,
        high=1e7,
        unit="N",
        words="side force on a hull at rest with the wind on the beam",
        fit=True,
        spread=2.1,  # 5 m/s on a side of 0.3 L B: 0.5 x 1.2 kg/m^3 x 0.9 x 25 m^2/s^2 x 0.158 m^2
    )
    toward: float = param(
        0.0,
        low=-2 * pi,
        high=2 * pi,
        unit="rad",
        words="direction the wind blows to",
        fit=True,
        spread=3.0,
    )
    arm: float = param(
        0.0,
        low=-200.0,
        high=200.0,
        unit="m",
        words="lever of the side force, ahead of the origin",
        fit=True,
        spread=0.1,
        within=(-0.6, 0.6),
    )
    swing: float = param(
        0.0,
        low=-200.0,
        high=200.0,
        unit="m",
        words="additional lever with the wind from astern",
        fit=True,
        spread=0.1,
        within=(-0.6, 0.6),
    )
    end_on: float = param(0.5, low=0.0, high=2.0, unit="", words="force end-on over force abeam")
    inverse_speed: float = param(
        0.0,
        low=0.0,
        high=1.0,
        unit="s/m",
        words="one over the speed of the wind; 0: a wind much faster than the hull",
        fit=True,
        spread=0.15,  # a wind of 6.7 m/s
    )
