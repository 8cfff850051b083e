"""MMG propeller at low speed: thrust and side force in all four quadrants."""

from dataclasses import dataclass
from math import sqrt
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import UNSET, Force, Role, Wrench, param, wrench
from boatsim.physics.effects.mmg_propeller import open_water_thrust


@njit(inline="always")
def inflow_speed(m: Any, q: Any) -> float:
    """Return the speed of the water that enters a ship's propeller, behind the hull's wake [m/s].

    The wake fraction decreases with the sideways velocity of the stern; going astern there is no
    wake.

    Args:
        m: Motion of the hull.
        q: Parameters with the wake coefficients.
    """
    if m.ur <= 0.0:
        return float(m.ur)
    slide = (m.vr + q.propeller_at * q.length * m.r) / max(sqrt(m.ur * m.ur + m.vr * m.vr), 1e-9)
    left = 1.0 - q.wake + q.wake_tau * abs(slide) + q.wake_C_P * slide * slide
    return float(m.ur * min(max(left, 0.0), 1.0))


@njit(inline="always")
def astern_thrust(shaft: float, u: float, q: Any) -> float:
    """Return the thrust of a propeller whose shaft turns astern, divided by rho D^2 [m^2/s^2].

    It is linear in J_s = u / (n D) and constant below `astern_from`. J_s is negative while the ship
    still goes ahead, so the constant is that of a crash stop.

    Args:
        shaft: Shaft rate, negative [1/s].
        u: Surge velocity through the water [m/s].
        q: Parameters of the effect.
    """
    nD = shaft * q.diameter
    if u > q.astern_from * nD:
        return float(q.astern_stop * nD * nD)
    return float(q.astern_C1 * nD * nD + q.astern_C2 * nD * u)


@njit(inline="always")
def propeller_thrust(m: Any, q: Any, shaft: float) -> float:
    """Return the thrust of a propeller, ahead or astern, divided by rho D^2 [m^2/s^2].

    Astern the measured value includes the reaction of the hull.

    Args:
        m: Motion of the hull.
        q: Parameters of the effect.
        shaft: Shaft rate, positive ahead [1/s].
    """
    if shaft < 0.0:
        return astern_thrust(shaft, m.ur, q)
    return float((1.0 - q.thrust_deduction) * open_water_thrust(shaft, inflow_speed(m, q), q))


@njit(inline="always")
def side_force(m: Any, q: Any, shaft: float) -> tuple[float, float]:
    """Return side force and yaw moment of a propeller (its paddle-wheel effect) per water density.

    The side force is divided by 0.5 rho L d, the yaw moment by 0.5 rho L^2 d [m^2/s^2]. With the
    shaft astern they are linear in J_s = u / (n D) in three ranges, with the shaft ahead and the
    ship astern they are a parabola in J_s; with both ahead they are zero.

    Args:
        m: Motion of the hull.
        q: Parameters of the effect.
        shaft: Shaft rate, positive ahead [1/s].
    """
    nD, u = shaft * q.diameter, m.ur
    if shaft < 0.0:
        if u > q.aside_low * nD:
            return nD * (q.Y_low * nD + q.Y_low_J * u), nD * (q.N_low * nD + q.N_low_J * u)
        if u < q.aside_high * nD:
            return q.Y_high * nD * nD, q.N_high * nD * nD
        return nD * (q.Y_mid * nD + q.Y_mid_J * u), nD * (q.N_mid * nD + q.N_mid_J * u)
    if u < 0.0:
        Y = q.Y_braked_JJ * u * u + q.Y_braked_J * u * nD + q.Y_braked * nD * nD
        N = q.N_braked_JJ * u * u + q.N_braked_J * u * nD + q.N_braked * nD * nD
        return q.pitch_ratio * q.pitch_ratio * Y, q.pitch_ratio * q.pitch_ratio * N
    return 0.0, 0.0


@njit(inline="always")
def law(m: Any, q: Any, s: Any) -> Wrench:
    """Return the thrust, side force and yaw moment of a propeller in all four quadrants.

    The thrust is reduced by the thrust deduction of the hull.

    Args:
        m: Motion of the hull: velocities [m/s], rates [rad/s], position [m], attitude [rad].
        q: Parameters of the effect, with the names and units of its class.
        s: Signals bound to the roles of the effect.

    Returns:
        Force [N] and moment [N m] in body axes.
    """
    X = q.density * q.diameter * q.diameter * propeller_thrust(m, q, s.shaft)
    Y, N = side_force(m, q, s.shaft)
    k = 0.5 * q.gain * q.density * q.length * q.draught  # [kg/m]
    return wrench(X=q.gain * X, Y=k * Y, N=k * q.length * N)


def coefficient_parameter(words: str) -> float:
    """Declare a nondimensional propeller coefficient from captive tests as a parameter."""
    return param(0.0, low=-10.0, high=10.0, unit="", words=words)


