"""Foil: lift and drag of a body such as the housing of an azimuth thruster, fixed or steered."""

from dataclasses import dataclass
from math import asin, atan2, cos, sin
from typing import Any, ClassVar

from numba import njit

from boatsim.physics import particulars
from boatsim.physics.base import Force, Role, Wrench, param, wrench


@njit(inline="always")
def law(m: Any, q: Any, s: Any) -> Wrench:
    """Return force and moment on the hull of a foil in the flow at its mount.

    Args:
        m: Motion of the hull: velocities [m/s], rates [rad/s], position [m], attitude [rad].
        q: Parameters of the effect, with the names and units of its class.
        s: Signals bound to the roles of the effect.

    Returns:
        Force [N] and moment [N m] in body axes.
    """
    along, across = m.ur - q.y * m.r, m.vr + q.x * m.r - q.z * m.p
    flow = atan2(across, along)
    attack = s.angle - flow
    pressure = 0.5 * q.density * q.area * (along * along + across * across)
    # either end of the chord may lead, so that the angle to the flow is at most a quarter turn
    drag = pressure * (q.drag + q.drag_slope * asin(min(abs(sin(attack)), 1.0)))
    lift = pressure * q.lift * sin(2.0 * attack)
    X = -drag * cos(flow) - lift * sin(flow)
    Y = -drag * sin(flow) + lift * cos(flow)
    return wrench(X=X, Y=Y, K=-q.z * Y, M=q.z * X, N=q.x * Y - q.y * X)


@dataclass(frozen=True)
class Foil(Force):
    """Foil at a place on the hull, in the undisturbed flow: thruster housing, skeg or keel.

    D = 0.5 rho A V^2 (c_0 + c_1 |alpha|),  L = 0.5 rho A V^2 c_L sin(2 alpha)

    alpha = a - atan2(v_f, u_f) is the angle of its chord to the flow (u_f, v_f) at its place
    (x, y, z), |alpha| the angle to the nearer end of the chord, V the speed of that flow. The drag
    acts along the flow, the lift L across it; a foil turned to starboard pushes to starboard. At
    small angles the lift coefficient is 2 c_L alpha.
    """

    formula: ClassVar[str] = (
        r"\begin{aligned} D &= \tfrac{1}{2} \rho A V^2 \left(c_0 + c_1 |\alpha|\right), "
        r"\quad L = \tfrac{1}{2} \rho A V^2 c_L \sin 2\alpha, \quad \alpha = a - \beta \\ X "
        r"&= -D \cos\beta - L \sin\beta, \quad Y = -D \sin\beta + L \cos\beta, \quad \beta "
        r"= \operatorname{atan2}(v_f, u_f) \\ u_f &= u_r - y r, \quad v_f = v_r + x r - z p "
        r"\\ K &= -z Y, \quad M = z X, \quad N = x Y - y X \end{aligned}"
    )
    symbols: ClassVar = {
        "area": "A",
        "density": r"\rho",
        "drag": "c_0",
        "drag_slope": "c_1",
        "lift": "c_L",
        "x": "x",
        "y": "y",
        "z": "z",
    }
    words: ClassVar[str] = "a foil, such as the housing of an azimuth thruster, has lift and drag"
    shown_by: ClassVar[str] = "turns with the propeller stopped"
    source: ClassVar[str] = (
        "S. F. Hoerner, H. V. Borst, Fluid-Dynamic Lift, 1985, chapter 17: small aspect ratios"
    )
    roles: ClassVar = {
        "angle": Role("rad", "direction of the chord, 0 ahead, positive to starboard", fixed=0.0)
    }
    law: ClassVar = law

    area: float = param(0.0, low=0.0, high=1000.0, unit="m^2", words="lateral area of the foil")
    drag: float = param(
        0.0, low=0.0, high=5.0, unit="", words="drag coefficient, c_0", calibrates="damping"
    )
    drag_slope: float = param(
        0.0,
        low=0.0,
        high=10.0,
        unit="1/rad",
        words="growth of the drag coefficient with the angle, c_1",
        calibrates="damping",
    )
    lift: float = param(
        0.0,
        low=0.0,
        high=3.5,
        unit="",
        words="lift coefficient at 45 degrees, c_L; at small angles half its slope per rad",
        calibrates="thrust",
    )
    density: float = param(
        particulars.SEA_WATER, low=0.0, high=1500.0, unit="kg/m^3", words="density of the water"
    )
    x: float = param(0.0, low=-500.0, high=500.0, unit="m", words="place ahead of the origin")
    y: float = param(
        0.0, low=-100.0, high=100.0, unit="m", words="place to starboard of the origin"
    )
    z: float = param(0.0, low=-100.0, high=100.0, unit="m", words="place below the origin")
