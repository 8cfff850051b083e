"""What is the same for every freedom: a run of many steps under recorded commands."""

from typing import Any

import numpy as np

from boatsim.physics.base import Array
from boatsim.physics.kernel.compiling import compiled, lean
from boatsim.physics.kernel.laws import HELD, PAUSES, actuate, pause
from boatsim.physics.kernel.planar import NQ, K, constants, step_in_place

SHORTEST = 1e-3  # [s] of a step; within one, a signal that jumps counts with its mean
LONG = 1e4  # [s] longer than any actuator takes


@lean
def actuate_in_place(commands: Array, memory: Array, dt: float, p: Array, on: Any, act: Array) -> None:
    """One step of all channels."""
    actuate(commands, memory, dt, p, on, act)


@compiled
def settle(commands: Array, memory: Array, p: Array, on: Any, act: Array) -> None:
    """Let the actuators reach their commands: a few steps far longer than any actuator takes, in place."""
    for _ in range(3):
        actuate_in_place(commands, memory, LONG, p, on, act)


@compiled
def rollout(
    t0: float, y: Array, commands: Array, memory: Array, dt: float, substeps: int, body: Array, p: Array, on: Any,
    extra: Array, out: Array,
) -> None:  # fmt: skip
    """Free run: row i of commands (N, C) is held for `substeps` steps of dt; states to out (N + 1, 2 NQ)."""
    k, act = np.zeros(K), np.zeros(HELD)
    constants(body, p, on, k)
    out[0] = y
    for i in range(commands.shape[0]):
        for j in range(substeps):
            t, left = t0 + (i * substeps + j) * dt, dt
            if PAUSES:  # cut the step where an actuator's signal jumps
                part = max(pause(commands[i], memory, p, on), SHORTEST)
                while part < left - 1e-9:
                    actuate_in_place(commands[i], memory, part, p, on, act)
                    step_in_place(t, y, part, act, p, on, k, extra)
                    t, left = t + part, left - part
                    part = max(pause(commands[i], memory, p, on), SHORTEST)
            actuate_in_place(commands[i], memory, left, p, on, act)
            step_in_place(t, y, left, act, p, on, k, extra)
        out[i + 1] = y[: 2 * NQ]
