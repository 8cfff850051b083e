"""Dispersion of linear waves, and the attenuation of their pressure with depth."""

from typing import Any

import numpy as np
from numba import njit

from boatsim.physics.particulars import GRAVITY

# Newton's iterations from Eckart's approximation (1952), k h = x / sqrt(tanh x) with x = w^2 h / g,
# which errs by 5 %; each squares the error, and the fourth leaves that of rounding
NEWTON = 4
STILL = 1e-30  # least w^2 h / g, so that a frequency of zero has a wave number of about zero


@njit
def wave_number(frequency: Any, depth: float) -> Any:
    """Return the wave number k of linear waves, from w^2 = g k tanh(k h).

    Args:
        frequency: Angular frequency w [rad/s], a number or an array (N,), at least 0.
        depth: Depth of the water h [m]; 0 for deep water, where k = w^2 / g.

    Returns:
        Wave number [rad/m], of the shape of `frequency`.
    """
    if depth <= 0.0:
        return frequency * frequency / GRAVITY
    x = np.maximum(frequency * frequency * depth / GRAVITY, STILL)
    kh = x / np.sqrt(np.tanh(x))
    for _ in range(NEWTON):
        t = np.tanh(kh)
        kh = kh - (kh * t - x) / (t + kh * (1.0 - t * t))
    return kh / depth


@njit(forceinline=True)
def pressure_attenuation(number: float, below: float, depth: float) -> float:
    """Return the dynamic pressure of a linear wave at a depth over that at the surface.

    It is cosh k (h - z) / cosh k h, and exp(-k z) in deep water.

    Args:
        number: Wave number k [rad/m].
        below: Depth z at which the pressure is taken, below the surface [m].
        depth: Depth of the water h [m]; 0 for deep water.
    """
    near = np.exp(-number * below)
    if depth <= 0.0:
        return near
    far = np.exp(-number * (2.0 * depth - below))
    return (near + far) / (1.0 + np.exp(-2.0 * number * depth))
