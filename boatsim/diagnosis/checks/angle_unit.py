"""Angles and turning rates in degrees."""

import numpy as np

from boatsim.diagnosis.checks.finding import Change, Finding
from boatsim.physics.vessel import Vessel
from boatsim.recordings import units
from boatsim.recordings.expression import UNITS
from boatsim.recordings.table import Recording

NAMES = {"psi_rad": "heading", "phi_rad": "roll", "r_radps": "yaw_rate", "p_radps": "roll_rate"}


def look(recording: Recording, _: Vessel) -> list[Finding]:
    """Headings, rolls and their rates whose size or steps are those of degrees."""
    found = []
    for name, row in units.in_degrees({"t_s": recording.t, **recording.signals}).items():
        values = recording[name]
        low, high = np.nanmin(values), np.nanmax(values)
        evidence = f"{name} goes from {low:.4g} to {high:.4g}, and by its steps it is degrees (row {row + 1})"
        at = float(recording.t[row])
        change = Change(name, name, UNITS["deg"])
        found.append(
            Finding(
                f"{NAMES[name]}_in_degrees",
                evidence,
                sure=0.99,
                spans=((at, at),),
                changes=(change,),
            )
        )
    return found
