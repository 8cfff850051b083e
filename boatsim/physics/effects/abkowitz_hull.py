"""Abkowitz hull: surge, sway and yaw as a polynomial in speed loss, drift, rate of turn and rudder angle."""

from dataclasses import dataclass
from math import sqrt
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import UNSET, Force, Role, Wrench, param, wrench

SLOWEST = 0.3  # of the approach speed; what tests about it say of slower ships is not defined there


@njit(inline="always")
def law(m: Any, q: Any, s: Any) -> Wrench:
    """Model accelerations, times the body's mass and inertia, less what a rigid body turning brings along by itself.

    The model's own inertia, which need not be symmetric, is solved here; nondimensional as in the source: speeds over
    the instantaneous U, times over L / U, the rudder's sign turned so that a positive angle steers to starboard. All of
    it goes with the speed through the water: a uniform current carries ship, water and model along.
    """
    U = max(sqrt(m.ur * m.ur + m.vr * m.vr), SLOWEST * q.speed)
    u, v, r, d = (m.ur - q.speed) / U, m.vr / U, m.r * q.length / U, -s.angle
    X = (
        u * (q.X_u + u * (q.X_uu + u * q.X_uuu))
        + q.X_vv * v * v
        + q.X_rr * r * r
        + q.X_rv * r * v
        + q.gain * d * (q.X_dd * d + q.X_udd * u * d + q.X_vd * v + q.X_uvd * u * v)
    )
    Y = (
        v * (q.Y_v + q.Y_vu * u + v * (q.Y_vvv * v + q.Y_vvr * r))
        + r * (q.Y_r + q.Y_ru * u)
        + q.gain
        * d
        * (q.Y_d + u * (q.Y_ud + u * q.Y_uud) + q.Y_ddd * d * d + v * (q.Y_vdd * d + q.Y_vvd * v))
        + q.Y_0
        + u * (q.Y_0u + u * q.Y_0uu)
    )
    N = (
        v * (q.N_v + q.N_vu * u + v * (q.N_vvv * v + q.N_vvr * r))
        + r * (q.N_r + q.N_ru * u)
        + q.gain
        * d
        * (q.N_d + u * (q.N_ud + u * q.N_uud) + q.N_ddd * d * d + v * (q.N_vdd * d + q.N_vvd * v))
        + q.N_0
        + u * (q.N_0u + u * q.N_0uu)
    )
    determinant = q.m22 * q.m33 - q.m23 * q.m32
    along = X / q.m11 * U * U / q.length
    across = (q.m33 * Y - q.m23 * N) / determinant * U * U / q.length
    turning = (q.m22 * N - q.m32 * Y) / determinant * U * U / (q.length * q.length)
    return wrench(
        X=q.mass * (along - m.vr * m.r), Y=q.mass * (across + m.ur * m.r), N=q.yaw_inertia * turning
    )


def derivative(name: str) -> float:
    """A nondimensional derivative."""
    return param(0.0, low=-10.0, high=10.0, unit="", words=f"{name}', nondimensional")


def inertia(words: str) -> float:
    """An entry of the nondimensional inertia."""
    return param(1.0, low=-10.0, high=10.0, unit="", words=words)


@dataclass(frozen=True)
class AbkowitzHull(Force):
    """A whole manoeuvring model from captive tests; rigid body and added mass are in its own inertia.

    The origin of motion is that of the derivatives.
    """

    words: ClassVar[str] = (
        "hull and rudder forces as a polynomial in drift, rate of turn and rudder angle"
    )
    shown_by: ClassVar[str] = "turning circles and zig-zags"
    source: ClassVar[str] = "M. A. Abkowitz, Lectures on Ship Hydrodynamics, Hy-5, Lyngby 1964"
    roles: ClassVar = {"angle": Role("rad", "the rudder, positive turns to starboard")}
    law: ClassVar = law

    length: float = param(
        UNSET, low=0.0, high=500.0, unit="m", words="of the ship", follows="vessel.length"
    )
    speed: float = param(
        1.0, low=0.01, high=50.0, unit="m/s", words="approach speed of the derivatives"
    )
    mass: float = param(
        UNSET, low=0.0, high=1e12, unit="kg", words="the body's", follows="vessel.body.mass"
    )
    yaw_inertia: float = param(
        UNSET,
        low=0.0,
        high=1e16,
        unit="kg m^2",
        words="the body's",
        follows="vessel.body.yaw_inertia",
    )
    gain: float = param(
        1.0, low=0.1, high=5.0, unit="", words="rudder force per stated one", calibrates="thrust"
    )
    m11: float = inertia("m' - X_udot'")
    m22: float = inertia("m' - Y_vdot'")
    m23: float = inertia("m' x_G' - Y_rdot'")
    m32: float = inertia("m' x_G' - N_vdot'")
    m33: float = inertia("I_z' - N_rdot'")
    X_u: float = derivative("X_u")
    X_uu: float = derivative("X_uu")
    X_uuu: float = derivative("X_uuu")
    X_vv: float = derivative("X_vv")
    X_rr: float = derivative("X_rr")
    X_rv: float = derivative("X_rv")
    X_dd: float = derivative("X_dd")
    X_udd: float = derivative("X_udd")
    X_vd: float = derivative("X_vd")
    X_uvd: float = derivative("X_uvd")
    Y_v: float = derivative("Y_v")
    Y_r: float = derivative("Y_r")
    Y_vvv: float = derivative("Y_vvv")
    Y_vvr: float = derivative("Y_vvr")
    Y_vu: float = derivative("Y_vu")
    Y_ru: float = derivative("Y_ru")
    Y_d: float = derivative("Y_d")
    Y_ddd: float = derivative("Y_ddd")
    Y_ud: float = derivative("Y_ud")
    Y_uud: float = derivative("Y_uud")
    Y_vdd: float = derivative("Y_vdd")
    Y_vvd: float = derivative("Y_vvd")
    Y_0: float = derivative("Y_0")
    Y_0u: float = derivative("Y_0u")
    Y_0uu: float = derivative("Y_0uu")
    N_v: float = derivative("N_v")
    N_r: float = derivative("N_r")
    N_vvv: float = derivative("N_vvv")
    N_vvr: float = derivative("N_vvr")
    N_vu: float = derivative("N_vu")
    N_ru: float = derivative("N_ru")
    N_d: float = derivative("N_d")
    N_ddd: float = derivative("N_ddd")
    N_ud: float = derivative("N_ud")
    N_uud: float = derivative("N_uud")
    N_vdd: float = derivative("N_vdd")
    N_vvd: float = derivative("N_vvd")
    N_0: float = derivative("N_0")
    N_0u: float = derivative("N_0u")
    N_0uu: float = derivative("N_0uu")
