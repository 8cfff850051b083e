"""Simulation of many boats at one task, used by environments, controllers and tests.

The motion of a boat depends only on the seed of its episode, not on other boats.
"""

from collections.abc import Callable, Sequence
from math import inf, isfinite
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from boatsim.errors import BadInput
from boatsim.learn import episode_random
from boatsim.learn.actions import Controls, make_controls
from boatsim.learn.backends import Boats, World
from boatsim.learn.hull import Hulls, Motion
from boatsim.learn.task_scale import planar_state_indices, task_scale
from boatsim.learn.tasks.base import Signal, Task
from boatsim.learn.variation import Variation
from boatsim.physics.signals import Array
from boatsim.physics.vessel import Vessel
from boatsim.simulate.batch import Batch
from boatsim.simulate.tank import Tank

Flags = NDArray[np.bool_]
Observations = NDArray[np.float32]
ALL_BOATS = slice(None)
# Creates a simulator from vessels, number of boats, integration step [s] and tank.
MakeWorld = Callable[[Sequence[Vessel], int, float, Tank], World]


def make_batch_world(threads: int | None = None) -> MakeWorld:
    """Return a function that creates simulators of many boats in open water, compiled.

    Args:
        threads: Threads that share the boats; None for one per core.
    """
    return lambda vessels, n, step, _: Batch(vessels, n, step, threads=threads)


class Step(NamedTuple):
    """Rewards, ends of episodes and metrics after one control step of n boats."""

    reward: Array  # (n,)
    terminated: Flags  # (n,)
    truncated: Flags  # (n,) the time is over
    finished: Boats  # (k,) numbers of the boats whose episodes end
    metrics: dict[str, Array]  # (k,) each, of these episodes


