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
    """(C,) as sent, in the order of the vessel's inputs, neutral where not given, in surroundings as it has them.

    Raises BadInput for a command it does not take.
    """
    for name in given:
        if name not in vessel.commands:
            raise BadInput(vessel.unknown_command(name))
    sent = [given.get(n, c.neutral) for n, c in vessel.commands.items()]
    return np.array([*sent, *(m.neutral for m in vessel.measured.values())], dtype=float)


def taken_row(vessel: Vessel, given: Mapping[str, float]) -> Array:
    """(C,) commands that act when these are sent. Raises BadInput."""
    return taken(vessel, sent_row(vessel, given))


def taken_rows(vessel: Vessel, signals: Mapping[str, Array], count: int) -> Array:
    """(N, C) inputs that act under the columns of a recording of `count` rows; other columns are passed over."""
    neutral = zip(vessel.inputs, sent_row(vessel, {}).tolist(), strict=True)
    return taken(vessel, np.column_stack([signals.get(n, np.full(count, x)) for n, x in neutral]))


def taken(vessel: Vessel, sent: Array) -> Array:
    """Inputs (..., C) that act when these are sent, in the vessel's order. Raises BadInput for one not finite."""
    limits = vessel.limits()
    if not limits:
        return sent
    low, high = np.array(list(limits.values())).T
    if not np.isfinite(sent).all():
        place = tuple(np.argwhere(~np.isfinite(sent))[0])
        name = list(limits)[place[-1]]
        what = "command" if name in vessel.commands else "measured"
        raise BadInput(
            f"{vessel.name}: {what} {name} = {sent[place]:g}; allowed {limits[name][0]:g} to {limits[name][1]:g}"
        )
    return np.asarray(np.clip(sent, low, high), dtype=float)


def beyond(vessel: Vessel, sent: Array) -> list[str]:
    """Channels of which more is sent (C,) than their range holds."""
    passed = np.abs(sent - taken(vessel, sent)).tolist()
    pairs = zip(
        vessel.commands.items(), passed, strict=False
    )  # what is measured comes behind and has no range
    return [n for (n, c), off in pairs if off > SLACK * (c.high - c.low)]
