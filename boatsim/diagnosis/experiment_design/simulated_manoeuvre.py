"""A manoeuvre on a vessel: the course that a fitted boat is expected to take in it, laid out like a recording."""

from dataclasses import dataclass, replace

import numpy as np

from boatsim.diagnosis.experiment_design.manoeuvres import Manoeuvre
from boatsim.diagnosis.filter import (
    InitialState,
    MappedRecording,
    axes_of,
    body_of,
    command_changes,
)
from boatsim.diagnosis.problem import Fit, Problem
from boatsim.physics.base import Array
from boatsim.physics.kernel.records import Inputs, Model

CLEAR, TOUCH = (
    0.6,
    0.5,
)  # of its length a boat's middle is kept off a wall, and where its end would touch
SHORTEST = 0.5  # share of a manoeuvre that must fit between the walls
SWITCHES = 40  # most changes of course in a zig-zag


@dataclass(frozen=True)
class Course:
    """What a boat is expected to do, without noise and ambient force."""

    manoeuvre: (
        Manoeuvre  # with the times at which a zig-zag changes over, and no longer than walls allow
    )
    start: Array  # (2 NQ,) state of the kernels at its begin
    track: MappedRecording  # what sensors like those of the recordings would show


def laid(problem: Problem, found: Fit, manoeuvre: Manoeuvre) -> Course | None:
    """The course of a fitted boat in a manoeuvre; None if walls leave no room for it, or if the boat runs away."""
    length, wall = problem.program.vessel.length, walls(problem)
    start = _start(problem, found, manoeuvre)
    manoeuvre = _switched(problem, found, manoeuvre, start)
    times, commands = _rows(problem, manoeuvre)
    states = _states(problem, found, times, commands, start)
    if wall is not None:
        start = _between(wall - CLEAR * length, states, manoeuvre.to_wall)
        states = _states(problem, found, times, commands, start)
        inside = np.logical_and.accumulate(
            (np.abs(states[:, :2]) <= wall - TOUCH * length).all(axis=1)
        )
        if inside.mean() < SHORTEST:
            return None
        times, commands, states = times[inside], commands[inside], states[inside]
        manoeuvre = manoeuvre if inside.all() else _cut(manoeuvre, round(float(times[-1]), 1))
    if not np.isfinite(states).all():
        return None
    return Course(
        manoeuvre, start, _track(problem, manoeuvre.words, times, commands, states, start)
    )


def walls(problem: Problem) -> Array | None:
    """Where walls stand, plus and minus (x, y) [m], if the library that is tried knows of any."""
    program = problem.program
    if "surge" not in program.vessel.dof or "walls_m" not in problem.recordings[0].facts:
        return None
    x_low, x_high, y_low, y_high = problem.recordings[0].facts["walls_m"]
    return np.array([min(-x_low, x_high), min(-y_low, y_high)])


def _cut(manoeuvre: Manoeuvre, end: float) -> Manoeuvre:
    """The manoeuvre until a time [s]."""
    n = sum(t < end for t in manoeuvre.times)
    return replace(manoeuvre, times=manoeuvre.times[:n], levels=manoeuvre.levels[:n], duration=end)


def _track(
    problem: Problem, name: str, times: Array, commands: Array, shown: Array, start: Array
) -> MappedRecording:
    """What the sensors of the first recording would show (N, 2 NQ) of a course begun at a state, as a recording."""
    first, nq = problem.recordings[0], problem.program.module.NQ
    measured = np.ascontiguousarray(shown[:, first.codes])
    change_times, change_values = command_changes(times, commands)
    track = replace(
        first,
        name=name,
        times=times,
        measured=measured,
        commands=commands,
        command_times=change_times,
        command_values=change_values,
        specified_initial=None,
    )
    mean = track.initial.mean.copy()
    mean[:nq] = shown[0, :nq]
    mean[nq : 2 * nq] = start[nq:]
    initial = InitialState(mean, track.initial.covariance, start[nq:])
    return replace(track, specified_initial=initial)