@dataclass(frozen=True)
class MmgLowSpeedPropeller(Force):
    """One propeller on the centreline, all four quadrants of ship speed and shaft rate.

    n >= 0: X = (1 - t_P) rho n^2 D^4 (k0 + k1 J + k2 J |J|)
    n < 0:  X = rho n^2 D^4 (astern_C1 + astern_C2 J_s)

    J = u_P / (n D) with the inflow speed u_P behind the wake, J_s = u / (n D). Side force and yaw
    moment of a backing propeller are linear in J_s in three ranges: below `aside_low`, between, and
    above `aside_high`.
    """

    formula: ClassVar[str] = (
        r"\begin{aligned} X &= g \, \begin{cases} (1 - t_P) \, \rho \, n^2 D^4 \left(k_0 "
        r"+ k_1 J + k_2 J |J|\right) & n \ge 0 \\ \rho \, n^2 D^4 \left(C_1 + C_2 "
        r"J_s\right) & n < 0 \end{cases} \\ Y &= \tfrac{1}{2} g \, \rho L d \, (n D)^2 \, "
        r"Y'(J_s), \quad N = \tfrac{1}{2} g \, \rho L^2 d \, (n D)^2 \, N'(J_s), \quad J "
        r"= \frac{u_P}{n D}, \quad J_s = \frac{u_r}{n D} \end{aligned}"
    )
    symbols: ClassVar = {
        "length": "L",
        "draught": "d",
        "density": r"\rho",
        "diameter": "D",
        "thrust_deduction": "t_P",
        "k0": "k_0",
        "k1": "k_1",
        "k2": "k_2",
        "astern_C1": "C_1",
        "astern_C2": "C_2",
        "gain": "g",
    }
    words: ClassVar[str] = (
        "thrust of a propeller ahead and astern, with a side force when it backs (MMG, low speed)"
    )
    shown_by: ClassVar[str] = "crash stops and backing"
    source: ClassVar[str] = (
        "Y. Miyauchi, A. Maki, N. Umeda, D. M. Rachman, Y. Akimoto, J. Mar. Sci. Technol. 27, 2022"
    )
    roles: ClassVar = {"shaft": Role("1/s", "shaft rate, positive ahead")}
    law: ClassVar = law

    length: float = param(
        UNSET,
        low=0.0,
        high=500.0,
        unit="m",
        words="main dimension of the ship",
        follows="vessel.length",
    )
    draught: float = param(
        UNSET,
        low=0.0,
        high=50.0,
        unit="m",
        words="main dimension of the ship",
        follows="vessel.draught",
    )
    density: float = param(
        UNSET,
        low=0.0,
        high=1100.0,
        unit="kg/m^3",
        words="density of the water",
        follows="mmg_low_speed_hull.density",
    )
    diameter: float = param(1.0, low=0.001, high=20.0, unit="m", words="propeller diameter, D_P")
    pitch_ratio: float = param(1.0, low=0.0, high=3.0, unit="", words="pitch ratio, P / D_P")
    thrust_deduction: float = param(
        0.0, low=0.0, high=1.0, unit="", words="thrust deduction with the shaft ahead, t_P"
    )
    wake: float = param(
        0.0, low=0.0, high=1.0, unit="", words="wake fraction on a straight course ahead, w_P0"
    )
    wake_tau: float = coefficient_parameter(
        "tau, decrease of the wake with the sideways velocity of the stern"
    )
    wake_C_P: float = coefficient_parameter("C_P, decrease of the wake with its square")
    propeller_at: float = param(
        -0.5, low=-1.0, high=1.0, unit="", words="x_P', propeller ahead of midship, in lengths"
    )
    k0: float = coefficient_parameter("K_T at J = 0, shaft ahead")
    k1: float = coefficient_parameter("coefficient of J in K_T")
    k2: float = coefficient_parameter("coefficient of J^2 in K_T")
    astern_C1: float = coefficient_parameter("thrust astern over rho n^2 D_P^4 at J_s = 0")
    astern_C2: float = coefficient_parameter("coefficient of J_s in the value before")
    astern_from: float = coefficient_parameter("J_s below which the thrust astern is constant")
    astern_stop: float = coefficient_parameter("thrust astern over rho n^2 D_P^4 below that J_s")
    aside_low: float = coefficient_parameter(
        "J_s below which the side force of a backing shaft has its first form"
    )
    aside_high: float = coefficient_parameter("J_s above which the side force has its last form")
    Y_low: float = coefficient_parameter("side force over 1/2 rho L d (n D_P)^2 in the first form")
    Y_low_J: float = coefficient_parameter("coefficient of J_s in the value before")
    Y_mid: float = coefficient_parameter("the same in the middle form")
    Y_mid_J: float = coefficient_parameter("coefficient of J_s in the value before")
    Y_high: float = coefficient_parameter("the same in the last form")
    Y_braked: float = coefficient_parameter(
        "side force over 1/2 rho L d (n P)^2, shaft ahead and ship astern"
    )
    Y_braked_J: float = coefficient_parameter("coefficient of J_s in the value before")
    Y_braked_JJ: float = coefficient_parameter("coefficient of J_s^2 in the value before")
    N_low: float = coefficient_parameter(
        "yaw moment over 1/2 rho L^2 d (n D_P)^2 in the first form"
    )
    N_low_J: float = coefficient_parameter("coefficient of J_s in the value before")
    N_mid: float = coefficient_parameter("the same in the middle form")
    N_mid_J: float = coefficient_parameter("coefficient of J_s in the value before")
    N_high: float = coefficient_parameter("the same in the last form")
    N_braked: float = coefficient_parameter(
        "yaw moment over 1/2 rho L^2 d (n P)^2, shaft ahead and ship astern"
    )
    N_braked_J: float = coefficient_parameter("coefficient of J_s in the value before")
    N_braked_JJ: float = coefficient_parameter("coefficient of J_s^2 in the value before")
    gain: float = param(
        1.0,
        low=0.1,
        high=5.0,
        unit="",
        words="thrust over its specified value",
        calibrates="thrust",
    )
