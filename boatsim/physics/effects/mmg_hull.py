"""MMG hull: forces of the bare hull as polynomials in drift and yaw rate."""

from dataclasses import dataclass
from math import sqrt
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import UNSET, Force, Wrench, param, wrench

# R_0 is taken whole where u / U is above its inverse, up to 60 deg of drift; the model is for much
# less
BOW_ON = 2.0
# [-] r L / U up to which the polynomials are taken; the tightest turns of a ship under way are
# below 1.5
FASTEST = 3.0


@njit(inline="always")
def law(m: Any, q: Any) -> Wrench:
    """Return the hull force of the MMG standard method and the Coriolis force of the added mass.

    Velocities are nondimensional with U: v / U and r L / U. In yaw the Coriolis force is part of
    N_v. For a hull that turns almost on the spot U is at least |r| L / 3, so that r L / U stays
    within the range of the polynomials. The resistance opposes the surge velocity; beyond 60 deg of
    drift it decreases to zero at 90 deg and changes its sign.

    Args:
        m: Motion of the hull: velocities [m/s], rates [rad/s], position [m], attitude [rad].
        q: Parameters of the effect, with the names and units of its class.

    Returns:
        Force [N] and moment [N m] in body axes.
    """
    U = max(sqrt(m.ur * m.ur + m.vr * m.vr), abs(m.r) * q.length / FASTEST, 1e-9)
    v, r = m.vr / U, m.r * q.length / U
    against = min(max(BOW_ON * m.ur / U, -1.0), 1.0)
    X = -q.R_0 * against + v * v * (q.X_vv + q.X_vvvv * v * v) + r * (q.X_vr * v + q.X_rr * r)
    Y = v * (q.Y_v + v * (q.Y_vvv * v + q.Y_vvr * r)) + r * (
        q.Y_r + r * (q.Y_vrr * v + q.Y_rrr * r)
    )
    N = v * (q.N_v + v * (q.N_vvv * v + q.N_vvr * r)) + r * (
        q.N_r + r * (q.N_vrr * v + q.N_rrr * r)
    )
    k = 0.5 * q.density * q.length * q.draught * U * U  # [N]
    return wrench(X=k * X + q.m_y * m.vr * m.r, Y=k * Y - q.m_x * m.ur * m.r, N=k * q.length * N)


def derivative_parameter(name: str, axis: str) -> float:
    """Declare a nondimensional hydrodynamic derivative of a hull as a parameter of an effect."""
    return param(
        0.0,
        low=-10.0,
        high=10.0,
        unit="",
        words=f"{name}', nondimensional",
        calibrates="damping",
        axis=axis,
    )


@dataclass(frozen=True)
class MmgHull(Force):
    """Hull of a ship going ahead, MMG standard method; origin of motion midship.

    X = q (-R_0 + X_vv v'^2 + X_vr v' r' + X_rr r'^2 + X_vvvv v'^4) + m_y v r
    Y = q (Y_v v' + Y_r r' + Y_vvv v'^3 + Y_vvr v'^2 r' + Y_vrr v' r'^2 + Y_rrr r'^3) - m_x u r
    N = q L (N_v v' + N_r r' + N_vvv v'^3 + N_vvr v'^2 r' + N_vrr v' r'^2 + N_rrr r'^3)

    q = 0.5 rho L d U^2, v' = v / U, r' = r L / U. The vessel needs `added_mass` with coriolis = 0,
    because the Coriolis force of the added mass is part of this effect.
    """

    formula: ClassVar[str] = (
        r"\begin{aligned} X &= q \left(-R'_0 f + X'_{vv} v'^2 + X'_{vr} v' r' + X'_{rr} "
        r"r'^2 + X'_{vvvv} v'^4\right) + m_y v_r r \\ Y &= q \left(Y'_v v' + Y'_r r' + "
        r"Y'_{vvv} v'^3 + Y'_{vvr} v'^2 r' + Y'_{vrr} v' r'^2 + Y'_{rrr} r'^3\right) - "
        r"m_x u_r r \\ N &= q L \left(N'_v v' + N'_r r' + N'_{vvv} v'^3 + N'_{vvr} v'^2 "
        r"r' + N'_{vrr} v' r'^2 + N'_{rrr} r'^3\right) \\ q &= \tfrac{1}{2} \rho L d \, "
        r"U^2, \quad v' = v_r / U, \quad r' = r L / U, \quad f = \min(\max(2 u_r / U, "
        r"-1), 1) \end{aligned}"
    )
    symbols: ClassVar = {
        "length": "L",
        "draught": "d",
        "density": r"\rho",
        "m_x": "m_x",
        "m_y": "m_y",
    }
    words: ClassVar[str] = "hull forces as polynomials in drift and rate of turn (MMG)"
    shown_by: ClassVar[str] = "turning circles and zig-zags"
    source: ClassVar[str] = (
        "H. Yasukawa, Y. Yoshimura, J. Mar. Sci. Technol. 20, 2015 (MMG standard method)"
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
    R_0: float = derivative_parameter("R_0", "surge")
    X_vv: float = derivative_parameter("X_vv", "surge")
    X_vr: float = derivative_parameter("X_vr", "surge")
    X_rr: float = derivative_parameter("X_rr", "surge")
    X_vvvv: float = derivative_parameter("X_vvvv", "surge")
    Y_v: float = derivative_parameter("Y_v", "sway")
    Y_r: float = derivative_parameter("Y_r", "sway")
    Y_vvv: float = derivative_parameter("Y_vvv", "sway")
    Y_vvr: float = derivative_parameter("Y_vvr", "sway")
    Y_vrr: float = derivative_parameter("Y_vrr", "sway")
    Y_rrr: float = derivative_parameter("Y_rrr", "sway")
    N_v: float = derivative_parameter("N_v", "yaw")
    N_r: float = derivative_parameter("N_r", "yaw")
    N_vvv: float = derivative_parameter("N_vvv", "yaw")
    N_vvr: float = derivative_parameter("N_vvr", "yaw")
    N_vrr: float = derivative_parameter("N_vrr", "yaw")
    N_rrr: float = derivative_parameter("N_rrr", "yaw")
