"""Speed hold: ideal propulsion that keeps the surge speed constant."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import UNSET, Force, Wrench, param, wrench


@njit(inline="always")
def law(m: Any, q: Any) -> Wrench:
    """Return the surge force that keeps the speed through the water constant.

    It is -m v r - gain (u - speed) and cancels the Coriolis force.

    Args:
        m: Motion of the hull: velocities [m/s], rates [rad/s], position [m], attitude [rad].
        q: Parameters of the effect, with the names and units of its class.

    Returns:
        Force [N] and moment [N m] in body axes.
    """
    return wrench(X=-q.mass * m.vr * m.r - q.gain * (m.ur - q.speed))


@dataclass(frozen=True)
class SpeedHold(Force):
    """Ideal propulsion that cancels Coriolis force and speed deviation.

    X = -m v_r r - gain (u_r - speed)

    Without other surge forces u_r stays exactly at `speed`, as linear manoeuvring models assume.
    """

    formula: ClassVar[str] = r"X = -m \, v_r r - g (u_r - U)"
    symbols: ClassVar = {"speed": "U", "gain": "g", "mass": "m"}
    words: ClassVar[str] = "the speed ahead through the water is held constant"
    shown_by: ClassVar[str] = "turning hard at constant power"
    source: ClassVar[str] = (
        "T. I. Fossen, Handbook of Marine Craft Hydrodynamics, 2nd ed. 2021, section 6.5: u = u0"
    )
    law: ClassVar = law

    speed: float = param(0.0, low=-50.0, high=50.0, unit="m/s", words="speed that is held")
    gain: float = param(0.0, low=0.0, high=1e9, unit="N s/m", words="force per speed deviation")
    mass: float = param(
        UNSET,
        low=0.0,
        high=1e12,
        unit="kg",
        words="mass of the rigid body; default: that of the vessel",
        follows="vessel.body.mass",
    )
