"""Hydrostatics: linear restoring forces of buoyancy in heave, roll and pitch."""

from dataclasses import dataclass
from math import cos, sin
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import UNSET, Boat, Force, Wrench, param, wrench
from boatsim.physics.particulars import GRAVITY


@njit(inline="always")
def law(m: Any, q: Any) -> Wrench:
    """Return the linear restoring force of buoyancy in heave, roll and pitch.

    It is -G (z, phi, theta) about the equilibrium of the displaced mass. A mass beyond the
    displacement makes the hull float deeper.

    Args:
        m: Motion of the hull: velocities [m/s], rates [rad/s], position [m], attitude [rad].
        q: Parameters of the effect, with the names and units of its class.

    Returns:
        Force [N] and moment [N m] in body axes.
    """
    sunk = m.z - q.flotation * m.theta  # [m] sinkage of the centre of flotation
    Z = -q.heave * sunk + (q.mass - q.displacement) * GRAVITY
    if q.vertical != 0.0:
        return wrench(
            Y=Z * sin(m.phi),
            Z=Z * cos(m.phi),
            K=-q.roll * m.phi,
            M=q.flotation * q.heave * sunk - q.pitch * m.theta,
        )
    return wrench(Z=Z, K=-q.roll * m.phi, M=q.flotation * q.heave * sunk - q.pitch * m.theta)


@dataclass(frozen=True)
class Hydrostatics(Force):
    """Linear restoring force in heave, roll and pitch on still water.

    The origin of motion lies on the waterline at rest.

    Z = -heave (z - x_F theta) + (m - m_0) g,  K = -roll phi
    M = x_F heave (z - x_F theta) - pitch theta

    heave = rho g A_wp [N/m], roll = m g GM_T, pitch = m g GM_L [N m], x_F = `flotation` [m], m_0 =
    `displacement` [kg].
    """

    formula: ClassVar[str] = (
        r"\begin{aligned} Z &= -\rho g A_{wp} (z - x_F \theta) + (m - m_0) \, g, \quad K "
        r"= -m g \, GM_T \, \phi \\ M &= x_F \, \rho g A_{wp} (z - x_F \theta) - m g \, "
        r"GM_L \, \theta \end{aligned}"
    )
    symbols: ClassVar = {
        "heave": r"\rho g A_{wp}",
        "roll": r"m g \, GM_T",
        "pitch": r"m g \, GM_L",
        "flotation": "x_F",
        "mass": "m",
        "displacement": "m_0",
    }
    words: ClassVar[str] = "buoyancy restores the draught and the attitude of the hull"
    shown_by: ClassVar[str] = "a release from heave, heel or trim"
    source: ClassVar[str] = (
        "T. I. Fossen, Handbook of Marine Craft Hydrodynamics, 2nd ed. 2021, section 4.2"
    )
    law: ClassVar = law

    heave: float = param(
        0.0,
        low=0.0,
        high=1e12,
        unit="N/m",
        words="rho g A_wp",
        calibrates="restoring",
        axis="heave",
    )
    roll: float = param(
        0.0, low=0.0, high=1e13, unit="N m", words="m g GM_T", calibrates="restoring", axis="roll"
    )
    pitch: float = param(
        0.0,
        low=0.0,
        high=1e15,
        unit="N m",
        words="m g GM_L, about the centre of flotation",
        calibrates="restoring",
        axis="pitch",
    )
    flotation: float = param(
        0.0, low=-250.0, high=250.0, unit="m", words="centre of flotation ahead of the origin"
    )
    mass: float = param(
        UNSET, low=0.0, high=1e12, unit="kg", words="mass of the boat", follows="vessel.body.mass"
    )
    displacement: float = param(
        UNSET, low=0.0, high=1e12, unit="kg", words="mass with which the hull floats at z = 0"
    )
    vertical: float = param(
        0.0,
        low=0.0,
        high=1.0,
        unit="",
        words="1: the force in heave stays vertical while the hull rolls; 0: it rolls too",
    )

    def derived_parameters(self, vessel: Boat) -> dict[str, float]:
        """Return the default displacement, the vessel's mass, with which the hull floats at z = 0.

        Args:
            vessel: Vessel with a body.
        """
        return {"displacement": vessel.body.mass}
