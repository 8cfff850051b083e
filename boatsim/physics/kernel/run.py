"""Actuators, and runs of many steps under given commands."""

from typing import Any

import numpy as np

from boatsim.physics.kernel.compiling import compiled, lean
from boatsim.physics.signals import Array

from .inertia import constants
from .laws import HAS_PAUSE, HELD, actuate, pause
from .motion import NQ, K, step_in_place

SHORTEST = 1e-6  # [s] of a step; within one, a signal that jumps counts with its mean
# by which parts of a step that only ever shrink may be shorter less: a ramp behind a lag ends
# without end
GROWS = 8.0
LONG = 1e4  # [s] longer than any actuator takes
ENOUGH = 1e-9  # [s] a step is done


@lean
def actuate_in_place(
    commands: Array, memory: Array, dt: float, p: Array, on: Any, act: Array
) -> None:
    """One step of all channels: act holds the actuators at its begin, in its middle and at its end."""
    actuate(commands, memory, dt, p, on, act, np.int64(HELD))


@compiled
def settle(commands: Array, memory: Array, p: Array, on: Any, act: Array) -> None:
    """Let the actuators reach their commands: a few steps far longer than any actuator takes, in place."""
    for i in range(3 * HELD):
        act[i] = 0.0
    for _ in range(3):
        actuate_in_place(commands, memory, LONG, p, on, act)
    for i in range(HELD):
        act[i] = act[HELD + i] = act[2 * HELD + i]


@lean
def until_bend(
    commands: Array, memory: Array, left: float, least: float, p: Array, on: Any
) -> float:
    """Length of the next step: no further than `left`, nor, beyond `least`, than where a signal jumps or bends."""
    if HAS_PAUSE:
        return min(left, max(pause(commands, memory, p, on), least))
    return left


@lean
def least_after(part: float, before: float, least: float) -> float:
    """The least length of the next part of a step, after this one and the one before."""
    return GROWS * least if part <= least or part < before else SHORTEST


@compiled
def rollout(
    t0: float,
    y: Array,
    commands: Array,
    memory: Array,
    dt: float,
    substeps: int,
    body: Array,
    p: Array,
    on: Any,
    extra: Array,
    out: Array,
) -> None:
    """Free run: row i of commands (N, C) is held for `substeps` steps of dt; states to out (N + 1, 2 NQ)."""
    k, act = np.zeros(K), np.zeros(3 * HELD)
    constants(body, p, on, k)
    out[0] = y
    for i in range(commands.shape[0]):
        for j in range(substeps):
            t, left, least, before = t0 + (i * substeps + j) * dt, dt, SHORTEST, 0.0
            while left > ENOUGH:
                part = until_bend(commands[i], memory, left, least, p, on)
                least, before = least_after(part, before, least), part
                actuate_in_place(commands[i], memory, part, p, on, act)
                step_in_place(t, y, part, act, p, on, k, extra)
                t, left = t + part, left - part
        out[i + 1] = y[: 2 * NQ]
