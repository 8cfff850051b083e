"""Area and force of a rudder of which only the place is known."""

from math import pi

from boatsim.physics import particulars
from boatsim.physics.estimate.base import DENSITY, Estimate, HullParticulars

ASPECT = 1.5  # span per chord, usual on ships: Mariner 1.6, Esso Osaka 1.5
# kappa, share of the race's gain in speed that reaches the blade: KVLCC2 by Yasukawa, Yoshimura
# 2015
REACHES = 0.5


def rudder_area(hull: HullParticulars) -> Estimate:
    """Estimate the area [m^2] of a boat's rudder from the main particulars of the hull.

    Args:
        hull: Hull with its main particulars.
    """
    value = hull.length * hull.draught / 100.0 * (1.0 + 25.0 * (hull.breadth / hull.length) ** 2)
    return Estimate(value, "L T / 100 x (1 + 25 (B / L)^2), Det Norske Veritas 1975")


def rudder_force_slope(blade: float, speed: float) -> Estimate:
    """Estimate the side force of a rudder per rudder angle [N/rad].

    Args:
        blade: Rudder area [m^2].
        speed: Speed of the water at the rudder [m/s].
    """
    value = particulars.rudder_force_slope(blade, ASPECT, speed, DENSITY)
    return Estimate(
        value, f"A. Fujii, T. Tsuda 1961, {blade:.3g} m^2 of aspect {ASPECT:g} at {speed:.3g} m/s"
    )


def slipstream_rudder_force() -> Estimate:
    """Estimate the normal force of a rudder in the slipstream of a propeller, at rest.

    The result is the force divided by the thrust and by the sine of the rudder angle. A rudder as
    high as the propeller diameter D has the area D^2 / aspect. The slipstream of a propeller at
    rest has V^2 = 8 T / (pi rho D^2) far behind, and `REACHES` of that velocity at the rudder.
    """
    value = particulars.rudder_lift_slope(ASPECT) * REACHES**2 * 4.0 / (pi * ASPECT)
    return Estimate(
        value,
        "f_alpha kappa^2 4 / (pi aspect), momentum theory of a blade as high as the propeller",
    )
