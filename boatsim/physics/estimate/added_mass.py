"""Added mass from a regression over ships for slender hulls, from strip theory for others."""

from math import pi

from boatsim.physics.estimate.base import DENSITY, Estimate, HullParticulars

CLARKE = "D. Clarke, P. Gedling, G. Hine 1983"
STRIPS = "strips of 0.5 pi rho T^2, J. N. Newman, Marine Hydrodynamics, 1977, section 4.13"


def surge_added_mass(hull: HullParticulars) -> Estimate:
    """Estimate the surge added mass [kg] of a boat from its main particulars (all hulls together).

    Args:
        hull: Boat with its main particulars.
    """
    value = (
        hull.hulls
        * 2.7
        * DENSITY
        * (hull.mass / hull.hulls / DENSITY) ** (5.0 / 3.0)
        / hull.length**2
    )
    return Estimate(value, "2.7 rho V^(5/3) / L^2, H. Soeding 1982 (Fossen 2021, eq. 6.41)")


def sway_added_mass(hull: HullParticulars) -> Estimate:
    """Estimate the sway added mass [kg] of a boat from its main particulars (all hulls together).

    Args:
        hull: Boat with its main particulars.
    """
    strips = hull.hulls * 0.5 * pi * DENSITY * hull.draught**2 * hull.length
    if not hull.is_slender:
        return Estimate(strips, STRIPS)
    b, fullness = hull.breadth, 0.16 * hull.block_coefficient * hull.breadth / hull.draught
    return Estimate(strips * (1.0 + fullness - 5.1 * (b / hull.length) ** 2), CLARKE)


def yaw_added_mass(hull: HullParticulars) -> Estimate:
    """Estimate the yaw added moment of inertia [kg m^2] of a boat about midship.

    Each hull of a catamaran adds its surge added mass times the square of its distance from the
    centreline.

    Args:
        hull: Boat with its main particulars.
    """
    strips = hull.hulls * 0.5 * pi * DENSITY * hull.draught**2 * hull.length**3
    apart = surge_added_mass(hull).value * (0.5 * hull.hull_spacing) ** 2
    if not hull.is_slender:
        return Estimate(strips / 12.0 + apart, STRIPS)
    fullness = 0.017 * hull.block_coefficient * hull.breadth / hull.draught
    return Estimate(
        strips * max(1.0 / 12.0 + fullness - 0.33 * hull.breadth / hull.length, 0.01) + apart,
        CLARKE,
    )
