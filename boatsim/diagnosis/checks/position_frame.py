"""Check for positions that were rotated with the boat, a kinematic error of the recording.

The error arises if u and v are integrated in body axes and the sum is rotated by the heading,
instead of the velocity before integration. The rate of such positions is off by r (-Y, X), in
proportion to yaw rate and distance from the origin.
"""

from dataclasses import replace
from operator import itemgetter

import numpy as np

from boatsim.diagnosis.config import DEFAULT, ChecksConfig
from boatsim.recordings.table import Recording
from boatsim.recordings.units import cumulative_integral

NEEDED = ("x_m", "y_m", "psi_rad", "u_mps", "v_mps")


def drop_rotated_positions(
    recording: Recording, config: ChecksConfig = DEFAULT.checks
) -> Recording:
    """Return a recording without positions that were wrongly rotated with the heading.

    Args:
        recording: The recording; it is checked only if all poses and velocities are complete,
            because a sum of velocities has no meaning over gaps.
        config: Thresholds of the quality checks.

    Returns:
        The recording, without x_m and y_m and with a remark if they were rotated.
    """
    for name in NEEDED:
        if name not in recording.signals or np.isnan(recording[name]).any():
            return recording
    share, sd = position_rotation_fraction(recording)
    whole = abs(share - 1.0) < config.rotation_tolerance
    if not (whole and share > config.rotation_min_sds * sd):
        return recording
    remark = (
        f"{recording.origin}: x_m, y_m and u_mps, v_mps contradict each other in "
        f"proportion to yaw rate and distance from the origin (share {share:.2f}, sd {sd:.2g}). "
        "The positions were rotated with the heading and are not used"
    )
    signals = dict(recording.signals)
    del signals["x_m"], signals["y_m"]
    return replace(recording, signals=signals, remarks=(*recording.remarks, remark))


def position_rotation_fraction(recording: Recording) -> tuple[float, float]:
    """Estimate by how much recorded positions were wrongly rotated with the heading.

    The positions are modelled as (1 - k) integral R s' + k R s, where R is the rotation by the
    heading and s the integral of (u, v). Origin, current, lever of the antenna, scale of the
    velocities and offset of the compass are estimated together with k.

    Args:
        recording: A recording with complete poses and velocities.

    Returns:
        The estimate of k (0 for correct positions, 1 for rotated ones) and its standard deviation.
    """
    x, y, psi, u, v = itemgetter(*NEEDED)(recording.signals)
    t = recording.t - recording.t[0]
    c = np.cos(psi)
    s = np.sin(psi)
    one = np.ones_like(t)
    none = np.zeros_like(t)
    north = cumulative_integral(t, u * c - v * s)
    east = cumulative_integral(t, u * s + v * c)
    ahead = cumulative_integral(t, u)
    abeam = cumulative_integral(t, v)
    rotated = (c * ahead - s * abeam - north, s * ahead + c * abeam - east)
    regressors = [
        rotated,
        (one, none),
        (none, one),
        (t, none),
        (none, t),
        (c, s),
        (-s, c),
        (north, east),
        (-east, north),
    ]
    A = np.column_stack(list(map(np.concatenate, regressors)))
    e = np.concatenate([x - north, y - east])
    inverse = np.linalg.pinv(A.T @ A)
    estimate = inverse @ A.T @ e
    residual = e - A @ estimate
    variance = inverse[0, 0] * (residual @ residual) / (len(e) - A.shape[1])
    return float(estimate[0]), float(np.sqrt(variance))
