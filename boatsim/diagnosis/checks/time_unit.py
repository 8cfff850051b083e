"""Time stamps in milli-, micro- or nanoseconds: rows lie so far apart that no boat could be followed."""

import numpy as np

from boatsim.diagnosis.checks.finding import Change, Finding
from boatsim.diagnosis.priors import froude_time
from boatsim.physics.vessel import Vessel
from boatsim.recordings.expression import UNITS
from boatsim.recordings.table import Recording

TOO_LONG = 5.0  # [s] between rows on a boat of 1.2 m, in which it sails four lengths
USUAL = 0.1  # [s] between rows of a log, usually, and how far from it one may be, as a factor
FAR = 100.0


def look(recording: Recording, vessel: Vessel) -> list[Finding]:
    """Whether the rows lie as far apart as no log's do, and in another unit lie as those of a log."""
    steps = np.diff(recording.t[np.isfinite(recording.t)])
    forward = steps[steps > 0.0]
    if not len(forward) or (step := float(np.median(forward))) < TOO_LONG * froude_time(vessel):
        return []
    near = {unit: abs(np.log(step * UNITS[unit] / USUAL)) for unit in ("ms", "us", "ns")}
    unit = min(near, key=lambda u: near[u])
    if near[unit] > np.log(FAR):
        return []
    evidence = (
        f"rows lie {step:.6g} s apart, too far to follow a hull of {vessel.length:g} m; in {unit} that is "
        f"{step * UNITS[unit]:.4g} s"
    )
    return [Finding("time_unit", evidence, sure=0.99, changes=(Change("t_s", "t_s", UNITS[unit]),))]
