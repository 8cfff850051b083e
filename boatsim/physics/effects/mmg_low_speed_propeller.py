"""MMG propeller at low speed: ahead and astern on a ship that goes ahead or astern, with the side force it makes."""

from dataclasses import dataclass
from math import sqrt
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import UNSET, Force, Role, Wrench, param, wrench
from boatsim.physics.effects.mmg_propeller import open_water


@njit(inline="always")
def inflow(m: Any, q: Any) -> float:
    """Speed of the water through the propeller [m/s]; the wake thins as the stern slides, and astern there is none."""
    if m.ur <= 0.0:
        return float(m.ur)
    slide = (m.vr + q.propeller_at * q.length * m.r) / max(sqrt(m.ur * m.ur + m.vr * m.vr), 1e-9)
    left = 1.0 - q.wake + q.wake_tau * abs(slide) + q.wake_C_P * slide * slide
    return float(m.ur * min(max(left, 0.0), 1.0))


@njit(inline="always")
def backing(shaft: float, u: float, q: Any) -> float:
    """Thrust per density and D^2 [m^2/s^2] of a shaft that turns astern: linear in J_s, constant below `astern_from`.

    J_s = u / (n D) is negative while the ship still goes ahead, so the constant is that of a crash stop.
    """
    nD = shaft * q.diameter
    if u > q.astern_from * nD:
        return float(q.astern_stop * nD * nD)
    return float(q.astern_C1 * nD * nD + q.astern_C2 * nD * u)


@njit(inline="always")
def push(m: Any, q: Any, shaft: float) -> float:
    """Thrust on the ship per density and D^2 [m^2/s^2]; astern it is measured with what it does to the hull."""
    if shaft < 0.0:
        return backing(shaft, m.ur, q)
    return float((1.0 - q.thrust_deduction) * open_water(shaft, inflow(m, q), q))


@njit(inline="always")
def aside(m: Any, q: Any, shaft: float) -> tuple[float, float]:
    """Side force and yaw moment per 1/2 density L d and 1/2 density L^2 d [m^2/s^2], in three ranges of J_s astern.

    Going ahead with the shaft ahead there is none; astern with the shaft ahead it is a parabola in J_s.
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
    """Thrust with what its suction costs the hull, and what the race does to the hull's side."""
    X = q.density * q.diameter * q.diameter * push(m, q, s.shaft)
    Y, N = aside(m, q, s.shaft)
    k = 0.5 * q.gain * q.density * q.length * q.draught  # [kg/m]
    return wrench(X=q.gain * X, Y=k * Y, N=k * q.length * N)


def number(words: str) -> float:
    """A nondimensional number from captive tests."""
    return param(0.0, low=-10.0, high=10.0, unit="", words=words)


@dataclass(frozen=True)
class MmgLowSpeedPropeller(Force):
    """One propeller on the centre line, in all four quadrants."""

    words: ClassVar[str] = (
        "a propeller pushes ahead or astern, and aside when it backs (MMG, low speed)"
    )
    shown_by: ClassVar[str] = "crash stops and backing"
    source: ClassVar[str] = (
        "Y. Miyauchi, A. Maki, N. Umeda, D. M. Rachman, Y. Akimoto, J. Mar. Sci. Technol. 27, 2022"
    )
    roles: ClassVar = {"shaft": Role("1/s", "the propeller's rate, ahead positive")}
    law: ClassVar = law

    length: float = param(
        UNSET, low=0.0, high=500.0, unit="m", words="of the ship", follows="vessel.length"
    )
    draught: float = param(
        UNSET, low=0.0, high=50.0, unit="m", words="of the ship", follows="vessel.draught"
    )
    density: float = param(
        UNSET,
        low=0.0,
        high=1100.0,
        unit="kg/m^3",
        words="of the water",
        follows="mmg_low_speed_hull.density",
    )
    diameter: float = param(1.0, low=0.001, high=20.0, unit="m", words="D_P")
    pitch_ratio: float = param(1.0, low=0.0, high=3.0, unit="", words="P / D_P")
    thrust_deduction: float = param(0.0, low=0.0, high=1.0, unit="", words="t_P, shaft ahead")
    wake: float = param(0.0, low=0.0, high=1.0, unit="", words="w_P0, on a straight course ahead")
    wake_tau: float = number("tau, how much a slide of the stern thins the wake")
    wake_C_P: float = number("C_P, and its square")
    propeller_at: float = param(
        -0.5, low=-1.0, high=1.0, unit="", words="x_P', lengths ahead of midship"
    )
    k0: float = number("K_T at J = 0, shaft ahead")
    k1: float = number("of J in K_T")
    k2: float = number("of J^2 in K_T")
    astern_C1: float = number("thrust astern over rho n^2 D_P^4 at J_s = 0")
    astern_C2: float = number("of J_s in it")
    astern_from: float = number("J_s below which it is constant")
    astern_stop: float = number("that constant")
    aside_low: float = number(
        "J_s below which the side force of a backing shaft has its first form"
    )
    aside_high: float = number("J_s above which it has its last")
    Y_low: float = number("side force over 1/2 rho L d (n D_P)^2 in the first form")
    Y_low_J: float = number("of J_s in it")
    Y_mid: float = number("the same in between")
    Y_mid_J: float = number("of J_s in it")
    Y_high: float = number("the same in the last form")
    Y_braked: float = number("side force over 1/2 rho L d (n P)^2, shaft ahead and ship astern")
    Y_braked_J: float = number("of J_s in it")
    Y_braked_JJ: float = number("of J_s^2 in it")
    N_low: float = number("yaw moment over 1/2 rho L^2 d (n D_P)^2 in the first form")
    N_low_J: float = number("of J_s in it")
    N_mid: float = number("the same in between")
    N_mid_J: float = number("of J_s in it")
    N_high: float = number("the same in the last form")
    N_braked: float = number("yaw moment over 1/2 rho L^2 d (n P)^2, shaft ahead and ship astern")
    N_braked_J: float = number("of J_s in it")
    N_braked_JJ: float = number("of J_s^2 in it")
    gain: float = param(
        1.0, low=0.1, high=5.0, unit="", words="thrust per stated one", calibrates="thrust"
    )
