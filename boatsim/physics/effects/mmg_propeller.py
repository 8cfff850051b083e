"""MMG propeller: thrust in the wake of a hull that drifts and turns."""

from dataclasses import dataclass
from math import atan2, exp, sqrt
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import UNSET, Force, Role, Wrench, param, wrench


@njit(inline="always")
def drift_angle(m: Any) -> float:
    """Return the drift angle beta of the hull [rad]; zero also for a ship going straight astern.

    Args:
        m: Motion of the hull.
    """
    return atan2(-m.vr, abs(m.ur))


@njit(inline="always")
def inflow_speed(m: Any, q: Any) -> float:
    """Return the speed of the water that enters a ship's propeller, behind the hull's wake [m/s].

    The wake fraction decreases with the drift angle at the propeller.

    Args:
        m: Motion of the hull.
        q: Parameters with the wake coefficients.
    """
    U = max(sqrt(m.ur * m.ur + m.vr * m.vr), 1e-9)
    # drift angle at the propeller; positive: flow from port
    drift = drift_angle(m) - q.propeller_at * m.r * q.length / U
    C2 = q.wake_C2_port if drift > 0.0 else q.wake_C2_starboard
    return float(m.ur * (1.0 - q.wake) * (1.0 + (1.0 - exp(-q.wake_C1 * abs(drift))) * (C2 - 1.0)))


@njit(inline="always")
def open_water_thrust(shaft: float, V: float, q: Any) -> float:
    """Return the open-water thrust of a propeller over rho D^2: K_T n^2 D^2 [m^2/s^2].

    K_T = k0 + k1 J + k2 J |J| is evaluated without J = V / (n D), so that the shaft may stand
    still. Ahead it is the published polynomial; going astern a stopped propeller drags against the
    motion as well.

    Args:
        shaft: Shaft rate n [1/s].
        V: Speed of the water through the propeller [m/s].
        q: Parameters with the diameter [m], k0, k1 and k2.
    """
    nD = shaft * q.diameter
    return float(q.k0 * nD * nD + q.k1 * nD * V + q.k2 * V * abs(V))


@njit(inline="always")
def law(m: Any, q: Any, s: Any) -> Wrench:
    """Return the propeller thrust of the MMG standard method, less the thrust deduction.

    Args:
        m: Motion of the hull: velocities [m/s], rates [rad/s], position [m], attitude [rad].
        q: Parameters of the effect, with the names and units of its class.
        s: Signals bound to the roles of the effect.

    Returns:
        Force [N] and moment [N m] in body axes.
    """
    thrust = q.density * q.diameter * q.diameter * open_water_thrust(s.shaft, inflow_speed(m, q), q)
    return wrench(X=q.gain * (1.0 - q.thrust_deduction) * thrust)


@dataclass(frozen=True)
class MmgPropeller(Force):
    """One propeller on the centreline that turns ahead, MMG standard method.

    X = (1 - t_P) rho n^2 D_P^4 K_T(J_P),  J_P = u (1 - w_P) / (n D_P)
    1 - w_P = (1 - w_P0) (1 + (1 - exp(-C_1 |beta_P|)) (C_2 - 1)),  beta_P = beta - x_P' r'
    """

    formula: ClassVar[str] = (
        r"\begin{aligned} X &= g (1 - t_P) \, \rho \, n^2 D_P^4 \left(k_0 + k_1 J_P + k_2 "
        r"J_P |J_P|\right), \quad J_P = \frac{u_r (1 - w_P)}{n D_P} \\ 1 - w_P &= (1 - "
        r"w_{P0}) \left(1 + \left(1 - e^{-C_1 |\beta_P|}\right) (C_2 - 1)\right), \quad "
        r"\beta_P = \beta - x'_P r' \end{aligned}"
    )
    symbols: ClassVar = {
        "density": r"\rho",
        "diameter": "D_P",
        "thrust_deduction": "t_P",
        "wake": "w_{P0}",
        "wake_C1": "C_1",
        "propeller_at": "x'_P",
        "k0": "k_0",
        "k1": "k_1",
        "k2": "k_2",
        "gain": "g",
    }
    words: ClassVar[str] = "thrust of a propeller in the wake of the hull (MMG)"
    shown_by: ClassVar[str] = "turning circles, where the ship loses speed"
    source: ClassVar[str] = (
        "H. Yasukawa, Y. Yoshimura, J. Mar. Sci. Technol. 20, 2015 (MMG standard method)"
    )
    roles: ClassVar = {"shaft": Role("1/s", "shaft rate, positive ahead")}
    law: ClassVar = law

    length: float = param(
        UNSET, low=0.0, high=500.0, unit="m", words="length of the ship", follows="vessel.length"
    )
    density: float = param(
        UNSET,
        low=0.0,
        high=1100.0,
        unit="kg/m^3",
        words="density of the water",
        follows="mmg_hull.density",
    )
    diameter: float = param(1.0, low=0.001, high=20.0, unit="m", words="propeller diameter, D_P")
    thrust_deduction: float = param(0.0, low=0.0, high=1.0, unit="", words="thrust deduction, t_P")
    wake: float = param(
        0.0, low=0.0, high=1.0, unit="", words="wake fraction on a straight course, w_P0"
    )
    wake_C1: float = param(
        0.0, low=0.0, high=20.0, unit="", words="C_1, decrease of the wake with the drift angle"
    )
    wake_C2_port: float = param(
        1.0, low=0.0, high=3.0, unit="", words="C_2 for flow from port, beta_P > 0"
    )
    wake_C2_starboard: float = param(
        1.0, low=0.0, high=3.0, unit="", words="C_2 for flow from starboard"
    )
    propeller_at: float = param(
        -0.5, low=-1.0, high=1.0, unit="", words="x_P', propeller ahead of midship, in lengths"
    )
    k0: float = param(0.0, low=-2.0, high=2.0, unit="", words="K_T at J = 0")
    k1: float = param(0.0, low=-2.0, high=2.0, unit="", words="coefficient of J in K_T")
    k2: float = param(0.0, low=-2.0, high=2.0, unit="", words="coefficient of J^2 in K_T")
    gain: float = param(
        1.0,
        low=0.1,
        high=5.0,
        unit="",
        words="thrust over its specified value",
        calibrates="thrust",
    )
