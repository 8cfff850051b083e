"""How the actuators stood when a recording began: settled to its first commands, or still as they are at rest.

A log often begins with the manoeuvre. A propeller that takes its time then spools up in the first rows, and were it
taken to run already, the boat would seem to change its speed more slowly than it does.
"""

from dataclasses import replace

import numpy as np

from boatsim.diagnosis.filter import MappedRecording, NoiseLevels
from boatsim.physics.commands import sent_row, taken

# [s] ahead of the first row: actuators settle to what was in force then, however long ago
BEFORE = 1.0
TOLD = 6.0  # [nats] by which the recording must be likelier with actuators that begin at rest
# of the largest speed recorded, which a boat that lies still is below when the recording begins
SLOW = 0.2


def begun(track: MappedRecording, levels: NoiseLevels) -> MappedRecording:
    """The track, its actuators at neutral before the first row where the boat lies still then and is likelier so."""
    vessel = track.program.vessel
    rest = track.orders[0].copy()
    commands = len(vessel.commands)
    rest[:commands] = taken(vessel, sent_row(vessel, {}))[:commands]
    if not commands or np.array_equal(rest, track.orders[0]):
        return track
    given, orders = np.append(track.times[0] - BEFORE, track.given), np.vstack([rest, track.orders])
    resting = replace(track, given=given, orders=orders)
    on = track.program.switches()
    settled, from_rest = (t.likelihood(t.values, on, levels) for t in (track, resting))
    return resting if from_rest > settled + TOLD and _lies_still(resting, levels) else track


def _lies_still(track: MappedRecording, levels: NoiseLevels) -> bool:
    """Whether the boat does when the recording begins: where it does not, a wrong vessel may ask for less thrust."""
    nq = track.program.module.NQ
    means, _ = track.smoothed(track.values, track.program.switches(), levels)
    energy = means[:, nq : 2 * nq] ** 2 @ track.inertia
    return bool(energy[0] <= SLOW**2 * energy.max())
