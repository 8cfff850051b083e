"""Many boats over the same steps, each with parameters, commands and a memory of its own; without the interpreter.

All arrays have a row a boat, and `boats` says whose turn it is, so that threads can share the rows between them: no
number of a boat depends on another's, nor on who steps it.
"""

from typing import Any

import numpy as np

from boatsim.physics.kernel.compiling import shared, unlocked
from boatsim.physics.signals import Array

from .inertia import constants
from .laws import HELD
from .motion import NQ, feels, step_in_place
from .run import ENOUGH, SHORTEST, actuate_in_place, least_after, settle, until_bend

# As in `rollout`, but in one piece: what the parts of a step have in common is computed once.
bent, actuated, stepped = shared(until_bend), shared(actuate_in_place), shared(step_in_place)


@unlocked
def weigh_boats(boats: Any, body: Array, p: Array, on: Any, k: Array) -> None:
    """Constants k of body (n, 6) and parameters p."""
    for b in boats:
        constants(body[b], p[b], on, k[b])


@unlocked
def settle_boats(boats: Any, commands: Array, memory: Array, p: Array, on: Any, act: Array) -> None:
    """Forget what actuators remember and let them reach their commands."""
    for b in boats:
        for i in range(memory.shape[1]):
            memory[b, i] = 0.0
        settle(commands[b], memory[b], p[b], on, act[b])


@unlocked
def advance_boats(
    boats: Any,
    t: Array,
    y: Array,
    commands: Array,
    memory: Array,
    act: Array,
    dt: float,
    steps: int,
    p: Array,
    on: Any,
    k: Array,
    extra: Array,
) -> None:
    """Steps of dt [s] with each row of commands (n, C) held; t, states y (n, 2 NQ) and actuators in place."""
    for b in boats:
        begin = t[b]
        for j in range(steps):
            now, left, least, before = begin + j * dt, dt, SHORTEST, 0.0
            while left > ENOUGH:
                part = bent(commands[b], memory[b], left, least, p[b], on)
                least, before = least_after(part, before, least), part
                actuated(commands[b], memory[b], part, p[b], on, act[b])
                stepped(now, y[b], part, act[b], p[b], on, k[b], extra)
                now, left = now + part, left - part
        t[b] = begin + steps * dt


@unlocked
def feel_boats(
    boats: Any,
    t: Array,
    y: Array,
    act: Array,
    p: Array,
    on: Any,
    k: Array,
    extra: Array,
    felt: Array,
) -> None:
    """Time and what `feels` says of boats, without noise, to rows of felt (n, 11)."""
    last = np.int64(2 * HELD)  # the actuators at the end of the last step
    for b in boats:
        felt[b, 0] = t[b]
        found = feels(t[b], y[b, : 2 * NQ], act[b], last, p[b], on, k[b], extra)
        for i in range(len(found)):
            felt[b, 1 + i] = found[i]