def _states(problem: Problem, found: Fit, times: Array, commands: Array, start: Array) -> Array:
    """Channels (N, 2 NQ) of a free run as a recording would show them, ambient force left out."""
    values = problem.values(problem.recordings[0], found.free, found.theta)
    out = np.full((1, len(times), len(start)), np.nan)
    problem.program.module.free_runs(
        Inputs(times, times, commands),
        problem.config.filter.filter_step,
        Model(body_of(values), values, problem.program.switches(found.effects)),
        np.array([0]),
        np.array([len(times) - 1]),
        start[None],
        out,
    )
    return np.asarray(out[0])


def _rows(problem: Problem, manoeuvre: Manoeuvre) -> tuple[Array, Array]:
    """Times (N,) of a recording at the rate of the first one, and the commands (N, C) in force."""
    rate = float(np.median(np.diff(problem.recordings[0].times)))
    times = np.asarray(rate * np.arange(int(manoeuvre.duration / rate) + 1), dtype=np.float64)
    now = np.searchsorted(np.array(manoeuvre.times) - 1e-6, times, side="right") - 1
    rows = [problem.program.command_array(level) for level in manoeuvre.levels]
    commands = np.array(rows).reshape(len(rows), -1)
    return times, np.ascontiguousarray(commands[now]) if commands.size else np.zeros(
        (len(times), 1)
    )


def _switched(problem: Problem, found: Fit, manoeuvre: Manoeuvre, start: Array) -> Manoeuvre:
    """A zig-zag with the times at which its heading is expected to be reached."""
    if not manoeuvre.heading:
        return manoeuvre
    sides, switches, side = manoeuvre.levels, [0.0], 0.0
    for _ in range(SWITCHES):
        levels = tuple(sides[i % 2] for i in range(len(switches)))
        manoeuvre = replace(manoeuvre, times=tuple(switches), levels=levels)
        times, commands = _rows(problem, manoeuvre)
        psi = _states(problem, found, times, commands, start)[
            :, axes_of(problem.program.vessel).index("yaw")
        ]
        turned = (
            side * psi if side else np.abs(psi)
        )  # which way the first angle turns the hull is seen first
        reached = (turned >= manoeuvre.heading) & (times > switches[-1])
        if not reached.any():
            break
        row = int(np.argmax(reached))
        side = -float(np.sign(psi[row]))
        switches.append(round(float(times[row]), 3))
    return manoeuvre


def _start(problem: Problem, found: Fit, manoeuvre: Manoeuvre) -> Array:
    """State (2 NQ,) in which it begins: where the recordings were, at rest, or at their usual speed."""
    first, axes = problem.recordings[0], axes_of(problem.program.vessel)
    nq = len(axes)
    state = np.zeros(2 * nq)
    if "surge" not in axes:
        state[axes.index("roll")] = manoeuvre.heel
        return state
    for c, code in enumerate(first.codes):
        if code < nq and axes[code] in ("surge", "sway"):
            state[code] = round(float(np.nanmean(first.measured[:, c])), 2)
    if manoeuvre.under_way:
        values, on = (
            problem.values(first, found.free, found.theta),
            problem.program.switches(found.effects),
        )
        states = first.smooth(values, on, found.levels).means
        state[nq] = float(f"{np.median(np.hypot(states[:, nq], states[:, nq + 1])):.3g}")
    return state


def _between(room: Array, states: Array, to_wall: bool) -> Array:
    """Start of a course such that it lies in the middle between the walls, or reaches the one ahead."""
    low, high = states[:, :2].min(axis=0), states[:, :2].max(axis=0)
    start = states[0].copy()
    start[:2] -= 0.5 * (low + high)
    if to_wall:
        start[0] += room[0] - 0.5 * (high[0] - low[0])
    start[:2] = np.round(start[:2], 2)
    return np.asarray(start)
