"""Full thrust of a boat without a specified value, and its decrease with speed."""

from math import sqrt

from boatsim.physics.estimate.base import Estimate, HullParticulars
from boatsim.physics.particulars import GRAVITY

# of the thrust at rest, at top speed: K_T of a Wageningen B-screw of P/D 0.7 at J 0.4 by that at J
# 0, which is 0.51 to 0.59 for 3 or 4 blades and area ratios of 0.7 to 0.4, rounded down
LEFT = 0.5
FAST = 0.4  # Froude number of the top speed if none is given: the hump of the wave resistance
OF_WEIGHT = 0.4  # Otter: 24.4 kgf of 55 kg, MSS otter.m


def full_thrust(hull: HullParticulars) -> Estimate:
    """Estimate the full thrust of a boat at rest [N], all thrusters together.

    Args:
        hull: Hull with its main particulars.
    """
    return Estimate(
        OF_WEIGHT * hull.mass * GRAVITY,
        f"nobody stated it: {OF_WEIGHT:g} of the weight, as the Otter (MSS otter.m)",
    )


def thrust_loss_with_speed(hull: HullParticulars, top_speed: float | None) -> Estimate:
    """Estimate the relative loss of thrust per forward speed [s/m].

    Args:
        hull: Hull with its main particulars.
        top_speed: Top speed [m/s], or None.
    """
    if top_speed is None:
        speed = FAST * sqrt(GRAVITY * hull.length)
        origin = "by rule"
    else:
        speed = top_speed
        origin = "stated"
    share = f"{1.0 - LEFT:g} of it at a top speed of {speed:.3g} m/s"
    rule = f"{share}, {origin}: M. M. Bernitsas et al. 1981"
    return Estimate((1.0 - LEFT) / speed, rule)
