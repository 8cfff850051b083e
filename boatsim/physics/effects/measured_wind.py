"""Measured wind: air drag from a recorded true wind."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Force, Role, Wrench, param
from boatsim.physics.effects.fan_wind import AIR_DENSITY, air_drag


@njit(inline="always")
def law(m: Any, q: Any, s: Any) -> Wrench:
    """Return the air drag of the hull in a recorded true wind.

    The air velocity relative to the hull is the true wind less the velocity of the hull over
    ground.

    Args:
        m: Motion of the hull: velocities [m/s], rates [rad/s], position [m], attitude [rad].
        q: Parameters of the effect, with the names and units of its class.
        s: Signals bound to the roles of the effect.

    Returns:
        Force [N] and moment [N m] in body axes.
    """
    north, east = -s.speed * s.cos_comes_from, -s.speed * s.sin_comes_from
    along = m.cos_psi * north + m.sin_psi * east - m.u
    across = m.cos_psi * east - m.sin_psi * north - m.v
    return air_drag(along, across, q.density, q, q.swing)


@dataclass(frozen=True)
class MeasuredWind(Force):
    """Air drag of the hull in a wind whose speed over ground and direction are recorded.

    X = 0.5 rho front U^2 cos g,  Y = 0.5 rho side U^2 sin g,  N = (arm + swing cos g) Y

    U is the speed of the air past the hull, g the direction it moves to, from the bow. `front` and
    `side` are areas times drag coefficients. A diagnosis tests it for a vessel that names
    `wind_mps` and `wind_from_rad` in [measured], if they are recorded. For a regression with C_N =
    N1 sin g + N2 sin 2g over length L and side area: arm = N1 L / C_Y and swing = 2 N2 L / C_Y.
    """

    formula: ClassVar[str] = (
        r"\begin{aligned} X &= \tfrac{1}{2} \rho A_x U^2 \cos\gamma, \quad Y = "
        r"\tfrac{1}{2} \rho A_y U^2 \sin\gamma, \quad N = (l + l_1 \cos\gamma) \, Y \\ U "
        r"\cos\gamma &= -V \cos(\gamma_\mathrm{from} - \psi) - u, \quad U \sin\gamma = -V "
        r"\sin(\gamma_\mathrm{from} - \psi) - v \end{aligned}"
    )
    symbols: ClassVar = {
        "front": "A_x",
        "side": "A_y",
        "arm": "l",
        "swing": "l_1",
        "density": r"\rho",
    }
    words: ClassVar[str] = "the measured wind exerts a drag and a yaw moment on the hull"
    shown_by: ClassVar[str] = "turning through all headings while holding the thrust"
    source: ClassVar[str] = (
        "T. I. Fossen, Handbook of Marine Craft Hydrodynamics, 2nd ed. 2021, section 10.1"
    )
    tied_to: ClassVar[str] = "the air"
    law: ClassVar = law
    of_air: ClassVar = True
    roles: ClassVar = {
        "speed": Role("m/s", "speed of the wind over ground"),
        "comes_from": Role("rad", "direction the wind comes from, clockwise from the x axis"),
    }

    recorded_as: ClassVar = {"speed": "wind_mps", "comes_from": "wind_from_rad"}
    alone: ClassVar[bool] = True
    strength: ClassVar = ("front", "side")
    starts: ClassVar = ({"front": 0.03, "side": 0.1},)

    front: float = param(
        0.021,
        low=0.0,
        high=5000.0,
        unit="m^2",
        words="frontal drag area",
        calibrates="wind",
        fit=True,
        spread=0.08,  # 0.9 x 0.3 B^2 of a boat whose superstructure is wide and high
    )
    side: float = param(
        0.114,
        low=0.0,
        high=20000.0,
        unit="m^2",
        words="lateral drag area",
        calibrates="wind",
        fit=True,
        spread=0.16,  # 0.9 x 0.3 L B
    )
    arm: float = param(
        0.0,
        low=-200.0,
        high=200.0,
        unit="m",
        words="lever of the side force, ahead of the origin",
        calibrates="wind",
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
        calibrates="wind",
        fit=True,
        spread=0.1,
        within=(-0.6, 0.6),
    )
    density: float = param(
        AIR_DENSITY, low=0.5, high=2.0, unit="kg/m^3", words="density of the air"
    )
