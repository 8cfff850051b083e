"""Unwrapping of measured directions, so that rows on both sides of a full turn can be averaged."""

from dataclasses import replace

import numpy as np

from boatsim.physics.vessel import Vessel
from boatsim.recordings.table import Recording


def unwrap_directions(recording: Recording, vessel: Vessel) -> Recording:
    """Return a recording whose measured directions, such as that of the wind, are unwrapped.

    They no longer jump by a full turn.

    Args:
        recording: The recording.
        vessel: The vessel, which lists its measured directions (`environment_angles`).
    """
    signals = dict(recording.signals)
    for name in vessel.environment_angles:
        if name in signals:
            signals[name] = np.unwrap(recording[name])
    return replace(recording, signals=signals)
