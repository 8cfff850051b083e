"""Direction of waves in body axes, and the place of a hull along them."""

from math import cos, sin
from typing import Any

from numba import njit


@njit(forceinline=True)
def heading_of_waves(bearing: float, m: Any) -> tuple[float, float, float]:
    """Return the direction of waves in body axes, and the hull's place along it.

    The waves travel on the water, which moves with the current: the place is that relative to the
    water, from the origin at t = 0.

    Args:
        bearing: Direction to which the waves run [rad].
        m: Motion of the hull.

    Returns:
        Parts of the direction ahead and to starboard, and the distance [m] travelled by the hull
        through the water along the direction of the waves.
    """
    ahead, across = cos(bearing), sin(bearing)  # direction of the waves in earth axes
    run = ahead * (m.x - m.carried_north) + across * (m.y - m.carried_east)
    return m.cos_psi * ahead + m.sin_psi * across, m.cos_psi * across - m.sin_psi * ahead, run
