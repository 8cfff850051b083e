"""Abkowitz hull: polynomials in speed loss, drift, yaw rate and rudder angle."""

from dataclasses import dataclass
from math import sqrt
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import UNSET, Force, Role, Wrench, param, wrench

# share of the approach speed below which captive tests do not define the model
SLOWEST = 0.3


@njit(inline="always")
def law(m: Any, q: Any, s: Any) -> Wrench:
    """Return the force of an Abkowitz model, polynomials in drift, yaw rate and rudder angle.

    The model solves its own inertia matrix, which need not be symmetric. Its accelerations are
    multiplied by the mass and the yaw inertia of the body, and the Coriolis terms that the
    rigid-body equations add are subtracted. Derivatives are nondimensional as in the source:
    velocities over the instantaneous speed U, yaw rate times L / U. The sign of the rudder angle is
    reversed so that a positive angle turns to starboard. All velocities are relative to the water.

    Args:
        m: Motion of the hull: velocities [m/s], rates [rad/s], position [m], attitude [rad].
        q: Parameters of the effect, with the names and units of its class.
        s: Signals bound to the roles of the effect.

    Returns:
        Force [N] and moment [N m] in body axes.
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


def derivative_parameter(name: str) -> float:
    """Declare one nondimensional hydrodynamic derivative as a parameter of an effect."""
    return param(0.0, low=-10.0, high=10.0, unit="", words=f"{name}', nondimensional")


def inertia_parameter(words: str) -> float:
    """Declare one entry of a nondimensional inertia matrix as a parameter of an effect."""
    return param(1.0, low=-10.0, high=10.0, unit="", words=words)


@dataclass(frozen=True)
class AbkowitzHull(Force):
    """Complete manoeuvring model from captive model tests, rigid body and added mass included.

    m11 u' = X(du, v, r, delta), and with sway and yaw coupled by inertia:
    [m22 m23; m32 m33] [v'; r'] = [Y(du, v, r, delta); N(du, v, r, delta)]

    All quantities are nondimensional: du = (u - U0) / U, v / U, r L / U. X, Y and N are polynomials
    up to third order. The origin of motion is the reference point of the derivatives. Below 0.3 of
    the approach speed the speed U is held, because the tests do not define the model there.
    """

    formula: ClassVar[str] = (
        r"\begin{aligned} X &= m \left(X' / m'_{11} \, U^2 / L - v_r r\right) \\ Y &= m "
        r"\left(\dot v' \, U^2 / L + u_r r\right), \quad N = I_z \, \dot r' \, U^2 / L^2 "
        r"\\ \begin{bmatrix} \dot v' \\ \dot r' \end{bmatrix} &= \begin{bmatrix} m'_{22} "
        r"& m'_{23} \\ m'_{32} & m'_{33} \end{bmatrix}^{-1} \begin{bmatrix} Y' \\ N' "
        r"\end{bmatrix} \\ X' &= X_u u' + X_{uu} u'^2 + X_{uuu} u'^3 + X_{vv} v'^2 + "
        r"X_{rr} r'^2 + X_{rv} r' v' \\ &\quad + g \left(X_{\delta\delta} \delta^2 + "
        r"X_{u\delta\delta} u' \delta^2 + X_{v\delta} v' \delta + X_{uv\delta} u' v' "
        r"\delta\right) \\ Y' &= Y_v v' + Y_{vu} v' u' + Y_{vvv} v'^3 + Y_{vvr} v'^2 r' + "
        r"Y_r r' + Y_{ru} r' u' \\ &\quad + g \left(Y_\delta \delta + Y_{u\delta} u' "
        r"\delta + Y_{uu\delta} u'^2 \delta + Y_{\delta\delta\delta} \delta^3 + "
        r"Y_{v\delta\delta} v' \delta^2 + Y_{vv\delta} v'^2 \delta\right) \\ &\quad + Y_0 "
        r"+ Y_{0u} u' + Y_{0uu} u'^2 \\ u' &= (u_r - U_0) / U, \quad v' = v_r / U, \quad "
        r"r' = r L / U \\ U &= \max\left(\sqrt{u_r^2 + v_r^2},\; 0.3 \, U_0\right) "
        r"\end{aligned}"
    )
    symbols: ClassVar = {
        "length": "L",
        "speed": "U_0",
        "mass": "m",
        "yaw_inertia": "I_z",
        "gain": "g",
        "m11": "m'_{11}",
        "m22": "m'_{22}",
        "m23": "m'_{23}",
        "m32": "m'_{32}",
        "m33": "m'_{33}",
    }
    words: ClassVar[str] = (
        "hull and rudder forces as a polynomial in drift, rate of turn and rudder angle"
    )
    shown_by: ClassVar[str] = "turning circles and zig-zags"
    source: ClassVar[str] = "M. A. Abkowitz, Lectures on Ship Hydrodynamics, Hy-5, Lyngby 1964"
    roles: ClassVar = {"angle": Role("rad", "rudder angle, positive turns to starboard")}
    law: ClassVar = law

    length: float = param(
        UNSET, low=0.0, high=500.0, unit="m", words="length of the ship, L", follows="vessel.length"
    )
    speed: float = param(
        1.0, low=0.01, high=50.0, unit="m/s", words="approach speed of the derivatives, U0"
    )
    mass: float = param(
        UNSET, low=0.0, high=1e12, unit="kg", words="that of the body", follows="vessel.body.mass"
    )
    yaw_inertia: float = param(
        UNSET,
        low=0.0,
        high=1e16,
        unit="kg m^2",
        words="that of the body",
        follows="vessel.body.yaw_inertia",
    )
    gain: float = param(
        1.0,
        low=0.1,
        high=5.0,
        unit="",
        words="rudder force over its specified value",
        calibrates="thrust",
    )
    m11: float = inertia_parameter("m' - X_udot'")
    m22: float = inertia_parameter("m' - Y_vdot'")
    m23: float = inertia_parameter("m' x_G' - Y_rdot'")
    m32: float = inertia_parameter("m' x_G' - N_vdot'")
    m33: float = inertia_parameter("I_z' - N_rdot'")
    X_u: float = derivative_parameter("X_u")
    X_uu: float = derivative_parameter("X_uu")
    X_uuu: float = derivative_parameter("X_uuu")
    X_vv: float = derivative_parameter("X_vv")
    X_rr: float = derivative_parameter("X_rr")
    X_rv: float = derivative_parameter("X_rv")
    X_dd: float = derivative_parameter("X_dd")
    X_udd: float = derivative_parameter("X_udd")
    X_vd: float = derivative_parameter("X_vd")
    X_uvd: float = derivative_parameter("X_uvd")
    Y_v: float = derivative_parameter("Y_v")
    Y_r: float = derivative_parameter("Y_r")
    Y_vvv: float = derivative_parameter("Y_vvv")
    Y_vvr: float = derivative_parameter("Y_vvr")
    Y_vu: float = derivative_parameter("Y_vu")
    Y_ru: float = derivative_parameter("Y_ru")
    Y_d: float = derivative_parameter("Y_d")
    Y_ddd: float = derivative_parameter("Y_ddd")
    Y_ud: float = derivative_parameter("Y_ud")
    Y_uud: float = derivative_parameter("Y_uud")
    Y_vdd: float = derivative_parameter("Y_vdd")
    Y_vvd: float = derivative_parameter("Y_vvd")
    Y_0: float = derivative_parameter("Y_0")
    Y_0u: float = derivative_parameter("Y_0u")
    Y_0uu: float = derivative_parameter("Y_0uu")
    N_v: float = derivative_parameter("N_v")
    N_r: float = derivative_parameter("N_r")
    N_vvv: float = derivative_parameter("N_vvv")
    N_vvr: float = derivative_parameter("N_vvr")
    N_vu: float = derivative_parameter("N_vu")
    N_ru: float = derivative_parameter("N_ru")
    N_d: float = derivative_parameter("N_d")
    N_ddd: float = derivative_parameter("N_ddd")
    N_ud: float = derivative_parameter("N_ud")
    N_uud: float = derivative_parameter("N_uud")
    N_vdd: float = derivative_parameter("N_vdd")
    N_vvd: float = derivative_parameter("N_vvd")
    N_0: float = derivative_parameter("N_0")
    N_0u: float = derivative_parameter("N_0u")
    N_0uu: float = derivative_parameter("N_0uu")
