"""Readings of a direction that go round: 6.2 and then 0.1 rad is a small step, and the mean of the two is not 3.1."""

from dataclasses import replace

import numpy as np

from boatsim.physics.vessel import Vessel
from boatsim.recordings.table import Recording


def unwound(recording: Recording, vessel: Vessel) -> Recording:
    """The recording with measured directions that never jump by a turn, so that rows may be averaged."""
    there = [n for n in vessel.reading_angles if n in recording.signals]
    return replace(
        recording, signals=recording.signals | {n: np.unwrap(recording[n]) for n in there}
    )
