"""Positions that were turned with the boat: a kinematic error of a recording, to be found before forces are blamed.

Integrating u and v in body axes and turning the sum by the heading, instead of turning the velocity and integrating,
gives positions whose rate is off by r (-Y, X): in proportion to yaw rate and distance from the origin.
"""

from dataclasses import replace

import numpy as np

from boatsim.physics.base import Array
from boatsim.recordings.table import Recording

NEEDED = ("x_m", "y_m", "psi_rad", "u_mps", "v_mps")
SURE = 10.0  # standard deviations by which the turned share must differ from none
# by which it may miss 1: honest positions give a share near 0, noise of the heading lowers the
# other
WHOLE = 0.5


def in_one_frame(recording: Recording) -> Recording:
    """The recording without positions that contradict its velocities in this way; a remark says so."""
    if any(name not in recording.signals or np.isnan(recording[name]).any() for name in NEEDED):
        return recording  # a position is no sum of velocities over rows that lack some
    share, sd = turned_share(recording)
    if not (abs(share - 1.0) < WHOLE and share > SURE * sd):
        return recording
    remark = (
        f"{recording.path or recording.name}: x_m, y_m and u_mps, v_mps contradict each other in proportion to yaw "
        f"rate and distance from the origin (share {share:.2f}, sd {sd:.2g}): the positions were turned with the "
        "heading; they are not used"
    )
    signals = {k: v for k, v in recording.signals.items() if k not in ("x_m", "y_m")}
    return replace(recording, signals=signals, remarks=(*recording.remarks, remark))


def turned_share(recording: Recording) -> tuple[float, float]:
    """Share k of R s in a position that is made of (1 - k) integral R s' and k R s, with its standard deviation.

    R turns by the heading, s is the integral of (u, v): 0 for honest positions, 1 for turned ones. Origin, current,
    lever of the antenna, scale of the velocities and offset of the compass are left free beside it.
    """
    x, y, psi, u, v = (recording[name] for name in NEEDED)
    t, c, s = recording.t - recording.t[0], np.cos(psi), np.sin(psi)
    one, none = np.ones_like(t), np.zeros_like(t)
    north, east = _integral(t, u * c - v * s), _integral(t, u * s + v * c)
    ahead, abeam = _integral(t, u), _integral(t, v)
    turned = (c * ahead - s * abeam - north, s * ahead + c * abeam - east)
    free = [
        (one, none),
        (none, one),
        (t, none),
        (none, t),
        (c, s),
        (-s, c),
        (north, east),
        (-east, north),
    ]
    A = np.column_stack([np.concatenate(pair) for pair in (turned, *free)])
    e = np.concatenate([x - north, y - east])
    inverse = np.linalg.pinv(A.T @ A)
    found = inverse @ A.T @ e
    left = e - A @ found
    return float(found[0]), float(np.sqrt(inverse[0, 0] * (left @ left) / (len(e) - A.shape[1])))


def _integral(t: Array, rate: Array) -> Array:
    """(N,) trapezoid rule from the first row on."""
    return np.concatenate(([0.0], np.cumsum(0.5 * (rate[1:] + rate[:-1]) * np.diff(t))))
