"""Extent of the tracks of recordings, which shows whether the boat may touch a fixed object."""

from collections.abc import Sequence

import numpy as np

from boatsim.diagnosis.config import DEFAULT, LoadConfig
from boatsim.physics.facts import TRACK
from boatsim.physics.vessel import Vessel
from boatsim.recordings.table import Recording

AXES = ("x_m", "y_m")


def small_track_fact(
    recordings: Sequence[Recording], vessel: Vessel, config: LoadConfig = DEFAULT.load
) -> dict[str, object]:
    """Return the fact `track_m` if the boat stays within a few of its lengths, else nothing.

    Args:
        recordings: Recordings of one diagnosis, with a common origin of positions.
        vessel: The vessel, whose length limits the extent.
        config: Largest extent in boat lengths.

    Returns:
        `track_m`: the middle of the tracks, north and east, and half their extent [m]. Empty if a
        recording has no position, or if the tracks extend farther.
    """
    middles, reaches = list[float](), list[float]()
    for axis in AXES:
        known = []
        for recording in recordings:
            values = recording.signals.get(axis, np.zeros(0))
            known.append(values[np.isfinite(values)])
        if not all(map(len, known)):
            return {}
        positions = np.concatenate(known)
        low, high = float(positions.min()), float(positions.max())
        if high - low > config.near_track_lengths * vessel.length:
            return {}
        middles.append(0.5 * (low + high))
        reaches.append(0.5 * (high - low))
    return {TRACK: [*middles, *reaches]}
