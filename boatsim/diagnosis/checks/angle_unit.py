"""Check for angles and angular rates that are recorded in degrees."""

import numpy as np

from boatsim.diagnosis.checks.finding import Change, Finding
from boatsim.diagnosis.config import ChecksConfig
from boatsim.physics.vessel import Vessel
from boatsim.recordings import units
from boatsim.recordings.expression import UNITS
from boatsim.recordings.table import Recording

QUANTITIES = {
    "psi_rad": "heading",
    "phi_rad": "roll",
    "r_radps": "yaw_rate",
    "p_radps": "roll_rate",
}


def check_angle_unit(recording: Recording, vessel: Vessel, config: ChecksConfig) -> list[Finding]:
    """Find angles and angular rates of a recording that are in degrees instead of radians.

    A column is in degrees if its size or its steps are impossible in radians.

    Args:
        recording: The recording as written in the file.
        vessel: The vessel, which may turn over.
        config: Thresholds of the quality checks.

    Returns:
        One finding per column in degrees.
    """
    columns = {"t_s": recording.t, **recording.signals}
    found = []
    degrees = units.find_columns_in_degrees(columns, vessel.turns_over)
    for name, row in degrees.items():
        low = np.nanmin(recording[name])
        high = np.nanmax(recording[name])
        time = float(recording.t[row])
        found.append(
            Finding(
                f"{QUANTITIES[name]}_in_degrees",
                f"{name} ranges from {low:.4g} to {high:.4g}. Its steps are those of degrees, "
                f"first in row {row + 1}",
                probability=config.probability_evident,
                spans=((time, time),),
                changes=(Change(name, name, UNITS["deg"]),),
            )
        )
    return found
