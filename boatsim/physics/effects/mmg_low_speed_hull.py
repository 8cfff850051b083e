"""MMG hull at low speed: lift in proportion to the way through the water, and every section's cross-flow drag."""

from dataclasses import dataclass
from math import atan2, pi, sqrt
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import UNSET, Force, Wrench, param, wrench
from boatsim.physics.effects.cross_flow_drag import panel


@njit(inline="always")
def cross_flow(v: float, r: float, length: float) -> tuple[float, float]:
    """Integrals of w|w| and x w|w|, w = v + x r, from stern to bow of a hull about midship."""
    half = 0.5 * length
    turn = min(max(-v / r, -half), half) if r != 0.0 else -half  # where the cross flow changes sign
    aft, aft_moment = panel(-half, turn, v, r)
    fore, fore_moment = panel(turn, half, v, r)
    return aft + fore, aft_moment + fore_moment


@njit(inline="always")
def law(m: Any, q: Any) -> Wrench:
    """Defined for any drift, from rest to astern, where polynomials of v/U and r L/U are not.

    The share of the resistance astern grows with the drift angle, 0 ahead to pi astern. The added mass brings its
    Coriolis force in surge and sway; in yaw that is part of N_v.
    """
    U, L = sqrt(m.ur * m.ur + m.vr * m.vr), q.length
    astern = abs(atan2(m.vr, m.ur)) / pi
    across, _ = cross_flow(m.vr, q.C_rY * m.r, L)
    _, turning = cross_flow(m.vr, q.C_rN * m.r, L)
    k = 0.5 * q.density * L * q.draught  # [kg/m]
    X = (q.X_0F + (q.X_0A - q.X_0F) * astern) * m.ur * U + q.X_vr * L * m.vr * m.r
    Y = q.Y_v * m.vr * abs(m.ur) + q.Y_r * L * m.r * m.ur - q.C_D * across / L
    N = q.N_v * m.vr * m.ur + q.N_r * L * m.r * abs(m.ur) - q.C_D * turning / (L * L)
    return wrench(X=k * X + q.m_y * m.vr * m.r, Y=k * Y - q.m_x * m.ur * m.r, N=k * L * N)


def coefficient(words: str, axis: str = "") -> float:
    """A nondimensional number from captive tests, known as well as these are."""
    return param(0.0, low=-10.0, high=10.0, unit="", words=words, calibrates="damping", axis=axis)


@dataclass(frozen=True)
class MmgLowSpeedHull(Force):
    """Of a ship that stops, backs and turns on the spot; needs added_mass with coriolis = 0. Origin midship."""

    words: ClassVar[str] = (
        "hull forces from rest to astern: lift with the way and cross-flow drag (MMG, low speed)"
    )
    shown_by: ClassVar[str] = "stopping, backing and turning on the spot"
    source: ClassVar[str] = (
        "Y. Yoshimura, I. Nakao, A. Ishibashi, MARSIM 2009 (unified model, ocean and harbour)"
    )
    law: ClassVar = law

    length: float = param(
        UNSET, low=0.0, high=500.0, unit="m", words="of the ship", follows="vessel.length"
    )
    draught: float = param(
        UNSET, low=0.0, high=50.0, unit="m", words="of the ship", follows="vessel.draught"
    )
    density: float = param(1000.0, low=0.0, high=1100.0, unit="kg/m^3", words="of the water")
    m_x: float = param(
        UNSET, low=0.0, high=1e9, unit="kg", words="added mass", follows="added_mass.surge"
    )
    m_y: float = param(
        UNSET, low=0.0, high=1e9, unit="kg", words="added mass", follows="added_mass.sway"
    )
    X_0F: float = coefficient("X_0(F)', resistance ahead", "surge")
    X_0A: float = coefficient("X_0(A)', resistance astern", "surge")
    X_vr: float = coefficient("X_vr'", "surge")
    Y_v: float = coefficient("Y_v'", "sway")
    Y_r: float = coefficient("Y_r'", "sway")
    N_v: float = coefficient("N_v'", "yaw")
    N_r: float = coefficient("N_r'", "yaw")
    C_D: float = coefficient("C_D, cross-flow drag of a section")
    C_rY: float = coefficient(
        "C_rY, how much turning counts in the cross flow that makes sway force", "sway"
    )
    C_rN: float = coefficient("C_rN, and in that which makes yaw moment", "yaw")
