"""Forces that the vessel as written has along a recording: of its actuators, and of each of its own coefficients."""

from collections.abc import Iterable

import numpy as np

from boatsim.diagnose.filter import Track
from boatsim.diagnose.problem import Fit, Problem
from boatsim.physics.base import Array


def actuators(track: Track) -> Array:
    """(N, HELD) actuators of the vessel as written under the recorded commands, with cosines and sines of angles."""
    program = track.program
    on, act, memory = program.switches(), np.zeros(program.module.HELD), np.zeros(program.memory_size)
    program.module.settle(track.commands[0], memory, track.values, on, act)
    out = np.empty((len(track.times), len(act)))
    steps = np.append(np.diff(track.times), track.times[-1] - track.times[-2])
    for row, step in enumerate(steps.tolist()):
        program.module.actuate_in_place(track.commands[row], memory, step, track.values, on, act)
        out[row] = act
    return out


def along(track: Track, states: Iterable[Array], held: Iterable[Array], values: Array) -> Array:
    """(N, axes) body-axes wrench of the vessel's own laws at states (N, 2 NQ) with actuators (N, HELD)."""
    forces, on = track.program.module.forces, track.program.switches()
    return np.array([forces(0.0, y, act, values, on) for y, act in zip(states, held, strict=True)])


def coefficient_forces(problem: Problem, found: Fit, track: Track, states: Array) -> Array:
    """(F, N, axes) force that goes with each fitted coefficient of the vessel's own, at its value as written.

    Laws are linear in the coefficients that a recalibration may change.
    """
    held, ones = actuators(track), np.ones(len(found.free))
    states = np.ascontiguousarray(states)
    base = along(track, states, held, problem.values(track, found.free, ones))
    parts = []
    for j in range(len(found.free)):
        twice = problem.values(track, found.free, ones + np.eye(len(ones))[j])
        parts.append(along(track, states, held, twice) - base)
    return np.array(parts).reshape(len(parts), *base.shape)
