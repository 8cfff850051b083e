"""A recording in which nothing was measured, for tests of what needs no data."""

import numpy as np

from boatsim.diagnosis.filter import MappedRecording
from boatsim.physics.program import Program


def unmeasured(program: Program, rows: int = 5) -> MappedRecording:
    """Return a recording of a vessel program with a heading that is empty in all rows."""
    return MappedRecording(
        "made_up",
        program,
        0.1 * np.arange(rows),
        np.full((rows, 1), np.nan),
        ("heading_sd_rad",),
        ("psi_rad",),
        np.array([2]),
        np.zeros((rows, len(program.vessel.commands))),
        np.append(program.values(), program.body),
        {"heading_sd_rad": 1.0},
    )
