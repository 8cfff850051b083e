"""Range of the channels of a vessel, widened to that of the commands in recordings."""

from collections.abc import Iterable
from dataclasses import replace

import numpy as np

from boatsim.physics.vessel import Vessel
from boatsim.recordings.table import Recording


def widen_channel_ranges(vessel: Vessel, recordings: Iterable[Recording]) -> Vessel:
    """Return a vessel whose channels have at least the range of the commands in recordings.

    A reader of recordings has refused commands that are too large to be of the channel's unit.

    Args:
        vessel: The vessel.
        recordings: Recordings of it.
    """
    commands = dict(vessel.commands)
    for recording in recordings:
        for name in commands.keys() & recording.signals.keys():
            command = commands[name]
            low = min(command.low, float(np.nanmin(recording[name])))
            high = max(command.high, float(np.nanmax(recording[name])))
            if (low, high) != (command.low, command.high):
                commands[name] = command.model_copy(update={"low": low, "high": high})
    if commands == dict(vessel.commands):
        return vessel
    return replace(vessel, commands=commands)
