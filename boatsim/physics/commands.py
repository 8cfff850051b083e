"""The commands that a vessel accepts, limited to the ranges of its channels.

Controllers, starts, environments, recordings and simulations all use these functions.
"""

from collections.abc import Mapping

import numpy as np

from boatsim.errors import BadInput
from boatsim.physics.base import Array
from boatsim.physics.vessel import Vessel

SLACK = 1e-6  # share of a channel's range by which rounding may exceed it


def input_vector(vessel: Vessel, given: Mapping[str, float]) -> Array:
    """Return an array (inputs,) of all inputs of a vessel, with commands given by name.

    Values are not limited to the allowed ranges. Inputs are the commands in the vessel's order,
    then the measured quantities of the environment.

    Args:
        vessel: The vessel.
        given: Commands by name. Other commands and measured quantities have their neutral values.

    Raises:
        BadInput: The vessel has no such command.
    """
    for name in given:
        if name not in vessel.commands:
            raise BadInput(vessel.unknown_command_message(name))
    sent = [given.get(name, channel.neutral) for name, channel in vessel.commands.items()]
    sent += [measured.neutral for measured in vessel.measured.values()]
    return np.array(sent, dtype=float)


def clipped_commands(vessel: Vessel, given: Mapping[str, float]) -> Array:
    """Return an array (inputs,) of all inputs of a vessel, commands limited to their ranges.

    Args:
        vessel: The vessel.
        given: Commands by name; the others are neutral.

    Raises:
        BadInput: The vessel has no such command, or a value is not finite.
    """
    return clip_to_channel_ranges(vessel, input_vector(vessel, given))


def clipped_recorded_commands(vessel: Vessel, signals: Mapping[str, Array], count: int) -> Array:
    """Return the inputs (N, inputs) of a vessel in each row of a recording.

    They are limited to the allowed ranges of their channels. Directions of drives that can turn
    all round keep their whole turns.

    Args:
        vessel: The vessel.
        signals: Columns (N,) of the recording by name; an input without a column is neutral, other
            columns are ignored.
        count: Number of rows N.

    Raises:
        BadInput: A value is not finite.
    """
    columns = []
    for name, neutral in zip(vessel.inputs, input_vector(vessel, {}).tolist(), strict=True):
        columns.append(signals.get(name, np.full(count, neutral)))
    return _clip_to_limits(vessel, np.column_stack(columns), vessel.recorded_limits())


def clip_to_channel_ranges(vessel: Vessel, sent: Array) -> Array:
    """Return inputs of a vessel, each limited to the allowed range of its channel.

    Args:
        vessel: The vessel.
        sent: Inputs (..., inputs) in the vessel's order.

    Raises:
        BadInput: A value is not finite.
    """
    return _clip_to_limits(vessel, sent, vessel.limits())


def _clip_to_limits(
    vessel: Vessel, sent: Array, limits: Mapping[str, tuple[float, float]]
) -> Array:
    if not limits:
        return sent
    low, high = np.array(list(limits.values())).T
    if not np.isfinite(sent).all():
        place = tuple(np.argwhere(~np.isfinite(sent))[0])
        name = list(limits)[place[-1]]
        what = "command" if name in vessel.commands else "measured"
        least, most = limits[name]
        raise BadInput(
            f"{vessel.name}: {what} {name} = {sent[place]:g}; allowed {least:g} to {most:g}"
        )
    return np.asarray(np.clip(sent, low, high), dtype=float)


def saturated_channels(vessel: Vessel, sent: Array) -> list[str]:
    """Return the names of the channels whose command exceeds its allowed range.

    Args:
        vessel: The vessel.
        sent: Inputs (inputs,) in the vessel's order.
    """
    excess = np.abs(sent - clip_to_channel_ranges(vessel, sent)).tolist()
    # measured inputs follow the commands and have no range
    pairs = zip(vessel.commands.items(), excess, strict=False)
    return [name for (name, c), off in pairs if off > SLACK * (c.high - c.low)]
