"""Fan wind: air drag of a hull of known areas in a steady stream of air."""

from dataclasses import dataclass
from math import cos, pi, sin, sqrt
from typing import Any, ClassVar

from numba import njit
from numba.extending import register_jitable

from boatsim.physics.base import Force, Wrench, param, wrench

AIR_DENSITY = 1.2  # [kg/m^3] dry air at 20 deg C, 1013 hPa


@register_jitable  # compiled inside other laws; plain Python if called alone
def air_drag(along: float, across: float, density: float, q: Any, swing: float) -> Wrench:
    """Return the quadratic air drag of the hull and its yaw moment.

    X = 0.5 rho U front a,  Y = 0.5 rho U side b,  N = (arm + swing a / U) Y

    Args:
        along: Velocity of the air past the hull, forward, a [m/s].
        across: Velocity of the air past the hull, to starboard, b [m/s].
        density: Density of the air [kg/m^3].
        q: Parameters with `front`, `side` [m^2] and `arm` [m].
        swing: Shift of the centre of pressure with a wind from astern [m].
    """
    speed = sqrt(along * along + across * across)
    pressure = 0.5 * density * speed
    Y = pressure * q.side * across
    arm = q.arm + (swing * along / speed if speed > 0.0 else 0.0)
    return wrench(X=pressure * q.front * along, Y=Y, N=arm * Y)


@njit(inline="always")
def law(m: Any, q: Any) -> Wrench:
    """Return the air drag of the hull in a steady stream of air, such as from a bank of fans.

    It follows from the velocity of the air relative to the hull.

    Args:
        m: Motion of the hull: velocities [m/s], rates [rad/s], position [m], attitude [rad].
        q: Parameters of the effect, with the names and units of its class.

    Returns:
        Force [N] and moment [N m] in body axes.
    """
    north, east = q.speed * cos(q.toward), q.speed * sin(q.toward)
    along = m.cos_psi * north + m.sin_psi * east - m.u
    across = m.cos_psi * east - m.sin_psi * north - m.v
    return air_drag(along, across, AIR_DENSITY, q, 0.0)


@dataclass(frozen=True)
class FanWind(Force):
    """Air drag of the hull in a stream of constant speed and direction, as from a bank of fans.

    X = 0.5 rho U front a,  Y = 0.5 rho U side b,  N = arm Y

    U is the speed of the air past the hull, a and b its components forward and to starboard [m/s];
    `front` and `side` [m^2] are areas times drag coefficients, `arm` [m] is the lever of the side
    force.
    """

    formula: ClassVar[str] = (
        r"\begin{aligned} X &= \tfrac{1}{2} \rho \, U A_x a, \quad Y = \tfrac{1}{2} \rho "
        r"\, U A_y b, \quad N = l \, Y, \quad U = \sqrt{a^2 + b^2} \\ a &= V \cos(\gamma "
        r"- \psi) - u, \quad b = V \sin(\gamma - \psi) - v \end{aligned}"
    )
    symbols: ClassVar = {
        "speed": "V",
        "toward": r"\gamma",
        "front": "A_x",
        "side": "A_y",
        "arm": "l",
    }
    exogenous: ClassVar = ("speed", "toward")
    words: ClassVar[str] = "a steady wind exerts a drag and a yaw moment on the hull"
    shown_by: ClassVar[str] = "turning through all headings while holding the thrust"
    source: ClassVar[str] = "checked specification of Bayless 2017, section 7 (wind model [A])"
    tied_to: ClassVar[str] = "the air"
    law: ClassVar = law
    of_air: ClassVar = True

    speed: float = param(1.5, low=0.0, high=40.0, unit="m/s", words="speed of the air")
    toward: float = param(0.0, low=-pi, high=pi, unit="rad", words="direction the air moves to")
    front: float = param(0.021, low=0.0, high=5000.0, unit="m^2", words="frontal drag area")
    side: float = param(0.114, low=0.0, high=20000.0, unit="m^2", words="lateral drag area")
    arm: float = param(
        -0.02,
        low=-200.0,
        high=200.0,
        unit="m",
        words="lever of the side force, ahead of the origin",
    )

    def air_velocity(self, t: float) -> tuple[float, float]:
        """Return the velocity of the air over ground, north and east [m/s].

        Args:
            t: Time [s]; not used, as the wind is steady.
        """
        return self.speed * cos(self.toward), self.speed * sin(self.toward)
