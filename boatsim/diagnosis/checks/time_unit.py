"""Check for time stamps in milliseconds, microseconds or nanoseconds."""

import numpy as np

from boatsim.diagnosis.checks.finding import Change, Finding
from boatsim.diagnosis.config import ChecksConfig
from boatsim.diagnosis.priors import froude_time_scale
from boatsim.physics.vessel import Vessel
from boatsim.recordings.expression import UNITS
from boatsim.recordings.table import Recording

TIME_UNITS = ("ms", "us", "ns")


def check_time_unit(recording: Recording, vessel: Vessel, config: ChecksConfig) -> list[Finding]:
    """Find time stamps of a recording in milliseconds, microseconds or nanoseconds.

    Rows are then too far apart in seconds, but not in the smaller unit.

    Args:
        recording: The recording as written in the file.
        vessel: The vessel; its length scales the durations.
        config: Thresholds of the quality checks.

    Returns:
        At most one finding "time_unit".
    """
    steps = np.diff(recording.t[np.isfinite(recording.t)])
    forward = steps[steps > 0.0]
    if not len(forward):
        return []
    step = float(np.median(forward))
    if step < config.time_max_step * froude_time_scale(vessel):
        return []
    deviations = [abs(np.log(step * UNITS[u] / config.time_usual_step)) for u in TIME_UNITS]
    best = int(np.argmin(deviations))
    if deviations[best] > np.log(config.time_step_tolerance):
        return []
    unit = TIME_UNITS[best]
    evidence = (
        f"rows are {step:.6g} s apart, too far for a hull of {vessel.length:g} m. In {unit} they "
        f"are {step * UNITS[unit]:.4g} s apart"
    )
    changes = (Change("t_s", "t_s", UNITS[unit]),)
    return [Finding("time_unit", evidence, probability=config.probability_evident, changes=changes)]