class TaskSimulation:
    """Simulation of n boats at one learning task, each in its own episode."""

    def __init__(
        self,
        task: Task,
        variation: Variation,
        n: int,
        *,
        period: float,
        step: float,
        duration: float,
        world: MakeWorld,
        tank: Tank | None = None,
    ) -> None:
        """Create a simulation.

        Args:
            task: The task.
            variation: Vessels and parameters that vary between episodes.
            n: Number of boats.
            period: Duration of a control step [s].
            step: Integration step [s]; the period is a multiple of it.
            duration: Duration of an episode [s].
            world: Creates the simulator.
            tank: Replaces the basin of the task; None for that basin.

        Raises:
            BadInput: A duration is wrong, or the vessel cannot do the task.
        """
        self.task = task
        self.variation = variation
        self.n = n
        if not 0.0 < period < inf:
            raise BadInput(f"period = {period:g} s; allowed is more than 0")
        self.period = period
        self.duration = duration
        self.substeps = _substeps(period, step)
        if not period <= duration < inf:
            raise BadInput(f"duration = {duration:g} s; allowed is at least a period, {period:g} s")
        self.vessel = variation.boats[0]
        self.controls: Controls = make_controls(self.vessel, type(task).use)
        task.check_actions(self.vessel.name, self.controls.names)
        self.scale = task_scale(self.vessel, self.controls.commands(self.controls.ahead))
        self.tank = tank or task.basin(self.scale)
        self.world = world(variation.boats, n, step, self.tank)
        self.commands = np.tile(self.controls.neutral, (n, 1))  # present commands
        self._columns = planar_state_indices(self.vessel)
        self._vessel_hulls = Hulls.from_vessels(variation.boats)
        self._hulls = self._vessel_hulls.select(np.zeros(n, dtype=np.int64))
        self._last_step = round(duration / period)
        self._steps = np.zeros(n, dtype=np.int64)
        self._goal = np.zeros((n, type(task).goals))
        self._memory = np.zeros((n, type(task).memory))
        self._actions = np.zeros((n, len(self.controls.names)))
        task_signals = task.signals(self.scale)
        self.signals: tuple[Signal, ...] = (*task_signals, *self._action_signals())
        self._task_signals = len(task_signals)
        self._per_bound = np.array([[1.0 / signal.bound] for signal in self.signals])
        self._observed: tuple[Array, ...] = ()

    def _action_signals(self) -> list[Signal]:
        """Observations of the last action."""
        signals = []
        for name, words in zip(self.controls.names, self.controls.words, strict=True):
            signals.append(Signal(f"last_{name}", 1.0, f"action before: {words}"))
        return signals

    def begin_episodes(self, seeds: episode_random.Seeds, boats: Boats) -> None:
        """Begin new episodes of some boats: sample vessel, parameters, start and goal by the seeds.

        Args:
            seeds: Seeds (k,) of the episodes.
            boats: Numbers (k,) of the boats.
        """
        task = self.task
        size = self.variation.random_number_count
        uniforms = episode_random.uniform_numbers(seeds, size + type(task).random_numbers)
        which = self.variation.sample_and_assign(self.world, uniforms[:, :size], boats)
        starts, goals = task.sample_episodes(uniforms[:, size:], self.scale)
        states = np.zeros((len(boats), 2 * len(self.vessel.dof)))
        states[:, self._columns] = starts
        self.world.reset(states, None, boats)
        hulls = self._vessel_hulls.select(which)
        for present, new in zip(self._hulls, hulls, strict=True):
            present[boats] = new
        self._steps[boats] = 0
        self._goal[boats] = goals
        self._actions[boats] = 0.0
        self.commands[boats] = self.controls.neutral
        observed = task.observe(Motion(*starts.T), np.zeros(len(boats)), goals, hulls, self.scale)
        self._memory[boats] = task.initial_memory(observed, self.scale)
        if not self._observed:  # the first call
            self._observe()
        for present, new in zip(self._observed, observed, strict=True):
            present[boats] = new

    def step(self, actions: Array) -> Step:
        """Simulate one control step of all boats under a learner's actions.

        Args:
            actions: Actions (n, A); they are limited to -1 and 1.

        Returns:
            Rewards, ends and metrics of ended episodes.
        """
        self._actions[:] = np.minimum(np.maximum(actions, -1.0), 1.0)
        return self.step_commands(self.controls.commands(self._actions))

    def step_commands(self, commands: Array) -> Step:
        """Simulate one control step of all boats under commands in the vessel's own units.

        Args:
            commands: Commands (n, C) in the units of the channels.

        Returns:
            Rewards, ends and metrics of ended episodes.
        """
        self.commands = commands
        self.world.advance(commands, self.substeps)
        self._steps += 1
        self._observe()
        outcome = self.task.outcome(self._observed, self._memory, self.period, self.scale)
        reward, terminated = outcome
        truncated = (self._steps >= self._last_step) & ~terminated
        finished = np.flatnonzero(terminated | truncated)
        metrics: dict[str, Array] = {}
        if len(finished):
            observed = tuple([values[finished] for values in self._observed])
            memory = self._memory[finished]
            metrics = self.task.metrics(observed, memory, self.t[finished], self.scale)
        return Step(reward, terminated, truncated, finished, metrics)

    def _observe(self) -> None:
        self._observed = self.task.observe(self.motion, self.t, self._goal, self._hulls, self.scale)

    @property
    def goals(self) -> Array:
        """Goals (n, `goals`) of the present episodes; see `Task`."""
        return self._goal

    @property
    def t(self) -> Array:
        """Time (n,) [s] since the start of each boat's episode."""
        return np.asarray(self._steps * self.period, dtype=float)

    @property
    def motion(self) -> Motion:
        """True position, heading and velocity of all boats."""
        return Motion(*self.world.states.T[self._columns])

    def observations(self, normalised: bool, boats: Boats | slice = ALL_BOATS) -> Observations:
        """Return what a learner observes of some boats, (k, S), in the order of `signals`.

        Each value is limited to the bounds of its signal.

        Args:
            normalised: Whether the observations are divided by their bounds; otherwise in their
                units.
            boats: Numbers (k,) of the boats.
        """
        actions = self._actions[boats].T
        rows = np.empty((len(self.signals), actions.shape[1]))
        for row, observed in zip(rows, self._observed[: self._task_signals], strict=False):
            row[:] = observed[boats]
        rows[self._task_signals :] = actions
        rows *= self._per_bound
        np.minimum(np.maximum(rows, -1.0, out=rows), 1.0, out=rows)
        if not isfinite(rows.sum()):  # the motion of a boat diverged; its episode ends
            np.nan_to_num(rows, copy=False)
        if not normalised:
            rows /= self._per_bound
        return np.ascontiguousarray(rows.T, dtype=np.float32)


def _substeps(period: float, step: float) -> int:
    """Integration steps per control step."""
    substeps = 0
    if 0.0 < step < inf:
        substeps = round(period / step)
    if substeps < 1 or abs(substeps * step - period) > 1e-9 * period:
        raise BadInput(f"step = {step:g} s; allowed are whole parts of the period, {period:g} s")
    return substeps
