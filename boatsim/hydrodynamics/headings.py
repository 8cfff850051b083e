"""Headings of an excitation table brought to 0 to pi by the symmetry of the hull."""

from pathlib import Path

import numpy as np

from boatsim.errors import BadInput
from boatsim.physics.coefficients.wave_grid import MIRROR
from boatsim.physics.signals import Array

CLOSE = 1e-6  # [rad] between headings that are the same


def on_starboard_side(heading: Array, excitation: Array, path: Path) -> tuple[Array, Array]:
    """Return headings from 0 to pi, and the excitation of waves that run to them.

    Those to port are mirrored at the plane of symmetry of the hull, where the other side lacks
    them.

    Args:
        heading: Directions to which the waves run (H,), clockwise from x [rad].
        excitation: Complex excitation (N, H, 6).
        path: File, for messages.

    Raises:
        BadInput: There is no heading.
    """
    found: dict[float, Array] = {}
    mirrored: dict[float, Array] = {}
    for h, angle in enumerate(heading):
        turned = (angle + np.pi) % (2.0 * np.pi) - np.pi
        values = excitation[:, h]
        if abs(turned + np.pi) < CLOSE:
            turned = np.pi
        side, key = found, round(abs(turned), 6)
        if turned < -CLOSE:
            side, values = mirrored, values * MIRROR
        side.setdefault(key, values)
    found = mirrored | found
    if not found:
        raise BadInput(f"{path}: there is no excitation")
    angles = sorted(found)
    return np.array(angles), np.stack([found[angle] for angle in angles], axis=1)


def is_conjugate(heading: Array, excitation: Array) -> bool:
    """Return whether an excitation has the time factor exp(-i w t) instead of exp(i w t).

    In long waves the force in surge of following waves precedes the elevation by a quarter of a
    period: it is proportional to +i with exp(i w t).

    Args:
        heading: Directions to which the waves run (H,) [rad], 0 for following waves.
        excitation: Complex excitation (N, H, 6), lowest frequency first.
    """
    along = np.cos(heading)
    surge = excitation[0, :, 0].imag * along
    return bool(np.sum(surge) < 0.0)
