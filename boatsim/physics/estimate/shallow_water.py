"""Increase of sway and yaw added mass in shallow water."""

from math import cos, log, pi

from boatsim.physics.estimate.base import Estimate


def shallow_water_factor(draught: float, depth: float) -> Estimate:
    """Estimate the added mass across the hull in shallow water over that in deep water.

    The section is a plate that reaches down to the draught. With its mirror image in the water
    surface it is a plate across a channel, whose potential flow is known: k = -8 / pi^2 (h / T)^2
    ln cos(pi T / (2 h)), 1 in deep water.

    Args:
        draught: Draught T [m].
        depth: Depth h of the water [m], more than the draught.
    """
    ratio = depth / draught
    value = -8.0 / pi**2 * ratio**2 * log(cos(0.5 * pi / ratio))
    return Estimate(
        value, f"x {value:.3g} in {depth:g} m of water, a plate across a channel: L. I. Sedov 1965"
    )
