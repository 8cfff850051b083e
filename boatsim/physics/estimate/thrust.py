"""Full thrust of a boat whose owner states none."""

from boatsim.physics.estimate.base import Estimate, Hull
from boatsim.physics.particulars import GRAVITY

OF_WEIGHT = 0.4  # Otter: 24.4 kgf of 55 kg, MSS otter.m


def full(hull: Hull) -> Estimate:
    """Of all thrusters together [N]."""
    return Estimate(
        OF_WEIGHT * hull.mass * GRAVITY, f"nobody stated it: {OF_WEIGHT:g} of the weight, as the Otter (MSS otter.m)"
    )
