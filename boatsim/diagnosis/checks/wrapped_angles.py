"""Unwrapping of directions of wind and drives, so that rows across a full turn can be averaged."""

from dataclasses import replace

import numpy as np

from boatsim.physics.vessel import Vessel
from boatsim.recordings.notes import unit_of
from boatsim.recordings.table import Recording


def unwrap_directions(recording: Recording, vessel: Vessel) -> Recording:
    """Return a recording whose directions, such as that of the wind or a drive, are unwrapped.

    They no longer jump by a full turn. A jump by more than half a turn becomes the shorter way
    round, which is the way that a drive takes if it can turn all round.

    Args:
        recording: The recording.
        vessel: The vessel, which lists the directions of its drives (`full_turns`). Its measured
            quantities in rad are directions.
    """
    signals = dict(recording.signals)
    directions = [name for name in vessel.measured if unit_of(name) == "rad"]
    for name in dict.fromkeys((*vessel.environment_angles, *directions, *vessel.full_turns)):
        if name in signals:
            signals[name] = np.unwrap(recording[name])
    return replace(recording, signals=signals)
