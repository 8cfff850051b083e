"""Largest recorded commands, which scale the thresholds of candidate effects.

A dead band, play or a stall shows only between zero and the largest command of a recording.
Starting points, priors and bounds that scale with the size of a hull would miss it on one with
stronger engines.
"""

from collections.abc import Sequence

import numpy as np

from boatsim.diagnosis.config import DEFAULT, LoadConfig
from boatsim.diagnosis.filter import MappedRecording
from boatsim.physics.base import ChannelEffect, CoefficientRelease, Effect
from boatsim.physics.vessel import Vessel


def largest_command(
    recordings: Sequence[MappedRecording], effect: Effect, config: LoadConfig = DEFAULT.load
) -> float:
    """Return the largest recorded command of the actuators on which a candidate effect acts.

    Args:
        recordings: Recordings mapped to programs of one vessel.
        effect: A candidate effect.
        config: Percentile that counts as the largest command.

    Returns:
        Size of the command in the unit of its channel; 0 where there is none.
    """
    vessel = recordings[0].program.vessel
    order = list(vessel.commands)
    columns = [order.index(name) for name in command_channels(vessel, effect) if name in order]
    if not columns:
        return 0.0
    sizes = np.concatenate([abs(mapped.commands[:, columns]) for mapped in recordings])
    return float(np.percentile(sizes, config.command_percentile))


def command_channels(vessel: Vessel, effect: Effect) -> tuple[str, ...]:
    """Return the names of the command channels on which a candidate effect acts.

    These are the actuators of a channel effect (such as a dead band), or the inputs of those
    effects of the vessel whose numbers the candidate changes. Of several inputs those in the unit
    of the candidate's thresholds are returned: the angle of a rudder and not its shaft.

    Args:
        vessel: Vessel of the recordings.
        effect: A candidate effect.
    """
    if isinstance(effect, ChannelEffect):
        return vessel.target_actuators(effect)
    if not isinstance(effect, CoefficientRelease):
        return ()
    kind = type(effect)
    units = {kind.params()[name].unit for name in kind.thresholds}
    channels = []
    for change in effect.changes(vessel):
        owner = vessel.effect(change.owner) if change.owner != "body" else None
        if owner is None:
            continue
        for role, name in vessel.bindings(owner).items():
            if isinstance(name, str) and type(owner).roles[role].unit in units:
                channels.append(name)
    return tuple(channels)


def manoeuvre_commands(vessel: Vessel) -> tuple[str, ...]:
    """Return the names of the commands that a manoeuvre sets on a vessel.

    A command that feeds an actuator, such as a PWM signal, replaces the actuator's own command.
    """
    fed = set()
    for effect in vessel.effects:
        for target in vessel.target_actuators(effect):
            if vessel.command_for_actuator(effect, target):
                fed.add(target)
    return tuple(name for name in vessel.commands if name not in fed)
