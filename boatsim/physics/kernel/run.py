"""Actuators, and simulations of many steps under given commands."""

from typing import Any

import numpy as np

from boatsim.physics.kernel.compiling import compiled, lean
from boatsim.physics.kernel.records import VesselNumbers, VesselState
from boatsim.physics.signals import Array

from .inertia import compute_mass_constants
from .laws import HAS_TIME_TO_DISCONTINUITY, HELD, advance_channels, time_to_discontinuity
from .motion import NQ, K, step_in_place

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
    """Advance all channels by one step.

    Fill act with the actuators at its begin, in its middle and at its end.
    """
    advance_channels(commands, memory, dt, p, on, act, np.int64(HELD))


@compiled
def settle_actuators(commands: Array, memory: Array, p: Array, on: Any, act: Array) -> None:
    """Let the actuators reach their commands, in place, by a few very long steps."""
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
    """Return the length of the next part of a step: up to a jump or bend, within [least, left]."""
    if HAS_TIME_TO_DISCONTINUITY:
        return min(left, max(time_to_discontinuity(commands, memory, p, on), least))
    return left


@lean
def minimum_substep(part: float, before: float, least: float) -> float:
    """Return the least length of the next part of a step, after `before` and `part`."""
    return GROWS * least if part <= least or part < before else SHORTEST


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
    """Simulate a vessel: row i of commands (N, C) is held for `substeps` steps of dt.

    States to out (N + 1, 2 NQ).

    Changes the arrays of `plant`.
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
                step_in_place(t, y, part, act, p, on, k, force)
                t, left = t + part, left - part
        out[i + 1] = y[: 2 * NQ]
