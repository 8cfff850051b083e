"""Forces of the vessel along a recording: of its actuators and of each of its coefficients."""

from collections.abc import Sequence

import numpy as np

from boatsim.diagnosis.command_range import manoeuvre_commands
from boatsim.diagnosis.filter import MappedRecording
from boatsim.diagnosis.problem import Fit, Problem
from boatsim.physics.base import Array


def actuator_states(
    mapped: MappedRecording, effects: Sequence[str] = (), values: Array | None = None
) -> Array:
    """Simulate the actuators of a vessel over a recording, driven by the recorded commands.

    The mean state from each row to the next is returned.

    Args:
        mapped: The mapped recording.
        effects: Candidates that act.
        values: Parameter values; None for those of the vessel as specified.

    Returns:
        Actuator states (N, HELD).
    """
    program = mapped.program
    if values is None:
        values = mapped.values
    on = program.effect_switches(effects)
    steps = np.append(np.diff(mapped.times), mapped.times[-1] - mapped.times[-2])
    held = np.empty((len(steps), program.actuator_signal_size // 3))
    program.estimation_functions.mean_actuator_signals(
        mapped.command_values[0], np.ascontiguousarray(mapped.commands), steps, values, on, held
    )
    return held


def body_forces(
    mapped: MappedRecording,
    states: Array,
    held: Array,
    values: Array,
    effects: Sequence[str] = (),
) -> Array:
    """Return the total force of all active effects of a vessel along a recording, in body axes.

    Args:
        mapped: A recording on the program.
        states: States (N, 2 NQ) of the vessel.
        held: Actuator states (N, HELD).
        values: Parameter values.
        effects: Candidates that act in addition to the effects of the vessel.

    Returns:
        Forces and moments (N, axes) [N, N m].

    Raises:
        ValueError: There is not one row of actuator states for each state.
    """
    if len(states) != len(held):
        raise ValueError(f"{len(states)} states and {len(held)} rows of actuator states")
    program = mapped.program
    on = program.effect_switches(effects)
    states = np.ascontiguousarray(states, dtype=float)
    forces = np.empty((len(states), program.module.NQ))
    program.estimation_functions.total_body_forces(
        states, np.ascontiguousarray(held, dtype=float), values, on, forces
    )
    return forces


def full_thrust(mapped: MappedRecording) -> float:
    """Return the surge force [N] at rest with all drives at their upper command limits.

    The force at neutral commands is subtracted.
    """
    program = mapped.program
    vessel = program.vessel
    drives = [n for n in manoeuvre_commands(vessel) if n not in vessel.angles]
    if "surge" not in vessel.dof or not drives:
        return 0.0
    neutral = {n: c.neutral for n, c in vessel.commands.items()}
    full = neutral | {n: vessel.commands[n].high for n in drives}
    return _surge_force_at_rest(mapped, full) - _surge_force_at_rest(mapped, neutral)


def _surge_force_at_rest(mapped: MappedRecording, commands: dict[str, float]) -> float:
    program = mapped.program
    act = np.zeros(program.actuator_signal_size)
    memory = np.zeros(program.memory_size)
    values = mapped.values
    on = program.effect_switches()
    program.estimation_functions.settle_actuators(
        program.command_array(commands), memory, values, on, act
    )
    rest = np.zeros((1, 2 * program.module.NQ))
    return float(body_forces(mapped, rest, act[None], values)[0][0])


def coefficient_forces(problem: Problem, fit: Fit, mapped: MappedRecording, states: Array) -> Array:
    """Return the force that each fitted coefficient of the vessel exerts along a recording.

    Coefficients have their specified values. Effects are linear in the coefficients that a
    recalibration changes.

    Args:
        problem: The estimation problem.
        fit: The recalibrated vessel.
        mapped: The mapped recording.
        states: Smoothed states (N, 2 NQ).

    Returns:
        Forces (F, N, axes) of the F coefficients.
    """
    held = actuator_states(mapped)
    ones = np.ones(len(fit.free))
    states = np.ascontiguousarray(states)
    base = body_forces(mapped, states, held, problem.parameter_vector(mapped, fit.free, ones))
    parts = np.empty((len(ones), *base.shape))
    for j, unit in enumerate(np.eye(len(ones))):
        doubled = problem.parameter_vector(mapped, fit.free, ones + unit)
        parts[j] = body_forces(mapped, states, held, doubled) - base
    return parts


def force_sensitivities(
    problem: Problem, fit: Fit, mapped: MappedRecording, states: Array
) -> Array:
    """Return how the force of a fitted vessel model along a recording changes by each parameter.

    Stochastic forces and errors of instruments exert no force along a given motion, so that their
    parameters have none.

    Args:
        problem: The estimation problem.
        fit: Fit of the vessel model with some candidate effects.
        mapped: The mapped recording.
        states: Smoothed states (N, 2 NQ).

    Returns:
        Forces (F, N, axes) of the F free parameters per prior standard deviation [N, N m].
    """
    step = problem.config.fit.derivative_step
    states = np.ascontiguousarray(states)
    values = problem.parameter_vector(mapped, fit.free, fit.theta)
    held = actuator_states(mapped, fit.effects, values)
    base = body_forces(mapped, states, held, values, fit.effects)
    parts = np.empty((len(fit.free), *base.shape))
    for j, parameter in enumerate(fit.free):
        theta = fit.theta.copy()
        change = step * parameter.sd
        if theta[j] + change > parameter.high:
            change = -change
        theta[j] += change
        values = problem.parameter_vector(mapped, fit.free, theta)
        own = held
        if not parameter.relative:  # it may change an actuator
            own = actuator_states(mapped, fit.effects, values)
        changed = body_forces(mapped, states, own, values, fit.effects)
        parts[j] = (changed - base) * (parameter.sd / change)
    return parts
