"""Arrays in which compiled code records steps of a vessel."""

import numpy as np

from boatsim.physics.kernel.records import StepRecord
from boatsim.physics.program import Program
from boatsim.physics.signals import MeasuredMotion

STATE_SIZE = 1 + len(MeasuredMotion._fields)  # time and motion


def make_step_record(program: Program, steps: int, periods: int) -> StepRecord:
    """Return a record of steps of a vessel, with arrays that are not filled yet.

    Args:
        program: The vessel's program.
        steps: Number of steps.
        periods: Number of periods into which they are divided.
    """
    forces = (steps, program.module.NQ)
    return StepRecord(
        done=np.zeros(2, dtype=np.int64),
        ends=np.zeros(periods, dtype=np.int64),
        logged=np.zeros(steps, dtype=np.int64),
        states=np.empty((steps, STATE_SIZE)),
        mean=np.empty((steps, len(program.vessel.actuators))),
        force=np.empty(forces),
        air=np.empty(forces),
        water=np.empty((steps, 2)),
    )
