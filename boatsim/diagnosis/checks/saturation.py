"""Commands that are at their limits for long: what lies beyond can not be told."""

import math

import numpy as np

from boatsim.diagnosis.checks.finding import Finding
from boatsim.physics.vessel import Vessel
from boatsim.recordings.table import Recording

MUCH = 0.5  # of the rows
AT = 1e-3  # of the range, by which a command at its limit may miss it


def look(recording: Recording, vessel: Vessel) -> list[Finding]:
    """Channels that are at their upper or lower limit in most rows, the limit not being their rest."""
    found = []
    for name, c in vessel.commands.items():
        if name not in recording.signals or not math.isfinite(c.high - c.low):
            continue
        for limit in (c.low, c.high):
            at = np.abs(recording[name] - limit) <= AT * (c.high - c.low)
            if at.mean() > MUCH and limit != c.neutral:
                evidence = (
                    f"{name} is at its limit {limit:g} in {100.0 * at.mean():.0f} % of the rows"
                )
                remedy = "its gain and a law that bends it can not be told apart; record smaller commands too"
                found.append(Finding("saturated", evidence, "limit", remedy=remedy))
    return found
