"""What a vessel takes of what is sent to it: within each channel's range, neutral where nothing is sent.

All ways in end here: controllers, starts, environments, recordings, rows for the twin.
"""

from collections.abc import Mapping

import numpy as np

from boatsim.errors import BadInput
from boatsim.physics.base import Array
from boatsim.physics.vessel import Vessel

SLACK = 1e-6  # share of a channel's range by which rounding may pass its end


def sent_row(vessel: Vessel, given: Mapping[str, float]) -> Array:
    """(C,) as sent, in the vessel's order, neutral where not given. Raises BadInput for a name it does not take."""
    for name in given:
        if name not in vessel.commands:
            raise BadInput(vessel.no_command(name))
    return np.array([given.get(n, c.neutral) for n, c in vessel.commands.items()], dtype=float)


def taken_row(vessel: Vessel, given: Mapping[str, float]) -> Array:
    """(C,) commands that act when these are sent. Raises BadInput."""
    return taken(vessel, sent_row(vessel, given))


def taken_rows(vessel: Vessel, signals: Mapping[str, Array], count: int) -> Array:
    """(N, C) commands that act under the columns of a recording of `count` rows; other columns are passed over."""
    columns = [signals.get(n, np.full(count, c.neutral)) for n, c in vessel.commands.items()]
    return taken(vessel, np.column_stack(columns))


def taken(vessel: Vessel, sent: Array) -> Array:
    """Commands (..., C) that act when these are sent, in the vessel's order. Raises BadInput for one not finite."""
    channels = vessel.commands
    if not channels:
        return sent
    low, high = np.array([(c.low, c.high) for c in channels.values()]).T
    if not np.isfinite(sent).all():
        place = tuple(np.argwhere(~np.isfinite(sent))[0])
        name = list(channels)[place[-1]]
        raise BadInput(
            f"{vessel.name}: command {name} = {sent[place]:g}; "
            f"allowed {channels[name].low:g} to {channels[name].high:g}"
        )
    return np.asarray(np.clip(sent, low, high), dtype=float)


def beyond(vessel: Vessel, sent: Array) -> list[str]:
    """Channels of which more is sent (C,) than their range holds."""
    passed = np.abs(sent - taken(vessel, sent)).tolist()
    pairs = zip(vessel.commands.items(), passed, strict=True)
    return [n for (n, c), off in pairs if off > SLACK * (c.high - c.low)]
