"""Wind: steady wind force in earth axes on a hull of unknown areas."""

from dataclasses import dataclass
from math import cos, pi, sin
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Force, Wrench, param, wrench


@njit(inline="always")
def law(m: Any, q: Any) -> Wrench:
    """Return the force and yaw moment of a steady wind on the hull.

    The force is full abeam and reduced to a share of it end-on.

    Args:
        m: Motion of the hull: velocities [m/s], rates [rad/s], position [m], attitude [rad].
        q: Parameters of the effect, with the names and units of its class.

    Returns:
        Force [N] and moment [N m] in body axes.
    """
    north, east = q.force * cos(q.toward), q.force * sin(q.toward)
    along = m.cos_psi * north + m.sin_psi * east
    across = m.cos_psi * east - m.sin_psi * north
    arm = q.arm + (q.swing * along / q.force if q.force > 0.0 else 0.0)
    return wrench(X=q.end_on * along, Y=across, N=arm * across)


@dataclass(frozen=True)
class Wind(Force):
    """Steady wind force of constant direction, for a hull whose areas are not known.

    X = end_on force cos g,  Y = force sin g,  N = (arm + swing cos g) Y

    g is the angle between the bow and the direction `toward` of the wind.
    """

    formula: ClassVar[str] = (
        r"X = e \, F \cos\gamma, \quad Y = F \sin\gamma, \quad N = (l + l_1 \cos\gamma) "
        r"\, Y, \quad \gamma = \gamma_\mathrm{to} - \psi"
    )
    symbols: ClassVar = {
        "force": "F",
        "toward": r"\gamma_\mathrm{to}",
        "arm": "l",
        "swing": "l_1",
        "end_on": "e",
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
    strength: ClassVar = ("force",)
    starts: ClassVar = tuple(
        {"force": 0.08, "toward": quarter * pi / 2} for quarter in (-1, 0, 1, 2)
    )

    force: float = param(
        0.0,
        low=0.0,
        high=1e7,
        unit="N",
        words="side force with the wind on the beam",
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
