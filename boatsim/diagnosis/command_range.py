"""How far the recorded commands go: what the thresholds of a threshold law are measured by.

A dead band, play or a stall shows only between nothing and the largest command that was given; starts, spreads and
bounds that go with the size of a boat miss it on one with stronger engines.
"""

from collections.abc import Sequence

import numpy as np

from boatsim.diagnosis.filter import MappedRecording
from boatsim.physics.base import Channel, Effect, Release
from boatsim.physics.vessel import Vessel

LARGEST = 98.0  # percentile of the size of a command: a stray row does not count


def excursion(tracks: Sequence[MappedRecording], effect: Effect) -> float:
    """Largest recorded command of what an entry acts on, in that channel's unit; 0 where there is none."""
    vessel = tracks[0].program.vessel
    order = list(vessel.commands)
    columns = [order.index(n) for n in bound(vessel, effect) if n in order]
    sizes = [abs(t.commands[:, columns]) for t in tracks] if columns else []
    return float(np.percentile(np.concatenate(sizes), LARGEST)) if sizes else 0.0


def bound(vessel: Vessel, effect: Effect) -> tuple[str, ...]:
    """Channels on which an entry acts: an actuator's, or those of the vessel's effect whose numbers it releases.

    Of several that such an effect takes, those in the unit of the entry's thresholds: a rudder's angle, not its shaft.
    """
    if isinstance(effect, Channel):
        return vessel.targets(effect)
    if not isinstance(effect, Release):
        return ()
    units = {type(effect).params()[n].unit for n in type(effect).thresholds}
    owners = (vessel.effect(c.owner) for c in effect.changes(vessel) if c.owner != "body")
    signals = (
        (type(owner).roles[role], n)
        for owner in owners
        if owner
        for role, n in vessel.bindings(owner).items()
    )
    return tuple(n for role, n in signals if isinstance(n, str) and role.unit in units)
