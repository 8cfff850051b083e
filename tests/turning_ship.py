"""A ship on a winding course with positions, heading, velocities and yaw rate, as a recording."""

import numpy as np

from boatsim.physics.base import Array
from boatsim.recordings.table import Recording

STEP = 0.5  # [s]
SPEED = 5.0  # [m/s]


def integral(t: Array, rate: Array) -> Array:
    """Integral (N,) by the trapezoidal rule."""
    return np.concatenate(([0.0], np.cumsum(0.5 * (rate[1:] + rate[:-1]) * np.diff(t))))


def winding_ship(
    seed: int = 0, count: int = 1200, noise: float = 1.0, step: float = STEP
) -> Recording:
    """A recording of a ship that swings to both sides.

    Args:
        seed: Of noise and course.
        count: Rows.
        noise: Noise of all sensors relative to usual instruments.
        step: Time between rows [s].
    """
    rng = np.random.default_rng(seed)
    t = step * np.arange(count)
    phase = rng.uniform(0.0, 6.0, 2)
    r = 0.035 * np.sin(0.05 * t + phase[0]) + 0.02 * np.sin(0.13 * t + phase[1])
    psi = 1.0 + integral(t, r)
    u = SPEED - 30.0 * np.abs(r)
    v = -8.0 * r
    x = integral(t, u * np.cos(psi) - v * np.sin(psi))
    y = integral(t, u * np.sin(psi) + v * np.cos(psi))
    sds = {"x_m": 0.3, "y_m": 0.3, "psi_rad": 2e-3, "u_mps": 0.02, "v_mps": 0.02, "r_radps": 5e-4}
    signals = {}
    for (name, sd), values in zip(sds.items(), (x, y, psi, u, v, r), strict=True):
        signals[name] = values + noise * sd * rng.standard_normal(count)
    return Recording("ship", t, signals)


def wandering_rate(t: Array, sd: float = 0.1, seed: int = 0) -> Array:
    """True seconds (N - 1,) per recorded second: an Ornstein-Uhlenbeck process about 1."""
    rng = np.random.default_rng(seed)
    rate = np.ones(len(t) - 1)
    decay = float(np.exp(-float(t[1] - t[0]) / 15.0))
    for k in range(1, len(rate)):
        kick = sd * np.sqrt(1.0 - decay**2) * rng.standard_normal()
        rate[k] = 1.0 + decay * (rate[k - 1] - 1.0) + kick
    return rate
