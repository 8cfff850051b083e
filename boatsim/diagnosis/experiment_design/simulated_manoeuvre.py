"""Simulation of a manoeuvre with a fitted vessel, as a recording without noise."""

from bisect import bisect_left
from dataclasses import dataclass, replace

import numpy as np

from boatsim.diagnosis.experiment_design.manoeuvres import Manoeuvre
from boatsim.diagnosis.filter import MappedRecording, command_changes, dof_in_state_order
from boatsim.diagnosis.filter_arguments import rigid_body_values
from boatsim.diagnosis.problem import Fit, Problem
from boatsim.physics.base import Array
from boatsim.physics.kernel.records import InitialState, Inputs, VesselNumbers


@dataclass(frozen=True)
class SimulatedManoeuvre:
    """A manoeuvre with the motion that a fitted vessel model predicts for it, as a recording.

    It contains neither sensor noise nor latent (unmodelled) force.
    """

    # with the expected switching times of a zig-zag, shortened if the walls require it
    manoeuvre: Manoeuvre
    start: Array  # (2 NQ,) state at its begin
    recording: MappedRecording  # by sensors like those of the first recording


def simulate_manoeuvre(
    problem: Problem, fit: Fit, manoeuvre: Manoeuvre
) -> SimulatedManoeuvre | None:
    """Simulate a manoeuvre with a fitted vessel model, without noise.

    If the walls of a tank are known, the start is moved and the manoeuvre shortened to stay clear
    of them.

    Args:
        problem: The problem; its first recording provides the sensors and the row rate.
        fit: Fit of the vessel model.
        manoeuvre: The manoeuvre.

    Returns:
        The simulated manoeuvre; None if the walls leave no room or the simulation diverges.
    """
    config = problem.config.plan
    length = problem.program.vessel.length
    walls = wall_distances(problem)
    start = _start(problem, fit, manoeuvre)
    manoeuvre = _with_switching_times(problem, fit, manoeuvre, start)
    times, commands = _rows(problem, manoeuvre)
    states = _free_run(problem, fit, times, commands, start)
    if walls is not None:
        start = _centred(walls - config.wall_clearance * length, states, manoeuvre.to_wall)
        states = _free_run(problem, fit, times, commands, start)
        free = (np.abs(states[:, :2]) <= walls - config.wall_contact * length).all(axis=1)
        inside = np.logical_and.accumulate(free)
        if inside.mean() < config.min_share_in_tank:
            return None
        times = times[inside]
        commands = commands[inside]
        states = states[inside]
        if not inside.all():
            manoeuvre = _shortened(manoeuvre, round(float(times[-1]), 1))
    if not np.isfinite(states).all():
        return None
    recording = _as_recording(problem, manoeuvre.name, times, commands, states, start)
    return SimulatedManoeuvre(manoeuvre, start, recording)


def wall_distances(problem: Problem) -> Array | None:
    """Return the distances (x, y) [m] of the tank walls from the origin; None without walls."""
    facts = problem.recordings[0].facts
    if "surge" not in problem.program.vessel.dof or "walls_m" not in facts:
        return None
    x_low, x_high, y_low, y_high = facts["walls_m"]
    return np.array([min(-x_low, x_high), min(-y_low, y_high)])


def _shortened(manoeuvre: Manoeuvre, end: float) -> Manoeuvre:
    """The manoeuvre until a time [s]."""
    count = bisect_left(manoeuvre.times, end)
    return replace(
        manoeuvre,
        times=manoeuvre.times[:count],
        levels=manoeuvre.levels[:count],
        duration=end,
    )


def _as_recording(
    problem: Problem, name: str, times: Array, commands: Array, states: Array, start: Array
) -> MappedRecording:
    """Recording of states (N, 2 NQ) by the sensors of the first recording."""
    first = problem.recordings[0]
    nq = problem.program.module.NQ
    change_times, change_values = command_changes(times, commands)
    recording = replace(
        first,
        name=name,
        times=times,
        measured=np.ascontiguousarray(states[:, first.codes]),
        commands=commands,
        command_times=change_times,
        command_values=change_values,
        specified_initial=None,
    )
    mean = recording.initial_state_prior.mean.copy()
    mean[:nq] = states[0, :nq]
    mean[nq : 2 * nq] = start[nq:]
    initial = InitialState(mean, recording.initial_state_prior.covariance, start[nq:])
    return replace(recording, specified_initial=initial)


