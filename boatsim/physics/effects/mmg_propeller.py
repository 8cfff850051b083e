"""MMG propeller: thrust behind a hull whose wake changes as the ship drifts and turns."""

from dataclasses import dataclass
from math import atan2, exp, sqrt
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import UNSET, Force, Role, Wrench, param, wrench


@njit(inline="always")
def drift_angle(m: Any) -> float:
    """Drift angle beta [rad], counted from the end that leads: a ship that goes straight astern has none."""
    return atan2(-m.vr, abs(m.ur))


@njit(inline="always")
def inflow(m: Any, q: Any) -> float:
    """Speed of the water through the propeller [m/s]; the wake is thinner the more askew the stern moves."""
    U = max(sqrt(m.ur * m.ur + m.vr * m.vr), 1e-9)
    drift = (
        drift_angle(m) - q.propeller_at * m.r * q.length / U
    )  # of the stern; positive: water from port
    C2 = q.wake_C2_port if drift > 0.0 else q.wake_C2_starboard
    return float(m.ur * (1.0 - q.wake) * (1.0 + (1.0 - exp(-q.wake_C1 * abs(drift))) * (C2 - 1.0)))


@njit(inline="always")
def open_water(shaft: float, V: float, q: Any) -> float:
    """K_T n^2 D^2 [m^2/s^2] of K_T = k0 + k1 J + k2 J |J|, written without J = V / (n D): the shaft may stand still.

    Ahead that is the published polynomial; astern a shaft that stands still drags against the way as well.
    """
    nD = shaft * q.diameter
    return float(q.k0 * nD * nD + q.k1 * nD * V + q.k2 * V * abs(V))


@njit(inline="always")
def law(m: Any, q: Any, s: Any) -> Wrench:
    """Thrust less what its suction costs the hull."""
    thrust = q.density * q.diameter * q.diameter * open_water(s.shaft, inflow(m, q), q)
    return wrench(X=q.gain * (1.0 - q.thrust_deduction) * thrust)


@dataclass(frozen=True)
class MmgPropeller(Force):
    """One propeller on the centre line that turns ahead."""

    words: ClassVar[str] = "a propeller pushes in the hull's wake (MMG)"
    shown_by: ClassVar[str] = "turning circles, where the ship loses speed"
    source: ClassVar[str] = (
        "H. Yasukawa, Y. Yoshimura, J. Mar. Sci. Technol. 20, 2015 (MMG standard method)"
    )
    roles: ClassVar = {"shaft": Role("1/s", "the propeller's rate, ahead positive")}
    law: ClassVar = law

    length: float = param(
        UNSET, low=0.0, high=500.0, unit="m", words="of the ship", follows="vessel.length"
    )
    density: float = param(
        UNSET, low=0.0, high=1100.0, unit="kg/m^3", words="of the water", follows="mmg_hull.density"
    )
    diameter: float = param(1.0, low=0.001, high=20.0, unit="m", words="D_P")
    thrust_deduction: float = param(0.0, low=0.0, high=1.0, unit="", words="t_P")
    wake: float = param(0.0, low=0.0, high=1.0, unit="", words="w_P0, on a straight course")
    wake_C1: float = param(
        0.0, low=0.0, high=20.0, unit="", words="C_1, how soon a drift thins the wake"
    )
    wake_C2_port: float = param(
        1.0, low=0.0, high=3.0, unit="", words="C_2 for water from port, beta_P > 0"
    )
    wake_C2_starboard: float = param(
        1.0, low=0.0, high=3.0, unit="", words="C_2 for water from starboard"
    )
    propeller_at: float = param(
        -0.5, low=-1.0, high=1.0, unit="", words="x_P', lengths ahead of midship"
    )
    k0: float = param(0.0, low=-2.0, high=2.0, unit="", words="K_T at J = 0")
    k1: float = param(0.0, low=-2.0, high=2.0, unit="", words="of J in K_T")
    k2: float = param(0.0, low=-2.0, high=2.0, unit="", words="of J^2 in K_T")
    gain: float = param(
        1.0, low=0.1, high=5.0, unit="", words="thrust per stated one", calibrates="thrust"
    )
