"""Check for commands that stay at their limits, so that their gain cannot be identified."""

import math

import numpy as np

from boatsim.diagnosis.checks.finding import Finding
from boatsim.diagnosis.config import ChecksConfig
from boatsim.physics.vessel import Vessel
from boatsim.recordings.table import Recording


def check_saturation(recording: Recording, vessel: Vessel, config: ChecksConfig) -> list[Finding]:
    """Find commands of a recording that are at a limit in most rows.

    Their gain cannot be identified. Limits that are the neutral value of the command do not count.

    Args:
        recording: A prepared recording.
        vessel: The vessel with its command limits.
        config: Thresholds of the quality checks.

    Returns:
        Findings "saturated" of kind "limit".
    """
    found = []
    for name, command in vessel.commands.items():
        span = command.high - command.low
        if name not in recording.signals or not math.isfinite(span):
            continue
        for limit in (command.low, command.high):
            at_limit = np.abs(recording[name] - limit) <= config.saturation_tolerance * span
            share = at_limit.mean()
            if share > config.saturation_min_share and limit != command.neutral:
                found.append(
                    Finding(
                        "saturated",
                        f"{name} is at its limit {limit:g} in {100.0 * share:.0f} % of the rows",
                        "limit",
                        remedy="its gain and its nonlinearity cannot be distinguished; "
                        "record smaller commands too",
                    )
                )
    return found
