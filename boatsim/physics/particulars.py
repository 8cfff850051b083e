"""Coefficients of a displacement hull from its particulars: published closed forms, one function each.

Effects call them when they are put on a vessel (`completed`); nothing here is compiled. SI units and radians.
"""

from math import atanh, pi, sqrt
from typing import NamedTuple

from boatsim.errors import BadInput

GRAVITY = 9.81  # [m/s^2] of all formulas here, as in Martin 1993
SEA_WATER = 1025.0  # [kg/m^3]


class Spheroid(NamedTuple):
    """Added mass and inertia of a spheroid per own mass and yaw inertia."""

    surge: float  # k1
    sway: float  # k2
    yaw: float  # k'


class Derivatives(NamedTuple):
    """Non-dimensional derivatives about midship; forces per 0.5 rho L T V^2, moments per 0.5 rho L^2 T V^2."""

    sway_by_sway: float  # Y'v
    sway_by_yaw: float  # Y'r
    yaw_by_sway: float  # N'v
    yaw_by_yaw: float  # N'r


def spheroid(length: float, draught: float) -> Spheroid:
    """Prolate spheroid of semi-axes length / 2 and draught (H. Lamb, Hydrodynamics, 6th ed. 1932, sections 114, 115).

    Raises BadInput for a hull no longer than twice its draught.
    """
    if length <= 2.0 * draught:
        raise BadInput(
            f"spheroid: length = {length:g} m; allowed is more than twice the draught, {2.0 * draught:g} m"
        )
    round_part = (2.0 * draught / length) ** 2
    square = 1.0 - round_part  # of the eccentricity
    e = sqrt(square)
    alpha = 2.0 * round_part / (e * square) * (atanh(e) - e)
    beta = 1.0 / square - round_part / (e * square) * atanh(e)
    turn = square * square * (beta - alpha)
    return Spheroid(
        alpha / (2.0 - alpha),
        beta / (2.0 - beta),
        turn / ((2.0 - square) * (2.0 * square - (2.0 - square) * (beta - alpha))),
    )


def derivatives(
    length: float, beam: float, draught: float, trim: float, block: float
) -> Derivatives:
    """Linear derivatives of a trimmed hull.

    S. Inoue, M. Hirano, K. Kijima, Int. Shipbuilding Progress 28 (1981), as C. R. Martin, UBC 1993 has them. `trim` is
    by the stern [m], `block` the block coefficient.
    """
    k, tau = 2.0 * draught / length, trim / draught
    lift = 0.5 * pi * k + 1.4 * block * beam / length
    return Derivatives(
        -lift * (1.0 + 2.0 / 3.0 * tau),
        0.25 * pi * k * (1.0 + 0.8 * tau),
        -k * (1.0 - 0.27 * tau * lift / k),
        -(0.54 * k - k * k) * (1.0 + 0.3 * tau),
    )


def rudder_slope(area: float, aspect: float, inflow: float, density: float = SEA_WATER) -> float:
    """Force normal to a blade per angle of attack [N/rad] (A. Fujii, T. Tsuda 1961), area [m^2], inflow [m/s]."""
    return 0.5 * density * lift_slope(aspect) * area * inflow * inflow


def lift_slope(aspect: float) -> float:
    """f_alpha of a blade by its span per chord: normal force coefficient per angle of attack (same)."""
    return 6.13 * aspect / (aspect + 2.25)


def hull_share(block: float) -> float:
    """a_H: force that a deflected rudder raises on the hull before it, per force on the blade (Inoue et al. 1981)."""
    return 0.627 * block - 0.153


def roll_ratio_by_speed(
    length: float, beam: float, block: float, metacentric_height: float, speed: float
) -> float:
    """What headway adds to the roll damping per critical, of a round bilge (Martin 1993, Appendix IV)."""
    f = speed / sqrt(GRAVITY * length) / block
    return 0.00085 * length / beam * sqrt(length / metacentric_height) * f * (1.0 + f + 2.0 * f * f)
