"""Forces that the vessel as written has along a recording: of its actuators, and of each of its own coefficients."""

from collections.abc import Iterable, Sequence

import numpy as np

from boatsim.diagnosis.experiment_design.manoeuvres import commanded
from boatsim.diagnosis.filter import MappedRecording
from boatsim.diagnosis.problem import Fit, Problem
from boatsim.physics.base import Array


def actuators(
    track: MappedRecording, effects: Sequence[str] = (), values: Array | None = None
) -> Array:
    """(N, HELD) mean actuators from row to row, under each row's mean commands.

    Those of the vessel as written, or with suspects acting and other `values`.
    """
    program, values = track.program, track.values if values is None else values
    on, act, memory = (
        program.switches(effects),
        np.zeros(program.held_size),
        np.zeros(program.memory_size),
    )
    program.module.settle(track.command_values[0], memory, values, on, act)
    out = np.empty((len(track.times), len(act) // 3))
    steps = np.append(np.diff(track.times), track.times[-1] - track.times[-2])
    for row, step in enumerate(steps.tolist()):
        program.module.actuate_in_place(track.commands[row], memory, step, values, on, act)
        begin, middle, end = act.reshape(3, -1)
        out[row] = (begin + 4.0 * middle + end) / 6.0
    return out


def along(
    track: MappedRecording,
    states: Iterable[Array],
    held: Iterable[Array],
    values: Array,
    effects: Sequence[str] = (),
) -> Array:
    """(N, axes) body-axes wrench of the vessel's laws, and of suspects, at states (N, 2 NQ), actuators (N, HELD)."""
    forces, on = track.program.module.forces, track.program.switches(effects)
    first = np.int64(0)
    return np.array(
        [forces(0.0, y, act, first, values, on) for y, act in zip(states, held, strict=True)]
    )


def full_thrust(track: MappedRecording) -> float:
    """Surge force [N] of the vessel as written at rest, every drive at its limit and straight ahead, over neutral."""
    program, vessel = track.program, track.program.vessel
    drives = [n for n in commanded(vessel) if n not in vessel.angles]
    if "surge" not in vessel.dof or not drives:
        return 0.0
    neutral = {n: c.neutral for n, c in vessel.commands.items()}
    found = []
    for sent in (neutral | {n: vessel.commands[n].high for n in drives}, neutral):
        act, memory = np.zeros(program.held_size), np.zeros(program.memory_size)
        program.module.settle(
            program.command_array(sent), memory, track.values, program.switches(), act
        )
        found.append(along(track, np.zeros((1, 2 * program.module.NQ)), [act], track.values)[0])
    return float(found[0][0] - found[1][0])


def coefficient_forces(
    problem: Problem, found: Fit, track: MappedRecording, states: Array
) -> Array:
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
