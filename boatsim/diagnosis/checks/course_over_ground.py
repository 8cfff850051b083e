"""Heading offset from the course over ground, on straight stretches ahead.

No model of the vessel is needed. In a turn the hull drifts outward. Going astern, the course is
opposite to the heading. A current sets the boat in one direction of the earth frame, whatever its
heading. An angle between heading and course that stays the same on straight stretches ahead and on
all headings is therefore an offset of the compass.
"""

from collections.abc import Sequence

import numpy as np

from boatsim.diagnosis.config import DEFAULT, ChecksConfig
from boatsim.diagnosis.priors import froude_time_scale
from boatsim.physics.base import Array
from boatsim.physics.vessel import Vessel
from boatsim.recordings.notes import unit_of
from boatsim.recordings.table import Recording


def heading_offset(
    recordings: Sequence[Recording], vessel: Vessel, config: ChecksConfig = DEFAULT.checks
) -> float | None:
    """Estimate the constant offset between the recorded heading and the course through the water.

    A boat whose heading is off by an angle a, in a current c, moves across its course by the
    current only: cos a Im q - sin a Re q = Im(c e^-i(psi + a)) dt, where q is the displacement over
    dt in the frame of the recorded heading. This holds at any speed. Straight stretches ahead are
    used.

    Args:
        recordings: Recordings with positions and headings.
        vessel: The vessel; its length scales the durations.
        config: Thresholds of the quality checks.

    Returns:
        Angle [rad] from the bow to the course, positive to starboard; None if the recordings do
        not determine it.
    """
    displacements = []
    headings = []
    for recording in recordings:
        moved, heading = _straight_stretches(recording, vessel, config)
        displacements.append(moved)
        headings.append(heading)
    displacement = np.concatenate(displacements)
    psi = np.concatenate(headings)
    if len(displacement) < config.course_min_stretches:
        return None
    across = np.column_stack([displacement.imag, -displacement.real])
    current = np.column_stack([np.cos(psi), np.sin(psi)])
    without_current = across - current @ np.linalg.pinv(current, rcond=1e-6) @ across
    sizes, axes = np.linalg.eigh(without_current.T @ without_current)
    squared_way = float(np.sum(np.abs(displacement) ** 2))
    if sizes[1] < config.course_min_variation * squared_way:
        return None
    if sizes[0] > config.course_max_residual * sizes[1]:
        return None
    c, s = axes[:, 0]
    ahead = np.sign(np.sum(displacement.real * c + displacement.imag * s))
    return float(np.arctan2(ahead * s, ahead * c))


def _straight_stretches(
    recording: Recording, vessel: Vessel, config: ChecksConfig
) -> tuple[Array, Array]:
    """Displacements (K,) over a Froude time, complex in the frame of the heading, and headings.

    Only fast, straight stretches ahead are returned.
    """
    t = recording.t
    known = np.isfinite(recording["psi_rad"])
    fixed = np.isfinite(recording["x_m"]) & np.isfinite(recording["y_m"])
    if not known.any() or fixed.sum() < config.course_min_stretches:
        return np.empty(0, dtype=complex), np.empty(0)
    at = t[fixed]
    z = recording["x_m"][fixed] + 1j * recording["y_m"][fixed]
    psi = np.interp(at, t[known], np.unwrap(recording["psi_rad"][known]))
    thrust = np.interp(at, t, _thrust_ahead(recording, vessel))
    duration = config.course_window * froude_time_scale(vessel)
    after = np.searchsorted(at, at + duration).clip(max=len(at) - 1)
    before = np.searchsorted(at, at - duration)
    way = z[after] - z
    turned_after = np.abs(psi[after] - psi)
    turned_before = np.abs(psi - psi[before])
    straight = np.maximum(turned_after, turned_before) < config.course_max_turn
    ahead = (thrust > 0.0) & (thrust[after] > 0.0) & (thrust[before] > 0.0)
    usual = np.quantile(np.abs(way), config.course_speed_quantile)
    fast = np.abs(way) > config.course_min_speed * usual
    least = config.course_min_window * duration
    complete = (at[after] - at >= least) & (np.arange(len(at)) > before)
    kept = straight & ahead & fast & complete
    middle = 0.5 * (psi + psi[after])
    return (way * np.exp(-1j * middle))[kept], middle[kept]


def _thrust_ahead(recording: Recording, vessel: Vessel) -> Array:
    """(N,) sum of the thrust commands, in shares of full command; ones without any command."""
    total = np.zeros(len(recording))
    thrusts = 0
    for name, command in vessel.commands.items():
        if unit_of(name) != "rad" and name in recording.signals:
            total += (recording[name] - command.neutral) / max(abs(command.low), abs(command.high))
            thrusts += 1
    return total if thrusts else np.ones(len(recording))
