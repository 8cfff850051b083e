"""Coefficients of a displacement hull from its particulars, by published formulas.

Effects call them when a vessel is loaded; none of them is compiled. SI units and
radians.
"""

from math import atanh, pi, sqrt
from typing import NamedTuple

from boatsim.errors import BadInput

GRAVITY = 9.81  # [m/s^2] of all formulas here, as in Martin 1993
SEA_WATER = 1025.0  # [kg/m^3]
# Length over the cube root of the displaced volume, far outside all boats: the vessels in models/,
# from tanker to catamaran, have 3.5 to 10.1
LEAST_SLENDERNESS, MOST_SLENDERNESS = 1.0, 60.0


class SpheroidAddedMass(NamedTuple):
    """Added masses of a spheroid in surge, sway and yaw, as ratios.

    They are divided by the displaced mass and, in yaw, by the yaw inertia of that mass.
    """

    surge: float  # k1
    sway: float  # k2
    yaw: float  # k'


class LinearDerivatives(NamedTuple):
    """Linear hull derivatives in sway and yaw about midship, nondimensional.

    Forces per 0.5 rho L T V^2, moments per 0.5 rho L^2 T V^2.
    """

    sway_by_sway: float  # Y'v
    sway_by_yaw: float  # Y'r
    yaw_by_sway: float  # N'v
    yaw_by_yaw: float  # N'r


def check_slenderness(length: float, mass: float) -> None:
    """Check that a hull of this length can have this mass, so that a wrong unit is found.

    Args:
        length: Length [m].
        mass: Mass, which is that of the displaced water [kg].

    Raises:
        BadInput: The length divided by the cube root of the displaced volume is that of no boat.
    """
    side = (mass / SEA_WATER) ** (1.0 / 3.0)
    if not LEAST_SLENDERNESS <= length / side <= MOST_SLENDERNESS:
        raise BadInput(
            f"length = {length:g} m does not fit mass = {mass:g} kg; allowed for this mass is "
            f"{LEAST_SLENDERNESS * side:.3g} to {MOST_SLENDERNESS * side:.3g} m"
        )


def spheroid_added_mass(length: float, draught: float) -> SpheroidAddedMass:
    """Return the added mass of a prolate spheroid of a hull's length and draught.

    Formulas: Lamb 1932, sections 114 and 115.

    Args:
        length: Length of the hull, twice the longer semi-axis [m].
        draught: Draught of the hull, the shorter semi-axis [m].

    Raises:
        BadInput: The hull is not longer than twice its draught.
    """
    if length <= 2.0 * draught:
        raise BadInput(
            f"spheroid: length = {length:g} m; "
            f"allowed is more than twice the draught, {2.0 * draught:g} m"
        )
    round_part = (2.0 * draught / length) ** 2
    square = 1.0 - round_part  # of the eccentricity
    e = sqrt(square)
    alpha = 2.0 * round_part / (e * square) * (atanh(e) - e)
    beta = 1.0 / square - round_part / (e * square) * atanh(e)
    turn = square * square * (beta - alpha)
    return SpheroidAddedMass(
        alpha / (2.0 - alpha),
        beta / (2.0 - beta),
        turn / ((2.0 - square) * (2.0 * square - (2.0 - square) * (beta - alpha))),
    )


def linear_derivatives(
    length: float, beam: float, draught: float, trim: float, block: float
) -> LinearDerivatives:
    """Estimate the linear sway and yaw derivatives of a trimmed hull by a published regression.

    S. Inoue, M. Hirano, K. Kijima, Int. Shipbuilding Progress 28 (1981), in the form of C. R.
    Martin, UBC 1993.

    Args:
        length: Length [m].
        beam: Beam [m].
        draught: Draught [m].
        trim: Trim by the stern [m].
        block: Block coefficient.
    """
    k, tau = 2.0 * draught / length, trim / draught
    lift = 0.5 * pi * k + 1.4 * block * beam / length
    return LinearDerivatives(
        -lift * (1.0 + 2.0 / 3.0 * tau),
        0.25 * pi * k * (1.0 + 0.8 * tau),
        -k * (1.0 - 0.27 * tau * lift / k),
        -(0.54 * k - k * k) * (1.0 + 0.3 * tau),
    )


def rudder_force_slope(
    area: float, aspect: float, inflow: float, density: float = SEA_WATER
) -> float:
    """Return the force normal to a rudder per angle of attack [N/rad] (A. Fujii, T. Tsuda 1961).

    Args:
        area: Area of the blade [m^2].
        aspect: Span divided by chord.
        inflow: Speed of the inflow [m/s].
        density: Density of the water [kg/m^3].
    """
    return 0.5 * density * rudder_lift_slope(aspect) * area * inflow * inflow


def rudder_lift_slope(aspect: float) -> float:
    """Return f_alpha, the slope of a rudder's normal force coefficient (Fujii, Tsuda 1961).

    Args:
        aspect: Span divided by chord.
    """
    return 6.13 * aspect / (aspect + 2.25)


def hull_force_ratio(block: float) -> float:
    """Estimate a_H, the side force that a rudder induces on the hull per force on the rudder.

    Source: Inoue et al. 1981.

    Args:
        block: Block coefficient.
    """
    return 0.627 * block - 0.153


def roll_damping_ratio_by_speed(
    length: float, beam: float, block: float, metacentric_height: float, speed: float
) -> float:
    """Estimate the increase of a hull's roll damping ratio with its forward speed.

    Source: Martin 1993, Appendix IV.

    Args:
        length: Length [m].
        beam: Beam [m].
        block: Block coefficient.
        metacentric_height: Metacentric height [m].
        speed: Forward speed [m/s].
    """
    f = speed / sqrt(GRAVITY * length) / block
    return 0.00085 * length / beam * sqrt(length / metacentric_height) * f * (1.0 + f + 2.0 * f * f)
