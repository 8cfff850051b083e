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
from boatsim.learn.actions import Controls, controls
from boatsim.learn.backends import Boats, World
from boatsim.learn.hull import Hulls, Motion, columns, scale_of
from boatsim.learn.tasks.base import Signal, Task
from boatsim.learn.variation import Variation
from boatsim.physics.signals import Array
from boatsim.physics.vessel import Vessel
from boatsim.simulate.batch import Batch
from boatsim.simulate.world import Tank

Flags = NDArray[np.bool_]
Seen = NDArray[np.float32]
EVERYONE = slice(None)
Made = Callable[
    [Sequence[Vessel], int, float, Tank], World
]  # of vessels, number of boats, integration step [s]


def open_water(threads: int | None = None) -> Made:
    """Worlds that are compiled batches; a core for each of the threads, unless told all there are."""
    return lambda vessels, n, step, _: Batch(vessels, n, step, threads=threads)


class Step(NamedTuple):
    """(n,) each, of a control step; `norms` are those of the boats whose episode it ends, by number in `over`."""

    reward: Array
    ended: Flags
    late: Flags  # out of time
    over: Boats
    norms: dict[str, Array]


class Play:
    """n boats at one task, each in an episode of its own."""

    def __init__(
        self,
        task: Task,
        variation: Variation,
        n: int,
        period: float,
        step: float,
        duration: float,
        world: Made,
        tank: Tank | None = None,
    ) -> None:
        """A control step of `period` s is a whole number of integration steps of `step` s. Raises BadInput.

        `tank` takes the place of the task's own basin.
        """
        self.task, self.variation, self.n = task, variation, n
        if not 0.0 < period < inf:
            raise BadInput(f"period = {period:g} s; allowed is more than 0")
        self.period, self.duration = period, duration
        self.substeps = round(period / step) if 0.0 < step < inf else 0
        if self.substeps < 1 or abs(self.substeps * step - period) > 1e-9 * period:
            raise BadInput(
                f"step = {step:g} s; allowed are whole parts of the period, {period:g} s"
            )
        if not period <= duration < inf:
            raise BadInput(f"duration = {duration:g} s; allowed is at least a period, {period:g} s")
        self.vessel = variation.boats[0]
        self.controls: Controls = controls(self.vessel, type(task).use)
        task.check(self.vessel.name, self.controls.names)
        self.scale = scale_of(self.vessel, self.controls.commands(self.controls.ahead))
        self.tank = tank or task.basin(self.scale)
        self.world = world(variation.boats, n, step, self.tank)
        self.commands = np.tile(self.controls.neutral, (n, 1))  # in force
        self._columns = columns(self.vessel)
        self._hulls_of = Hulls.of(variation.boats)
        self._hulls = self._hulls_of.at(np.zeros(n, dtype=np.int64))
        self._last = round(duration / period)  # control steps of an episode
        self._steps = np.zeros(n, dtype=np.int64)
        self._goal = np.zeros((n, type(task).goals))
        self._memory = np.zeros((n, type(task).memory))
        self._actions = np.zeros((n, len(self.controls.names)))
        signals = task.signals(self.scale)
        self.signals: tuple[Signal, ...] = (*signals, *self._commanded())
        self._of_task, self._per_bound = (
            len(signals),
            np.array([[1.0 / s.bound] for s in self.signals]),
        )
        self._seen: tuple[Array, ...] = ()

    def _commanded(self) -> list[Signal]:
        pairs = zip(self.controls.names, self.controls.words, strict=True)
        return [Signal(f"last_{name}", 1.0, f"action before: {words}") for name, words in pairs]

    def begin(self, seeds: episode_random.Seeds, boats: Boats) -> None:
        """Begin episodes of boats (k,) by their seeds (k,)."""
        task, size = self.task, self.variation.shares
        lots = episode_random.shares(seeds, size + type(task).shares)
        which = self.variation.begin(self.world, lots[:, :size], boats)
        starts, goals = task.begin(lots[:, size:], self.scale)
        states = np.zeros((len(boats), 2 * len(self.vessel.dof)))
        states[:, self._columns] = starts
        self.world.reset(states, None, boats)
        hulls = self._hulls_of.at(which)
        for all_of, here in zip(self._hulls, hulls, strict=True):
            all_of[boats] = here
        self._steps[boats], self._goal[boats], self._actions[boats] = 0, goals, 0.0
        self.commands[boats] = self.controls.neutral
        seen = task.look(Motion(*starts.T), np.zeros(len(boats)), goals, hulls, self.scale)
        self._memory[boats] = task.start(seen, self.scale)
        if not self._seen:  # the very first, of all boats
            self._look()
        for now, new in zip(self._seen, seen, strict=True):
            now[boats] = new

    def step(self, actions: Array) -> Step:
        """One control step with actions (n, A), from -1 to 1."""
        self._actions[:] = np.minimum(np.maximum(actions, -1.0), 1.0)
        return self.step_commands(self.controls.commands(self._actions))

    def step_commands(self, commands: Array) -> Step:
        """One control step with commands (n, C) as the vessel takes them."""
        self.commands = commands
        self.world.advance(commands, self.substeps)
        self._steps += 1
        self._look()
        reward, ended = self.task.judge(self._seen, self._memory, self.period, self.scale)
        late = (self._steps >= self._last) & ~ended
        over = np.flatnonzero(ended | late)
        norms: dict[str, Array] = {}
        if len(over):
            seen, memory = tuple(x[over] for x in self._seen), self._memory[over]
            norms = self.task.norms(seen, memory, self.t[over], self.scale)
        return Step(reward, ended, late, over, norms)

    def _look(self) -> None:
        self._seen = self.task.look(self.motion, self.t, self._goal, self._hulls, self.scale)

    @property
    def t(self) -> Array:
        """(n,) time [s] of each boat's episode."""
        return np.asarray(self._steps * self.period, dtype=float)

    @property
    def motion(self) -> Motion:
        """True motion of all boats."""
        return Motion(*self.world.states.T[self._columns])

    def observations(self, normalised: bool, boats: Boats | slice = EVERYONE) -> Seen:
        """(k, S) of boats as `signals` list them, over their bounds or in their units, clipped to these."""
        actions = self._actions[boats].T
        rows = np.empty((len(self.signals), actions.shape[1]))
        for row, seen in zip(rows, self._seen[: self._of_task], strict=False):
            row[:] = seen[boats]
        rows[self._of_task :] = actions
        rows *= self._per_bound
        np.minimum(np.maximum(rows, -1.0, out=rows), 1.0, out=rows)
        if not isfinite(rows.sum()):  # of a boat whose motion ran away; its episode ends
            np.nan_to_num(rows, copy=False)
        if not normalised:
            rows /= self._per_bound
        return np.ascontiguousarray(rows.T, dtype=np.float32)
