"""Actuators, and simulations of many steps under given commands."""

from typing import Any

import numpy as np

from boatsim.physics.kernel.compiling import compiled, lean
from boatsim.physics.kernel.records import VesselNumbers, VesselState
from boatsim.physics.signals import Array

from .inertia import compute_mass_constants
from .laws import (
    HAS_ADVANCE_MOTION_MEMORY,
    HAS_TIME_TO_DISCONTINUITY,
    HELD,
    MEMORY,
    advance_channels,
    time_to_discontinuity,
)
from .motion import NQ, K, advance_memory_of_motion, step_in_place, total_body_force

# [s] Shortest part of a step; within one, a signal that jumps is replaced by its mean.
SHORTEST = 1e-6
# Factor by which the shortest part grows where the parts of a step only become shorter: the parts
# of a ramp behind a first-order lag would become shorter without end.
GROWS = 8.0
LONG = 1e4  # [s] longer than any actuator needs to reach its command
ENOUGH = 1e-9  # [s] a remainder of a step that is neglected


@lean
def advance_actuators(
    commands: Array, memory: Array, dt: float, p: Array, on: Any, act: Array
) -> None:
    """Advance all actuators of a vessel by one step of dt [s] under constant commands.

    Fills act with their values at the begin, in the middle and at the end of the step.
    """
    advance_channels(commands, memory, dt, p, on, act, np.int64(HELD))


@compiled
def settle_actuators(commands: Array, memory: Array, p: Array, on: Any, act: Array) -> None:
    """Set all actuators of a vessel to the steady state under the commands, in place.

    A few very long steps are simulated.
    """
    for i in range(3 * HELD):
        act[i] = 0.0
    for _ in range(3):
        advance_actuators(commands, memory, LONG, p, on, act)
    for i in range(HELD):
        act[i] = act[HELD + i] = act[2 * HELD + i]


@lean
def substep_length(
    commands: Array, memory: Array, left: float, least: float, p: Array, on: Any
) -> float:
    """Return the length of the next part of an integration step.

    The part ends where an actuator's signal jumps or bends, and lies within [least, left], where
    `left` is the remainder of the step.
    """
    if HAS_TIME_TO_DISCONTINUITY:
        return min(left, max(time_to_discontinuity(commands, memory, p, on), least))
    return left


@lean
def minimum_substep(part: float, before: float, least: float) -> float:
    """Return the lower limit for the length of the next part of an integration step.

    It grows where the parts become ever shorter, from a part of length `before` to `part`.
    """
    return GROWS * least if part <= least or part < before else SHORTEST


@compiled
def mean_actuator_signals(
    first: Array, commands: Array, steps: Array, p: Array, on: Any, out: Array
) -> None:
    """Simulate all actuators of a vessel along the rows of a recording.

    They begin settled to the commands `first`. Row i of `commands` (N, C) acts for a time steps[i].
    Fills out (N, HELD) with the mean signals over these times.
    """
    act, memory = np.zeros(3 * HELD), np.zeros(MEMORY)
    settle_actuators(first, memory, p, on, act)
    for i in range(len(steps)):
        advance_actuators(commands[i], memory, steps[i], p, on, act)
        for j in range(HELD):
            out[i, j] = (act[j] + 4.0 * act[HELD + j] + act[2 * HELD + j]) / 6.0


@compiled
def total_body_forces(states: Array, held: Array, p: Array, on: Any, out: Array) -> None:
    """Compute the body forces of all effects at each of several states (N, 2 NQ).

    `held` (N, HELD) are the actuator signals there. Fills out (N, NQ).
    """
    for i in range(len(states)):
        force = total_body_force(0.0, states[i], held[i], np.int64(0), p, on)
        for j in range(NQ):
            out[i, j] = force[j]


@compiled
def rollout(
    model: VesselNumbers,
    plant: VesselState,
    commands: Array,
    t0: float,
    dt: float,
    substeps: int,
    out: Array,
) -> None:
    """Simulate a vessel under given commands: row i of (N, C) acts for `substeps` steps of dt.

    Fills out (N + 1, 2 NQ) with the states and changes the arrays of `plant`.
    """
    body, p, on = model
    y, memory, act, force = plant
    k = np.zeros(K)
    for i in range(3 * HELD):
        act[i] = 0.0
    compute_mass_constants(body, p, on, k)
    out[0] = y
    for i in range(commands.shape[0]):
        for j in range(substeps):
            t, left, least, before = t0 + (i * substeps + j) * dt, dt, SHORTEST, 0.0
            while left > ENOUGH:
                part = substep_length(commands[i], memory, left, least, p, on)
                least, before = minimum_substep(part, before, least), part
                advance_actuators(commands[i], memory, part, p, on, act)
                if HAS_ADVANCE_MOTION_MEMORY:
                    advance_memory_of_motion(t, y, part, memory, act, p, on)
                step_in_place(t, y, part, act, p, on, k, force)
                t, left = t + part, left - part
        out[i + 1] = y[: 2 * NQ]
