"""Linear models of a vessel about a steady motion, from central differences of its simulation.

`linearise_vessel` gives the sampled motion over one control period, `linear_model` the continuous
state-space model.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from math import sqrt

import numpy as np
from numpy.typing import NDArray

from boatsim.control.adaptive import Complex
from boatsim.control.linear_model import (
    LinearModel,
    Variable,
    variable_names,
    variable_scales,
)
from boatsim.errors import BadInput
from boatsim.physics.particulars import GRAVITY
from boatsim.physics.signals import COMPONENTS, ROTATIONS, STATE, Array
from boatsim.physics.vessel import Vessel
from boatsim.recordings.notes import unit_of
from boatsim.simulate.interval_map import POSITION, IntervalMap
from boatsim.simulate.steady_motion import INTERVAL, SteadyMotion, motion_scales
from boatsim.simulate.stepper import State

# [m/s], [rad/s], [N], [rad]: change of a state for its derivative; well below one step of a servo
# and well above rounding
STATE_CHANGE = 1e-5
COMMAND_CHANGE = 1e-4  # of a command's range, for the same reason
# Of the interval: a state whose influence has decayed by this factor at its end (a lag of less than
# a twelfth of the interval) counts as immediate
IMMEDIATE = 1e-5
# Entries of the scaled matrices below this are errors of the differences and are set to zero: they
# mean time constants of years for a boat of 1 m
ROUNDING = 1e-8
# Factor by which poses and velocities are preferred to the memory of effects as states
PREFERENCE = 1e4
# [rad/s sqrt(g / L)] at which two models are compared, from drift to actuators
FREQUENCIES = np.geomspace(0.01, 30.0, 15)
# Relative difference of the derivatives to both sides from which a law has a kink at the motion
KINK = 0.02


@dataclass(frozen=True)
class LinearVessel:
    """Motion of a vessel over one control period with held commands, about a steady motion.

    x(k+1) = A x(k) + B c(k) + E w(k). The state holds velocities, attitude and the memory of
    actuators and other effects, w constant body forces.
    """

    a: Array  # (n, n)
    b: Array  # (n, commands)
    commands: tuple[str, ...]
    outputs: Mapping[str, int]  # velocity or "psi" -> its place in the state
    delay: float  # [s] of the vessel's own command delay
    period: float  # [s]


@dataclass(frozen=True)
class _Derivatives:
    """Derivatives of the state at the end of an interval, and where they differ to both sides."""

    a: Array  # (n, n)
    b: Array  # (n, commands)
    e: Array  # (n, forces)
    kinks: tuple[str, ...]  # names of states and commands


def linearise_vessel(
    vessel: Vessel, state: State, commands: Mapping[str, float], period: float
) -> LinearVessel:
    """Linearise the motion of a vessel over one control period about a steady motion.

    Rate limits act on large motions only and are not part of it.

    Args:
        vessel: The vessel.
        state: Steady motion; position and heading do not matter.
        commands: Commands of the steady motion by channel.
        period: Control period over which the commands are held [s].
    """
    motion = IntervalMap(vessel, period)
    found = _derivatives(motion, SteadyMotion(state, commands), 1.0, ())
    outputs = {name: motion.fields.index(name) for name in motion.fields}
    return LinearVessel(found.a, found.b, tuple(commands), outputs, motion.delay, period)


def _derivatives(
    motion: IntervalMap, steady: SteadyMotion, share: float, axes: Sequence[str]
) -> _Derivatives:
    """Central differences about a steady motion.

    Args:
        motion: The motion over one interval.
        steady: The steady motion.
        share: Factor of the usual differences.
        axes: Degrees of freedom in which a further force acts.
    """
    start = steady.state._replace(t=0.0, x=0.0, y=0.0, psi=0.0)
    commands, n = steady.commands, len(motion)
    offset = np.zeros(n)
    if len(steady.memory):
        own = slice(len(motion.fields), n)
        offset[own] = steady.memory
        # the memory of the motion contains the length of the last step
        begin = motion.settled_state(start, commands) + offset
        offset[own] += (motion.advance(start, offset, commands) - begin)[own]
    middle = motion.advance(start, offset, commands)
    kinks = []

    def slope(more: Array, less: Array, above: float, below: float, name: str) -> Array:
        if above and below:
            sides = (more - middle) / above, (middle - less) / below
            largest = max(np.abs(sides[0]).max(), np.abs(sides[1]).max())
            if np.abs(sides[0] - sides[1]).max() > KINK * largest:
                kinks.append(name)
        return np.asarray((more - less) / (above + below))

    a = np.empty((n, n))
    by = share * STATE_CHANGE
    for j, name in enumerate([*motion.fields, *motion.memory_names]):
        change = np.zeros(n)
        change[j] = by
        more = motion.advance(start, offset + change, commands)
        less = motion.advance(start, offset - change, commands)
        a[:, j] = slope(more, less, by, by, name)
    b = np.empty((n, len(commands)))
    for j, (name, value) in enumerate(commands.items()):
        channel = motion.vessel.commands[name]
        by = share * COMMAND_CHANGE * (channel.high - channel.low)
        above = min(value + by, max(channel.high, value)) - value
        below = value - max(value - by, min(channel.low, value))
        more = motion.advance(start, offset, {**commands, name: value + above}, commands)
        less = motion.advance(start, offset, {**commands, name: value - below}, commands)
        b[:, j] = slope(more, less, above, below, name)
    e = np.empty((n, len(axes)))
    free = motion.force_axes
    for j, axis in enumerate(axes):
        force = np.zeros(len(free))
        # about as much as changes the velocity by STATE_CHANGE over the interval
        force[free.index(axis)] = share * STATE_CHANGE * _inertia(motion.vessel, axis)
        force /= motion.length
        more = motion.advance(start, offset, commands, force=force)
        less = motion.advance(start, offset, commands, force=-force)
        e[:, j] = (more - less) / (2.0 * force[free.index(axis)])
    return _Derivatives(a, b, e, tuple(kinks))


def _inertia(vessel: Vessel, axis: str) -> float:
    """Mass or moment of inertia of the rigid body in a degree of freedom [kg or kg m^2]."""
    body = vessel.body
    inertias = {
        "roll": body.roll_inertia,
        "pitch": body.effective_pitch_inertia(),
        "yaw": body.yaw_inertia,
    }
    return inertias.get(axis, body.mass)


# Continuous model
# ------------------------------------------------------------------------------------------------


def linear_model(
    vessel: Vessel, steady: SteadyMotion, outputs: Sequence[str] = (), position: bool = False
) -> LinearModel:
    """Return the linear state-space model of a vessel about a steady motion.

    The matrix of the sampled motion over a short interval is exact, and the continuous matrices are
    its logarithm. The interval and all differences are then halved; the second model is returned,
    with the difference of both as its accuracy.

    Args:
        vessel: The vessel.
        steady: Steady motion, as `find_steady_motion` returns it.
        outputs: Names of the states that are outputs; default: heading, attitude and velocities.
        position: Whether the position is a state where no force depends on it.

    Raises:
        BadInput: An output is no state, or the position is not linear because the vessel turns.
    """
    if position and abs(steady.state.r) > ROUNDING:
        raise BadInput(
            f"{vessel.name}: the position is no linear state of a turn, yaw rate "
            f"{steady.state.r:.3g} rad/s; allowed on a straight course only"
        )
    length = INTERVAL * sqrt(vessel.length / GRAVITY)
    first = _continuous_model(vessel, steady, length, 1.0, position)
    model = _continuous_model(vessel, steady, 0.5 * length, 0.5, position)
    accuracy = _response_difference(first, model, sqrt(vessel.length / GRAVITY))
    found = replace(model, accuracy=accuracy)
    if not outputs:
        outputs = [name for name in variable_names(found.states) if name in State._fields]
    return found.with_outputs(outputs)


def _response_difference(first: LinearModel, second: LinearModel, unit: float) -> float:
    """Largest relative difference of two frequency responses from all inputs to the motion.

    The response does not depend on the choice of the states, as the matrices do.

    Args:
        first: A model.
        second: Another model of the same vessel.
        unit: Unit of time sqrt(L / g) [s].
    """
    largest = 0.0
    for frequency in (FREQUENCIES / unit).tolist():
        old, new = _motion_response(first, frequency), _motion_response(second, frequency)
        largest = max(largest, np.abs(new - old).max() / (np.abs(new).max() or 1.0))
    return float(largest)


def _motion_response(model: LinearModel, frequency: float) -> Complex:
    """Response (motions, inputs and forces) at a frequency [rad/s], in units of the scales."""
    x, u = variable_scales(model.states), variable_scales((*model.inputs, *model.forces))
    pencil = 1j * frequency * np.eye(len(x)) - model.a * x / x[:, None]
    inputs = np.hstack((model.b, model.e)) * u / x[:, None]
    rows = [i for i, one in enumerate(model.states) if one.name in State._fields]
    return np.asarray(np.linalg.solve(pencil, inputs)[rows])


def _continuous_model(
    vessel: Vessel, steady: SteadyMotion, length: float, share: float, position: bool
) -> LinearModel:
    """The continuous model from the sampled motion over an interval of `length` s."""
    motion = IntervalMap(vessel, length, position=True)
    found = _derivatives(motion, steady, share, motion.force_axes)
    variables = _state_variables(motion, steady)
    inputs, forces = _input_variables(motion.vessel, steady), _force_variables(motion)
    scale, span = variable_scales(variables), variable_scales(inputs)
    size = variable_scales(forces)
    a = found.a * scale / scale[:, None]
    b, e = found.b * span / scale[:, None], found.e * size / scale[:, None]
    unused = [i for i, one in enumerate(variables) if not one.name]
    for name in POSITION:
        if not position and name in motion.fields:
            i = motion.fields.index(name)
            if np.abs(np.delete(a[:, i], i)).max() < ROUNDING:
                unused.append(i)
    kept = np.setdiff1d(np.arange(len(variables)), unused)
    both = np.hstack((b, e))[kept]
    moving = kept < len(motion.fields)
    chosen, a, both = _without_immediate_states(a[np.ix_(kept, kept)], both, moving)
    a, both = _logarithm(a, both, length)
    states = [variables[kept[i]] for i in chosen]
    scale = scale[kept][chosen]
    unit = sqrt(vessel.length / GRAVITY)
    a[np.abs(a) * unit < ROUNDING] = 0.0
    both[np.abs(both) * unit < ROUNDING] = 0.0
    both *= scale[:, None]
    m, n = len(inputs), len(states)
    remarks = []
    if motion.ignored:
        remarks.append(f"without a derivative and therefore left out: {', '.join(motion.ignored)}")
    if motion.delayed:
        remarks.append(f"the dead time acts on {', '.join(motion.delayed)} only")
    named = variable_names((*states, *inputs))
    kinks = [name for name in found.kinks if name in named]
    if kinks:
        remarks.append(
            f"the derivatives to both sides differ for {', '.join(kinks)}; the model has their mean"
        )
    return LinearModel(
        vessel.name,
        tuple(vessel.load),
        tuple(states),
        tuple(inputs),
        (),
        tuple(forces),
        a * scale[:, None] / scale,
        both[:, :m] / span,
        np.zeros((0, n)),
        np.zeros((0, m)),
        both[:, m:] / size,
        delay=motion.delay,
        remarks=tuple(remarks),
    )


def _without_immediate_states(
    a: Array, b: Array, moving: NDArray[np.bool_]
) -> tuple[NDArray[np.int64], Array, Array]:
    """Remove the modes of a sampled model that decay within the interval.

    They belong to actuators without lag, which only store the last command. The remaining states
    span the invariant subspace of the other eigenvalues.

    Args:
        a: Sampled A, (n, n).
        b: Sampled B, (n, m).
        moving: Whether a state (n,) is a pose or velocity, which is kept if possible.

    Returns:
        Indices of the remaining states (k,), A (k, k) and B (k, m) for them.
    """
    from scipy.linalg import qr, schur, solve_sylvester

    def slow(value: complex) -> bool:
        return abs(value) > IMMEDIATE

    t, z, count = schur(a, output="complex", sort=slow)
    n = len(a)
    if count == n:
        return np.arange(n, dtype=np.int64), a, b
    right = z[:, :count]
    mixed = solve_sylvester(t[:count, :count], -t[count:, count:], -t[:count, count:])
    left = np.hstack((np.eye(count), -mixed)) @ z.conj().T
    # the states that influence the remaining modes, and among them first the motion
    weight = np.where(np.abs(left).max(axis=0) > ROUNDING, 1.0, ROUNDING)
    weight[moving] *= PREFERENCE
    order = qr((right * weight[:, None]).conj().T, pivoting=True)[2]
    chosen = np.sort(order[:count]).astype(np.int64)
    basis = right[chosen]
    inverse = np.linalg.inv(basis)
    return (
        chosen,
        np.real(basis @ t[:count, :count] @ inverse),
        np.real(basis @ left @ b),
    )


def _logarithm(a: Array, b: Array, length: float) -> tuple[Array, Array]:
    """Continuous A and B of a sampled model with held inputs."""
    from scipy.linalg import logm

    n, m = b.shape
    whole = np.eye(n + m)
    whole[:n, :n], whole[:n, n:] = a, b
    rates = np.real(logm(whole)) / length
    return rates[:n, :n].copy(), rates[:n, n:].copy()


# States and inputs
# ------------------------------------------------------------------------------------------------


def _state_variables(motion: IntervalMap, steady: SteadyMotion) -> list[Variable]:
    """Names, units, values and scales of all entries of the state."""
    signals = {signal.symbol: signal for signal in STATE}
    scales = motion_scales(motion.vessel)
    found = []
    for name in motion.fields:
        value = getattr(steady.state, name)
        if name in (*POSITION, "psi"):
            value = 0.0
        unit = unit_of(signals[name].column)
        found.append(Variable(name, unit, float(value), scales[name], signals[name].axis))
    settled = motion.settled_state(steady.state, steady.commands)[len(motion.fields) :]
    if len(steady.memory):
        settled = settled + steady.memory
    pairs = zip(motion.memory_names, motion.memory_actuators, settled.tolist(), strict=True)
    for name, actuator, value in pairs:
        scale = 1.0
        if actuator in motion.vessel.commands:
            channel = motion.vessel.commands[actuator]
            scale = 0.5 * (channel.high - channel.low)
        found.append(Variable(name, unit_of(actuator), value, scale, name.partition(".")[0]))
    return found


def _input_variables(vessel: Vessel, steady: SteadyMotion) -> list[Variable]:
    found = []
    for name, value in steady.commands.items():
        channel = vessel.commands[name]
        scale = 0.5 * (channel.high - channel.low)
        found.append(Variable(name, unit_of(name), float(value), scale, vessel.roles.get(name, "")))
    return found


def _force_variables(motion: IntervalMap) -> list[Variable]:
    """Body forces and moments; their scale accelerates the rigid body by g, or by g over L."""
    found = []
    for axis in motion.force_axes:
        name, _, _ = COMPONENTS[axis].partition("_")
        unit, scale = "N", GRAVITY * _inertia(motion.vessel, axis)
        if axis in ROTATIONS:
            unit, scale = "N m", scale / motion.vessel.length
        found.append(Variable(name, unit, 0.0, scale, axis))
    return found
