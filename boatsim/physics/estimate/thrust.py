"""Full thrust of a boat whose owner states none, and what is left of it under way."""

from math import sqrt

from boatsim.physics.estimate.base import Estimate, Hull
from boatsim.physics.particulars import GRAVITY

# of the thrust at rest, at top speed: K_T of a Wageningen B-screw of P/D 0.7 at J 0.4 by that at J
# 0
LEFT = 0.5
FAST = 0.4  # Froude number of a top speed that nobody states: a hull begins to climb its own wave
OF_WEIGHT = 0.4  # Otter: 24.4 kgf of 55 kg, MSS otter.m


def full(hull: Hull) -> Estimate:
    """Of all thrusters together [N]."""
    return Estimate(
        OF_WEIGHT * hull.mass * GRAVITY,
        f"nobody stated it: {OF_WEIGHT:g} of the weight, as the Otter (MSS otter.m)",
    )


def loss(hull: Hull, top_speed: float | None) -> Estimate:
    """Share of the thrust that is lost per speed ahead [s/m]."""
    speed, said = (
        (top_speed, "stated")
        if top_speed is not None
        else (FAST * sqrt(GRAVITY * hull.length), "by rule")
    )
    rule = f"{1.0 - LEFT:g} of it at a top speed of {speed:.3g} m/s, {said}: M. M. Bernitsas et al. 1981"
    return Estimate((1.0 - LEFT) / speed, rule)
