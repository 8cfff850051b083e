"""Steps of one vessel with a record of each of them, in compiled code."""

import numpy as np

from boatsim.physics.kernel.compiling import unlocked
from boatsim.physics.kernel.records import FleetArrays, StepRecord

from .laws import HAS_ADVANCE_MOTION_MEMORY, HAS_AIR_WRENCH, HELD, water_velocity
from .motion import (
    NQ,
    advance_memory_of_motion,
    air_body_force,
    pose_and_velocities,
    step_in_place,
    total_body_force,
)
from .run import ENOUGH, SHORTEST, advance_actuators, minimum_substep, substep_length


@unlocked
def record_steps(fleet: FleetArrays, dt: float, record: StepRecord) -> None:
    """Simulate the first vessel of a batch over the steps of its next period of constant commands.

    Each step of dt [s] is recorded in the next row of the record.
    """
    t, y, commands, memory, act, p, on, k, force = fleet
    last = np.int64(2 * HELD)  # the actuators at the end of a step
    done, ends, logged, states, mean, forces, air, water = record
    for j in range(done[0], ends[done[1]]):
        now, left, least, before = t[0], dt, SHORTEST, 0.0
        for i in range(mean.shape[1]):
            mean[j, i] = 0.0
        while left > ENOUGH:
            part = substep_length(commands[0], memory[0], left, least, p[0], on)
            least, before = minimum_substep(part, before, least), part
            advance_actuators(commands[0], memory[0], part, p[0], on, act[0])
            if HAS_ADVANCE_MOTION_MEMORY:
                advance_memory_of_motion(now, y[0], part, memory[0], act[0], p[0], on)
            step_in_place(now, y[0], part, act[0], p[0], on, k[0], force)
            for i in range(mean.shape[1]):
                middle = act[0, HELD + i]
                mean[j, i] += (act[0, i] + 4.0 * middle + act[0, 2 * HELD + i]) / 6.0 * (part / dt)
            now, left = now + part, left - part
        t[0] += dt
        states[j, 0] = t[0]
        motion = pose_and_velocities(y[0, : 2 * NQ])
        for i in range(len(motion)):
            states[j, 1 + i] = motion[i]
        if logged[j] != 0:
            found = total_body_force(t[0], y[0, : 2 * NQ], act[0], last, p[0], on)
            for i in range(NQ):
                forces[j, i] = found[i]
            if HAS_AIR_WRENCH:
                found = air_body_force(t[0], y[0, : 2 * NQ], act[0], last, p[0], on)
                for i in range(NQ):
                    air[j, i] = found[i]
            north, east = water_velocity(t[0], motion[0], motion[1], p[0], on, act[0], last)
            water[j, 0], water[j, 1] = north, east
    done[0] = ends[done[1]]
    done[1] += 1