def _free_run(problem: Problem, fit: Fit, times: Array, commands: Array, start: Array) -> Array:
    """Channels (N, 2 NQ) of a free run as a recording has them, without the latent force."""
    values = problem.parameter_vector(problem.recordings[0], fit.free, fit.theta)
    out = np.full((1, len(times), len(start)), np.nan)
    problem.program.estimation_functions.simulate_intervals(
        Inputs(times, times, commands),
        problem.config.filter.filter_step,
        VesselNumbers(
            rigid_body_values(values), values, problem.program.effect_switches(fit.effects)
        ),
        np.array([0]),
        np.array([len(times) - 1]),
        start[None],
        out,
    )
    return np.asarray(out[0])


def _rows(problem: Problem, manoeuvre: Manoeuvre) -> tuple[Array, Array]:
    """Times (N,) at the row rate of the first recording, and the commands (N, K) that hold."""
    step = float(np.median(np.diff(problem.recordings[0].times)))
    times = np.asarray(step * np.arange(int(manoeuvre.duration / step) + 1), dtype=np.float64)
    row = np.searchsorted(np.array(manoeuvre.times) - 1e-6, times, side="right") - 1
    levels = np.array(list(map(problem.program.command_array, manoeuvre.levels)))
    levels = levels.reshape(len(manoeuvre.levels), -1)
    if not levels.size:
        return times, np.zeros((len(times), 1))
    return times, np.ascontiguousarray(levels[row])


def _with_switching_times(
    problem: Problem, fit: Fit, manoeuvre: Manoeuvre, start: Array
) -> Manoeuvre:
    """A zig-zag with the times at which its heading is expected to be reached."""
    if not manoeuvre.switch_heading:
        return manoeuvre
    yaw = dof_in_state_order(problem.program.vessel).index("yaw")
    sides = manoeuvre.levels
    switches = [0.0]
    sign = 0.0
    for _ in range(problem.config.plan.max_switches):
        levels = tuple(sides[i % 2] for i in range(len(switches)))
        manoeuvre = replace(manoeuvre, times=tuple(switches), levels=levels)
        times, commands = _rows(problem, manoeuvre)
        psi = _free_run(problem, fit, times, commands, start)[:, yaw]
        # the first turn shows to which side the first rudder angle turns the hull
        turned = sign * psi if sign else np.abs(psi)
        reached = (turned >= manoeuvre.switch_heading) & (times > switches[-1])
        if not reached.any():
            break
        row = int(np.argmax(reached))
        sign = -float(np.sign(psi[row]))
        switches.append(round(float(times[row]), 3))
    return manoeuvre


def _start(problem: Problem, fit: Fit, manoeuvre: Manoeuvre) -> Array:
    """State (2 NQ,) at the begin: the mean position of the recordings, at rest or under way."""
    first = problem.recordings[0]
    axes = dof_in_state_order(problem.program.vessel)
    nq = len(axes)
    state = np.zeros(2 * nq)
    if "surge" not in axes:
        if "roll" in axes:
            state[axes.index("roll")] = manoeuvre.release_angle
        return state
    for channel, code in enumerate(first.codes):
        if code < nq and axes[code] in ("surge", "sway"):
            state[code] = round(float(np.nanmean(first.measured[:, channel])), 2)
    if manoeuvre.under_way:
        values = problem.parameter_vector(first, fit.free, fit.theta)
        on = problem.program.effect_switches(fit.effects)
        states = first.smooth(values, on, fit.levels).means
        state[nq] = float(f"{np.median(np.hypot(states[:, nq], states[:, nq + 1])):.3g}")
    return state


def _centred(room: Array, states: Array, to_wall: bool) -> Array:
    """Start by which the course lies in the middle of the tank, or reaches the wall ahead."""
    low = states[:, :2].min(axis=0)
    high = states[:, :2].max(axis=0)
    start = states[0].copy()
    start[:2] -= 0.5 * (low + high)
    if to_wall:
        start[0] += room[0] - 0.5 * (high[0] - low[0])
    start[:2] = np.round(start[:2], 2)
    return np.asarray(start)
