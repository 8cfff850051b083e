"""State of the actuators when a recording begins: settled to the first commands, or at rest.

A log often begins with the manoeuvre. A propeller with a time constant then speeds up during the
first rows. If it were assumed to have settled, the vessel would seem to respond more slowly.
"""

from dataclasses import replace

import numpy as np

from boatsim.diagnosis.config import DEFAULT, ChecksConfig
from boatsim.diagnosis.filter import MappedRecording, NoiseLevels
from boatsim.physics.commands import clip_to_channel_ranges, input_vector

# [s] before the first row; the value has no effect, because actuators settle to earlier commands
COMMAND_LEAD = 1.0


def infer_initial_actuator_state(
    recording: MappedRecording, levels: NoiseLevels, config: ChecksConfig = DEFAULT.checks
) -> MappedRecording:
    """Return a mapped recording whose actuators start at rest, if the data show that.

    Otherwise the actuators start settled to the first commands.

    Args:
        recording: The recording mapped to its vessel.
        levels: Noise levels.
        config: Thresholds of the quality checks.

    Returns:
        The recording with neutral commands before the first row, if the vessel lies still then and
        the recording is more likely with them. Otherwise the recording itself.
    """
    vessel = recording.program.vessel
    neutral = recording.command_values[0].copy()
    commands = len(vessel.commands)
    neutral[:commands] = clip_to_channel_ranges(vessel, input_vector(vessel, {}))[:commands]
    if not commands or np.array_equal(neutral, recording.command_values[0]):
        return recording
    resting = replace(
        recording,
        command_times=np.append(recording.times[0] - COMMAND_LEAD, recording.command_times),
        command_values=np.vstack([neutral, recording.command_values]),
    )
    on = recording.program.effect_switches()
    settled = recording.log_likelihood(recording.values, on, levels)
    from_rest = resting.log_likelihood(resting.values, on, levels)
    likelier = from_rest > settled + config.initial_rest_gain
    if likelier and _lies_still(resting, levels, config):
        return resting
    return recording


def _lies_still(recording: MappedRecording, levels: NoiseLevels, config: ChecksConfig) -> bool:
    """Whether the vessel is at rest in the first row.

    If it moves, a wrong model of it may make less thrust more likely.
    """
    nq = recording.program.module.NQ
    on = recording.program.effect_switches()
    means = recording.smooth(recording.values, on, levels).means
    energy = means[:, nq : 2 * nq] ** 2 @ recording.inertia_with_added_mass
    return bool(energy[0] <= config.initial_rest_speed**2 * energy.max())
