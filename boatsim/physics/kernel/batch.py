"""Steps of many vessels, each with its own parameters, commands and actuators, in compiled code.

`boats` are the rows to work on, so that threads can share the rows among them. The numbers of one
vessel depend neither on another vessel nor on the thread.
"""

from typing import Any

import numpy as np

from boatsim.physics.kernel.compiling import compile_shared_law, unlocked
from boatsim.physics.kernel.records import FleetArrays
from boatsim.physics.signals import Array

from .inertia import compute_mass_constants
from .laws import HAS_ADVANCE_MOTION_MEMORY, HELD
from .motion import NQ, advance_memory_of_motion, instrument_readings, step_in_place
from .run import (
    ENOUGH,
    SHORTEST,
    advance_actuators,
    minimum_substep,
    settle_actuators,
    substep_length,
)

# As in `rollout`, but inlined: what the parts of a step have in common is computed once.
substep_length_inlined, advance_actuators_inlined = (
    compile_shared_law(substep_length),
    compile_shared_law(advance_actuators),
)
step_inlined = compile_shared_law(step_in_place)
advance_memory_inlined = compile_shared_law(advance_memory_of_motion)


@unlocked
def compute_mass_constants_of_boats(boats: Any, body: Array, p: Array, on: Any, k: Array) -> None:
    """Fill the rows `boats` of k (B, K) with the mass matrices of several vessels.

    They follow from rigid bodies (B, 6) and effect parameters (B, P).
    """
    for b in boats:
        compute_mass_constants(body[b], p[b], on, k[b])


@unlocked
def settle_actuators_of_boats(boats: Any, fleet: FleetArrays) -> None:
    """Set the actuators of several vessels to their steady state under the present commands."""
    for b in boats:
        for i in range(fleet.memory.shape[1]):
            fleet.memory[b, i] = 0.0
        settle_actuators(fleet.commands[b], fleet.memory[b], fleet.p[b], fleet.on, fleet.act[b])


@unlocked
def advance_boats(boats: Any, fleet: FleetArrays, dt: float, steps: int) -> None:
    """Simulate several vessels over steps of dt [s] with their commands held, in place."""
    t, y, commands, memory, act, p, on, k, force = fleet
    for b in boats:
        begin = t[b]
        for j in range(steps):
            now, left, least, before = begin + j * dt, dt, SHORTEST, 0.0
            while left > ENOUGH:
                part = substep_length_inlined(commands[b], memory[b], left, least, p[b], on)
                least, before = minimum_substep(part, before, least), part
                advance_actuators_inlined(commands[b], memory[b], part, p[b], on, act[b])
                if HAS_ADVANCE_MOTION_MEMORY:
                    advance_memory_inlined(now, y[b], part, memory[b], act[b], p[b], on)
                step_inlined(now, y[b], part, act[b], p[b], on, k[b], force)
                now, left = now + part, left - part
        t[b] = begin + steps * dt


@unlocked
def read_instruments_of_boats(boats: Any, fleet: FleetArrays, felt: Array) -> None:
    """Write time and noiseless instrument readings of several vessels to rows of felt (B, 11)."""
    t, y, _, _, act, p, on, k, force = fleet
    last = np.int64(2 * HELD)  # the actuators at the end of the last step
    for b in boats:
        felt[b, 0] = t[b]
        found = instrument_readings(t[b], y[b, : 2 * NQ], act[b], last, p[b], on, k[b], force)
        for i in range(len(found)):
            felt[b, 1 + i] = found[i]
