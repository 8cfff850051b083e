"""MMG hull at low speed: linear lift and cross-flow drag, from rest to going astern."""

from dataclasses import dataclass
from math import atan2, pi, sqrt
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import UNSET, Force, Wrench, param, wrench
from boatsim.physics.effects.cross_flow_drag import panel_integrals


@njit(inline="always")
def hull_integrals(v: float, r: float, length: float) -> tuple[float, float]:
    """Return the integrals of w|w| and x w|w|, w = v + x r, along a hull about midship.

    They give the cross-flow drag and its yaw moment.

    Args:
        v: Cross-flow velocity midship [m/s].
        r: Slope of the cross-flow velocity along the hull, the yaw rate [1/s].
        length: Length of the hull [m].
    """
    half = 0.5 * length
    # station at which the cross flow changes its sign
    turn = min(max(-v / r, -half), half) if r != 0.0 else -half
    aft, aft_moment = panel_integrals(-half, turn, v, r)
    fore, fore_moment = panel_integrals(turn, half, v, r)
    return aft + fore, aft_moment + fore_moment


@njit(inline="always")
def law(m: Any, q: Any) -> Wrench:
    """Return the force on a ship's bare hull at low speed, for every drift angle and at rest.

    Linear lift and cross-flow drag replace polynomials in v / U and r L / U, which are not defined
    at rest. The weight of the resistance coefficient astern grows linearly with the drift angle,
    from 0 ahead to 1 astern. In yaw the Coriolis force of the added mass is part of N_v.

    Args:
        m: Motion of the hull: velocities [m/s], rates [rad/s], position [m], attitude [rad].
        q: Parameters of the effect, with the names and units of its class.

    Returns:
        Force [N] and moment [N m] in body axes.
    """
    U, L = sqrt(m.ur * m.ur + m.vr * m.vr), q.length
    astern = abs(atan2(m.vr, m.ur)) / pi
    across, _ = hull_integrals(m.vr, q.C_rY * m.r, L)
    _, turning = hull_integrals(m.vr, q.C_rN * m.r, L)
    k = 0.5 * q.density * L * q.draught  # [kg/m]
    X = (q.X_0F + (q.X_0A - q.X_0F) * astern) * m.ur * U + q.X_vr * L * m.vr * m.r
    Y = q.Y_v * m.vr * abs(m.ur) + q.Y_r * L * m.r * m.ur - q.C_D * across / L
    N = q.N_v * m.vr * m.ur + q.N_r * L * m.r * abs(m.ur) - q.C_D * turning / (L * L)
    return wrench(X=k * X + q.m_y * m.vr * m.r, Y=k * Y - q.m_x * m.ur * m.r, N=k * L * N)


def coefficient_parameter(words: str, axis: str = "") -> float:
    """Declare a nondimensional coefficient from captive model tests as a parameter of an effect."""
    return param(0.0, low=-10.0, high=10.0, unit="", words=words, calibrates="damping", axis=axis)


@dataclass(frozen=True)
class MmgLowSpeedHull(Force):
    """Hull of a ship that stops, backs and turns on the spot, unified MMG model; origin midship.

    X = q (X_0 u U + X_vr L v r) + m_y v r,  X_0 between X_0F (ahead) and X_0A (astern)
    Y = q (Y_v v |u| + Y_r L r u - C_D / L integral(w|w| dx)) - m_x u r,  w = v + C_rY r x
    N = q L (N_v v u + N_r L r |u| - C_D / L^2 integral(x w|w| dx)),  w = v + C_rN r x

    q = 0.5 rho L d. The vessel needs `added_mass` with coriolis = 0.
    """

    formula: ClassVar[str] = (
        r"\begin{aligned} X &= q \left(X'_0 \, u_r U + X'_{vr} L \, v_r r\right) + m_y "
        r"v_r r, \quad q = \tfrac{1}{2} \rho L d \\ Y &= q \left(Y'_v \, v_r |u_r| + Y'_r "
        r"L \, r u_r - \frac{C_D}{L} \int w_Y |w_Y| \, \mathrm{d}x\right) - m_x u_r r \\ "
        r"N &= q L \left(N'_v \, v_r u_r + N'_r L \, r |u_r| - \frac{C_D}{L^2} \int x \, "
        r"w_N |w_N| \, \mathrm{d}x\right) \\ X'_0 &= X'_{0F} + (X'_{0A} - X'_{0F}) \, "
        r"|\operatorname{atan2}(v_r, u_r)| / \pi \\ w_Y &= v_r + C_{rY} r x, \quad w_N = "
        r"v_r + C_{rN} r x \end{aligned}"
    )
    symbols: ClassVar = {
        "length": "L",
        "draught": "d",
        "density": r"\rho",
        "m_x": "m_x",
        "m_y": "m_y",
        "C_D": "C_D",
    }
    words: ClassVar[str] = (
        "hull forces from rest to astern: linear lift and cross-flow drag (MMG, low speed)"
    )
    shown_by: ClassVar[str] = "stopping, backing and turning on the spot"
    source: ClassVar[str] = (
        "Y. Yoshimura, I. Nakao, A. Ishibashi, MARSIM 2009 (unified model, ocean and harbour)"
    )
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
        1000.0, low=0.0, high=1100.0, unit="kg/m^3", words="density of the water"
    )
    m_x: float = param(
        UNSET, low=0.0, high=1e9, unit="kg", words="added mass", follows="added_mass.surge"
    )
    m_y: float = param(
        UNSET, low=0.0, high=1e9, unit="kg", words="added mass", follows="added_mass.sway"
    )
    X_0F: float = coefficient_parameter("X_0(F)', resistance ahead", "surge")
    X_0A: float = coefficient_parameter("X_0(A)', resistance astern", "surge")
    X_vr: float = coefficient_parameter("X_vr'", "surge")
    Y_v: float = coefficient_parameter("Y_v'", "sway")
    Y_r: float = coefficient_parameter("Y_r'", "sway")
    N_v: float = coefficient_parameter("N_v'", "yaw")
    N_r: float = coefficient_parameter("N_r'", "yaw")
    C_D: float = coefficient_parameter("C_D, cross-flow drag coefficient of a section")
    C_rY: float = coefficient_parameter(
        "C_rY, factor on the yaw rate in the cross flow of the sway force", "sway"
    )
    C_rN: float = coefficient_parameter(
        "C_rN, factor on the yaw rate in the cross flow of the yaw moment", "yaw"
    )
